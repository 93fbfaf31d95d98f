//! Measures how much a mesh *pops* when the camera moves: `cargo bench --bench popping`. LOD computes new factors for every
//! frame, so a patch may get another pattern from one frame to the next. Its emitted surface then jumps, within the tolerance.
//!
//! Cameras move along random paths, the same in every run: orbits by 1 degree a frame, dollies towards the mesh by 1 % of the
//! distance a frame, and pans by 10 px a frame, which is about 1 % of the distance. At 60 frames a second this is a quick drag.
//! What two successive frames emit is compared under the camera of the second one, so that the camera's own movement doesn't
//! count. They are compared at the same places of each patch (`places.rs`), where these are in view of both cameras: LOD by error
//! keeps no tolerance out of view, and nobody sees what was there.
//!
//! - *surface*: the distance on screen between both emitted surfaces, where the limit surface faces the eye;
//! - *silhouette*: the part of that distance across the silhouette, where the limit surface is seen nearly edge-on;
//! - *normals*: the angle between both interpolated shading normals, where the limit surface faces the eye.
//!
//! Percentiles are those of the places of patches whose pattern changed: where it didn't, nothing moves. LOD by error keeps both
//! surfaces within the tolerance of the limit surface, each under its own camera, so a jump should be at most about twice the
//! tolerance. The bench says whether it is.
//!
//! Other parts of the mesh may hide a place; this isn't looked at. Flat patches without a texture are left out: LOD by error
//! lets their points slide, which nobody sees. Their outlines are measured in the patches beside them. Patches with the largest
//! factor are left out and counted, since no factor may be enough there.
//!
//! Arguments after `--` are mesh files that are measured too; `paths=N` and `frames=N`, the number of paths (200) and of frames in
//! each (8); `only=NAME`, which measures one mesh alone; and `meshes=all`, which prints a row for each mesh.

mod frame;
mod histogram;
mod jumps;
#[path = "../optimum/meshes.rs"]
mod meshes;
mod method;
mod paths;
mod places;
mod report;
mod view;

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use geometry::mesh::{Mesh, Topology};
use glam::Vec2;

use frame::Frame;
use jumps::Jumps;
use method::Method;
use paths::Path;
use places::Places;
use report::Measured;
use view::View;

const VIEWPORT: Vec2 = Vec2::new(1280.0, 720.0);
/// In px.
const TOLERANCES: [f32; 2] = [0.25, 1.0];

/// A mesh, and what all measurements of it share.
struct Subject {
    name: String,
    mesh: Arc<Mesh>,
    topology: Topology,
    places: Places,
}

impl Subject {
    fn new(name: String, mesh: Arc<Mesh>) -> Self {
        let topology = Topology::new(&mesh);
        let places = Places::new(&mesh, &topology);
        Self { name, mesh, topology, places }
    }

    /// Compares each frame along a path with the frame before it.
    fn measure(&self, path: &Path, method: Method, tolerance: f32) -> Jumps {
        let tessellation = method.tessellation(&self.mesh, &self.topology, &path.cameras[0], tolerance);
        let mut jumps = Jumps::default();
        let mut before: Option<(Frame, View)> = None;
        for camera in &path.cameras {
            let now = Frame::new(&self.mesh, &self.topology, &tessellation, camera);
            let view = View::new(camera, &self.mesh);
            if let Some((frame_before, view_before)) = &before {
                jumps.compare([frame_before, &now], &self.places, [view_before, &view]);
            }
            before = Some((now, view));
        }
        jumps
    }
}

/// Measures all paths with every tolerance and method, on all cores.
fn measure_all(subjects: &[Subject], paths: &[Path]) -> Vec<Measured> {
    let cases: Vec<_> = (0..paths.len())
        .flat_map(|path| {
            TOLERANCES.into_iter().flat_map(move |tolerance| Method::ALL.map(|method| (path, tolerance, method)))
        })
        .collect();
    let (next, measured) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, |cores| cores.get()) {
            scope.spawn(|| {
                while let Some(&(path, tolerance, method)) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let Path { mesh, motion, .. } = paths[path];
                    let jumps = subjects[mesh].measure(&paths[path], method, tolerance);
                    let own = Measured { mesh, motion, method, tolerance, jumps };
                    measured.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(own);
                }
            });
        }
    });
    measured.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner())
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    let value = |name: &str| arguments.iter().find_map(|argument| argument.strip_prefix(name));
    let number = |name: &str, default: usize| value(name).and_then(|text| text.parse().ok()).unwrap_or(default);
    let files: Vec<PathBuf> = arguments.iter().filter(|argument| !argument.contains('=')).map(PathBuf::from).collect();
    let mut meshes = meshes::with_files(&files);
    meshes.retain(|(name, _)| value("only=").is_none_or(|only| name == only));
    let subjects: Vec<Subject> = meshes.into_iter().map(|(name, mesh)| Subject::new(name, mesh)).collect();
    if subjects.is_empty() {
        eprintln!("No mesh has this name. The table that `meshes=all` prints has all names.");
        return;
    }
    let bounds: Vec<_> = subjects.iter().map(|subject| subject.mesh.bounds()).collect();
    let paths = paths::random(&bounds, number("paths=", 200), number("frames=", 8));
    let measured = measure_all(&subjects, &paths);
    let names: Vec<&str> = subjects.iter().map(|subject| subject.name.as_str()).collect();
    for tolerance in TOLERANCES {
        let own: Vec<&Measured> = measured.iter().filter(|one| one.tolerance == tolerance).collect();
        report::print(&names, tolerance, &own, value("meshes=") == Some("all"));
    }
}
