//! What the surface's colours stand for under the pointer, in numbers, while it rests, and the names of joints.

use std::time::{Duration, Instant};

use egui::{PopupAnchor, Response};
use glam::{Mat4, Vec2, Vec3};

use crate::app::App;
use crate::app::text::{factor, short};
use geometry::mesh::Bone;
use geometry::tessellate::{CurvatureKind, FIXED_ONE, LodView, Vertex, factor_side, patch_curvature, patch_net};
use geometry::view::{ScreenView, project, seen_on_plane};
use gpu::GpuError;
use inspect::measure::size_px;
use inspect::render::{Picked, Picking, Pixel, texel_density};
use inspect::settings::{Colors, SplitSide, SurfaceUnit};

/// How long the pointer rests before the place under it is looked up.
const REST: Duration = Duration::from_millis(120);

/// How close to a joint the pointer names it, in px.
const NEAR: f32 = 8.0;

/// A place where the pointer rests, and what is known of it.
pub(crate) struct PointerValue {
    half: SplitSide,
    pixel: Pixel,
    /// The number of the picture.
    picture: u64,
    since: Instant,
    search: Search,
}

enum Search {
    Waiting,
    UnderWay(Picking),
    Done(Option<String>),
}

impl App {
    /// Looks up the joint that is under the pointer and what the colours stand for there, and shows them.
    ///
    /// # Errors
    /// The device was lost.
    pub(super) fn show_pointer_value(&mut self, response: &Response) -> Result<(), GpuError> {
        let place = self.place_under(response);
        // What is no longer looked for must not count as under way.
        let kept = self.viewport.pointer.take();
        let key = |own: &PointerValue| (own.pixel, own.picture);
        let kept = kept.filter(|kept| Some(key(kept)) == place.as_ref().map(key));
        let Some(mut place) = kept.or(place) else { return Ok(()) };
        place.search = match std::mem::replace(&mut place.search, Search::Done(None)) {
            Search::Waiting => self.start_search(&place, response)?,
            Search::UnderWay(mut picking) => match picking.poll()? {
                Some(found) => Search::Done(found.and_then(|found| self.value_at(&place, &found))),
                None => Search::UnderWay(picking),
            },
            done => done,
        };
        match &place.search {
            Search::Waiting => response.ctx.request_repaint_after(REST),
            Search::UnderWay(_) => response.ctx.request_repaint(),
            Search::Done(value) => {
                let lines: Vec<_> = self.joint_at(&place).into_iter().chain(value.clone()).collect();
                let (layer, id) = (response.layer_id, response.id.with("value"));
                if !lines.is_empty() {
                    egui::Tooltip::always_open(response.ctx.clone(), layer, id, PopupAnchor::Pointer)
                        .show(|ui| lines.into_iter().for_each(|line| drop(ui.label(line))));
                }
            }
        }
        self.viewport.pointer = Some(place);
        Ok(())
    }

    /// The place under the pointer of a picture whose colours have numbers or that has bones; none while anything moves.
    fn place_under(&self, response: &Response) -> Option<PointerValue> {
        let pointer = response.hover_pos().filter(|_| !self.is_playing() && !response.is_pointer_button_down_on())?;
        let document = self.document.as_ref().filter(|_| !self.viewport.picture.is_busy())?;
        let at = (pointer - response.rect.min) * response.ctx.pixels_per_point();
        let (half, pixel) =
            self.viewport.picture.pixel(&document.scene, [at.x.max(0.0) as u32, at.y.max(0.0) as u32])?;
        let picture = self.viewport.picture.pictures;
        let overlays = self.settings.half(half)?.overlays;
        let is_looked_up = has_numbers(overlays.colors) || overlays.bones;
        is_looked_up.then(|| PointerValue { half, pixel, picture, since: Instant::now(), search: Search::Waiting })
    }

    fn start_search(&mut self, place: &PointerValue, response: &Response) -> Result<Search, GpuError> {
        if place.since.elapsed() < REST {
            return Ok(Search::Waiting);
        }
        let has_numbers = self.settings.half(place.half).is_some_and(|own| has_numbers(own.overlays.colors));
        let scene = self.document.as_mut().and_then(|document| document.scene.half_mut(place.half));
        let Some(scene) = scene.filter(|_| has_numbers) else { return Ok(Search::Done(None)) };
        // Looking through many chunks would take as long as drawing them.
        if scene.tessellator.chunk_count() > self.viewport.picture.short {
            return Ok(Search::Done(None));
        }
        response.ctx.request_repaint();
        Ok(Search::UnderWay(self.engine.picker.start(&self.engine.gpu, scene, &place.pixel)?))
    }

    /// The name of the joint that is next to a place, if its half shows bones.
    fn joint_at(&self, place: &PointerValue) -> Option<String> {
        self.settings.half(place.half).filter(|own| own.overlays.bones)?;
        let tessellator = &self.document.as_ref()?.scene.half(place.half)?.tessellator;
        let bones = tessellator.mesh().bones_in(tessellator.posed().pose());
        let (view, middle) = place.pixel.seen();
        let away = |bone: &Bone| Some(project(view.clip_from_object, view.viewport, bone.place)?.distance(middle));
        let near = bones.iter().filter_map(|bone| Some((away(bone).filter(|px| *px <= NEAR)?, bone)));
        near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, bone)| format!("Joint {}", bone.name))
    }

    /// What the colours stand for at a place where this was found.
    fn value_at(&self, place: &PointerValue, found: &Picked) -> Option<String> {
        let (view, middle) = place.pixel.seen();
        let vertices = found.triangle?.vertices;
        let corners = vertices.map(|vertex| Vec3::from(vertex.position));
        let (settings, scene) = (self.settings.half(place.half)?, self.document.as_ref()?.scene.half(place.half)?);
        match settings.overlays.colors {
            Colors::TriangleSize => {
                let size = size_px(corners.map(|corner| view.clip_from_object * corner.extend(1.0)), view.viewport)?;
                Some(format!("{} px", short(size)))
            }
            Colors::Deviation => {
                let reference = self.yardstick().1?;
                let point = seen_on_plane(&view, middle, corners)?;
                let distance = reference.closest(point.as_dvec3()).distance;
                let px_where_w_is_1 = self.viewport.picture.drawn?.camera.px_where_w_is_1(view.viewport.y);
                let px = f64::from(px_where_w_is_1 / (view.clip_from_object * point.extend(1.0)).w);
                Some(match settings.deviation_in {
                    SurfaceUnit::Units => format!("{} units", short(distance)),
                    SurfaceUnit::Px => format!("{} px", short(distance * px)),
                })
            }
            Colors::Curvature => {
                let domain = |vertex: &Vertex| vertex.domain().map(|weight| weight as f32);
                self.curvature_at(place.half, found.patch, mean_at(&view, middle, &vertices, domain)?)
            }
            Colors::TexelDensity => {
                let material = scene.tessellator.topology().material_of(found.patch);
                let material = &scene.tessellator.mesh().materials[material];
                let (density, unit) = match settings.texel_density_per {
                    SurfaceUnit::Units => (texel_density(material, vertices.map(|own| own.uv.into()), corners), "unit"),
                    SurfaceUnit::Px => {
                        let seen = |aside: Vec2| mean_at(&view, middle + aside, &vertices, |own| own.uv);
                        let uvs = [seen(Vec2::ZERO)?, seen(Vec2::X)?, seen(Vec2::Y)?];
                        (texel_density(material, uvs, [Vec3::ZERO, Vec3::X, Vec3::Y]), "px")
                    }
                };
                Some(format!("{} texels / {unit}", short(density?.into())))
            }
            _ => {
                let sides = self.found(place.half)?.outlines.patch(scene.tessellator.topology(), found.patch)?;
                let of_edge = |i| sides[factor_side(scene.tessellator.convention(), i) as usize].factor;
                let factors = [0, 1, 2].map(|i| factor(f64::from(of_edge(i)), 2));
                Some(format!("Factors {}", factors.join(", ")))
            }
        }
    }
}

/// Whether colours stand for numbers at each place.
fn has_numbers(colors: Colors) -> bool {
    use Colors::{Curvature, Deviation, Factors, LowFactors, TexelDensity, TriangleSize};
    matches!(colors, Factors | LowFactors | TriangleSize | Deviation | Curvature | TexelDensity)
}

/// The mean of something that a triangle's vertices have, as it is at the place of its plane that is seen at `px` of the picture.
fn mean_at(view: &ScreenView, px: Vec2, vertices: &[Vertex; 3], of: impl Fn(&Vertex) -> [f32; 2]) -> Option<Vec2> {
    let corners = vertices.map(|vertex| Vec3::from(vertex.position));
    let point = seen_on_plane(view, px, corners)?;
    let [a, b, c] = corners.map(|corner| (corner - point).as_dvec3());
    let whole = (b - a).cross(c - a);
    let shares = [b.cross(c), c.cross(a), a.cross(b)].map(|part| part.dot(whole) / whole.length_squared());
    let mean: Vec2 = shares.iter().zip(vertices).map(|(share, vertex)| *share as f32 * Vec2::from(of(vertex))).sum();
    mean.is_finite().then_some(mean)
}

impl App {
    /// The curvature of a patch in a half at domain coordinates `at`, in fixed point; none of a shader's surface, and in a pose as
    /// long as that isn't known on the CPU.
    fn curvature_at(&self, half: SplitSide, patch: u32, at: Vec2) -> Option<String> {
        if half == SplitSide::Right && self.uses_surface_shader() {
            return None;
        }
        let scene = self.document.as_ref()?.scene.half(half)?;
        let (mesh, topology) = scene.tessellator.posed().deformed_if_quick()?;
        let settings = self.settings.half(half)?;
        let inputs = settings.inputs(LodView::new(Mat4::IDENTITY, Vec2::ONE));
        // A pixel at a border may have its middle beside the triangle.
        let u = (at.x.max(0.0) as u32).min(FIXED_ONE);
        let v = (at.y.max(0.0) as u32).min(FIXED_ONE - u);
        let (kind, net) = (settings.curvature_kind, patch_net(&mesh, &topology, &inputs, patch));
        let curvature = patch_curvature(kind, inputs.evaluated_surface(&mesh), &net, u, v);
        let unit = if kind == CurvatureKind::Gaussian { "unit²" } else { "unit" };
        Some(format!("{} / {unit}", short(curvature.into())))
    }
}

impl PointerValue {
    /// Whether it isn't known yet.
    pub(crate) fn is_busy(&self) -> bool {
        !matches!(self.search, Search::Done(_))
    }
}
