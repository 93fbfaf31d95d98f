//! Reads what vertices have beside positions, normals and the base colour's texture coordinates: colours, tangents, and
//! untransformed texture coordinates. What is wrong with these is left out, with a warning.

use ::gltf::Semantic;
use ::gltf::accessor::Dimensions;
use glam::{DMat3, DQuat, DVec3, Vec2, Vec3, Vec4};

use super::accessor::List;
use super::materials::DetailNeeds;
use super::notes::Notes;
use super::primitive_data::PrimitiveData;
use crate::mesh::CornerDetail;

/// The lists of one primitive.
pub(super) struct VertexDetails<'a> {
    sets: [Option<List<'a, [f32; 2]>>; 2],
    colors: Option<Colors<'a>>,
    tangents: Option<List<'a, [f32; 4]>>,
    pub repairs: DetailRepairs,
}

/// Colours with or without alpha.
enum Colors<'a> {
    Rgb(List<'a, [f32; 3]>),
    Rgba(List<'a, [f32; 4]>),
}

/// Counts of repaired vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct DetailRepairs {
    /// Colours that aren't finite, which became white.
    pub bad_colors: usize,
    /// Tangents without a direction, for which others are computed.
    pub bad_tangents: usize,
    /// Texture coordinates that aren't finite, which became (0, 0).
    pub bad_uvs: usize,
    /// Primitives without texture coordinates that a map of their material uses.
    pub missing_uvs: usize,
}

impl<'a> VertexDetails<'a> {
    /// Prepares to read the details of `count` vertices. Without normals of the file, its tangents aren't used (specification,
    /// section 3.7.2.1).
    pub(super) fn new(source: PrimitiveData<'a>, count: usize, needs: DetailNeeds, notes: &mut Notes) -> Self {
        let mut read = Self {
            sets: [0, 1].map(|set| {
                let list = needs.sets[set].then(|| source.detail(Semantic::TexCoords(set as u32), count, notes));
                list.flatten()
            }),
            colors: colors(source, count, notes),
            tangents: None,
            repairs: DetailRepairs::default(),
        };
        if needs.tangents && source.has_normals(count) {
            read.tangents = source.detail(Semantic::Tangents, count, notes);
        }
        let is_missing = (0..2).any(|set| needs.sets[set] && read.sets[set].is_none());
        read.repairs.missing_uvs = usize::from(is_missing);
        read
    }

    /// Reads a vertex. Morph targets turn its tangent by `turn`, and then `linear` transforms its directions into the scene's space.
    pub(super) fn read(&mut self, i: usize, linear: &DMat3, turn: Option<DQuat>) -> CornerDetail {
        let (tangent, bitangent_sign) = self.tangent(i, linear, turn);
        CornerDetail { uvs: [0, 1].map(|set| self.uv(set, i)), color: self.color(i), tangent, bitangent_sign }
    }

    fn uv(&mut self, set: usize, i: usize) -> Vec2 {
        let uv: Vec2 = self.sets[set].as_ref().map_or(Vec2::ZERO, |list| list.get(i).into());
        if uv.is_finite() {
            return uv;
        }
        self.repairs.bad_uvs += 1;
        Vec2::ZERO
    }

    fn color(&mut self, i: usize) -> Vec4 {
        let color = match &self.colors {
            None => return Vec4::ONE,
            Some(Colors::Rgb(list)) => Vec3::from(list.get(i)).extend(1.0),
            Some(Colors::Rgba(list)) => list.get(i).into(),
        };
        if color.is_finite() {
            return color.clamp(Vec4::ZERO, Vec4::ONE);
        }
        self.repairs.bad_colors += 1;
        Vec4::ONE
    }

    /// A map that mirrors turns the bitangent around: it is a cross product.
    fn tangent(&mut self, i: usize, linear: &DMat3, turn: Option<DQuat>) -> (Vec3, f32) {
        let Some(tangents) = &self.tangents else { return (Vec3::ZERO, 1.0) };
        let [x, y, z, sign] = tangents.get(i);
        let own = Vec3::new(x, y, z);
        let unit = own.as_dvec3().normalize_or_zero();
        let morphed = turn.map_or(unit, |turn| turn * unit);
        let turned = (*linear * morphed).try_normalize().map(DVec3::as_vec3);
        let Some(tangent) = turned.filter(|_| own.is_finite() && !sign.is_nan()) else {
            self.repairs.bad_tangents += 1;
            return (Vec3::ZERO, 1.0);
        };
        let mirrored = linear.determinant() < 0.0;
        (tangent, if (sign < 0.0) == mirrored { 1.0 } else { -1.0 })
    }
}

fn colors<'a>(source: PrimitiveData<'a>, count: usize, notes: &mut Notes) -> Option<Colors<'a>> {
    let semantic = Semantic::Colors(0);
    match source.primitive.get(&semantic)?.dimensions() {
        Dimensions::Vec3 => source.detail(semantic, count, notes).map(Colors::Rgb),
        _ => source.detail(semantic, count, notes).map(Colors::Rgba),
    }
}
