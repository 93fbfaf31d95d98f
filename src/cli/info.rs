//! `pnaen info`: prints what a file holds, as text or as JSON.

use std::fmt;

use serde::Serialize;

use super::camera_and_light_report::{CameraInfo, LightInfo};
use super::material_report::{MaterialInfo, numbers};
use super::options::WeldOption;
use super::{CliError, to_json, write_text};
use geometry::mesh::crease_band::CreaseBand;
use geometry::mesh::rig::{AnimatedCounts, Clip, Rig};
use geometry::mesh::{EdgeCounts, NormalFaults, Repairs, TJunction, Topology, WeldPreview, t_junctions, weld_previews};
use geometry::names::{on_one_line, shown};
use geometry::numbers::exact;
use geometry::progress::{Cancelled, Progress};
use inspect::engine::{self, Loaded};
use load::part_tree::{Branch, tree};
use load::selection::is_material;
use load::{Contents, Source};

#[derive(Debug, clap::Args)]
pub struct Args {
    #[arg(help = super::options::mesh_help(), value_parser = super::options::source())]
    pub file: Source,
    #[command(flatten)]
    pub weld: WeldOption,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    let progress = Progress::default();
    let loaded = engine::load(&args.file, &args.weld.preparation(), &progress)?;
    args.weld.parts.say_idle(|own| own.is_of_tessellation(), "a surface or detail of --part has no effect here");
    let info = Info::new(&loaded, &progress)?;
    let text = if args.json { to_json(&info)? } else { info.to_string() };
    Ok(write_text("-".as_ref(), &text)?)
}

/// How many T-junctions the text lists.
const SHOWN: usize = 10;

/// A mesh in numbers.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Info {
    pub name: String,
    pub triangles: u32,
    /// The weld tolerance, relative to the bounding diagonal; 0 joins only equal positions.
    pub weld: f32,
    /// The crease band; all other numbers are of the mesh that has it.
    pub crease_band: CreaseBand,
    /// Triangles that are left out because two of their corners lie on one point.
    pub degenerate: u32,
    /// Triangles whose three corners lie in line, to within rounding. They are patches, since their edges join others'.
    pub collinear: u32,
    pub corners: u32,
    pub points: u32,
    pub materials: Vec<MaterialInfo>,
    pub lights: Vec<LightInfo>,
    pub cameras: Vec<CameraInfo>,
    /// What the file offers; its materials aren't among the parts.
    #[serde(flatten)]
    pub contents: Contents,
    pub animations: Vec<AnimationInfo>,
    pub edges: EdgeCounts,
    /// What each weld tolerance on offer would join and collapse, compared with the exact weld.
    pub joins: Vec<WeldPreview>,
    /// See [`t_junctions()`].
    pub t_junctions: u32,
    /// The positions of all T-junctions.
    pub t_junctions_at: Vec<TJunctionInfo>,
    pub repairs: Repairs,
    pub normal_faults: NormalFaults,
    pub bounds: BoundsInfo,
    /// Points in use - edges + patches.
    pub euler_characteristic: i64,
    /// Every edge has exactly two sides.
    pub closed: bool,
    /// The triangles at every edge of two sides are wound the same way.
    pub oriented: bool,
    pub warnings: Vec<String>,
}

/// An animation in numbers.
#[derive(Clone, Debug, Serialize)]
pub(super) struct AnimationInfo {
    pub name: String,
    /// s.
    pub duration: f64,
    /// What it moves, as counts.
    #[serde(flatten)]
    pub moved: AnimatedCounts,
}

/// A T-junction with positions, in object units.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct TJunctionInfo {
    /// The edge's ends, in its own direction.
    pub edge: [[f32; 3]; 2],
    pub point: [f32; 3],
    /// Where along the edge, 0 to 1.
    pub t: f32,
    /// Between the point and the edge.
    pub distance: f32,
}

/// The bounding box, in object units.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct BoundsInfo {
    pub min: [f32; 3],
    pub max: [f32; 3],
    pub diagonal: f32,
}

impl Info {
    pub(super) fn new(loaded: &Loaded, progress: &Progress) -> Result<Self, Cancelled> {
        let (mesh, topology, weld) = (&*loaded.mesh, &*loaded.topology, loaded.preparation.weld);
        // A weld tolerance applies to the mesh as it was read, before it got its crease band.
        let exact = (weld == 0.0 && loaded.crease_band.width == 0.0).then_some(topology);
        let t_junctions = t_junctions(topology, progress)?;
        // Divided among the cores already.
        let normal_faults = NormalFaults::new(mesh, topology);
        let counts = || (topology.edge_counts(), euler_characteristic(topology), mesh.bounds());
        let ((edges, euler_characteristic, bounds), joins) =
            rayon::join(counts, || weld_previews(&loaded.read, exact, progress));
        let mut contents = Contents::clone(&loaded.contents);
        contents.parts.retain(|part| !is_material(&part.name));
        Ok(Self {
            name: mesh.name.clone(),
            triangles: mesh.triangles.len() as u32,
            weld,
            crease_band: loaded.crease_band,
            degenerate: topology.degenerate,
            collinear: (0..topology.patches.len() as u32).filter(|patch| topology.is_in_line(*patch)).count() as u32,
            corners: mesh.corners.len() as u32,
            points: topology.points.len() as u32,
            materials: mesh.materials.iter().map(MaterialInfo::new).collect(),
            lights: mesh.lights.iter().map(LightInfo::new).collect(),
            cameras: mesh.cameras.iter().map(CameraInfo::new).collect(),
            contents,
            animations: mesh.rig.as_deref().map_or_else(Vec::new, animations),
            edges,
            joins: joins?,
            t_junctions: t_junctions.len() as u32,
            t_junctions_at: t_junctions.iter().map(|junction| t_junction(topology, junction)).collect(),
            repairs: mesh.repairs,
            normal_faults,
            bounds: BoundsInfo { min: bounds.min.into(), max: bounds.max.into(), diagonal: bounds.diagonal() },
            euler_characteristic,
            closed: topology.is_closed(),
            oriented: topology.is_oriented(),
            warnings: loaded.warnings.clone(),
        })
    }
}

impl fmt::Display for Info {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.write_mesh(f)?;
        self.write_odd(f)?;
        writeln!(f, "from          {} (object units)", numbers(&self.bounds.min))?;
        writeln!(f, "to            {}, diagonal {}", numbers(&self.bounds.max), exact(self.bounds.diagonal))?;
        self.materials.iter().try_for_each(|material| write!(f, "{material}"))?;
        self.lights.iter().try_for_each(|light| write!(f, "{light}"))?;
        self.cameras.iter().try_for_each(|camera| write!(f, "{camera}"))?;
        self.write_contents(f)?;
        for AnimationInfo { name, duration, moved } in &self.animations {
            // Files have times in f32: an f64 would print digits that the file doesn't have.
            let name = shown(name);
            writeln!(f, "animation     {name}: {} s, moves {moved}", *duration as f32)?;
        }
        self.warnings.iter().try_for_each(|warning| writeln!(f, "warning       {}", on_one_line(warning)))
    }
}

impl Info {
    /// What the file offers to choose from.
    fn write_contents(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Contents { variants, scenes, scene, parts, morph_targets } = &self.contents;
        variants.iter().try_for_each(|variant| writeln!(f, "variant       {}", shown(variant)))?;
        // Most files have one scene, of which nothing is to be said.
        for (i, name) in scenes.iter().enumerate().filter(|_| scenes.len() > 1) {
            let is_read = if Some(i) == *scene { ", which is shown" } else { "" };
            writeln!(f, "scene         {}{is_read}", shown(name))?;
        }
        for Branch { path, part, parts, shown: left, triangles, .. } in tree(parts).iter().filter(|_| parts.len() > 1) {
            let left_out = if *left == 0 { ", left out" } else { "" };
            let (kind, count) =
                if part.is_some() { ("part ", String::new()) } else { ("group", format!("{parts} parts, ")) };
            writeln!(f, "{kind}         {}: {count}{triangles} triangles{left_out}", shown(path))?;
        }
        for (name, weight) in morph_targets {
            writeln!(f, "morph target  {}: {weight} at rest in the file", shown(name))?;
        }
        Ok(())
    }

    /// What the mesh consists of.
    fn write_mesh(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let EdgeCounts { smooth, split, seam, boundary, non_manifold } = self.edges;
        let welded = match self.weld {
            weld if weld > 0.0 => format!("within {weld} of the bounding diagonal"),
            _ => "where exactly equal".to_owned(),
        };
        writeln!(f, "{}", shown(&self.name))?;
        let Self { triangles, degenerate, collinear, .. } = self;
        let in_line = if *collinear > 0 { format!("; {collinear} with their corners in line") } else { String::new() };
        writeln!(f, "triangles     {triangles} ({degenerate} degenerate, left out{in_line})")?;
        writeln!(f, "points        {} (welded {welded})", self.points)?;
        writeln!(f, "corners       {}", self.corners)?;
        writeln!(f, "edges         {}", self.edges.total())?;
        writeln!(f, "  smooth        {smooth}")?;
        writeln!(f, "  split normal  {split}")?;
        writeln!(f, "  uv seam       {seam}")?;
        writeln!(f, "  boundary      {boundary}")?;
        writeln!(f, "  non-manifold  {non_manifold}")?;
        let closed = if self.closed { "closed" } else { "open" };
        let wound = if self.oriented { "" } else { ", wound both ways" };
        writeln!(f, "surface       {closed}{wound}, Euler characteristic {}", self.euler_characteristic)?;
        let CreaseBand { width, creases, .. } = self.crease_band;
        if width > 0.0 {
            writeln!(f, "crease band   {width} of the bounding diagonal wide, along {creases} creases")?;
        }
        Ok(())
    }

    /// What may be wrong with the mesh.
    fn write_odd(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Repairs { normals_made, normals_replaced, normals_rescaled, denormals } = self.repairs;
        let NormalFaults { against_face, opposite, along_edge } = self.normal_faults;
        writeln!(
            f,
            "weld          (what each tolerance would join; tolerances are relative to the bounding diagonal)"
        )?;
        self.joins.iter().try_for_each(|join| writeln!(f, "  {:<14e}{join}", join.tolerance))?;
        writeln!(
            f,
            "T-junctions   {} (points on other triangles' open edges; no tessellation closes these gaps)",
            self.t_junctions
        )?;
        for TJunctionInfo { edge: [from, to], point, .. } in self.t_junctions_at.iter().take(SHOWN) {
            let [point, from, to] = [point, from, to].map(|[x, y, z]| format!("{x} {y} {z}"));
            writeln!(f, "  at {point} between {from} and {to}")?;
        }
        if self.t_junctions_at.len() > SHOWN {
            writeln!(f, "  and {} more", self.t_junctions_at.len() - SHOWN)?;
        }
        writeln!(f, "repairs       (triangles' corners)")?;
        writeln!(f, "  made          {normals_made} (had no normal: smooth up to the crease angle)")?;
        writeln!(f, "  replaced      {normals_replaced} (normal zero or not finite)")?;
        writeln!(f, "  rescaled      {normals_rescaled} (normal not of length 1)")?;
        writeln!(f, "  denormal      {denormals} (coordinates so small that they are 0 now)")?;
        writeln!(f, "normals")?;
        writeln!(f, "  against face  {against_face} (corners whose normal opposes their triangle's)")?;
        writeln!(f, "  opposite      {opposite} (edges where two sides' normals oppose each other)")?;
        writeln!(f, "  along edge    {along_edge} (corners whose normal runs along an edge)")
    }
}

fn t_junction(topology: &Topology, junction: &TJunction) -> TJunctionInfo {
    let at = |point: u32| topology.points[point as usize].to_array();
    let TJunction { edge, point, t, distance } = *junction;
    TJunctionInfo { edge: topology.edge_points(&topology.edges[edge as usize]).map(at), point: at(point), t, distance }
}

fn animations(rig: &Rig) -> Vec<AnimationInfo> {
    let own = |clip: &Clip| (clip.name.clone(), clip.duration, rig.animated_counts(clip));
    rig.clips.iter().map(own).map(|(name, duration, moved)| AnimationInfo { name, duration, moved }).collect()
}

/// Points in use - edges + patches: 2 for a sphere, 0 for a torus.
fn euler_characteristic(topology: &Topology) -> i64 {
    let mut used = vec![false; topology.points.len()];
    for patch in 0..topology.patches.len() as u32 {
        topology.patch_points(patch).into_iter().for_each(|point| used[point as usize] = true);
    }
    let points = used.iter().filter(|used| **used).count();
    points as i64 - topology.edges.len() as i64 + topology.patches.len() as i64
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{Vec2, Vec3};

    use super::*;
    use geometry::mesh::shapes::Shape;
    use geometry::mesh::{Corner, Mesh};
    use inspect::engine::Preparation;

    fn info(mesh: &Mesh, weld: f32) -> Info {
        let progress = Progress::new();
        let topology = Topology::build_within(mesh, weld, &progress).unwrap();
        let preparation = Preparation { weld, ..Preparation::default() };
        let loaded = Loaded { preparation, ..Loaded::from_mesh(Arc::new(mesh.clone()), Arc::new(topology)) };
        Info::new(&loaded, &progress).unwrap()
    }

    #[test]
    fn info_of_a_torus() {
        let mesh = Shape::Torus.build();
        let info = info(&mesh, 0.0);
        assert_eq!((info.degenerate, info.collinear), (0, 0));
        assert_eq!((info.triangles, info.points, info.euler_characteristic, info.closed), (256, 128, 0, true));
        assert_eq!((info.materials.len(), info.materials[0].triangles), (1, 256));
        let json = serde_json::to_value(&info).unwrap();
        assert_eq!(json["edges"]["seam"], 24);
    }

    #[test]
    fn a_closed_mesh_with_a_triangle_wound_the_other_way_is_closed_and_wound_both_ways() {
        let mut mesh = Shape::Torus.build();
        let mut triangles = mesh.triangles.to_vec();
        triangles[7].swap(0, 1);
        mesh.triangles = triangles.into();
        let turned = info(&mesh, 0.0);
        assert_eq!((turned.closed, turned.oriented), (true, false));
        assert!(turned.to_string().contains("closed, wound both ways, Euler characteristic 0"), "{turned}");
        let topology = Topology::new(&mesh);
        assert!(topology.is_closed() && !topology.is_closed_and_oriented(), "as leaks are judged by");
    }

    #[test]
    fn info_of_an_empty_mesh() {
        let info = info(&Mesh::default(), 0.0);
        assert_eq!((info.triangles, info.euler_characteristic, info.closed), (0, 0, false));
    }

    #[test]
    fn triangles_in_line_are_not_degenerate_and_are_said() {
        let mut all = comb();
        // A third, a tenth and a sum of them are rounded; the second is bent by a thousandth.
        let at = |x: f32, y: f32| Corner { position: Vec3::new(x, y, 0.1 * x), normal: Vec3::Z, uv: Vec2::ZERO };
        let first = all.corners.len() as u32;
        all.corners.extend([
            at(0.0, 0.0),
            at(1.0 / 3.0, 0.1),
            at(1.0, 0.3),
            at(0.0, 0.0),
            at(1.0, 0.301),
            at(2.0, 0.6),
        ]);
        let added = [first, first + 3].map(|a| [a, a + 1, a + 2]);
        all.triangles = all.triangles.iter().copied().chain(added).chain([[0, 0, 1]]).collect::<Vec<_>>().into();
        let info = info(&all, 0.0);
        assert_eq!((info.triangles, info.degenerate, info.collinear), (16, 1, 1));
        let text = info.to_string();
        assert!(text.contains("16 (1 degenerate, left out; 1 with their corners in line)"), "{text}");
    }

    /// A triangle over the edge from 0 to 16 along x, and twelve with their tips on it.
    fn comb() -> Mesh {
        let corner = |x: f32, y: f32| Corner { position: Vec3::new(x, y, 0.0), normal: Vec3::Z, uv: Vec2::ZERO };
        let tooth = |i: u32| [corner(i as f32, 0.0), corner(i as f32 - 0.5, -1.0), corner(i as f32 + 0.5, -1.0)];
        let mut corners = vec![corner(0.0, 0.0), corner(16.0, 0.0), corner(8.0, 1.0)];
        corners.extend((1..13).flat_map(tooth));
        let triangles = (0..13).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect::<Vec<_>>().into();
        Mesh { corners, triangles, ..Mesh::default() }
    }

    #[test]
    fn t_junctions_are_listed_with_their_positions() {
        let info = info(&comb(), 0.0);
        assert_eq!((info.t_junctions, info.t_junctions_at.len()), (12, 12));
        let json = serde_json::to_value(&info).unwrap();
        let third = serde_json::json!({
            "edge": [[0.0, 0.0, 0.0], [16.0, 0.0, 0.0]], "point": [3.0, 0.0, 0.0], "t": 0.1875, "distance": 0.0,
        });
        assert_eq!(json["t_junctions_at"][2], third);
        let text = info.to_string();
        assert!(text.contains("T-junctions   12 "), "{text}");
        assert!(text.contains("\n  at 3 0 0 between 0 0 0 and 16 0 0\n"), "{text}");
        assert!(text.contains("at 10 0 0") && !text.contains("at 11 0 0") && text.contains("and 2 more"), "{text}");
    }

    #[test]
    fn info_lists_what_each_weld_tolerance_would_join() {
        let mut corners = comb().corners;
        // Two combs, at a distance between 1e-4 and 1e-3 of the diagonal.
        corners.extend(corners.clone().iter().map(|c| Corner { position: c.position + 0.01 * Vec3::Z, ..*c }));
        let triangles = (0..26).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect::<Vec<_>>().into();
        let info = info(&Mesh { corners, triangles, ..Mesh::default() }, 0.0);
        assert_eq!(info.joins.iter().map(|join| join.edges).collect::<Vec<_>>(), [0, 0, 0, 0, 78, 78].map(Some));
        let text = info.to_string();
        assert!(text.contains("\n  1e-7          joins nothing\n"), "{text}");
        assert!(text.contains("\n  1e-3          joins 78 edges\n"), "{text}");
        let json = serde_json::to_value(&info).unwrap();
        assert_eq!((&json["joins"][4]["edges"], &json["joins"][4]["collapsed"]), (&78.into(), &0.into()));
    }

    #[test]
    fn info_prints_the_weld_tolerance_and_its_effect() {
        let exact = info(&comb(), 0.0).to_string();
        assert!(exact.contains("(welded where exactly equal)"), "{exact}");
        let rough = info(&comb(), 0.1);
        assert!(rough.weld == 0.1 && rough.points < 39 && rough.degenerate > 0, "{rough:?}");
        assert!(rough.to_string().contains("(welded within 0.1 of the bounding diagonal)"));
    }
}
