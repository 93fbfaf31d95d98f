//! A mesh of fewer triangles, which is drawn in place of a large one while the camera moves. It is made on a thread of its own
//! when it is first needed.

use std::sync::Arc;

use super::job_list::{Jobs, Work};
use geometry::mesh::{Material, Mesh, Topology};
use inspect::engine::{Engine, Loaded};
use inspect::render::Scene;

/// Memory for its output, in bytes for each triangle: three indices, and vertices of which each triangle has its own at worst.
const BYTES_A_TRIANGLE: u64 = 12 + 3 * 32;

#[derive(Default)]
pub(crate) enum StandIn {
    #[default]
    NotMade,
    Made(Box<Scene>),
    /// It isn't tried again: previews do without.
    Failed,
}

impl StandIn {
    pub(crate) fn scene(&mut self) -> Option<&mut Scene> {
        match self {
            Self::Made(scene) => Some(scene),
            _ => None,
        }
    }

    /// Whether it is made. The first call starts that, with about so many triangles.
    pub(crate) fn is_made(
        &self,
        jobs: &mut Jobs,
        context: &egui::Context,
        engine: &Engine,
        loaded: &Loaded,
        triangles: usize,
    ) -> bool {
        if matches!(self, Self::NotMade) && !jobs.has(Work::StandIn) {
            let (engine, mesh, topology) = (engine.clone(), loaded.mesh.clone(), loaded.topology.clone());
            let make = move |_: &_| {
                let mesh = Arc::new(simplified(&mesh, &topology, triangles));
                let topology = Arc::new(Topology::new(&mesh));
                engine.gpu.attempt(|| engine.scene_of(mesh, topology, BYTES_A_TRIANGLE * 2 * triangles as u64))?
            };
            jobs.start(context, Work::StandIn, String::new(), make, |app, _, made| {
                if let Some(document) = &mut app.document {
                    document.stand_in =
                        made.ok().and_then(Result::ok).map_or(Self::Failed, |scene| Self::Made(Box::new(scene)));
                }
            });
        }
        matches!(self, Self::Made(_))
    }
}

/// A mesh with about so many triangles. Corners that are close together become one, whatever their texture coordinates: nothing
/// but the shape is kept.
fn simplified(mesh: &Mesh, topology: &Topology, triangles: usize) -> Mesh {
    let bytes: &[u8] = bytemuck::cast_slice(&topology.points);
    let Ok(points) = meshopt::VertexDataAdapter::new(bytes, size_of::<glam::Vec3>(), 0) else { return Mesh::default() };
    let mut details = Vec::new();
    let mut small = Mesh { name: mesh.name.clone(), lights: mesh.lights.clone(), ..Mesh::default() };
    let part = triangles as f64 / mesh.triangles.len().max(1) as f64;
    let mut kept = Vec::new();
    // The corner that stands for a point, and its number in the small mesh.
    let mut corner_of = vec![0; topology.points.len()];
    // A point may stand for those of a material that it doesn't belong to.
    (0..).zip(&topology.corner_points).for_each(|(corner, &point)| corner_of[point as usize] = corner);
    let mut number_of = vec![u32::MAX; topology.points.len()];
    for material in &mesh.materials {
        let own = &mesh.triangles[material.triangles.start as usize..material.triangles.end as usize];
        let corners = own.as_flattened();
        corners.iter().for_each(|&corner| corner_of[topology.corner_points[corner as usize] as usize] = corner);
        let indices: Vec<u32> = corners.iter().map(|&corner| topology.corner_points[corner as usize]).collect();
        let wanted = 3 * (part * own.len() as f64).ceil() as usize;
        let found = meshopt::simplify_sloppy(&indices, &points, wanted, f32::MAX, None);
        let first = kept.len() as u32;
        for triangle in found.as_chunks::<3>().0 {
            kept.push(triangle.map(|point| {
                let number = &mut number_of[point as usize];
                if *number == u32::MAX {
                    *number = small.corners.len() as u32;
                    let corner = corner_of[point as usize] as usize;
                    small.corners.push(mesh.corners[corner]);
                    details.extend(mesh.details.as_ref().map(|details| details[corner]));
                }
                *number
            }));
        }
        small.materials.push(Material { triangles: first..kept.len() as u32, ..material.clone() });
    }
    small.triangles = Arc::new(kept);
    small.details = mesh.details.as_ref().map(|_| Arc::new(details));
    small
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::{Corner, CornerDetail, Shape};

    /// A torus of many quads.
    fn large() -> Mesh {
        let mut mesh = Shape::Torus.build();
        for _ in 0..4 {
            mesh = split(&mesh);
        }
        mesh
    }

    /// The same mesh with four triangles in place of each.
    fn split(mesh: &Mesh) -> Mesh {
        let mut finer = Mesh { triangles: Arc::default(), ..mesh.clone() };
        let mut triangles = Vec::new();
        for triangle in mesh.triangles.iter() {
            let [a, b, c] = triangle.map(|corner| mesh.corners[corner as usize]);
            let middle = |a: Corner, b: Corner| Corner {
                position: (a.position + b.position) / 2.0,
                normal: (a.normal + b.normal).normalize(),
                uv: (a.uv + b.uv) / 2.0,
            };
            let first = finer.corners.len() as u32;
            finer.corners.extend([a, b, c, middle(a, b), middle(b, c), middle(c, a)]);
            triangles.extend([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]].map(|own| own.map(|k| first + k)));
        }
        finer.materials.iter_mut().for_each(|material| {
            material.triangles = 4 * material.triangles.start..4 * material.triangles.end;
        });
        finer.triangles = Arc::new(triangles);
        finer
    }

    #[test]
    fn points_of_another_material_can_stand_for_those_of_one() {
        let mut mesh = large();
        let (corners, triangles) = (mesh.corners.len() as u32, mesh.triangles.len() as u32);
        // The same torus once more, a little larger: no point belongs to both.
        let larger = mesh.corners.iter().map(|corner| Corner { position: corner.position * 1.001, ..*corner });
        mesh.corners.extend(larger.collect::<Vec<_>>());
        let second = mesh.triangles.iter().map(|triangle| triangle.map(|corner| corner + corners));
        mesh.triangles = Arc::new(mesh.triangles.iter().copied().chain(second).collect());
        mesh.materials.push(Material { triangles: triangles..2 * triangles, ..mesh.materials[0].clone() });
        let few = simplified(&mesh, &Topology::new(&mesh), 3_000);
        let counts: Vec<_> = few.materials.iter().map(|material| material.triangles.len()).collect();
        assert!(counts.iter().all(|count| (250..=1_600).contains(count)), "{counts:?}");
    }

    #[test]
    fn a_stand_in_has_few_triangles_and_the_same_extent() {
        let mut mesh = large();
        let detail = |corner: &Corner| CornerDetail { color: corner.position.extend(1.0), ..CornerDetail::default() };
        mesh.details = Some(Arc::new(mesh.corners.iter().map(detail).collect()));
        let few = simplified(&mesh, &Topology::new(&mesh), 3_000);
        assert_eq!(few.details, Some(Arc::new(few.corners.iter().map(detail).collect())));
        assert!(mesh.triangles.len() > 50_000, "the mesh is large: {}", mesh.triangles.len());
        assert!((500..=3_000).contains(&few.triangles.len()), "{} triangles", few.triangles.len());
        assert_eq!(few.materials.len(), mesh.materials.len());
        let (own, other) = (few.bounds(), mesh.bounds());
        let largest = (own.min - other.min).abs().max((own.max - other.max).abs()).max_element();
        assert!(largest < 0.05 * other.diagonal(), "its bounds differ by {largest}");
    }
}
