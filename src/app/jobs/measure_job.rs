//! Measures what is shown while the window goes on, on a thread of its own.

use glam::Vec3;
use thiserror::Error;

use super::background_job::Stopped;
use super::walk::Walk;
use geometry::tessellate::{HullFactors, Inputs, PatchFactors, is_beyond_near};
use geometry::view::ScreenView;
use gpu::{Given, Gpu, GpuError, Readback};
use inspect::engine::measurements::closed_extent;
use inspect::measure::{Agreement, CrackedEdge, Measured, RequestedFactors, Sizes, Survey};
use inspect::render::{Camera, Scene};

/// Why a measurement ended without a result.
#[derive(Debug, Error)]
pub(crate) enum MeasureError {
    #[error(transparent)]
    Gpu(#[from] GpuError),
    #[error("measuring the picture {0}; any other setting starts a new measurement")]
    Measuring(Stopped),
    #[error("looking for what hides the place {0}; it may be hidden")]
    Looking(Stopped),
    #[error("counting leaks {0}; any other setting starts a new count")]
    Leaking(Stopped),
    #[error("comparing outlines {0}; any other setting starts a new comparison")]
    Comparing(Stopped),
    #[error("measuring the deviation {0}; any other setting starts a new measurement")]
    Deviating(Stopped),
}

/// The measurement of the tessellation that is shown, and the last results.
#[derive(Default)]
pub(crate) struct MeasureJob {
    /// The tessellation that the last measurement is about, and from where it is seen.
    of: Option<(u64, ScreenView)>,
    walk: Option<Walk<Surveyed>>,
    results: Option<Results>,
    /// The extent of a mesh whose leaks can be counted: see [`closed_extent`].
    closed: Option<[Vec3; 2]>,
    /// Counts changes of the results, including their loss.
    pub generation: u64,
}

pub(crate) struct Results {
    /// The tessellation's number.
    pub of: u64,
    pub found: Measured,
    /// How the factors of an LOD shader agree.
    pub agreement: Option<Agreement>,
    pub sizes: Sizes,
    /// Emitted vertices and triangles.
    pub totals: (u64, u64),
    pub seen: Seen,
    /// The cracked edge whose gap is the widest in px, and that gap.
    pub widest_crack: Option<(u32, f64)>,
    pub shading_seams: u64,
}

impl Results {
    /// An edge's gap in px, in the view that LOD was computed for: the tessellation is meant for it.
    pub(crate) fn gap_px(&self, edge: &CrackedEdge) -> f64 {
        let view = &self.seen.inputs.view;
        edge.gap_px(view.clip_from_object, 2.0 * view.half_viewport)
    }

    /// Finds the widest gap again, seen from where LOD is computed for now.
    fn look_from(&mut self, seen: Seen) {
        self.seen = seen;
        let gaps = self.found.cracks.cracked().iter().map(|crack| (crack.edge, self.gap_px(crack)));
        // The first of those that are as wide, which has the widest gap in object units.
        self.widest_crack = gaps.reduce(|a, b| if b.1 > a.1 { b } else { a });
    }
}

/// From where a measured picture is seen, and what it was tessellated with.
#[derive(Clone, Copy)]
pub(crate) struct Seen {
    pub camera: Camera,
    pub view: ScreenView,
    pub inputs: Inputs,
}

struct Surveyed {
    /// None if only the view is another one than before.
    whole: Option<(Measured, Option<Agreement>)>,
    closed: Option<[Vec3; 2]>,
    sizes: Sizes,
}

impl MeasureJob {
    /// The results for what is shown, once measured.
    pub(crate) fn found(&self) -> Option<&Measured> {
        let results = self.results.as_ref().filter(|results| self.of.is_some_and(|(of, _)| of == results.of));
        results.map(|results| &results.found)
    }

    /// The last results of the document. While what is shown is being measured, they are those of the picture before.
    pub(crate) fn last(&self) -> Option<&Results> {
        self.results.as_ref()
    }

    /// Whether what was measured last of this document is closed, and beyond the near plane of a view.
    pub(crate) fn is_closed_in(&self, view: ScreenView) -> bool {
        self.closed.is_some_and(|extent| is_beyond_near(view.clip_from_object, extent))
    }

    pub(crate) fn is_busy(&self) -> bool {
        self.walk.is_some()
    }

    /// Stops a measurement of another tessellation, whose results aren't wanted any more.
    pub(crate) fn keep_only(&mut self, tessellation: u64) {
        if self.of.is_some_and(|(of, _)| of != tessellation) {
            (self.of, self.walk) = (None, None);
            self.generation += 1;
        }
    }

    /// Stops the measurement. It isn't started again by itself.
    pub(crate) fn give_up(&mut self) {
        self.walk = None;
    }

    /// Stops the measurement and forgets all results.
    pub(crate) fn forget(&mut self) {
        *self = Self { generation: self.generation + 1, ..Self::default() };
    }

    /// Goes on measuring a scene, whose counts must be known. Starts over if its tessellation or its view has changed.
    ///
    /// # Errors
    /// The device was lost, or the measurement's thread panicked.
    pub(crate) fn go_on(&mut self, gpu: &Gpu, scene: &mut Scene, seen: &Seen) -> Result<(), MeasureError> {
        let (of, totals) = (scene.tessellator.generation(), scene.tessellator.totals());
        if self.of != Some((of, seen.view)) {
            // Another view of the same triangles changes nothing but their sizes.
            let is_known = self.results.as_ref().is_some_and(|results| results.of == of);
            self.walk = None;
            self.generation += u64::from(self.of.is_none_or(|(before, _)| before != of));
            self.of = Some((of, seen.view));
            self.walk = Some(start(gpu, scene, seen.view, is_known)?);
            return Ok(());
        }
        let Some(walk) = &mut self.walk else { return Ok(()) };
        let Some(ended) = walk.go_on(gpu, scene)? else { return Ok(()) };
        self.walk = None;
        let Some(Surveyed { whole, closed, sizes }) = ended.map_err(MeasureError::Measuring)? else { return Ok(()) };
        if let Some((found, agreement)) = whole {
            let shading_seams = found.cracks.shading_seams().count() as u64;
            let results =
                Results { of, found, agreement, sizes, totals, seen: *seen, widest_crack: None, shading_seams };
            self.results = Some(results);
            self.closed = closed;
            self.generation += 1;
        } else if let Some(results) = &mut self.results {
            results.sizes = sizes;
        }
        self.results.iter_mut().for_each(|results| results.look_from(*seen));
        Ok(())
    }

    /// The part of several chunks that has been copied, 0 to 1; none if none are being copied.
    pub(crate) fn fraction(&self) -> Option<f32> {
        self.walk.as_ref()?.copied()
    }
}

/// Starts to measure all of a scene, or if the rest is known the sizes of its triangles in another view.
fn start(gpu: &Gpu, scene: &mut Scene, view: ScreenView, is_known: bool) -> Result<Walk<Surveyed>, GpuError> {
    if is_known {
        return Walk::start(gpu, scene, None, move |parts| {
            let mut sizes = Sizes::new(view);
            parts.visit(&mut [&mut sizes])?;
            Some(Surveyed { whole: None, closed: None, sizes })
        });
    }
    let tessellator = &scene.tessellator;
    let (posed, convention) = (tessellator.posed().clone(), tessellator.convention());
    let item = size_of::<PatchFactors>() as u64;
    let buffers = tessellator.patch_factors().map(|(buffer, count)| (buffer, 0..u64::from(count) * item));
    // The patches' factors come first, and then those that were asked for.
    let patch_bytes: u64 = buffers.clone().map(|(_, bytes)| bytes.end).sum();
    let sizes = tessellator.buffers();
    // An LOD shader gave a [`HullFactors`] for every patch, and LOD a factor for every edge or for every side.
    let (of_lod, buffer, requested_bytes) = match tessellator.user_factors() {
        Some(own) => (None, own, u64::from(sizes.patch_count) * size_of::<HullFactors>() as u64),
        None => {
            let (factors, edges) = tessellator.edge_factors();
            (Some(edges), factors, u64::from(sizes.factor_count) * size_of::<f32>() as u64)
        }
    };
    let readback = Readback::start(gpu, buffers.chain([(buffer, 0..requested_bytes)]));
    let of_file = match tessellator.given() {
        Some(Given::Factors(given)) => Some(RequestedFactors::given(convention, given)),
        _ => None,
    };
    Walk::start(gpu, scene, Some(readback), move |parts| {
        let bytes = parts.first()?;
        let (factors, read) = bytes.split_at(patch_bytes as usize);
        let own: Vec<HullFactors> = if of_lod.is_none() { bytemuck::pod_collect_to_vec(read) } else { Vec::new() };
        let asked = of_file.unwrap_or_else(|| match of_lod {
            None => RequestedFactors::given(convention, &own),
            Some(edges) => RequestedFactors::new(edges, convention, bytemuck::pod_collect_to_vec(read)),
        });
        let (mesh, topology) = posed.deformed();
        // Where the sides of edges got different factors from a shader is told as it is of a file.
        let agreement = (!own.is_empty()).then(|| Agreement::new(&topology, &own, convention));
        let mut sizes = Sizes::new(view);
        let mut survey = Survey::new(&mesh, &topology, bytemuck::pod_collect_to_vec(factors), asked);
        parts.visit(&mut [&mut survey, &mut sizes])?;
        let found = survey.finish();
        Some(Surveyed { closed: closed_extent(&mesh, &topology, &found), sizes, whole: Some((found, agreement)) })
    })
}
