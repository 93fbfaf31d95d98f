//! What is compared: partitionings, and where their factors come from.

use geometry::mesh::{Mesh, Topology};
use geometry::tessellate::{Inputs, Lod, Partitioning, Tessellation, tessellate};
use inspect::render::camera::Camera;

use crate::VIEWPORT;

#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Method {
    pub partitioning: Partitioning,
    lod: Lod,
}

impl Method {
    /// The last one moves continuously. It stands for as little popping as there can be.
    pub(crate) const ALL: [Self; 4] = [
        Self { partitioning: Partitioning::Rows, lod: Lod::Error },
        Self { partitioning: Partitioning::Integer, lod: Lod::Error },
        Self { partitioning: Partitioning::FractionalOdd, lod: Lod::Error },
        Self { partitioning: Partitioning::FractionalOdd, lod: Lod::EdgeLength },
    ];

    pub(crate) fn name(self) -> String {
        let partitioning = match self.partitioning {
            Partitioning::Rows => "rows",
            Partitioning::Integer => "integer",
            _ => "fractional-odd",
        };
        if self.keeps_tolerance() { partitioning.to_owned() } else { format!("{partitioning}, edge-length") }
    }

    /// Whether LOD keeps a tolerance.
    pub(crate) fn keeps_tolerance(self) -> bool {
        self.lod == Lod::Error
    }

    /// Settings for a path that begins with this camera. LOD by edge length gets about as many triangles as rows have there.
    pub(crate) fn tessellation(
        self,
        mesh: &Mesh,
        topology: &Topology,
        camera: &Camera,
        tolerance: f32,
    ) -> Tessellation {
        let Self { partitioning, lod } = self;
        let own = Tessellation { lod, tolerance, partitioning, ..Tessellation::default() };
        if self.keeps_tolerance() {
            return own;
        }
        let triangles = |tessellation: &Tessellation| {
            let inputs = Inputs::new(tessellation, camera.lod_view(VIEWPORT, &mesh.bounds()));
            tessellate(mesh, topology, &inputs, None).triangles.len()
        };
        let wanted = triangles(&Self::ALL[0].tessellation(mesh, topology, camera, tolerance));
        // Lengths of segments in px, from much too short to much too long.
        let (mut short, mut long) = (0.5f32, 2000.0f32);
        for _ in 0..12 {
            let pixels = (short * long).sqrt();
            let has_more = triangles(&Tessellation { pixels, ..own }) > wanted;
            (short, long) = if has_more { (pixels, long) } else { (short, pixels) };
        }
        Tessellation { pixels: long, ..own }
    }
}
