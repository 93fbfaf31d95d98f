//! The picture of a comparison: their triangles in the colours of their distance from ours, and what differs as lines.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::Args;
use crate::cli::CliError;
use geometry::groups::group_starts;
use geometry::mesh::{Mesh, MeshSlices, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{FIXED_ONE, Surface, Tessellation, Vertex, outline_place};
use inspect::engine::{Engine, Loaded};
use inspect::reference_shape::ReferenceShape;
use inspect::render::layout::WORST_COLOR;
use inspect::render::{Camera, LineSegment};
use inspect::settings::{Colors, Overlays, Settings};
use inspect::shot::legend::{Named, draw_key};
use inspect::shot::{Shot, ShotError, ShotView, Subject, write_picture};
use lab::compare::{Comparison, ForeignMesh, OurTessellation, SideDifference};

/// sRGB colours of what differs: sides that are cut differently, patches that differ, patches without triangles, and vertices
/// off the surface.
const SIDE: [u8; 3] = [255, 150, 30];
const PATCH: [u8; 3] = [240, 228, 66];
const MISSING: [u8; 3] = [90, 160, 255];
const MOVED: [u8; 3] = [255, 70, 200];

/// How many lines of each kind are drawn at most.
const MOST: usize = 200_000;
/// Up to so many sides or patches are drawn with wide lines, which would hide everything if there were more.
const FEW: usize = 48;
/// Half the width of wide and of other lines, in px.
const WIDE: f32 = 2.0;
const NARROW: f32 = 0.75;

/// Draws the picture and writes it.
pub(super) fn draw(
    args: &Args,
    path: &Path,
    loaded: &Loaded,
    camera: &Camera,
    ours: &OurTessellation,
    theirs: &ForeignMesh,
    comparison: &Comparison,
) -> Result<(), CliError> {
    let engine = Engine::chosen(&args.adapter.choice())?;
    let positions: Vec<_> = comparison.positions.iter().map(|position| position.as_vec3().to_array()).collect();
    let mesh = mesh_of(&positions, &theirs.triangles).ok_or(CliError::NothingToDraw)?;
    let topology = Topology::new(&mesh);
    let (mesh, topology) = (Arc::new(mesh), Arc::new(topology));
    let shown = Loaded { read: mesh.clone(), mesh, topology, ..loaded.clone() };
    let there = differences(ours, comparison).into_iter().filter(|(_, lines)| !lines.is_empty());
    let (mut names, mut lines): (Vec<Named>, Vec<_>) = there.unzip();
    // Sides are seen over patches.
    if let [(SIDE, _), (PATCH, _), ..] = names[..] {
        lines.swap(0, 1);
    }
    let reference_shape = our_mesh(ours);
    let is_compared = reference_shape.is_some();
    let subject = Subject {
        reference_surface: reference_shape.map(|own| ("ours".to_owned(), Arc::new(own))),
        more_lines: [Vec::new(), lines.concat()],
        arena_bytes: args.surface.arena_bytes(),
        ..Subject::new(shown, settings(is_compared))
    };
    let scene = engine.scene(&subject.loaded, subject.arena_bytes)?;
    let view =
        ShotView { camera: *camera, lod_camera: None, size: args.surface.size, transparent: false, legend: true };
    names.extend(is_compared.then_some((WORST_COLOR, "largest distance from ours")));
    let mut picture = Shot::new(engine, scene, subject, view)?.picture(None, &Progress::new())?;
    draw_key(&mut picture, "What differs", &names).map_err(ShotError::from)?;
    Ok(write_picture(path, &picture.into())?)
}

/// Their triangles as they are, in the colours of their distance from ours if that is known.
fn settings(is_compared: bool) -> Settings {
    let colors = if is_compared { Colors::Deviation } else { Colors::default() };
    let overlays = Overlays { colors, wireframe: true, ..Overlays::default() };
    let tessellation = Tessellation { surface: Surface::Flat, factor: 1.0, ..Tessellation::default() };
    Settings { overlays, ..Settings::from(tessellation) }
}

/// A mesh of these triangles.
fn mesh_of(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Option<Mesh> {
    let slices = MeshSlices { positions, indices: triangles.as_flattened(), ..MeshSlices::default() };
    Mesh::from_slices(&slices).ok()
}

/// What we emit, as the surface that theirs is compared with.
fn our_mesh(ours: &OurTessellation) -> Option<ReferenceShape> {
    let positions: Vec<[f32; 3]> = ours.tessellated.vertices.iter().map(|vertex| vertex.position).collect();
    ReferenceShape::from_mesh(&mesh_of(&positions, &ours.tessellated.triangles)?)
}

/// What differs, as lines and dots: each kind with its colour and its name.
fn differences(ours: &OurTessellation, comparison: &Comparison) -> [(Named, Vec<LineSegment>); 4] {
    let outlines = Outlines::new(ours);
    let half_width = |count: usize| if count > FEW { NARROW } else { WIDE };
    let of_patches = |patches: &[u32], color| {
        let half_width = half_width(patches.len());
        let lines = patches.iter().flat_map(|patch| [0, 1, 2].map(|side| (*patch, side)));
        let lines = lines.flat_map(|(patch, side)| outlines.lines(patch, side, color, half_width));
        lines.take(MOST).collect()
    };
    let of_side = |side: &SideDifference| {
        let patch = ours.topology.patch_of(side.triangle)?;
        Some(outlines.lines(patch, side.side as usize, SIDE, half_width(comparison.sides.len())))
    };
    let dot = |place: &DVec3| {
        let place = place.as_vec3();
        LineSegment { half_width: 4.0, ..LineSegment::new(place, place, MOVED) }
    };
    let sides = comparison.sides.iter().filter_map(of_side).flatten().take(MOST).collect();
    [
        ((SIDE, "side that is cut differently"), sides),
        ((PATCH, "patch that differs"), of_patches(&comparison.different, PATCH)),
        ((MISSING, "patch without triangles"), of_patches(&comparison.missing, MISSING)),
        ((MOVED, "vertex off the surface"), comparison.strays.iter().take(MOST).map(dot).collect()),
    ]
}

/// Our vertices on the outlines of patches.
struct Outlines<'a> {
    ours: &'a OurTessellation<'a>,
    /// The first vertex of each patch, and the end.
    starts: Vec<u32>,
}

impl<'a> Outlines<'a> {
    fn new(ours: &'a OurTessellation<'a>) -> Self {
        let patches = ours.tessellated.vertices.iter().map(Vertex::patch);
        let starts = group_starts(ours.topology.patches.len(), patches);
        Self { ours, starts }
    }

    /// Lines through our vertices on a side of a patch; straight if we emit none.
    fn lines(&self, patch: u32, side: usize, color: [u8; 3], half_width: f32) -> Vec<LineSegment> {
        let [from, to] = [patch, patch + 1].map(|patch| self.starts[patch as usize] as usize);
        let own = &self.ours.tessellated.vertices[from..to];
        let on_side = own.iter().filter_map(|vertex| {
            let [u, v] = vertex.domain();
            let (own, t) = outline_place(u, v)?;
            (own == side && t > 0).then(|| (t, Vec3::from(vertex.position)))
        });
        let corners = self.ours.topology.patch_positions(patch);
        let mut points: Vec<(u32, Vec3)> = on_side.collect();
        points.push((0, corners[side]));
        points.push((FIXED_ONE, corners[(side + 1) % 3]));
        points.sort_by_key(|(t, _)| *t);
        let line = |ends: &[(u32, Vec3)]| LineSegment { half_width, ..LineSegment::new(ends[0].1, ends[1].1, color) };
        points.windows(2).map(line).collect()
    }
}
