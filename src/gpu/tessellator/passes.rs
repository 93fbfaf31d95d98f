//! The passes, in the order in which they run.

use std::collections::HashSet;

use super::Tessellator;
use crate::buffer::empty;
use crate::compute_pipeline::{BoundPass, Pass, Step, Workgroups};
use crate::layout::{EmitArgs, Params, Slab};
use crate::minimum::{self, Minimum};
use crate::params::params_of;
use crate::pass_inputs::{BoundPasses, PassInputs};
use crate::pipelines::{
    CENTERS, CHUNKS, COUNTS, CURVE_NETS, DIRECTIONS, DISPLACE, DRAWS, EDGE_FACTORS, EMIT_TRIANGLES, EMIT_VERTICES,
    FACTOR_LEVELS, FRAMES, HULL_FACTORS, LEAST_TRIANGLES, PATCH_DIRECTIONS, POINT_LEVELS, SCAN, grid,
};
use crate::readback::{Readback, read_buffer};
use crate::recorder::{RecordPasses, Recorder, Timing, submit_untimed};
use crate::search_passes::search_passes;
use crate::slab::SCAN_BLOCK;
use crate::{Given, GpuError, UserPipelines};
use geometry::cores::each;
use geometry::tessellate::{
    Displacement, HullFactors, Inputs, Lod, LodView, Normals, Partitioning, Tessellation, minimum_inputs,
};

/// What parameters say about which passes run, and with which constants.
#[derive(Clone, Copy)]
struct Choices {
    by_error: bool,
    has_rows: bool,
    displaces: bool,
    /// Of [`Normals`].
    normals: u32,
}

impl Choices {
    fn new(params: &Params) -> Self {
        Self {
            by_error: params.lod == Lod::Error as u32,
            has_rows: params.partitioning == Partitioning::Rows as u32,
            displaces: params.displacement != Displacement::Off as u32,
            normals: params.normals,
        }
    }
}

/// Records passes under one name, if there are any.
fn record(recorder: &mut impl RecordPasses, name: &'static str, steps: &[Step]) {
    if !steps.is_empty() {
        recorder.compute(name, |pass| steps.iter().for_each(|step| step.run(pass)));
    }
}

impl Tessellator {
    /// Submits the passes that decide what will be emitted: deform and nets (where they are out of date), factors, counts,
    /// scan, chunks. It does nothing if they have run. [`Self::read_counts`] waits for the counts, and [`Self::poll_counts`] says when
    /// they are here. Returns whether it submitted anything.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub fn count(&mut self, timing: &mut Timing) -> Result<bool, GpuError> {
        if self.counts_done || self.pending.is_some() {
            return Ok(false);
        }
        let gpu = self.gpu.clone();
        let mut recorder = Recorder::new(&gpu, timing);
        self.record_chunks(&mut recorder)?;
        let tables = self.slabs.iter().map(|slab| (&slab.chunks, 0..slab.chunks.size()));
        let reports = self.user_report.iter().chain(self.user_surface.as_ref().map(|own| &own.report));
        let tables = tables.chain(reports.map(|report| (report, 0..report.size())));
        let mut pending = Readback::from_buffers(&gpu, recorder.encoder(), tables);
        recorder.submit();
        pending.request();
        self.pending = Some(pending);
        Ok(true)
    }

    /// Records everything up to the first chunk's output in the arena, without a readback; and nothing if the arena holds that
    /// already. Draw arguments cover the patches that fit the arena: see [`Self::first_chunk`].
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub fn record_first_chunk(&mut self, recorder: &mut impl RecordPasses) -> Result<(), GpuError> {
        if self.inputs.is_none() || self.emitted == Some((0, 0)) {
            return Ok(());
        }
        self.record_chunks(recorder)?;
        self.record_emission(recorder, (0, 0))
    }

    fn record_chunks(&mut self, recorder: &mut impl RecordPasses) -> Result<(), GpuError> {
        if let Some(rig) = self.rig.as_ref().filter(|_| self.posed.pose().is_some() && !self.is_deformed) {
            record(recorder, "deform", &rig.steps(&self.inputs_of_passes())?);
            self.is_deformed = true;
        }
        let shape = (self.params.chosen_surface, self.params.alpha);
        if self.nets_done != Some(shape) {
            record(recorder, "nets", &self.nets()?);
            record(recorder, "directions", &self.directions()?);
            self.nets_done = Some(shape);
        }
        let choices = Choices::new(&self.params);
        record(recorder, "factors", &self.factors(choices)?);
        record(recorder, "levels", &self.levels(choices)?);
        for slab in 0..self.slabs.len() {
            self.counts(slab)?.iter().for_each(|(name, steps)| record(recorder, name, steps));
        }
        Ok(())
    }

    /// Makes the pipelines of the passes under these settings, as far as that can be told before anything is counted, and binds
    /// them, on all cores. May run on any thread: passes that are recorded meanwhile wait for the pipelines that they need.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn prepare(&self, tessellation: &Tessellation) -> Result<(), GpuError> {
        let inputs = Inputs::new(tessellation, LodView::default());
        let choices = Choices::new(&params_of(&inputs, &self.mesh, &self.buffers, self.given.as_ref(), false));
        // What takes longest comes first, each pass once.
        let on = self.inputs_of_passes();
        let searches = if choices.by_error { search_passes(&on, choices.has_rows) } else { vec![] };
        let searches: HashSet<Pass> = searches.into_iter().map(|(pass, _)| pass).collect();
        each(&Vec::from_iter(searches), |pass| on.bound(*pass).map(drop))?;
        let of_slabs =
            || (0..self.slabs.len()).try_for_each(|slab| self.counts(slab).and(self.emission(slab, choices)).map(drop));
        let works: [&(dyn Fn() -> Result<(), GpuError> + Sync); 5] = [
            &of_slabs,
            &|| self.nets().map(drop),
            &|| self.directions().map(drop),
            &|| self.factors(choices).map(drop),
            &|| self.levels(choices).map(drop),
        ];
        each(&works, |work| work())
    }

    /// Records the passes that compute the minimum triangle count of every patch ([`Self::minimum`]), unless that is known for the
    /// inputs that were last set. The nets must be recorded.
    ///
    /// # Errors
    /// More patches than the adapter binds memory for, or a pipeline can't be made.
    pub fn record_minimum(&mut self, recorder: &mut impl RecordPasses) -> Result<(), GpuError> {
        let Some(inputs) = &self.inputs else { return Ok(()) };
        let params = params_of(&minimum_inputs(inputs), &self.mesh, &self.buffers, None, false);
        let mut minimum = match self.minimum.take() {
            Some(minimum) => minimum,
            None => Minimum::new(&self.gpu, &self.buffers)?,
        };
        let recorded = minimum.record(&self.inputs_of_passes(), &params, recorder);
        self.minimum = Some(minimum);
        recorded
    }

    /// Makes the pipelines of those passes. May run on any thread.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn prepare_minimum(&self, partitioning: Partitioning) -> Result<(), GpuError> {
        let search = minimum::search(&self.gpu, &self.pipelines, self.buffers.patch_count, partitioning.has_rows());
        let mut passes = [EDGE_FACTORS, LEAST_TRIANGLES, search].into_iter();
        passes.try_for_each(|pass| self.pipelines.get(pass).get(&self.gpu).map(|_| ()))
    }

    /// What the hull shader writes, one for each patch: the counts pass computes it too, but doesn't store it. The counts must be
    /// known.
    ///
    /// # Errors
    /// More patches than the adapter binds memory for, or a lost device.
    pub fn hull_factors(&self) -> Result<Vec<HullFactors>, GpuError> {
        let (gpu, patches) = (&self.gpu, self.buffers.patch_count);
        let written = empty::<HullFactors>(gpu, "hull factors", patches as usize)?;
        let own = [("written_factors", &written)];
        let on = PassInputs { own: &own, bound: &BoundPasses::default(), ..self.inputs_of_passes() };
        let step = on.over(HULL_FACTORS, patches)?;
        submit_untimed(gpu, |recorder| {
            record(recorder, "hull factors", &[step]);
            Ok(())
        })?;
        let mut factors = bytemuck::pod_collect_to_vec(&read_buffer(gpu, &written, 0, written.size())?);
        factors.truncate(patches as usize);
        Ok(factors)
    }

    /// What passes over the mesh are bound to.
    pub(super) fn inputs_of_passes(&self) -> PassInputs<'_> {
        PassInputs {
            gpu: &self.gpu,
            pipelines: &self.pipelines,
            mesh: &self.buffers,
            params: &self.params_buffer,
            given: &self.given_buffer,
            arena: &self.arena,
            images: self.images.as_ref(),
            bound: &self.bound,
            slab: None,
            own: &[],
        }
    }

    /// What passes over a slab are bound to.
    fn inputs_of_slab(&self, slab: usize) -> PassInputs<'_> {
        PassInputs { bound: &self.slab_passes[slab], slab: Some(&self.slabs[slab]), ..self.inputs_of_passes() }
    }

    /// The control points of every curve, and at the centre of every patch.
    fn nets(&self) -> Result<Vec<Step>, GpuError> {
        let (on, mesh) = (self.inputs_of_passes(), &self.buffers);
        let mut steps = match &self.user_surface {
            Some(own) => {
                let pipelines = self.pipelines.user_surface(&own.shader);
                own_steps(&on, &pipelines, &own.report, &[1, 3 * mesh.patch_count, mesh.curve_count])?
            }
            None => vec![on.over(CURVE_NETS, mesh.curve_count)?],
        };
        steps.push(on.over(CENTERS, mesh.patch_count)?);
        Ok(steps)
    }

    /// Where displacement moves points to.
    fn directions(&self) -> Result<Vec<Step>, GpuError> {
        let (on, mesh) = (self.inputs_of_passes(), &self.buffers);
        let Some(corners) = mesh.displaced_corners else { return Ok(Vec::new()) };
        Ok(vec![on.over(DIRECTIONS, mesh.point_count)?, on.over(FRAMES, corners)?])
    }

    /// Factors of LOD, or of functions of the user's own.
    fn factors(&self, choices: Choices) -> Result<Vec<Step>, GpuError> {
        let (on, mesh) = (self.inputs_of_passes(), &self.buffers);
        match (&self.given, &self.user_report) {
            (Some(Given::Shader(shader)), Some(report)) => {
                let (pipelines, patches) = (self.pipelines.user_lod(shader), mesh.patch_count);
                return own_steps(&on, &pipelines, report, &[1, 3 * patches, patches, patches]);
            }
            (Some(_), _) => return Ok(Vec::new()),
            (None, _) => {}
        }
        let mut steps = vec![on.over(EDGE_FACTORS, mesh.factor_count)?];
        if choices.by_error {
            if choices.displaces && mesh.displaced_corners.is_some() {
                steps.push(on.over(PATCH_DIRECTIONS, mesh.patch_count)?);
            }
            for (pass, workgroups) in search_passes(&on, choices.has_rows) {
                steps.push(Step { bound: on.bound(pass)?, workgroups });
            }
        }
        Ok(steps)
    }

    /// If vertices are displaced, the levels at which heights are looked up.
    fn levels(&self, choices: Choices) -> Result<Vec<Step>, GpuError> {
        let (on, mesh) = (self.inputs_of_passes(), &self.buffers);
        if !choices.displaces || mesh.displaced_corners.is_none() {
            return Ok(Vec::new());
        }
        Ok(vec![on.over(FACTOR_LEVELS, mesh.factor_count)?, on.over(POINT_LEVELS, mesh.point_count)?])
    }

    /// What a slab will emit.
    fn counts(&self, slab: usize) -> Result<[(&'static str, Vec<Step>); 3], GpuError> {
        let on = self.inputs_of_slab(slab);
        let Slab { patch_count, chunk_capacity, material_count, .. } = self.slabs[slab].slab;
        let blocks = (patch_count + 1).div_ceil(SCAN_BLOCK);
        let step = |pass, workgroups| {
            Ok::<_, GpuError>(Step { bound: on.bound(pass)?, workgroups: Workgroups::Grid([workgroups, 1, 1]) })
        };
        let draws = on.over(DRAWS, chunk_capacity * material_count)?;
        Ok([
            ("counts", vec![step(COUNTS, blocks)?]),
            ("scan", vec![step(SCAN, blocks)?]),
            ("chunks", vec![step(CHUNKS, 1)?, draws]),
        ])
    }

    /// What emits the vertices of a chunk of a slab and its triangles, and what displaces it.
    fn emission(&self, slab: usize, choices: Choices) -> Result<(BoundPass, BoundPass, Option<BoundPass>), GpuError> {
        let on = self.inputs_of_slab(slab);
        let rows = u32::from(choices.has_rows);
        let vertices = EMIT_VERTICES.with("EMIT_NORMALS", choices.normals.min(Normals::Surface as u32));
        let own = [("connectivity_table", self.pipelines.patterns(&self.gpu)?)];
        let triangles = PassInputs { own: &own, ..on }.bound(EMIT_TRIANGLES.with("EMIT_ROWS", rows))?;
        let displaces = choices.displaces && self.images.is_some();
        let displace = if displaces { Some(on.bound(DISPLACE)?) } else { None };
        Ok((on.bound(vertices.with("EMIT_ROWS", rows))?, triangles, displace))
    }

    /// Records the emission of chunk `index` into the arena, unless the arena already holds it.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub fn emit(&mut self, recorder: &mut impl RecordPasses, index: usize) -> Result<(), GpuError> {
        let (slab_index, chunk_index, _) = self.chunks[index];
        if self.emitted == Some((slab_index, chunk_index)) {
            return Ok(());
        }
        self.record_emission(recorder, (slab_index, chunk_index))
    }

    fn record_emission(&mut self, recorder: &mut impl RecordPasses, at: (usize, u32)) -> Result<(), GpuError> {
        let (slab_index, chunk_index) = at;
        let (vertices, triangles, displace) = self.emission(slab_index, Choices::new(&self.params))?;
        let slab = &self.slabs[slab_index];
        let args = u64::from(chunk_index) * size_of::<EmitArgs>() as u64;
        let run = |pass: &mut wgpu::ComputePass, bound: &BoundPass, field: usize| {
            bound.set(pass);
            pass.set_bind_group(1, &slab.chunk_number(&self.gpu, &bound.pipeline, chunk_index), &[]);
            pass.dispatch_workgroups_indirect(&slab.emit_args, args + field as u64);
        };
        recorder.compute("emit", |pass| {
            run(pass, &vertices, std::mem::offset_of!(EmitArgs, vertices));
            run(pass, &triangles, std::mem::offset_of!(EmitArgs, triangles));
        });
        if let Some(displace) = displace {
            recorder.compute("displace", |pass| run(pass, &displace, std::mem::offset_of!(EmitArgs, displaced)));
        }
        self.emitted = Some(at);
        Ok(())
    }
}

/// The passes of functions of the user's own, each with an invocation for each of so many items.
fn own_steps(
    on: &PassInputs,
    pipelines: &UserPipelines,
    report: &wgpu::Buffer,
    items: &[u32],
) -> Result<Vec<Step>, GpuError> {
    let own = [("report", report)];
    let on = PassInputs { own: &own, ..*on };
    let step = |(pipeline, items): (_, &u32)| {
        Ok(Step { bound: on.bound_by(pipeline)?, workgroups: Workgroups::Grid(grid(*items)) })
    };
    pipelines.0.iter().zip(items).map(step).collect()
}
