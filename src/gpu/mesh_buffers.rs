//! A mesh in device memory.

use super::buffer::{bytes_of, empty, filled, filled_by};
use super::layout::{Corner, CornerDetail, CurveNet, Patch};
use super::relief_buffers::{height_maps, relief_buffers};
use super::{Gpu, GpuError};
use geometry::defaults::with_defaults;
use geometry::mesh::{CurveItems, CurveStyle, Curves, Dominance, Mesh, PartStyle, Sharing, StylesUsed, Topology};

/// `SEARCH_COUNTERS` in `shaders/types.wgsl`: how many counters the searches of LOD by error have.
pub const SEARCH_COUNTERS: u32 = 10;

/// A mesh and its topology on the device, with room for the control nets and factors that passes compute.
pub struct MeshBuffers {
    /// The position of every point; then, for every patch, room for the control point at its centre, and as w what
    /// `shaders/patch_traits.wgsl` says.
    pub points: wgpu::Buffer,
    pub corners: wgpu::Buffer,
    /// What corners have beside their shading attributes: one element for each of them, or only one, of a corner that has
    /// nothing, for a mesh without details.
    pub corner_details: wgpu::Buffer,
    pub patches: wgpu::Buffer,
    pub curves: wgpu::Buffer,
    pub curve_sides: wgpu::Buffer,
    pub factor_curves: wgpu::Buffer,
    pub material_patches: wgpu::Buffer,
    pub curve_nets: wgpu::Buffer,
    /// One factor for each edge; then room for what LOD by error needs, see `shaders/search_state.wgsl`.
    pub edge_factors: wgpu::Buffer,
    /// The workgroups of the searches of LOD by error on a software driver, as indirect arguments: see `shaders/pass_requests.wgsl`.
    pub search_workgroups: wgpu::Buffer,
    /// What is known of every height image beside its pixels: a [`super::layout::HeightMap`].
    pub maps: wgpu::Buffer,
    /// See [`relief_buffers`].
    pub relief: Vec<(&'static str, wgpu::Buffer)>,
    /// How many corners there are, if heights displace the mesh.
    pub displaced_corners: Option<u32>,
    pub grouping: Grouping,
    pub point_count: u32,
    pub patch_count: u32,
    pub factor_count: u32,
    pub curve_count: u32,
    pub material_count: u32,
}

with_defaults! {
    /// How the sides of edges are grouped into curves.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Grouping {
        pub sharing: Sharing = Sharing::AllSides,
        pub styles: StylesUsed = StylesUsed::Nothing,
    }
}

impl Grouping {
    /// The curves of a mesh's edges.
    pub fn curves(self, mesh: &Mesh, topology: &Topology) -> Curves {
        Curves::styled(mesh, topology, self.sharing, self.styles)
    }
}

impl MeshBuffers {
    /// Uploads a mesh, its sides grouped into curves.
    ///
    /// # Errors
    /// A buffer would be larger than the adapter binds.
    pub fn new(gpu: &Gpu, mesh: &Mesh, topology: &Topology, grouping: Grouping) -> Result<Self, GpuError> {
        let heights = mesh.heights.as_deref();
        let is_listed = grouping != Grouping::default() || heights.is_some();
        let lists = is_listed.then(|| grouping.curves(mesh, topology));
        let grouped = CurveItems { topology, lists: lists.as_ref() };
        let material_patches: Vec<[u32; 2]> = topology.material_patches.iter().map(|r| [r.start, r.end]).collect();
        let dominance = heights.zip(grouped.lists);
        let dominance = dominance.map(|(heights, lists)| Dominance::new(topology, lists, &heights.angles));
        let factor_count = grouped.factor_count() as usize;
        let factor_room = 2 * factor_count + 7 * topology.patches.len() + SEARCH_COUNTERS as usize;
        Ok(Self {
            points: points(gpu, mesh, topology)?,
            corners: filled_by(gpu, "corners", mesh.corners.len(), |i| corner(&mesh.corners[i]))?,
            corner_details: corner_details(gpu, mesh)?,
            patches: filled_by(gpu, "patches", topology.patches.len(), |i| patch(&topology.patches[i], &grouped))?,
            curves: filled_by(gpu, "curves", grouped.curve_count(), |i| grouped.curve(i))?,
            curve_sides: filled_by(gpu, "sides", grouped.side_count(), |i| grouped.side(i))?,
            factor_curves: filled_by(gpu, "edges", factor_count + 1, |i| grouped.factor_curve(i))?,
            material_patches: filled(gpu, "materials", &material_patches)?,
            curve_nets: match grouped.lists.filter(|lists| !lists.styles.is_empty()) {
                None => empty::<CurveNet>(gpu, "curve nets", grouped.curve_count())?,
                Some(lists) => filled_by(gpu, "curve nets", lists.styles.len(), |i| styled_net(&lists.styles[i]))?,
            },
            edge_factors: empty::<f32>(gpu, "edge factors", factor_room)?,
            search_workgroups: empty::<[u32; 3]>(gpu, "search workgroups", 1)?,
            maps: height_maps(gpu, heights),
            relief: relief_buffers(gpu, mesh, topology, dominance.as_ref())?,
            displaced_corners: heights.map(|_| mesh.corners.len() as u32),
            grouping,
            point_count: topology.points.len() as u32,
            patch_count: topology.patches.len() as u32,
            factor_count: grouped.factor_count(),
            curve_count: grouped.curve_count() as u32,
            material_count: material_patches.len() as u32,
        })
    }

    /// Bytes of points, topology, nets and factors.
    pub fn bytes(&self) -> u64 {
        let topology = [&self.patches, &self.curves, &self.curve_sides, &self.factor_curves, &self.material_patches];
        let computed = [&self.curve_nets, &self.edge_factors];
        let attributes = [&self.points, &self.corners, &self.corner_details];
        let relief = self.relief.iter().map(|(_, buffer)| buffer);
        bytes_of(topology) + bytes_of(computed) + bytes_of(attributes) + bytes_of(relief)
    }
}

/// `TEXTURED` in `shaders/patch_traits.wgsl`: added to the number of a patch's height image if the patch has a texture.
pub const TEXTURED: u32 = 512;

/// `DETAIL_STEP` there: what the count of the detail of the patch's part is multiplied by.
pub const DETAIL_STEP: u32 = 1024;

/// `CURVE_SURFACE_STEP` in `shaders/types.wgsl`: what the number of a curve's surface is multiplied by.
pub const CURVE_SURFACE_STEP: u32 = 2048;

/// How many times the least detail a detail is.
fn detail_count(detail: f32) -> u32 {
    (detail / PartStyle::LEAST) as u32
}

/// Room for a curve's control points, with its style behind the first.
fn styled_net(style: &CurveStyle) -> CurveNet {
    let style = detail_count(style.detail) + CURVE_SURFACE_STEP * (style.surface as u32 + 1);
    CurveNet { _pad: style as f32, ..bytemuck::Zeroable::zeroed() }
}

/// The positions of points, then room for the centres of patches beside their traits.
fn points(gpu: &Gpu, mesh: &Mesh, topology: &Topology) -> Result<wgpu::Buffer, GpuError> {
    let heights = mesh.heights.as_deref();
    let traits = |patch| {
        let material = topology.material_of(patch);
        let triangle = topology.patches[patch as usize].triangle;
        let map = heights.and_then(|heights| heights.map_of(triangle)).map_or(0, |map| map + 1);
        let is_textured = mesh.materials.get(material).is_some_and(|material| material.texture.is_some());
        map + if is_textured { TEXTURED } else { 0 } + DETAIL_STEP * detail_count(topology.detail_of(mesh, patch))
    };
    filled_by(gpu, "points", topology.points.len() + topology.patches.len(), |i| match topology.points.get(i) {
        Some(point) => point.extend(0.0).to_array(),
        None => [0.0, 0.0, 0.0, traits((i - topology.points.len()) as u32) as f32],
    })
}

fn corner(own: &geometry::mesh::Corner) -> Corner {
    Corner { normal: own.normal.to_array(), _pad: 0.0, uv: own.uv.to_array(), _pad2: [0.0; 2] }
}

fn corner_details(gpu: &Gpu, mesh: &Mesh) -> Result<wgpu::Buffer, GpuError> {
    let none = [CornerDetail::default()];
    let details = mesh.details.as_deref().map_or(&none[..], |details| details);
    filled_by(gpu, "corner details", details.len(), |i| details[i])
}

fn patch(patch: &geometry::mesh::Patch, grouped: &CurveItems) -> Patch {
    let topology = grouped.topology;
    let kind = |side: u32| topology.edges[topology.sides[side as usize].edge as usize].kind as u32;
    let curve = |side: u32| {
        let (curve, runs_against) = grouped.curve_of(side);
        curve << 1 | u32::from(runs_against)
    };
    let corners = topology.corners(patch);
    Patch {
        points: corners.map(|corner| topology.corner_points[corner as usize]),
        corners,
        curves: patch.sides.map(curve),
        factors: patch.sides.map(|side| grouped.factor(side) << 3 | kind(side)),
    }
}
