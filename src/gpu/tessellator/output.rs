//! What is emitted, chunk by chunk, for whoever draws or reads it.

use std::ops::Range;

use super::Tessellator;
use crate::layout::{Chunk, DrawArgs};
use crate::{UserReport, VERTEX_HALF};

/// What a chunk left in the arena, for whoever draws or reads it.
pub struct ChunkBuffers<'a> {
    pub chunk: Chunk,
    /// See [`ChunkBuffers::vertices`].
    vertices: &'a wgpu::Buffer,
    pub indices: &'a wgpu::Buffer,
    /// One [`DrawArgs`] a material, from `draw_args_offset` bytes on.
    pub draw_args: &'a wgpu::Buffer,
    pub draw_args_offset: u64,
    /// The factors of the slab's patches, the first of which is `first_patch`.
    pub patch_factors: &'a wgpu::Buffer,
    pub first_patch: u32,
    /// The slab itself: a [`crate::layout::Slab`].
    pub slab: &'a wgpu::Buffer,
}

impl ChunkBuffers<'_> {
    /// The vertices: the first half of all of them, and the second of all of them, in which bytes of which buffer.
    /// [`crate::put_together`] puts them together.
    pub fn vertices(&self) -> [(&wgpu::Buffer, Range<u64>); 2] {
        let (bytes, half) = (u64::from(self.chunk.vertex_count) * VERTEX_HALF, self.vertices.size() / 2);
        [0, half].map(|start| (self.vertices, start..start + bytes))
    }
}

impl Tessellator {
    /// Takes the chunk tables of all slabs, as the device wrote them, and what it reports of functions of the user's own.
    pub(super) fn take_chunks(&mut self, tables: &[u8]) {
        let (mut tables, has_lod) = (tables, self.user_report.is_some());
        let mut report = |is_there: bool| -> Option<UserReport> {
            let (rest, report) = tables.split_at(tables.len() - if is_there { size_of::<UserReport>() } else { 0 });
            tables = rest;
            is_there.then(|| bytemuck::pod_read_unaligned(report))
        };
        // The last one is taken first.
        if let Some(own) = &mut self.user_surface {
            own.last = report(true);
        }
        self.user_lod_report = report(has_lod);
        let table: Vec<Chunk> = bytemuck::pod_collect_to_vec(tables);
        self.counts_done = true;
        self.chunks.clear();
        let mut rows = table.iter();
        for (index, slab) in self.slabs.iter().enumerate() {
            for chunk in 0..slab.slab.chunk_capacity {
                if let Some(row) = rows.next().filter(|row| row.vertex_count > 0) {
                    self.chunks.push((index, chunk, *row));
                }
            }
        }
    }

    /// How many chunks the output takes; 0 before the counts are known, and when nothing is emitted.
    pub fn chunk_count(&self) -> usize {
        if self.counts_done { self.chunks.len() } else { 0 }
    }

    /// Vertices and triangles of the whole output.
    pub fn totals(&self) -> (u64, u64) {
        let sum = |count: fn(&Chunk) -> u32| self.chunks.iter().map(|(_, _, chunk)| u64::from(count(chunk))).sum();
        (sum(|chunk| chunk.vertex_count), sum(|chunk| chunk.triangle_count))
    }

    /// The arena as chunk `index` left it.
    pub fn chunk(&self, index: usize) -> ChunkBuffers<'_> {
        let (slab_index, chunk_index, chunk) = self.chunks[index];
        let slab = &self.slabs[slab_index];
        let row = size_of::<DrawArgs>() as u64 * u64::from(self.buffers.material_count);
        ChunkBuffers {
            chunk,
            vertices: &self.arena.vertices,
            indices: &self.arena.indices,
            draw_args: &slab.draw_args,
            draw_args_offset: u64::from(chunk_index) * row,
            patch_factors: &slab.patch_factors,
            first_patch: slab.slab.first_patch,
            slab: &slab.uniform,
        }
    }

    /// What [`Self::record_first_chunk`] leaves: draw arguments, and the table whose first entry is a [`Chunk`].
    pub fn first_chunk(&self) -> (&wgpu::Buffer, &wgpu::Buffer) {
        (&self.slabs[0].draw_args, &self.slabs[0].chunks)
    }

    /// Room for vertices and for indices, whatever chunk they hold.
    pub fn arena(&self) -> (&wgpu::Buffer, &wgpu::Buffer) {
        (&self.arena.vertices, &self.arena.indices)
    }

    /// The factors of all patches, slab by slab.
    pub fn patch_factors(&self) -> impl Iterator<Item = (&wgpu::Buffer, u32)> + Clone {
        self.slabs.iter().map(|slab| (&slab.patch_factors, slab.slab.patch_count))
    }
}
