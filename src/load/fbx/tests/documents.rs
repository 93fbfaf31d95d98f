//! Small FBX files, each as a tree.

use super::tree::{Entry, Value, entry, list, object, one, properties};

/// A second, in the units of key frames.
const SECOND: i64 = 46_186_158_000;

/// A file with these objects and connections. `z_up` says whether Z points up; the unit is in centimetres.
pub(crate) fn document(z_up: bool, unit: f64, objects: Vec<Entry>, connections: &[Link]) -> Vec<Entry> {
    let axes: [f64; 6] = if z_up { [2.0, 1.0, 1.0, -1.0, 0.0, 1.0] } else { [1.0, 1.0, 2.0, 1.0, 0.0, 1.0] };
    let settings = properties(&[
        ("UpAxis", "int", &axes[0..1]),
        ("UpAxisSign", "int", &axes[1..2]),
        ("FrontAxis", "int", &axes[2..3]),
        ("FrontAxisSign", "int", &axes[3..4]),
        ("CoordAxis", "int", &axes[4..5]),
        ("CoordAxisSign", "int", &axes[5..6]),
        ("UnitScaleFactor", "double", &[unit]),
    ]);
    vec![
        list("FBXHeaderExtension", vec![one("FBXHeaderVersion", 1003), one("FBXVersion", 7400)]),
        list("GlobalSettings", vec![one("Version", 1000), settings]),
        list("Objects", objects),
        list("Connections", connections.iter().map(Link::entry).collect()),
    ]
}

/// A connection: what to what, by numbers, and to which of its properties.
pub(crate) struct Link(pub i64, pub i64, pub &'static str);

impl Link {
    pub(super) fn entry(&self) -> Entry {
        let Self(from, to, property) = *self;
        let mut values: Vec<Value> = vec![if property.is_empty() { "OO" } else { "OP" }.into(), from.into(), to.into()];
        values.extend((!property.is_empty()).then(|| property.into()));
        entry("C", values)
    }
}

/// A node with properties.
pub(crate) fn model(id: i64, name: &str, kind: &str, all: &[(&str, &str, &[f64])]) -> Entry {
    object("Model", id, &format!("Model::{name}"), kind, vec![one("Version", 232), properties(all)])
}

/// A mesh of vertices and polygons, with more entries.
pub(crate) fn geometry(id: i64, vertices: &[f64], polygons: &[&[i32]], more: Vec<Entry>) -> Entry {
    let indices = polygons.iter().flat_map(|polygon| {
        let last = polygon.len() - 1;
        polygon.iter().enumerate().map(move |(i, &vertex)| if i == last { -1 - vertex } else { vertex })
    });
    let mut children = vec![
        one("Vertices", vertices.to_vec()),
        one("PolygonVertexIndex", indices.collect::<Vec<i32>>()),
        one("GeometryVersion", 124),
    ];
    children.extend(more);
    object("Geometry", id, "Geometry::mesh", "Mesh", children)
}

/// A layer of a mesh, such as its normals: how it maps to corners, and its lists.
pub(crate) fn layer(name: &str, mapping: &str, lists: Vec<Entry>) -> Entry {
    let is_indexed = lists.len() > 1 || name.ends_with("Material");
    let reference = if is_indexed { "IndexToDirect" } else { "Direct" };
    let mut children = vec![
        one("Version", 101),
        one("Name", ""),
        one("MappingInformationType", mapping),
        one("ReferenceInformationType", reference),
    ];
    children.extend(lists);
    Entry { name: name.to_owned(), values: vec![0.into()], children }
}

/// A prism with hexagonal caps of radius 100 around Z, from z = 0 to z = 50: two hexagons and six squares.
pub(crate) fn prism(more: Vec<Entry>) -> Entry {
    let ring = |z: f64| {
        (0..6).flat_map(move |i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::FRAC_PI_3).sin_cos();
            [100.0 * cos, 100.0 * sin, z]
        })
    };
    let vertices: Vec<f64> = ring(0.0).chain(ring(50.0)).collect();
    let sides: Vec<Vec<i32>> = (0..6).map(|i| vec![i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6]).collect();
    let mut polygons: Vec<&[i32]> = vec![&[5, 4, 3, 2, 1, 0], &[6, 7, 8, 9, 10, 11]];
    polygons.extend(sides.iter().map(|side| &side[..]));
    geometry(10, &vertices, &polygons, more)
}

/// The prism in centimetres with Z up, whose sides are smooth and whose caps are flat.
pub(crate) fn smoothed_prism() -> Vec<Entry> {
    let smoothing = layer("LayerElementSmoothing", "ByPolygon", vec![one("Smoothing", vec![0, 0, 1, 1, 1, 1, 1, 1])]);
    let objects =
        vec![prism(vec![smoothing]), model(20, "prism", "Mesh", &[("Lcl Translation", "Lcl Translation", &[0.0; 3])])];
    document(true, 1.0, objects, &[Link(20, 0, ""), Link(10, 20, "")])
}

/// Curves of one property of an object: the curve node with its number, and for each component its key frames as time in s and
/// value. `interpolation` is 2 for steps and 4 for lines.
pub(crate) fn curves(
    id: i64,
    (target, property): (i64, &'static str),
    components: &[(&'static str, &[(f64, f64)])],
    interpolation: i32,
) -> (Vec<Entry>, Vec<Link>) {
    let kind = property.rsplit(' ').next().unwrap_or_default();
    let defaults: Vec<(&str, &str, &[f64])> =
        components.iter().map(|(name, keys)| (*name, "Number", first(keys))).collect();
    let mut objects =
        vec![object("AnimationCurveNode", id, &format!("AnimCurveNode::{kind}"), "", vec![properties(&defaults)])];
    let mut links = vec![Link(id, LAYER, ""), Link(id, target, property)];
    for (i, &(component, keys)) in (1_i64..).zip(components) {
        let times: Vec<i64> = keys.iter().map(|(time, _)| (time * SECOND as f64).round() as i64).collect();
        let children = vec![
            one("Default", 0.0),
            one("KeyVer", 4008),
            one("KeyTime", times),
            one("KeyValueFloat", keys.iter().map(|(_, value)| *value).collect::<Vec<f64>>()),
            one("KeyAttrFlags", vec![interpolation]),
            one("KeyAttrDataFloat", vec![0.0; 4]),
            one("KeyAttrRefCount", vec![keys.len() as i32]),
        ];
        objects.push(object("AnimationCurve", id + i, "AnimCurve::", "", children));
        links.push(Link(id + i, id, component));
    }
    (objects, links)
}

/// The value of the first key frame, as a list.
fn first(keys: &[(f64, f64)]) -> &[f64] {
    keys.first().map_or(&[], |key| std::slice::from_ref(&key.1))
}

/// The number of the layer of all curves.
pub(super) const LAYER: i64 = 901;

/// Adds parts of a document, such as a clip and its curves.
pub(super) fn add<const N: usize>(
    (objects, links): (&mut Vec<Entry>, &mut Vec<Link>),
    parts: [(Vec<Entry>, Vec<Link>); N],
) {
    for (more, joined) in parts {
        objects.extend(more);
        links.extend(joined);
    }
}

/// A stack with one layer, from 0 to a time in s.
pub(crate) fn stack(name: &str, end: f64) -> (Vec<Entry>, Vec<Link>) {
    span(name, [0.0, end])
}

/// A stack with one layer, between two times in s.
pub(crate) fn span(name: &str, [start, stop]: [f64; 2]) -> (Vec<Entry>, Vec<Link>) {
    let time = |name: &str, seconds: f64| {
        let ticks = (seconds * SECOND as f64) as i64;
        entry("P", vec![name.into(), "KTime".into(), "Time".into(), "".into(), ticks.into()])
    };
    let times = list("Properties70", vec![time("LocalStart", start), time("LocalStop", stop)]);
    let objects = vec![
        object("AnimationStack", 900, &format!("AnimStack::{name}"), "", vec![times]),
        object("AnimationLayer", LAYER, "AnimLayer::base", "", vec![one("Version", 100)]),
    ];
    (objects, vec![Link(LAYER, 900, "")])
}

/// A matrix that moves, as its columns.
fn moved([x, y, z]: [f64; 3]) -> Vec<f64> {
    vec![1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, z, 1.0]
}

/// A strip in metres with Y up, from (0, 0, 0) to (4, 1, 0) with a vertex pair at every metre. The bone `root` at the origin moves
/// its left half, and `tip` at (2, 0, 0) its right half; both have half of the middle. Within a second `tip` turns by 90 degrees
/// about Z.
pub(crate) fn skinned_strip() -> Vec<Entry> {
    let vertices: Vec<f64> = (0..=4).flat_map(|x| [[x, 0, 0], [x, 1, 0]]).flatten().map(f64::from).collect();
    let polygons: Vec<Vec<i32>> = (0..4).map(|i| vec![2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1]).collect();
    let polygons: Vec<&[i32]> = polygons.iter().map(|polygon| &polygon[..]).collect();
    let cluster = |id, name: &str, indices: Vec<i32>, weights: Vec<f64>, at: f64| {
        let children = vec![
            one("Version", 100),
            one("Indexes", indices),
            one("Weights", weights),
            one("Transform", moved([-at, 0.0, 0.0])),
            one("TransformLink", moved([at, 0.0, 0.0])),
        ];
        object("Deformer", id, &format!("SubDeformer::{name}"), "Cluster", children)
    };
    let mut objects = vec![
        geometry(10, &vertices, &polygons, Vec::new()),
        model(20, "strip", "Mesh", &[]),
        model(30, "root", "LimbNode", &[]),
        model(31, "tip", "LimbNode", &[("Lcl Translation", "Lcl Translation", &[2.0, 0.0, 0.0])]),
        object("Deformer", 40, "Deformer::skin", "Skin", vec![one("Version", 101), one("Link_DeformAcuracy", 50.0)]),
        cluster(41, "root", vec![0, 1, 2, 3, 4, 5], vec![1.0, 1.0, 1.0, 1.0, 0.5, 0.5], 0.0),
        cluster(42, "tip", vec![4, 5, 6, 7, 8, 9], vec![0.5, 0.5, 1.0, 1.0, 1.0, 1.0], 2.0),
    ];
    let mut links = vec![
        Link(20, 0, ""),
        Link(30, 0, ""),
        Link(31, 30, ""),
        Link(10, 20, ""),
        Link(40, 10, ""),
        Link(41, 40, ""),
        Link(42, 40, ""),
        Link(30, 41, ""),
        Link(31, 42, ""),
    ];
    let turn: &[(f64, f64)] = &[(0.0, 0.0), (1.0, 90.0)];
    let still: &[(f64, f64)] = &[(0.0, 0.0)];
    let components = [("d|X", still), ("d|Y", still), ("d|Z", turn)];
    add((&mut objects, &mut links), [stack("wave", 1.0), curves(50, (31, "Lcl Rotation"), &components, 4)]);
    document(false, 100.0, objects, &links)
}

/// A square in metres whose corner 2 rises along Z: by 1 at half of the weight, and by 4 at all of it. The weight grows from 0 to
/// 100 % within two seconds.
pub(crate) fn morphed_square() -> Vec<Entry> {
    let shape = |id, height: f64| {
        let children = vec![
            one("Version", 100),
            one("Indexes", vec![2]),
            one("Vertices", vec![0.0, 0.0, height]),
            one("Normals", vec![0.0, 0.0, 0.0]),
        ];
        object("Geometry", id, "Geometry::shape", "Shape", children)
    };
    let channel = vec![one("Version", 100), one("DeformPercent", 0.0), one("FullWeights", vec![50.0, 100.0])];
    let mut objects = vec![
        geometry(10, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0], &[&[0, 1, 2, 3]], Vec::new()),
        model(20, "square", "Mesh", &[]),
        object("Deformer", 40, "Deformer::shapes", "BlendShape", vec![one("Version", 100)]),
        object("Deformer", 41, "SubDeformer::rise", "BlendShapeChannel", channel),
        shape(42, 1.0),
        shape(43, 4.0),
    ];
    let mut links =
        vec![Link(20, 0, ""), Link(10, 20, ""), Link(40, 10, ""), Link(41, 40, ""), Link(42, 41, ""), Link(43, 41, "")];
    let keys: &[(f64, f64)] = &[(0.0, 0.0), (2.0, 100.0)];
    let components = [("d|DeformPercent", keys)];
    add((&mut objects, &mut links), [stack("rise", 2.0), curves(50, (41, "DeformPercent"), &components, 4)]);
    document(false, 100.0, objects, &links)
}

/// A square in metres with texture coordinates, colours of corners, and a Phong material. Its texture's image is embedded, or
/// named by a path.
pub(crate) fn textured_square(image: Result<&[u8], &str>) -> Vec<Entry> {
    square_textured_as("DiffuseColor", image, 100.0)
}

/// The same square with the texture as this property of its material, in units of so many centimetres.
pub(crate) fn square_textured_as(property: &'static str, image: Result<&[u8], &str>, unit: f64) -> Vec<Entry> {
    let uvs = layer(
        "LayerElementUV",
        "ByPolygonVertex",
        vec![one("UV", vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]), one("UVIndex", vec![0, 1, 2, 3])],
    );
    let colors = layer("LayerElementColor", "AllSame", vec![one("Colors", vec![1.0, 0.5, 0.25, 1.0])]);
    let materials = layer("LayerElementMaterial", "AllSame", vec![one("Materials", vec![0])]);
    let normals = layer("LayerElementNormal", "ByPolygon", vec![one("Normals", vec![0.0, 0.0, 2.0])]);
    let look = properties(&[
        ("DiffuseColor", "Color", &[0.2, 0.4, 0.6]),
        ("DiffuseFactor", "Number", &[0.5]),
        ("EmissiveColor", "Color", &[0.1, 0.0, 0.3]),
        ("EmissiveFactor", "Number", &[2.0]),
        ("Opacity", "Number", &[0.75]),
    ]);
    let path = image.err().unwrap_or("C:\\Users\\artist\\wood.png");
    let mut video = vec![one("Type", "Clip"), one("FileName", path), one("RelativeFilename", path)];
    video.extend(image.ok().map(|bytes| entry("Content", vec![Value::Bytes(bytes.to_vec())])));
    let texture = vec![
        one("Type", "TextureVideoClip"),
        one("FileName", path),
        one("RelativeFilename", path),
        properties(&[("WrapModeU", "enum", &[1.0]), ("Scaling", "Vector3D", &[2.0, 3.0, 1.0])]),
    ];
    let square = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let objects = vec![
        geometry(10, &square, &[&[0, 1, 2, 3]], vec![normals, uvs, colors, materials]),
        model(20, "square", "Mesh", &[]),
        object("Material", 60, "Material::paint", "", vec![one("ShadingModel", "phong"), look]),
        object("Texture", 61, "Texture::wood", "", texture),
        object("Video", 62, "Video::wood", "Clip", video),
    ];
    let links = [Link(20, 0, ""), Link(10, 20, ""), Link(60, 20, ""), Link(61, 60, property), Link(62, 61, "")];
    document(false, unit, objects, &links)
}

/// A PNG image of two texels: red above blue.
pub(crate) fn image() -> Vec<u8> {
    let pixels = image::RgbImage::from_raw(1, 2, vec![255, 0, 0, 0, 0, 255]).expect("two texels");
    let mut png = std::io::Cursor::new(Vec::new());
    pixels.write_to(&mut png, image::ImageFormat::Png).expect("an image in memory");
    png.into_inner()
}

/// A NURBS surface: the orders along u and v, numbers of control points, forms, control points with their weights, and knots.
#[derive(Clone)]
pub(crate) struct Nurbs {
    pub orders: [i64; 2],
    pub sizes: [i64; 2],
    pub forms: [&'static str; 2],
    pub points: Vec<f64>,
    pub knots: [Vec<f64>; 2],
    pub flips: bool,
}

impl Nurbs {
    /// A surface between the same curve at two heights z, of control points with x, y and a weight.
    pub(super) fn extruded(order: i64, form: &'static str, curve: &[[f64; 3]], knots: Vec<f64>, height: f64) -> Self {
        let row = |z: f64| curve.iter().flat_map(move |&[x, y, weight]| [x, y, z, weight]);
        Self {
            orders: [order, 2],
            sizes: [curve.len() as i64, 2],
            forms: [form, "Open"],
            points: row(0.0).chain(row(height)).collect(),
            knots: [knots, vec![0.0, 0.0, 1.0, 1.0]],
            flips: false,
        }
    }

    /// The geometry with this number.
    pub(super) fn entry(&self, id: i64) -> Entry {
        let pair = |name: &str, [u, v]: [i64; 2]| entry(name, vec![u.into(), v.into()]);
        let children = vec![
            pair("NurbsSurfaceOrder", self.orders),
            pair("Dimensions", self.sizes),
            pair("Step", [4, 4]),
            entry("Form", self.forms.iter().map(|form| (*form).into()).collect()),
            one("Points", self.points.clone()),
            one("KnotVectorU", self.knots[0].clone()),
            one("KnotVectorV", self.knots[1].clone()),
            one("FlipNormals", i64::from(self.flips)),
        ];
        object("Geometry", id, "Geometry::surface", "NurbsSurface", children)
    }
}

/// A quarter of a cylinder of radius 1 around Z, from z = 0 to z = 2.
pub(crate) fn quarter_cylinder() -> Nurbs {
    let curve = [[1.0, 0.0, 1.0], [1.0, 1.0, std::f64::consts::FRAC_1_SQRT_2], [0.0, 1.0, 1.0]];
    Nurbs::extruded(3, "Open", &curve, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], 2.0)
}
