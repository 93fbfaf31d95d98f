//! Finds the material, the colours and the texture coordinates of triangles.
//!
//! A triangle has one image at most, which colours of its corners multiply. Layers that come to that are shown as they are, and others
//! are blended into images of their own.

use std::collections::HashMap;

use glam::{Vec2, Vec4};

use super::document::Document;
use super::images::Images;
use super::layers::{Method, blended};
use super::mixtures::{Mixture, Shown, Source, Textured};
use super::model::{Object, TriangleLook};
use super::properties::{Group, MultiProperties, material_color};
use super::texture2d::Texture2d;
use crate::face_builder::{FaceBuilder, counted, linear_color};
use crate::read_error::ReadError;
use geometry::mesh::{Alpha, Material};
use geometry::names::shown;

/// How many different images of layers are made. Each takes as much memory as its largest texture.
const MAX_MIXTURES: usize = 64;

/// The material of a triangle, the numbers of its corners' colours, and their texture coordinates.
#[derive(Clone, Copy)]
pub(super) struct Resolved {
    pub material: usize,
    pub numbers: [u32; 3],
    pub uvs: [Vec2; 3],
    pub fault: Option<Fault>,
}

/// Why a triangle is shown without its properties, or not as the file means it.
#[derive(Clone, Copy)]
pub(super) enum Fault {
    Absent,
    Beyond,
    Nested,
    Uneven,
    Apart,
    Crowded,
}

/// Numbers of triangles that aren't shown as the file means them, by [`Fault`].
#[derive(Default)]
pub(super) struct Faults([usize; 6]);

impl Faults {
    pub(super) fn count(&mut self, fault: Option<Fault>) {
        self.0.iter_mut().skip(fault.map_or(usize::MAX, |fault| fault as usize)).take(1).for_each(|count| *count += 1);
    }

    pub(super) fn warnings(&self) -> impl Iterator<Item = String> + use<> {
        counted(self.0.into_iter().zip([
            "triangles whose material, colour or texture coordinates aren't in the file, shown without",
            "triangles that go on where their texture ends (tile style none), which show its border there",
            "triangles with layers that have layers themselves, which are left out",
            "triangles with a colour above or below a texture that differs at their corners, shown with its mean",
            "triangles with several textures at different texture coordinates, shown with the mean colours of all but the uppermost",
            "triangles whose layers would need more than 64 images, shown with the uppermost texture alone",
        ]))
    }
}

/// A layer of a triangle.
struct Layer<'d> {
    paint: Paint<'d>,
    method: Method,
    /// Whether it is a material or a mixture of some.
    is_material: bool,
}

enum Paint<'d> {
    /// Of the corners, in linear RGBA.
    Colors([Vec4; 3]),
    Image {
        key: (usize, u32),
        texture: &'d Texture2d,
        uvs: [[f32; 2]; 3],
    },
}

impl Layer<'_> {
    fn is_image(&self) -> bool {
        matches!(self.paint, Paint::Image { .. })
    }
}

/// The materials that have been needed so far.
pub(super) struct Looks<'d> {
    document: &'d Document,
    images: &'d Images,
    /// Materials that are used, by part, group and entry.
    materials: HashMap<(usize, u32, u32), usize>,
    /// Materials with a texture, by part and texture, and whether it hides what is behind.
    with_textures: HashMap<(usize, u32, bool), usize>,
    /// Those with a mixture, by its uppermost texture.
    with_mixtures: HashMap<(usize, u32, Mixture), usize>,
    textured: Vec<Textured>,
    /// The material of triangles without one, opaque and translucent.
    plain: [Option<usize>; 2],
}

impl<'d> Looks<'d> {
    pub(super) fn new(document: &'d Document, images: &'d Images) -> Self {
        Self {
            document,
            images,
            materials: HashMap::new(),
            with_textures: HashMap::new(),
            with_mixtures: HashMap::new(),
            textured: Vec::new(),
            plain: [None; 2],
        }
    }

    /// Which materials show images.
    pub(super) fn into_textured(self) -> Vec<Textured> {
        self.textured
    }

    /// Finds a triangle's material and colours (core specification, section 4.1.4.1).
    ///
    /// # Errors
    /// [`ReadError`].
    pub(super) fn resolve(
        &mut self,
        faces: &mut FaceBuilder,
        part: usize,
        object: &Object,
        look: u32,
    ) -> Result<Resolved, ReadError> {
        let own = (look as usize).checked_sub(1).and_then(|look| self.document.geometry.looks.get(look));
        let own = own.copied().unwrap_or(TriangleLook { group: None, entries: [None; 3] });
        // The group counts for nothing without the first entry.
        let (group, first) = match own.entries[0] {
            Some(first) => (own.group.or(object.group), Some(first)),
            None => (object.group, object.entry),
        };
        let Some((group, first)) = group.zip(first) else { return self.unpainted(faces, None) };
        let corners = own.of_corners(first);
        if let Some(Group::Layers(layers)) = self.document.parts[part].groups.get(&group) {
            return self.layered(faces, part, layers, corners);
        }
        match self.paint(part, group, corners) {
            Ok(Layer { paint: Paint::Image { key, texture, uvs }, .. }) => {
                self.textured(faces, (key, false), texture, (uvs, [Vec4::ONE; 3]))
            }
            Ok(layer) if layer.is_material => self.material(faces, (part, group, first), &layer),
            Ok(layer) => self.colored(faces, &[layer]),
            Err(fault) => self.unpainted(faces, Some(fault)),
        }
    }

    /// A triangle's property of a group, as a layer.
    fn paint(&self, part: usize, group: u32, corners: [u32; 3]) -> Result<Layer<'d>, Fault> {
        let document: &'d Document = self.document;
        let part_of = &document.parts[part];
        let of_corners = |color: &dyn Fn(usize) -> Option<Vec4>| match corners.map(|corner| color(corner as usize)) {
            [Some(a), Some(b), Some(c)] => Ok(Paint::Colors([a, b, c])),
            _ => Err(Fault::Absent),
        };
        let layer = |paint, is_material| Ok(Layer { paint, method: Method::Mix, is_material });
        match part_of.groups.get(&group).ok_or(Fault::Absent)? {
            // A material is that of the whole triangle.
            Group::Materials(materials) => {
                let color = materials.get(corners[0] as usize).map(|(_, color)| material_color(*color));
                layer(of_corners(&|_| color)?, true)
            }
            Group::Composites(composites) => layer(of_corners(&|i| composites.colors.get(i).copied())?, true),
            Group::Colors(colors) => layer(of_corners(&|i| colors.get(i).map(|color| linear_color(*color)))?, false),
            Group::Texture { texture, coordinates } => {
                let uvs = corners.map(|corner| coordinates.get(corner as usize).copied());
                let (Some(shown), [Some(a), Some(b), Some(c)]) = (part_of.textures.get(texture), uvs) else {
                    return Err(Fault::Absent);
                };
                layer(Paint::Image { key: (part, *texture), texture: shown, uvs: [a, b, c] }, false)
            }
            Group::Layers(_) => Err(Fault::Nested),
        }
    }

    /// A triangle with layers, of whose entries each corner has one.
    fn layered(
        &mut self,
        faces: &mut FaceBuilder,
        part: usize,
        layers: &MultiProperties,
        corners: [u32; 3],
    ) -> Result<Resolved, ReadError> {
        let [Some(a), Some(b), Some(c)] = corners.map(|corner| layers.entry(corner)) else {
            return self.unpainted(faces, Some(Fault::Absent));
        };
        let (mut found, mut fault) = (Vec::with_capacity(layers.layers.len()), None);
        let mut lowest = None;
        for (i, (group, method)) in layers.layers.iter().enumerate() {
            match self.paint(part, *group, [a[i], b[i], c[i]]) {
                Ok(layer) => {
                    lowest.get_or_insert((part, *group, a[i]));
                    // A material has a meaning of its own only below all others.
                    let is_material = layer.is_material && found.is_empty();
                    found.push(Layer { method: *method, is_material, ..layer });
                }
                Err(reason) => fault = fault.or(Some(reason)),
            }
        }
        found.drain(..self.hidden(&found));
        let mut resolved = match &found[..] {
            [] => self.unpainted(faces, None)?,
            [layer]
                if layer.is_material
                    && let Some(key) = lowest =>
            {
                self.material(faces, key, layer)?
            }
            layers => match layers.iter().rposition(Layer::is_image) {
                None => self.colored(faces, layers)?,
                Some(uppermost) => self.over_image(faces, layers, uppermost)?,
            },
        };
        resolved.fault = fault.or(resolved.fault);
        Ok(resolved)
    }

    /// How many of the lowest layers those above hide.
    fn hidden(&self, layers: &[Layer]) -> usize {
        let has_material = layers.first().is_some_and(|layer| layer.is_material);
        let is_opaque = |layer: &Layer| match &layer.paint {
            Paint::Colors(colors) => colors.iter().all(|color| color.w >= 1.0),
            Paint::Image { texture, .. } => self.images.is_opaque(&texture.path),
        };
        // The alpha of a factor uncovers a material again.
        let stays = |above: &[Layer]| above.iter().all(|layer| layer.method == Method::Mix || is_opaque(layer));
        let hides = |i: &usize| match layers[*i].method {
            Method::Mix => is_opaque(&layers[*i]) && (!has_material || stays(&layers[*i + 1..])),
            // What is next to a material begins anew.
            Method::Multiply => has_material && *i == 1 && stays(&layers[2..]),
        };
        (1..layers.len()).rev().find(hides).unwrap_or(0)
    }

    /// A triangle of layers without an image, which are blended at its corners.
    fn colored(&mut self, faces: &mut FaceBuilder, layers: &[Layer]) -> Result<Resolved, ReadError> {
        let colors = corner_colors(layers);
        let is_translucent = colors.iter().any(|color| color.w < 1.0);
        let mut numbers = [0; 3];
        for (number, color) in numbers.iter_mut().zip(colors) {
            *number = faces.number(color)?;
        }
        Ok(Resolved { material: self.plain(faces, is_translucent)?, numbers, uvs: [Vec2::ZERO; 3], fault: None })
    }

    /// A triangle of layers with images, of which this is the uppermost.
    fn over_image(
        &mut self,
        faces: &mut FaceBuilder,
        layers: &[Layer],
        uppermost: usize,
    ) -> Result<Resolved, ReadError> {
        let Paint::Image { key, texture, uvs } = layers[uppermost].paint else { return self.unpainted(faces, None) };
        if let Some(tints) = tints(layers, uppermost) {
            return self.textured(faces, (key, true), texture, (uvs, tints));
        }
        let (mixture, fault) = mixture(layers, uppermost);
        let known = (key.0, key.1, mixture);
        let resolved = match self.with_mixtures.get(&known) {
            Some(material) => self.on_texture(faces, *material, texture, (uvs, [Vec4::ONE; 3]))?,
            None if self.with_mixtures.len() >= MAX_MIXTURES => {
                let resolved = self.textured(faces, (key, true), texture, (uvs, [Vec4::ONE; 3]))?;
                return Ok(Resolved { fault: Some(Fault::Crowded), ..resolved });
            }
            None => {
                let name = format!("{}, layered", texture_name(texture, key.1));
                let material = self.showing(faces, &name, texture, Shown::Mixture(known.2.clone()))?;
                self.with_mixtures.insert(known, material);
                self.on_texture(faces, material, texture, (uvs, [Vec4::ONE; 3]))?
            }
        };
        Ok(Resolved { fault: fault.or(resolved.fault), ..resolved })
    }

    fn unpainted(&mut self, faces: &mut FaceBuilder, fault: Option<Fault>) -> Result<Resolved, ReadError> {
        let number = faces.number(Vec4::ONE)?;
        Ok(Resolved { material: self.plain(faces, false)?, numbers: [number; 3], uvs: [Vec2::ZERO; 3], fault })
    }

    /// A triangle with a texture, which hides what is behind or not. Its corners have these texture coordinates, and colours that
    /// multiply it.
    fn textured(
        &mut self,
        faces: &mut FaceBuilder,
        (key, hides): ((usize, u32), bool),
        texture: &Texture2d,
        corners: ([[f32; 2]; 3], [Vec4; 3]),
    ) -> Result<Resolved, ReadError> {
        let material = match self.with_textures.get(&(key.0, key.1, hides)) {
            Some(known) => *known,
            None => {
                let shown = Shown::Image { path: texture.path.clone(), hides };
                let material = self.showing(faces, &texture_name(texture, key.1), texture, shown)?;
                self.with_textures.insert((key.0, key.1, hides), material);
                material
            }
        };
        self.on_texture(faces, material, texture, corners)
    }

    /// Adds a material that shows an image, sampled as a texture is.
    fn showing(
        &mut self,
        faces: &mut FaceBuilder,
        name: &str,
        texture: &Texture2d,
        shown: Shown,
    ) -> Result<usize, ReadError> {
        let material = faces.material(Material { sampling: texture.sampling, ..Material::plain(name, [1.0; 4]) })?;
        self.textured.push(Textured { material, shown });
        Ok(material)
    }

    /// A triangle with a material that shows an image at these texture coordinates, whose v counts from the bottom.
    fn on_texture(
        &self,
        faces: &mut FaceBuilder,
        material: usize,
        texture: &Texture2d,
        (uvs, tints): ([[f32; 2]; 3], [Vec4; 3]),
    ) -> Result<Resolved, ReadError> {
        let fault = uvs.iter().any(|uv| texture.leaves(*uv)).then_some(Fault::Beyond);
        let mut numbers = [0; 3];
        for (number, tint) in numbers.iter_mut().zip(tints) {
            *number = faces.number(tint)?;
        }
        Ok(Resolved { material, numbers, uvs: uvs.map(|[u, v]| Vec2::new(u, 1.0 - v)), fault })
    }

    /// The material of triangles that only have colours.
    fn plain(&mut self, faces: &mut FaceBuilder, is_translucent: bool) -> Result<usize, ReadError> {
        let slot = &mut self.plain[usize::from(is_translucent)];
        if let Some(plain) = *slot {
            return Ok(plain);
        }
        let mut plain = Material::plain(if is_translucent { "translucent" } else { "default" }, [1.0; 4]);
        if is_translucent {
            plain.look.alpha = Alpha::Blend;
        }
        Ok(*slot.insert(faces.material(plain)?))
    }

    /// A triangle of a material, or of mixtures of some.
    fn material(
        &mut self,
        faces: &mut FaceBuilder,
        key: (usize, u32, u32),
        layer: &Layer,
    ) -> Result<Resolved, ReadError> {
        let document: &'d Document = self.document;
        let Some(Group::Materials(materials)) = document.parts[key.0].groups.get(&key.1) else {
            return self.colored(faces, std::slice::from_ref(layer));
        };
        let material = match (self.materials.get(&key), materials.get(key.2 as usize)) {
            (Some(known), _) => *known,
            (None, None) => return self.unpainted(faces, Some(Fault::Absent)),
            (None, Some((name, color))) => {
                let color = material_color(*color);
                let name = if name.is_empty() { format!("material {}", key.2) } else { shown(name) };
                let mut material = Material::plain(&name, color.to_array());
                if color.w < 1.0 {
                    material.look.alpha = Alpha::Blend;
                }
                *self.materials.entry(key).or_insert(faces.material(material)?)
            }
        };
        let number = faces.number(Vec4::ONE)?;
        Ok(Resolved { material, numbers: [number; 3], uvs: [Vec2::ZERO; 3], fault: None })
    }
}

/// The name of a texture's image, or its number in the part.
fn texture_name(texture: &Texture2d, number: u32) -> String {
    if texture.name().is_empty() { format!("texture {number}") } else { shown(texture.name()) }
}

/// Blends layers without an image at the corners of a triangle.
fn corner_colors(layers: &[Layer]) -> [Vec4; 3] {
    let has_material = layers.first().is_some_and(|layer| layer.is_material);
    std::array::from_fn(|corner| {
        let color = |layer: &Layer| match &layer.paint {
            Paint::Colors(colors) => Some((colors[corner], layer.method)),
            Paint::Image { .. } => None,
        };
        blended(&layers.iter().filter_map(color).collect::<Vec<_>>(), has_material)
    })
}

/// Returns the colours of corners that make layers of an image when they multiply it, if there are such.
fn tints(layers: &[Layer], image: usize) -> Option<[Vec4; 3]> {
    let (below, above) = (&layers[..image], &layers[image + 1..]);
    let has_material = layers.first().is_some_and(|layer| layer.is_material);
    if has_material || below.iter().any(Layer::is_image) || image > 0 && layers[image].method == Method::Mix {
        return None;
    }
    let mut tints = corner_colors(below);
    for layer in above {
        match (&layer.paint, layer.method) {
            (Paint::Colors(colors), Method::Multiply) => {
                tints.iter_mut().zip(colors).for_each(|(tint, color)| *tint = (*tint * *color).with_w(1.0));
            }
            (Paint::Colors(colors), Method::Mix) if colors.iter().all(|color| color.w == 0.0) => {}
            _ => return None,
        }
    }
    Some(tints)
}

/// Returns what blends layers with images into one, at the texture coordinates of the uppermost, and what that leaves out.
fn mixture(layers: &[Layer], uppermost: usize) -> (Mixture, Option<Fault>) {
    let has_material = layers.first().is_some_and(|layer| layer.is_material);
    let mut mixture = Mixture { images: Vec::new(), layers: Vec::new(), has_material };
    let mut fault = None;
    for layer in layers {
        let source = match &layer.paint {
            Paint::Colors(colors) => {
                let is_uneven = colors.iter().any(|color| *color != colors[0]);
                fault = fault.or(is_uneven.then_some(Fault::Uneven));
                Source::of_color(if is_uneven { colors.iter().sum::<Vec4>() / 3.0 } else { colors[0] })
            }
            Paint::Image { texture, uvs, .. } => {
                let image = mixture.image(&texture.path);
                let is_together = match &layers[uppermost].paint {
                    Paint::Image { texture: other, uvs: others, .. } => {
                        uvs == others && texture.sampling == other.sampling
                    }
                    Paint::Colors(_) => false,
                };
                fault = fault.or((!is_together).then_some(Fault::Apart));
                if is_together { Source::Image(image) } else { Source::Mean(image) }
            }
        };
        mixture.layers.push((source, layer.method));
    }
    (mixture, fault)
}
