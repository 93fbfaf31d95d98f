//! A mesh that is ready to be tessellated and drawn, with all its resources on the device.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use wgpu::util::DeviceExt;

use super::coverage::Coverage;
use super::deviation::Deviations;
use super::environment::Environment;
use super::layout::linear;
use super::matcap::MatcapPicture;
use super::materials::{Materials, UploadedMaterial};
use super::punctual::upload_lights;
use super::{Scale, Usual};
use crate::measure::DeviationField;
use crate::settings::SplitSide;
use geometry::mesh::{Bounds, Mesh, Moment, Topology};
use geometry::numbers::ulp_at;
use geometry::tessellate::bounds_through;
use geometry::view::ulp;
use gpu::{ComputePipelines, Gpu, GpuError, Tessellator};

/// A mesh on the device, its materials, and the lines that are drawn over it.
pub struct Scene {
    pub tessellator: Tessellator,
    /// The mesh's bounds at rest, or all through the clip that was framed: see [`Self::frame_clip`].
    pub bounds: Bounds,
    /// One unit in the last place of the mesh's largest coordinate, in object units.
    pub ulp: f32,
    /// At rest.
    usual: Usual,
    pub(super) materials: Vec<UploadedMaterial>,
    /// The lights of the file, if it has some.
    pub(super) lights: Option<wgpu::Buffer>,
    /// The light of a file, which pictures with [`Lighting::Environment`](crate::settings::Lighting) have; none for the studio's.
    pub environment: Option<Arc<Environment>>,
    pub(super) lines: Option<(wgpu::Buffer, u32)>,
    /// Made when a picture first has enough triangles.
    pub(super) coverage: Option<Coverage>,
    /// The distances from what was emitted to the reference surface, once they are known.
    deviation: Option<Deviations>,
    /// The lit sphere of the matcap overlay, in place of that of the settings.
    pub matcap: Option<MatcapPicture>,
    /// The moment that the pose is of; none at rest.
    moment: Option<Moment>,
    left_pose: LeftPose,
    /// What is left of the split: another tessellation, of the same mesh or another one.
    left: Option<Box<Scene>>,
}

/// The pose of the mesh left of a split.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum LeftPose {
    /// That of the right half.
    #[default]
    Same,
    /// That of a moment of its own; without one, the pose at rest.
    Own(Option<Moment>),
}

/// A line over the mesh, which is faintly visible through surfaces. If it starts and ends at the same place, it is a dot.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct LineSegment {
    /// Both ends, in object units.
    pub start: [f32; 3],
    pub end: [f32; 3],
    /// Linear RGB.
    pub color: [f32; 3],
    /// Half of the line's width in px.
    pub half_width: f32,
    /// How many lines lie over each other here, about. Behind surfaces, each is so much fainter that together they are as
    /// faint as one.
    pub times: f32,
}

impl LineSegment {
    /// A line of the usual width in an sRGB colour.
    pub fn new(start: Vec3, end: Vec3, color: [u8; 3]) -> Self {
        Self { start: start.to_array(), end: end.to_array(), color: linear(color), half_width: 2.0, times: 1.0 }
    }
}

impl Scene {
    /// Uploads a mesh. It needs no window, and may run on any thread.
    ///
    /// # Errors
    /// The mesh needs larger buffers than the adapter can bind, or its textures more memory than there is.
    pub fn new(
        gpu: &Gpu,
        materials: &Materials,
        pipelines: Arc<ComputePipelines>,
        mesh: Arc<Mesh>,
        topology: Arc<Topology>,
        arena_bytes: u64,
    ) -> Result<Self, GpuError> {
        let tessellator = Tessellator::new(gpu, pipelines, mesh.clone(), topology, arena_bytes)?;
        let materials = materials.upload(gpu, &mesh.materials)?;
        let ulp = ulp(tessellator.topology()) as f32;
        let lights = (!mesh.lights.is_empty()).then(|| upload_lights(gpu, &mesh.lights));
        Ok(Self { lights, ..Self::at_rest(tessellator, mesh.bounds(), ulp, materials) })
    }

    /// Makes a scene of the same mesh for [`Self::set_left`], on any thread. It shares the mesh, topology and images.
    pub fn sibling(&self, arena_bytes: u64) -> impl FnOnce() -> Result<Self, GpuError> + Send + use<> {
        let tessellator = self.tessellator.sibling(arena_bytes);
        let (bounds, moment, ulp, materials) = (self.bounds, self.moment, self.ulp, self.materials.clone());
        let (lights, environment) = (self.lights.clone(), self.environment.clone());
        // It has the bounds of that moment's clip, and is posed before it is drawn.
        move || Ok(Self { lights, environment, moment, ..Self::at_rest(tessellator()?, bounds, ulp, materials) })
    }

    fn at_rest(tessellator: Tessellator, bounds: Bounds, ulp: f32, materials: Vec<UploadedMaterial>) -> Self {
        Self {
            usual: Usual::new(tessellator.mesh(), tessellator.topology(), bounds.radius()),
            tessellator,
            bounds,
            ulp,
            materials,
            lights: None,
            environment: None,
            lines: None,
            coverage: None,
            deviation: None,
            matcap: None,
            moment: None,
            left_pose: LeftPose::Same,
            left: None,
        }
    }

    /// Sets what is drawn left of the split: another scene of the mesh, which takes the current pose, or that of another mesh, which is
    /// at the same moment of its clip with the same number.
    ///
    /// # Errors
    /// The mesh's rig needs larger buffers than the adapter can bind.
    pub fn set_left(&mut self, left: Option<Self>) -> Result<(), GpuError> {
        self.left = left.map(Box::new);
        self.follow()
    }

    /// Whether a half shows this scene's mesh.
    pub fn shares_mesh(&self, half: SplitSide) -> bool {
        self.half(half).is_some_and(|own| Arc::ptr_eq(own.tessellator.mesh(), self.tessellator.mesh()))
    }

    /// Whether a half shows this scene's mesh in its pose.
    pub fn shares_pose(&self, half: SplitSide) -> bool {
        half == SplitSide::Right || self.shares_mesh(half) && self.left_pose == LeftPose::Same
    }

    /// Sets the pose of the left half, also of one that is set later.
    ///
    /// # Errors
    /// The mesh's rig needs larger buffers than the adapter can bind.
    pub fn set_left_pose(&mut self, pose: LeftPose) -> Result<(), GpuError> {
        let before = std::mem::replace(&mut self.left_pose, pose);
        if before == pose { Ok(()) } else { self.follow() }
    }

    pub fn left_pose(&self) -> LeftPose {
        self.left_pose
    }

    /// The pose of a half in words, if the halves have poses of their own.
    pub fn pose_title(&self, half: SplitSide) -> Option<String> {
        let own = self.half(half).filter(|_| self.left.is_some() && self.left_pose != LeftPose::Same)?;
        let posed = own.clip_and_time().map(|(clip, time)| format!("{clip} at {} s", time as f32));
        Some(posed.unwrap_or_else(|| "at rest".to_owned()))
    }

    /// The name of the clip that the pose is of, and the time in it in s; none at rest.
    pub fn clip_and_time(&self) -> Option<(String, f64)> {
        let (moment, rig) = self.moment.zip(self.tessellator.mesh().rig.as_ref())?;
        Some((rig.clip_name(moment.clip), moment.time))
    }

    /// Gives the left half the bounds and pose of the right one, or of its own.
    fn follow(&mut self) -> Result<(), GpuError> {
        let is_same = self.shares_pose(SplitSide::Left);
        let Some(left) = &mut self.left else { return Ok(()) };
        if !is_same {
            let clips = left.tessellator.mesh().rig.as_ref().map_or(0, |rig| rig.clips.len());
            let moment = if let LeftPose::Own(own) = self.left_pose { own } else { self.moment };
            let moment = moment.filter(|moment| moment.clip < clips);
            let clip = moment.map(|moment| moment.clip);
            if clip != left.moment.map(|moment| moment.clip) {
                left.frame_clip(clip);
            }
            return left.set_moment(moment);
        }
        (left.bounds, left.ulp) = (self.bounds, self.ulp);
        (left.lights, left.moment) = (self.lights.clone(), self.moment);
        left.tessellator.pose_as(self.tessellator.posed())
    }

    /// The size of the buffers that the passes work with: see [`Tessellator::work_bytes`].
    pub fn work_bytes(&self) -> u64 {
        self.tessellator.work_bytes() + self.coverage.as_ref().map_or(0, Coverage::bytes)
    }

    /// The scene in a half of the picture; `None` on the left of a picture that isn't split.
    pub fn half(&self, half: SplitSide) -> Option<&Self> {
        match half {
            SplitSide::Left => self.left.as_deref(),
            SplitSide::Right => Some(self),
        }
    }

    /// See [`Self::half`].
    pub fn half_mut(&mut self, half: SplitSide) -> Option<&mut Self> {
        match half {
            SplitSide::Left => self.left.as_deref_mut(),
            SplitSide::Right => Some(self),
        }
    }

    /// Sets the bounds to those all through a clip, so that nothing that depends on them changes while it plays; without a
    /// clip, to those at rest.
    pub fn frame_clip(&mut self, clip: Option<usize>) {
        self.bounds = bounds_through(self.tessellator.mesh(), clip);
        let largest = self.bounds.min.abs().max(self.bounds.max.abs()).max_element();
        self.ulp = if clip.is_some() { ulp_at(largest) } else { ulp(self.tessellator.topology()) } as f32;
        let is_same = self.shares_pose(SplitSide::Left);
        if let Some(left) = self.left.as_mut().filter(|_| is_same) {
            (left.bounds, left.ulp) = (self.bounds, self.ulp);
        }
    }

    /// Poses the mesh as at a moment of one of its clips, or at rest. It takes effect with the next tessellation.
    ///
    /// # Errors
    /// The mesh's rig needs larger buffers than the adapter can bind.
    pub fn set_moment(&mut self, moment: Option<Moment>) -> Result<(), GpuError> {
        let mesh = self.tessellator.mesh().clone();
        let pose = moment.zip(mesh.rig.as_ref()).map(|(moment, rig)| Arc::new(rig.pose(moment)));
        if mesh.rig.as_ref().is_some_and(|rig| !rig.lights.is_empty()) {
            let lights = pose.as_ref().map_or_else(|| mesh.lights.clone(), |pose| mesh.lights_in(pose));
            // Another buffer, since scenes beside this one may be in another pose.
            self.lights = Some(upload_lights(self.tessellator.gpu(), &lights));
        }
        self.tessellator.set_pose(pose)?;
        self.moment = moment;
        self.follow()
    }

    /// Sets the distances from what is emitted now to the reference surface, and their scale in object units; `None` forgets
    /// them.
    pub fn set_deviation(&mut self, gpu: &Gpu, field: Option<(&DeviationField, Scale)>) {
        let of = self.tessellator.generation();
        self.deviation = field.map(|(field, scale)| Deviations::new(gpu, field, scale, of));
    }

    /// Replaces the scale of the distances.
    pub fn scale_deviation(&mut self, scale: Scale) {
        if let Some(deviation) = &mut self.deviation {
            deviation.scale = scale;
        }
    }

    /// Whether the distances from what is emitted now to the reference surface are known.
    pub fn knows_deviation(&self) -> bool {
        self.known_deviation().is_some()
    }

    pub(super) fn known_deviation(&self) -> Option<&Deviations> {
        self.deviation.as_ref().filter(|known| known.of == self.tessellator.generation())
    }

    /// Numbers that are usual on the mesh, which colour scales are made for.
    pub fn usual(&self) -> Usual {
        Usual { radius: self.bounds.radius(), ..self.usual }
    }

    /// Replaces the lines that are drawn over the mesh.
    pub fn set_lines(&mut self, gpu: &Gpu, segments: &[LineSegment]) {
        self.lines = (!segments.is_empty()).then(|| {
            let buffer = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("lines"),
                contents: bytemuck::cast_slice(segments),
                usage: wgpu::BufferUsages::VERTEX,
            });
            (buffer, segments.len() as u32)
        });
    }
}
