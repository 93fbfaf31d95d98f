//! The passes, in the order in which they run.

use super::Tessellator;
use crate::GpuError;
use crate::bound_pass::{BoundPass, PassInputs};
use crate::layout::EmitArgs;
use crate::own_least::{self, OwnLeast};
use crate::params::params_of;
use crate::pipelines::grid;
use crate::readback::Readback;
use crate::recorder::{RecordPasses, Recorder};
use crate::search_passes::Each;
use crate::slab::{SCAN_BLOCK, SlabPasses};
use geometry::tessellate::{Displacement, Lod, Partitioning, Tessellation, own_least_inputs};

impl Tessellator {
    /// Records the passes that decide what will be emitted: deform and nets (where they are out of date), factors, counts,
    /// scan, chunks. The recorder must be submitted before [`Self::read_counts`] or [`Self::poll_counts`].
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub fn count(&mut self, recorder: &mut Recorder) -> Result<(), GpuError> {
        self.record_chunks(recorder)?;
        let tables = self.slabs.iter().map(|slab| (&slab.chunks, 0..slab.chunks.size()));
        let reports = self.own_report.iter().chain(self.own_surface.as_ref().map(|own| &own.report));
        let tables = tables.chain(reports.map(|report| (report, 0..report.size())));
        self.pending = Some(Readback::of_buffers(&self.gpu, recorder.encoder(), tables));
        Ok(())
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
        self.record_emission(recorder, 0, 0)
    }

    fn record_chunks(&mut self, recorder: &mut impl RecordPasses) -> Result<(), GpuError> {
        if let Some(rig) = self.rig.as_ref().filter(|_| self.posed.pose().is_some() && !self.is_deformed) {
            let passes = rig.passes(&self.inputs_of_passes())?;
            recorder.compute("deform", |pass| passes.iter().for_each(|(bound, grid)| bound.dispatch(pass, *grid)));
            self.is_deformed = true;
        }
        let shape = (self.params.surface, self.params.alpha);
        if self.nets_done != Some(shape) {
            self.record_nets(recorder)?;
            self.nets_done = Some(shape);
        }
        self.record_factors(recorder)?;
        for slab in &self.slabs {
            self.record_counts(recorder, slab)?;
        }
        Ok(())
    }

    /// Makes the pipelines of the passes under these settings, as far as that can be told before anything is counted, and binds
    /// them. May run on any thread: passes that are recorded meanwhile wait for the pipelines that they need.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn prepare(&self, tessellation: &Tessellation) -> Result<(), GpuError> {
        let (on, passes) = (self.inputs_of_passes(), &self.mesh_passes);
        let rows = tessellation.partitioning == Partitioning::Rows;
        if self.own_surface_passes()?.is_none() {
            passes.curve_nets(&on)?;
        }
        passes.centers(&on)?;
        passes.edge_factors(&on)?;
        self.own_lod()?;
        if tessellation.used_lod() == Lod::Error {
            passes.searches.steps(&on, rows)?;
        }
        if let Some((relief, images)) = self.buffers.relief.as_ref().zip(self.images.as_ref()) {
            passes.directions(&on, relief)?;
            passes.frames(&on, relief)?;
            if tessellation.displacement != Displacement::Off {
                passes.factor_levels(&on, images)?;
                passes.point_levels(&on, relief)?;
                self.slabs.iter().try_for_each(|slab| slab.displace(&on, images).map(|_| ()))?;
            }
        }
        for slab in &self.slabs {
            slab.counts(&on)?;
            slab.scan(&on)?;
            slab.chunks(&on)?;
            slab.emit_vertices(&on, rows, tessellation.normals as usize)?;
            slab.emit_triangles(&on, rows)?;
        }
        Ok(())
    }

    /// Records the passes that compute the own least of every patch ([`Self::own_least`]), unless that is known for the
    /// inputs that were last set. The nets must be recorded.
    ///
    /// # Errors
    /// More patches than the adapter binds memory for, or a pipeline can't be made.
    pub fn record_own_least(&mut self, recorder: &mut impl RecordPasses) -> Result<(), GpuError> {
        let Some(inputs) = &self.inputs else { return Ok(()) };
        let params = params_of(&own_least_inputs(inputs), &self.mesh, &self.buffers, None, false);
        let mut own_least = match self.own_least.take() {
            Some(own_least) => own_least,
            None => OwnLeast::new(&self.inputs_of_passes())?,
        };
        let recorded = own_least.record(&self.inputs_of_passes(), &params, recorder);
        self.own_least = Some(own_least);
        recorded
    }

    /// Makes the pipelines of those passes. May run on any thread.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn prepare_own_least(&self, partitioning: Partitioning) -> Result<(), GpuError> {
        own_least::prepare(&self.gpu, &self.pipelines, self.buffers.patch_count, partitioning == Partitioning::Rows)
    }

    /// What passes over the mesh and its slabs are bound to.
    pub(super) fn inputs_of_passes(&self) -> PassInputs<'_> {
        PassInputs {
            gpu: &self.gpu,
            pipelines: &self.pipelines,
            mesh: &self.buffers,
            params: &self.params_buffer,
            given: &self.given_buffer,
            arena: &self.arena,
        }
    }

    fn record_nets(&self, recorder: &mut impl RecordPasses) -> Result<(), GpuError> {
        let (on, passes) = (self.inputs_of_passes(), &self.mesh_passes);
        let (own, centers) = (self.own_surface_passes()?, passes.centers(&on)?);
        let curve_nets = if own.is_none() { Some(passes.curve_nets(&on)?) } else { None };
        recorder.compute("nets", |pass| {
            if let Some(curve_nets) = curve_nets {
                curve_nets.dispatch(pass, grid(self.buffers.curve_count));
            }
            if let Some(own) = own {
                own.dispatch(pass, self.buffers.patch_count, self.buffers.curve_count);
            }
            centers.dispatch(pass, grid(self.buffers.patch_count));
        });
        if let Some(relief) = &self.buffers.relief {
            let (directions, frames) = (passes.directions(&on, relief)?, passes.frames(&on, relief)?);
            recorder.compute("directions", |pass| {
                directions.dispatch(pass, grid(self.buffers.point_count));
                frames.dispatch(pass, grid(relief.corner_count));
            });
        }
        Ok(())
    }

    /// LOD's factors, and if vertices are displaced the levels at which heights are looked up.
    fn record_factors(&self, recorder: &mut impl RecordPasses) -> Result<(), GpuError> {
        let (on, passes) = (self.inputs_of_passes(), &self.mesh_passes);
        if let Some(own_lod) = self.own_lod()? {
            recorder.compute("factors", |pass| own_lod.dispatch(pass, self.buffers.patch_count));
        }
        if self.given.is_none() {
            let edge_factors = passes.edge_factors(&on)?;
            let by_error = self.params.lod == Lod::Error as u32;
            let by_heights = by_error && self.displacing_images().is_some();
            let heights_inside = if by_heights { Some(passes.heights_inside(&on)?) } else { None };
            let asked = if by_error {
                Some(passes.searches.steps(&on, self.params.partitioning == Partitioning::Rows as u32)?)
            } else {
                None
            };
            recorder.compute("factors", |pass| {
                edge_factors.dispatch(pass, grid(self.buffers.factor_count));
                if let Some(heights_inside) = heights_inside {
                    heights_inside.dispatch(pass, grid(self.buffers.patch_count));
                }
                for (step, each) in asked.into_iter().flatten() {
                    match each {
                        Each::Edge => step.dispatch(pass, grid(self.buffers.factor_count)),
                        Each::Patch => step.dispatch(pass, grid(self.buffers.patch_count)),
                        Each::Workgroups(count) => step.dispatch(pass, [count, 1, 1]),
                        Each::Counted(workgroups, offset) => step.dispatch_indirect(pass, workgroups, offset),
                    }
                }
            });
        }
        if let Some((relief, images)) = self.buffers.relief.as_ref().zip(self.displacing_images()) {
            let (factor_levels, point_levels) = (passes.factor_levels(&on, images)?, passes.point_levels(&on, relief)?);
            recorder.compute("levels", |pass| {
                factor_levels.dispatch(pass, grid(self.buffers.factor_count));
                point_levels.dispatch(pass, grid(self.buffers.point_count));
            });
        }
        Ok(())
    }

    fn record_counts(&self, recorder: &mut impl RecordPasses, slab: &SlabPasses) -> Result<(), GpuError> {
        let on = self.inputs_of_passes();
        let (counts, scan, chunks) = (slab.counts(&on)?, slab.scan(&on)?, slab.chunks(&on)?);
        let blocks = [(slab.slab.patch_count + 1).div_ceil(SCAN_BLOCK), 1, 1];
        recorder.compute("counts", |pass| counts.dispatch(pass, blocks));
        recorder.compute("scan", |pass| scan.dispatch(pass, blocks));
        recorder.compute("chunks", |pass| chunks.dispatch(pass, [1, 1, 1]));
        Ok(())
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
        self.record_emission(recorder, slab_index, chunk_index)
    }

    fn record_emission(
        &mut self,
        recorder: &mut impl RecordPasses,
        slab_index: usize,
        chunk_index: u32,
    ) -> Result<(), GpuError> {
        let (on, slab) = (self.inputs_of_passes(), &self.slabs[slab_index]);
        let rows = self.params.partitioning == Partitioning::Rows as u32;
        let vertices = slab.emit_vertices(&on, rows, self.params.normals as usize)?;
        let triangles = slab.emit_triangles(&on, rows)?;
        let displace = self.displacing_images().map(|images| slab.displace(&on, images)).transpose()?;
        let args = u64::from(chunk_index) * size_of::<EmitArgs>() as u64;
        let run = |pass: &mut wgpu::ComputePass, bound: &BoundPass, field: usize| {
            pass.set_pipeline(&bound.pipeline);
            pass.set_bind_group(0, &bound.group, &[]);
            pass.set_bind_group(1, &slab.chunk_number(&self.gpu, &bound.pipeline, chunk_index), &[]);
            pass.dispatch_workgroups_indirect(&slab.emit_args, args + field as u64);
        };
        recorder.compute("emit", |pass| {
            run(pass, vertices, std::mem::offset_of!(EmitArgs, vertices));
            run(pass, triangles, std::mem::offset_of!(EmitArgs, triangles));
        });
        if let Some(displace) = displace {
            recorder.compute("displace", |pass| run(pass, displace, std::mem::offset_of!(EmitArgs, displaced)));
        }
        self.emitted = Some((slab_index, chunk_index));
        Ok(())
    }
}
