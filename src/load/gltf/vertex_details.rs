//! Reads what vertices have beside positions, normals and the base colour's texture coordinates: colours, tangents, and
//! untransformed texture coordinates. What is wrong with these is left out, with a warning.

use ::gltf::Semantic;
use ::gltf::accessor::Dimensions;
use glam::{DMat3, DQuat, DVec3, Vec2, Vec3, Vec4};

use super::accessor::List;
use super::materials::DetailNeeds;
use super::notes::Notes;
use super::primitive_data::PrimitiveData;
use super::vertices::VertexRepairs;
use geometry::mesh::CornerDetail;

/// The lists of one primitive.
pub(super) struct VertexDetails<'a> {
    sets: [Option<List<'a, [f32; 2]>>; 2],
    colors: Option<Colors<'a>>,
    tangents: Option<List<'a, [f32; 4]>>,
    /// What each morph target that is used adds to tangents. Empty if none adds anything: tangents turn along with normals then.
    tangent_targets: Vec<Option<List<'a, [f32; 3]>>>,
}

/// What morph targets do to tangents at rest.
pub(super) enum TangentMorph<'a> {
    Nothing,
    /// They turn a tangent along with the normal.
    Turned(DQuat),
    /// They displace it, by these weights.
    Displaced(&'a [f32]),
}

/// Colours with or without alpha.
enum Colors<'a> {
    Rgb(List<'a, [f32; 3]>),
    Rgba(List<'a, [f32; 4]>),
}

impl<'a> VertexDetails<'a> {
    /// Prepares to read the details of `count` vertices. Without normals of the file, its tangents aren't used (specification,
    /// section 3.7.2.1). `uses_target` says which morph targets displace vertices, at rest or in a clip.
    pub(super) fn new(
        source: PrimitiveData<'a>,
        count: usize,
        needs: DetailNeeds,
        uses_target: impl Fn(usize) -> bool,
        repairs: &mut VertexRepairs,
        notes: &mut Notes,
    ) -> Self {
        let mut read = Self {
            sets: [0, 1].map(|set| {
                let list = needs.sets[set].then(|| source.detail(Semantic::TexCoords(set as u32), count, notes));
                list.flatten()
            }),
            colors: colors(source, count, notes),
            tangents: None,
            tangent_targets: Vec::new(),
        };
        if needs.tangents && source.has_normals(count) {
            read.tangents = source.detail(Semantic::Tangents, count, notes);
        }
        if read.tangents.is_some() {
            read.tangent_targets = tangent_targets(source, count, uses_target, notes);
        }
        let is_missing = (0..2).any(|set| needs.sets[set] && read.sets[set].is_none());
        repairs.missing_uvs += usize::from(is_missing);
        read
    }

    /// Reads a vertex. Morph targets change its tangent, and then `linear` transforms its directions into the scene's space.
    pub(super) fn read(
        &self,
        i: usize,
        linear: &DMat3,
        morph: &TangentMorph,
        repairs: &mut VertexRepairs,
    ) -> CornerDetail {
        let (tangent, bitangent_sign) = self.tangent(i, linear, morph).unwrap_or_else(|| {
            repairs.bad_tangents += 1;
            (Vec3::ZERO, 1.0)
        });
        let uvs = [0, 1].map(|set| self.uv(set, i, repairs));
        CornerDetail { uvs, color: self.color(i, repairs), tangent, bitangent_sign }
    }

    /// Returns the tangent of a vertex in the file if morph targets displace it; none if they turn it along with the normal, or
    /// if the vertex has no tangent that can be used.
    pub(super) fn displaced_tangent(&self, i: usize) -> Option<Vec3> {
        let [x, y, z, sign] = self.tangents.as_ref().filter(|_| self.displaces_tangents())?.get(i);
        let own = Vec3::new(x, y, z);
        (own.is_finite() && own != Vec3::ZERO && !sign.is_nan()).then_some(own)
    }

    /// Whether morph targets displace tangents, rather than turn them along with normals.
    pub(super) fn displaces_tangents(&self) -> bool {
        !self.tangent_targets.is_empty()
    }

    /// Returns what a morph target of weight 1 adds to the tangent of a vertex. Components that aren't finite become 0.
    pub(super) fn tangent_displacement(&self, target: usize, i: usize) -> [f32; 3] {
        let list = self.tangent_targets.get(target).and_then(Option::as_ref);
        list.map_or([0.0; 3], |list| list.get(i)).map(|x| if x.is_finite() { x } else { 0.0 })
    }

    fn uv(&self, set: usize, i: usize, repairs: &mut VertexRepairs) -> Vec2 {
        let uv: Vec2 = self.sets[set].as_ref().map_or(Vec2::ZERO, |list| list.get(i).into());
        if uv.is_finite() {
            return uv;
        }
        repairs.bad_uvs += 1;
        Vec2::ZERO
    }

    fn color(&self, i: usize, repairs: &mut VertexRepairs) -> Vec4 {
        let color = match &self.colors {
            None => return Vec4::ONE,
            Some(Colors::Rgb(list)) => Vec3::from(list.get(i)).extend(1.0),
            Some(Colors::Rgba(list)) => list.get(i).into(),
        };
        if color.is_finite() {
            return color.clamp(Vec4::ZERO, Vec4::ONE);
        }
        repairs.bad_colors += 1;
        Vec4::ONE
    }

    /// Returns a tangent, zero if there are none, and the sign of the bitangent; none for a tangent without a direction. A map that mirrors
    /// turns the bitangent around: it is a cross product.
    fn tangent(&self, i: usize, linear: &DMat3, morph: &TangentMorph) -> Option<(Vec3, f32)> {
        let Some(tangents) = &self.tangents else { return Some((Vec3::ZERO, 1.0)) };
        let [x, y, z, sign] = tangents.get(i);
        let own = Vec3::new(x, y, z);
        let unit = own.as_dvec3().normalize_or_zero();
        let morphed = match morph {
            TangentMorph::Nothing => unit,
            TangentMorph::Turned(turn) => *turn * unit,
            // Each displacement times its weight (specification, section 3.7.2.2).
            TangentMorph::Displaced(weights) => (0..).zip(*weights).fold(own.as_dvec3(), |sum, (target, weight)| {
                sum + Vec3::from(self.tangent_displacement(target, i)).as_dvec3() * f64::from(*weight)
            }),
        };
        let turned = (*linear * morphed).try_normalize().map(DVec3::as_vec3);
        let tangent = turned.filter(|_| own.is_finite() && !sign.is_nan())?;
        let mirrored = linear.determinant() < 0.0;
        Some((tangent, if (sign < 0.0) == mirrored { 1.0 } else { -1.0 }))
    }
}

/// Reads what the morph targets that are used add to tangents. Returns an empty list if none adds anything that can be read.
fn tangent_targets<'a>(
    source: PrimitiveData<'a>,
    count: usize,
    is_used: impl Fn(usize) -> bool,
    notes: &mut Notes,
) -> Vec<Option<List<'a, [f32; 3]>>> {
    let used = source.primitive.morph_targets().enumerate().map(|(i, target)| target.tangents().filter(|_| is_used(i)));
    let lists: Vec<_> =
        used.map(|accessor| source.optional(&accessor?, "TANGENT of a morph target", count, notes)).collect();
    if lists.iter().any(Option::is_some) { lists } else { Vec::new() }
}

fn colors<'a>(source: PrimitiveData<'a>, count: usize, notes: &mut Notes) -> Option<Colors<'a>> {
    let semantic = Semantic::Colors(0);
    match source.primitive.get(&semantic)?.dimensions() {
        Dimensions::Vec3 => source.detail(semantic, count, notes).map(Colors::Rgb),
        _ => source.detail(semantic, count, notes).map(Colors::Rgba),
    }
}
