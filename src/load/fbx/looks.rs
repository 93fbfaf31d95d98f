//! Reads what a material says: its numbers, and which textures it has. Old Lambert and Phong materials are read as ufbx converts
//! them to base colour, roughness and emission.

use glam::{DVec3, Vec3};
use ufbx::{MaterialMap, Mesh, ShaderType, Texture};

use super::convert::{matrix, vec4};
use crate::map_uvs::MapUvs;
use geometry::casts::to_f32;
use geometry::mesh::mipmap::MipFilter;
use geometry::mesh::{Alpha, Look};

/// The brightest emission.
const MOST_LIGHT: f32 = 65504.0;

/// A texture of a material, and where it lies on a mesh.
#[derive(Clone, Copy)]
pub(super) struct MapSource<'a> {
    pub texture: &'a Texture,
    pub uvs: MapUvs,
}

/// What a material says.
pub(super) struct LookSource<'a> {
    pub name: String,
    pub base_color: [f32; 4],
    pub double_sided: bool,
    /// All but its maps.
    pub look: Look,
    pub base: Option<MapSource<'a>>,
    pub opacity: Option<MapSource<'a>>,
    pub roughness: Option<MapSource<'a>>,
    /// Whether the roughness map holds glossiness, 1 - roughness.
    pub is_glossiness: bool,
    pub metalness: Option<MapSource<'a>>,
    pub normal: Option<MapSource<'a>>,
    pub emission: Option<MapSource<'a>>,
    pub occlusion: Option<MapSource<'a>>,
    /// The height image.
    pub height: Option<MapSource<'a>>,
    /// What its heights are multiplied by, in units of the file.
    pub height_factor: f32,
    /// What of it isn't drawn.
    pub undrawn: Vec<&'static str>,
}

impl<'a> LookSource<'a> {
    /// Reads a material as it lies on a mesh.
    pub(super) fn new(material: &'a ufbx::Material, mesh: &Mesh) -> Self {
        let (pbr, features) = (&material.pbr, &material.features);
        let map =
            |map: &'a MaterialMap| Some(texture_source(map.texture.as_ref().filter(|_| map.texture_enabled)?, mesh));
        // ufbx doesn't know the name that Autodesk's SDK gives this property.
        let is_height = |own: &&ufbx::MaterialTexture| own.material_prop.as_ref() == "DisplacementColor";
        let sdk_height = || material.textures.iter().find(is_height).map(|own| texture_source(&own.texture, mesh));
        let base = map(&pbr.base_color);
        let emission = map(&pbr.emission_color);
        let is_glossiness = features.roughness_as_glossiness.enabled;
        let color = |own: &MaterialMap, factor: &MaterialMap, is_mapped: bool, default: f64| {
            // A texture replaces the colour, and the factor stays.
            let color = if is_mapped { DVec3::ONE } else { rgb(own).unwrap_or(DVec3::splat(default)) };
            (color * number(factor, 1.0)).as_vec3().clamp(Vec3::ZERO, Vec3::splat(MOST_LIGHT))
        };
        let base_color = color(&pbr.base_color, &pbr.base_factor, base.is_some(), 1.0).min(Vec3::ONE);
        let opacity = opacity(material);
        let opacity_map = map(&pbr.opacity).or_else(|| map(&material.fbx.transparency_color));
        let is_matte = material.shader_type == ShaderType::FbxLambert;
        let roughness = match is_glossiness {
            true => 1.0 - number(&pbr.glossiness, 0.5),
            false => number(&pbr.roughness, if is_matte { 1.0 } else { 0.5 }),
        };
        let mut look = Look {
            metallic: unit(number(&pbr.metalness, 0.0)),
            roughness: unit(roughness),
            emissive: color(&pbr.emission_color, &pbr.emission_factor, emission.is_some(), 0.0).to_array(),
            alpha: if opacity < 1.0 || opacity_map.is_some() { Alpha::Blend } else { Alpha::Opaque },
            unlit: features.unlit.enabled,
            ..Look::default()
        };
        if features.pbr.enabled && !is_old(material.shader_type) {
            look.ior = to_f32(number(&pbr.specular_ior, 1.5).max(1.0));
            look.specular = unit(number(&pbr.specular_factor, 1.0));
            look.transmission = unit(number(&pbr.transmission_factor, 0.0));
            look.clearcoat = unit(number(&pbr.coat_factor, 0.0));
            look.clearcoat_roughness = unit(number(&pbr.coat_roughness, 0.0));
        }
        Self {
            name: name(&material.element),
            base_color: base_color.extend(opacity).to_array(),
            double_sided: features.double_sided.enabled,
            look,
            base,
            opacity: opacity_map,
            roughness: if is_glossiness { map(&pbr.glossiness) } else { map(&pbr.roughness) },
            is_glossiness,
            metalness: map(&pbr.metalness),
            normal: map(&pbr.normal_map),
            emission,
            occlusion: map(&pbr.ambient_occlusion),
            height: map(&material.fbx.displacement).or_else(|| map(&pbr.displacement_map)).or_else(sdk_height),
            height_factor: to_f32(number(&material.fbx.displacement_factor, 1.0)),
            undrawn: undrawn(material),
        }
    }

    /// Returns the texture coordinates that corners have themselves: those of the base colour, or else of the height image.
    pub(super) fn own_uvs(&self) -> MapUvs {
        self.base.or(self.height).map_or_else(MapUvs::default, |own| own.uvs)
    }

    /// Returns its textures, and how texels of each are averaged.
    pub(super) fn images(&self) -> impl Iterator<Item = (&'a Texture, MipFilter)> {
        let filters = [
            (self.base, MipFilter::from_base_color(self.look.alpha)),
            (self.opacity, MipFilter::Numbers),
            (self.roughness, MipFilter::Numbers),
            (self.metalness, MipFilter::Numbers),
            (self.normal, MipFilter::Normals),
            (self.emission, MipFilter::Colors),
            (self.occlusion, MipFilter::Numbers),
        ];
        filters.into_iter().filter_map(|(map, filter)| Some((map?.texture, filter)))
    }

    /// Returns the set of texture coordinates of each map.
    pub(super) fn sets(&self) -> impl Iterator<Item = usize> {
        let maps = [self.base, self.normal, self.roughness, self.metalness, self.emission, self.occlusion, self.height];
        maps.into_iter().flatten().map(|map| map.uvs.set)
    }

    /// Whether its corners need more than position, normal and the base colour's texture coordinates.
    pub(super) fn needs_details(&self) -> bool {
        let others = [&self.roughness, &self.metalness, &self.emission, &self.occlusion];
        self.normal.is_some() || others.into_iter().flatten().any(|map| map.uvs != self.own_uvs())
    }
}

/// Returns an element's name on one line.
pub(super) fn name(element: &ufbx::Element) -> String {
    geometry::names::shown(element.name.as_ref())
}

/// Whether a material is of the kinds that FBX itself describes, or of none.
fn is_old(shader: ShaderType) -> bool {
    use ShaderType::{BlenderPhong, FbxLambert, FbxPhong, Unknown};
    matches!(shader, Unknown | FbxLambert | FbxPhong | BlenderPhong)
}

/// Returns how much of the surface is there. Old materials say how transparent they are: a factor times a colour. The property
/// Opacity, which some exporters add, comes first, since others write a factor of 1 for opaque surfaces.
fn opacity(material: &ufbx::Material) -> f32 {
    let mean = |color: DVec3| (color.x + color.y + color.z) / 3.0;
    if let Some(own) = rgb(&material.pbr.opacity) {
        return unit(mean(own));
    }
    if !is_old(material.shader_type) {
        return 1.0;
    }
    if let Some(own) = ufbx::find_prop(&material.element.props, "Opacity") {
        return unit(own.value_vec4.x);
    }
    let fbx = &material.fbx;
    let transparency = number(&fbx.transparency_factor, 1.0) * rgb(&fbx.transparency_color).map_or(0.0, mean);
    unit(1.0 - transparency)
}

/// Returns what of a material isn't drawn.
fn undrawn(material: &ufbx::Material) -> Vec<&'static str> {
    let (fbx, pbr) = (&material.fbx, &material.pbr);
    let has = |map: &MaterialMap| map.texture.is_some() && map.texture_enabled;
    let is_layered = |texture: &ufbx::MaterialTexture| texture.texture.type_ != ufbx::TextureType::File;
    let found = [
        (has(&fbx.bump), "a bump map"),
        (has(&fbx.vector_displacement), "a map of displacement along vectors"),
        (has(&fbx.specular_color) || has(&pbr.specular_color), "a specular map"),
        (has(&fbx.reflection_color), "a reflection map"),
        (number(&pbr.sheen_factor, 0.0) > 0.0, "sheen"),
        (number(&pbr.subsurface_factor, 0.0) > 0.0, "subsurface scattering"),
        (material.textures.iter().any(is_layered), "a texture made of several, of which the first is used"),
    ];
    found.into_iter().filter(|(is_found, _)| *is_found).map(|(_, what)| what).collect()
}

/// Returns where a texture lies on a mesh.
fn texture_source<'a>(texture: &'a Texture, mesh: &Mesh) -> MapSource<'a> {
    let is_named = |set: &ufbx::UvSet| set.name.as_ref() == texture.uv_set.as_ref();
    let set = mesh.uv_sets.iter().position(is_named).unwrap_or(0);
    let mut transform = MapUvs::default().transform;
    if texture.has_uv_transform {
        let own = matrix(&texture.uv_to_texture);
        let [a, b, c] = [own.x_axis.x, own.y_axis.x, own.w_axis.x];
        let [d, e, f] = [own.x_axis.y, own.y_axis.y, own.w_axis.y];
        // FBX counts v from the bottom: both v and v' become 1 minus themselves.
        let turned = [a, -b, b + c, -d, e, 1.0 - e - f].map(to_f32);
        transform = if turned.iter().all(|x| x.is_finite()) { turned } else { transform };
    }
    MapSource { texture, uvs: MapUvs { set, transform } }
}

/// Returns the number of a map; what isn't finite, or isn't there, is the default.
fn number(map: &MaterialMap, default: f64) -> f64 {
    let own = map.value_vec4.x;
    if map.has_value && own.is_finite() { own } else { default }
}

fn rgb(map: &MaterialMap) -> Option<DVec3> {
    let own = vec4(&map.value_vec4).truncate();
    let own = if map.value_components == 1 { DVec3::splat(own.x) } else { own };
    (map.has_value && own.is_finite()).then_some(own)
}

fn unit(number: f64) -> f32 {
    to_f32(number.clamp(0.0, 1.0))
}
