//! Reads what vertices have beside positions, normals and the base colour's texture coordinates: colours, tangents, and
//! untransformed texture coordinates. What is wrong with these is left out, with a warning. What was repaired in vertices is counted
//! here, too.

use ::gltf::Semantic;
use ::gltf::accessor::Dimensions;
use glam::{Vec2, Vec3, Vec4};

use super::accessor::List;
use super::materials::DetailNeeds;
use super::notes::{Notes, counts};
use super::primitive_data::PrimitiveData;
use geometry::casts::to_u32;

counts! {
    pub(super) struct VertexFlaws {
        bad_uvs => "uvs that aren't finite, replaced by (0, 0)";
        missing_uvs => "primitives without the texture coordinates of a map, which has (0, 0) there";
        bad_colors => "colours of vertices that aren't finite, replaced by white";
        bad_tangents => "tangents without a direction, replaced by ones that are computed";
        bad_weights => "vertices with unusable joints or weights, left unskinned";
    }
}

/// What was repaired in vertices.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct VertexRepairs {
    /// Primitives without normals.
    pub without_normals: usize,
    pub flaws: VertexFlaws,
    /// Vertices that more joints than are kept move.
    pub cut_weights: usize,
    /// The largest part of a vertex's weights that was left out, of 1.
    pub largest_cut: f64,
}

impl VertexRepairs {
    /// Adds what was repaired in other vertices.
    pub(super) fn add(&mut self, other: &Self) {
        self.without_normals += other.without_normals;
        self.flaws += other.flaws;
        self.cut_weights += other.cut_weights;
        self.largest_cut = self.largest_cut.max(other.largest_cut);
    }
}

/// The lists of one primitive.
pub(super) struct VertexDetails<'a> {
    sets: [Option<List<'a, [f32; 2]>>; 2],
    colors: Option<Colors<'a>>,
    pub tangents: Option<List<'a, [f32; 4]>>,
}

/// Colours with or without alpha.
enum Colors<'a> {
    Rgb(List<'a, [f32; 3]>),
    Rgba(List<'a, [f32; 4]>),
}

impl<'a> VertexDetails<'a> {
    /// Prepares to read the details of `count` vertices. Without normals of the file, its tangents aren't used (specification,
    /// section 3.7.2.1).
    pub(super) fn new(
        source: PrimitiveData<'a>,
        count: usize,
        needs: DetailNeeds,
        repairs: &mut VertexRepairs,
        notes: &mut Notes,
    ) -> Self {
        let sets = [0, 1].map(|set| {
            let list = needs.sets[set].then(|| source.detail(Semantic::TexCoords(to_u32(set)), count, notes));
            list.flatten()
        });
        repairs.flaws.missing_uvs += usize::from((0..2).any(|set| needs.sets[set] && sets[set].is_none()));
        let colors = colors(source, count, notes);
        let has_tangents = needs.tangents && source.has_normals(count);
        let tangents = has_tangents.then(|| source.detail(Semantic::Tangents, count, notes)).flatten();
        Self { sets, colors, tangents }
    }

    /// Returns untransformed texture coordinates of a vertex.
    pub(super) fn uv(&self, set: usize, i: usize, repairs: &mut VertexRepairs) -> Vec2 {
        let uv: Vec2 = self.sets[set].as_ref().map_or(Vec2::ZERO, |list| list.get(i).into());
        if uv.is_finite() {
            return uv;
        }
        repairs.flaws.bad_uvs += 1;
        Vec2::ZERO
    }

    /// Returns the colour of a vertex, white if it has none.
    pub(super) fn color(&self, i: usize, repairs: &mut VertexRepairs) -> Vec4 {
        let color = match &self.colors {
            None => return Vec4::ONE,
            Some(Colors::Rgb(list)) => Vec3::from(list.get(i)).extend(1.0),
            Some(Colors::Rgba(list)) => list.get(i).into(),
        };
        if color.is_finite() {
            return color.clamp(Vec4::ZERO, Vec4::ONE);
        }
        repairs.flaws.bad_colors += 1;
        Vec4::ONE
    }
}

fn colors<'a>(source: PrimitiveData<'a>, count: usize, notes: &mut Notes) -> Option<Colors<'a>> {
    let semantic = Semantic::Colors(0);
    match source.primitive.get(&semantic)?.dimensions() {
        Dimensions::Vec3 => source.detail(semantic, count, notes).map(Colors::Rgb),
        _ => source.detail(semantic, count, notes).map(Colors::Rgba),
    }
}
