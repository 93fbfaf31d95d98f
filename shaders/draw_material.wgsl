// Materials as glTF 2.0 describes them (specification, section 3.9), in the light of environment.wgsl.

// What the mesh's materials need. Each part that isn't needed is left out when the pipeline is made. MAPS has a bit for each image
// beside that of the base colour, by SLOT_* and BEHIND: 12 at most.
override MAPS: u32 = 0xffffffffu;
override HAS_DETAILS: bool = true;
override HAS_COAT: bool = true;
override HAS_MASK: bool = true;
override HAS_TRANSMISSION: bool = true;
override HAS_SHEEN: bool = true;
// Whether pictures are drafts. In these only the mean of an image counts, except for the base colour's, and normal maps are left out.
// A place that shows more than half of what is behind it is left out, and any other place hides what is behind it.
override IS_DRAFT: bool = false;
// Lights of the file that shine.
override LIGHT_COUNT: u32 = MOST_LIGHTS;

// One element for each corner, if HAS_DETAILS.
@group(0) @binding(9) var<storage, read> corner_details: array<CornerDetail>;
@group(1) @binding(0) var<uniform> material: Material;
@group(1) @binding(1) var base_texture: texture_2d<f32>;
@group(1) @binding(2) var base_sampler: sampler;
@group(1) @binding(20) var<uniform> lights: array<PunctualLight, MOST_LIGHTS>;

// The bit in MAPS of the picture of what is behind a body that refracts light, or a rough surface.
const BEHIND: u32 = MAP_COUNT;

// Shorter tangents, squared, say nothing about a direction.
const LEAST_TANGENT: f32 = 1e-12;

// A place on an image, and how far it moves from a pixel to the next one on the right, and below.
struct ImagePlace {
    uv: vec2<f32>,
    right: vec2<f32>,
    below: vec2<f32>,
}

// Less of what is behind a place can't be seen: it is half a step of a picture's channels.
const LEAST_SEEN: f32 = 1.0 / 512.0;

// What is seen at a pixel. Only varyings have derivatives that can be relied on: for pixels beside a triangle, which derivatives
// are taken with, some drivers read no buffers.
struct SurfacePlace {
    // On the image of the base colour.
    own: ImagePlace,
    // In the patch, and how they change like places on images.
    weights: vec3<f32>,
    weights_right: vec3<f32>,
    weights_below: vec3<f32>,
    patch_index: u32,
    // The unit shading normal of the side that the triangle's winding makes the front.
    normal: vec3<f32>,
    front: bool,
    to_eye: vec3<f32>,
    // In object space, if LIGHT_COUNT isn't 0 or MAPS has BEHIND.
    position: vec3<f32>,
}

// CornerDetail in the middle of a pixel, and how its texture coordinates change.
struct PlaceDetail {
    uvs: vec4<f32>,
    uvs_right: vec4<f32>,
    uvs_below: vec4<f32>,
    color: vec4<f32>,
    // How much the colours' alpha changes from a pixel to the next one on the right, and below.
    alpha_change: vec2<f32>,
    tangent: vec3<f32>,
    bitangent_sign: f32,
}

fn surface_place(
    uv: vec2<f32>,
    weights: vec2<f32>,
    patch_index: u32,
    normal: vec3<f32>,
    front: bool,
    to_eye: vec3<f32>,
    position: vec3<f32>,
) -> SurfacePlace {
    let right = dpdx(weights);
    let below = dpdy(weights);
    return SurfacePlace(
        ImagePlace(uv, dpdx(uv), dpdy(uv)),
        vec3<f32>(weights, 1.0 - weights.x - weights.y),
        vec3<f32>(right, -right.x - right.y),
        vec3<f32>(below, -below.x - below.y),
        patch_index,
        normal,
        front,
        to_eye,
        position,
    );
}

// What the corners of the place's patch have, linear between them.
fn place_detail(place: SurfacePlace) -> PlaceDetail {
    var sum: PlaceDetail;
    sum.color = vec4<f32>(1.0);
    sum.bitangent_sign = 1.0;
    if HAS_DETAILS {
        let own = patches[place.patch_index].corners;
        sum.color = vec4<f32>(0.0);
        for (var k = 0u; k < 3u; k++) {
            let corner = corner_details[own[k]];
            let weight = place.weights[k];
            sum.uvs += weight * corner.uvs;
            sum.uvs_right += place.weights_right[k] * corner.uvs;
            sum.uvs_below += place.weights_below[k] * corner.uvs;
            sum.color += weight * corner.color;
            sum.alpha_change += vec2<f32>(place.weights_right[k], place.weights_below[k]) * corner.color.a;
            sum.tangent += weight * corner.tangent.xyz;
        }
        sum.bitangent_sign = corner_details[own[0]].tangent.w;
        // At a triangle's border the middle of a pixel may lie outside the patch.
        sum.color = clamp(sum.color, vec4<f32>(0.0), vec4<f32>(1.0));
    }
    return sum;
}

fn has_map(slot: u32) -> bool {
    return (MAPS & (1u << slot)) != 0u;
}

// The place that a map is read at: u and v of one of the texture coordinates, mapped as KHR_texture_transform says.
fn map_place(place: SurfacePlace, detail: PlaceDetail, slot: u32) -> ImagePlace {
    if !HAS_DETAILS {
        return place.own;
    }
    let map = material.maps[slot];
    let is_own = map.u.w < 0.5;
    let is_second = map.u.w > 1.5;
    let uv = select(select(detail.uvs.xy, detail.uvs.zw, is_second), place.own.uv, is_own);
    let right = select(select(detail.uvs_right.xy, detail.uvs_right.zw, is_second), place.own.right, is_own);
    let below = select(select(detail.uvs_below.xy, detail.uvs_below.zw, is_second), place.own.below, is_own);
    let turned = mat2x2<f32>(map.u.x, map.v.x, map.u.y, map.v.y);
    return ImagePlace(turned * uv + vec2<f32>(map.u.z, map.v.z), turned * right, turned * below);
}

fn texel(image: texture_2d<f32>, image_sampler: sampler, at: ImagePlace) -> vec4<f32> {
    return textureSampleGrad(image, image_sampler, at.uv, at.right, at.below);
}

// What an image other than that of the base colour says. The last mip level is the mean of an image.
fn image_texel(image: texture_2d<f32>, image_sampler: sampler, at: ImagePlace) -> vec4<f32> {
    if IS_DRAFT {
        return textureLoad(image, vec2<i32>(0), textureNumLevels(image) - 1u);
    }
    return texel(image, image_sampler, at);
}

// What the image of a bit in MAPS says.
fn slot_texel(slot: u32, at: ImagePlace) -> vec4<f32> {
    return placed_texel(countOneBits(MAPS & ((1u << slot) - 1u)), at);
}

// What a map says at a place; 1 without the map.
fn map_texel(place: SurfacePlace, detail: PlaceDetail, slot: u32) -> vec4<f32> {
    if !has_map(slot) {
        return vec4<f32>(1.0);
    }
    return slot_texel(slot, map_place(place, detail, slot));
}

// The unit normal that a normal map makes of a unit shading normal (glTF 2.0, section 3.9.3), on the front. The tangent is made
// perpendicular to the shading normal, which may be another one than at the corners, for example where the surface is displaced.
fn mapped_normal(normal: vec3<f32>, tangent: vec3<f32>, bitangent_sign: f32, from_map: vec3<f32>) -> vec3<f32> {
    let along = tangent - normal * dot(tangent, normal);
    if dot(along, along) < LEAST_TANGENT {
        return normal;
    }
    let t = normalize(along);
    let b = bitangent_sign * cross(normal, t);
    return normalize(from_map.x * t + from_map.y * b + from_map.z * normal);
}

// What a normal map says, as a direction in tangent space.
fn map_direction(texel: vec3<f32>, scale: f32) -> vec3<f32> {
    return (2.0 * texel - 1.0) * vec3<f32>(scale, scale, 1.0);
}

// What the material is at a place with that base colour and shown normal.
fn look_at(place: SurfacePlace, detail: PlaceDetail, base: vec3<f32>, normal: vec3<f32>) -> LookAt {
    var look: LookAt;
    look.base_color = base;
    let metal_and_rough = map_texel(place, detail, SLOT_METALLIC_ROUGHNESS);
    look.metallic = material.metallic * metal_and_rough.b;
    look.roughness = material.roughness * metal_and_rough.g;
    look.specular_color = material.specular_color * map_texel(place, detail, SLOT_SPECULAR_COLOR).rgb;
    look.specular = material.specular * map_texel(place, detail, SLOT_SPECULAR).a;
    look.ior = material.ior;
    look.occlusion = 1.0 + material.occlusion_strength * (map_texel(place, detail, SLOT_OCCLUSION).r - 1.0);
    // The surface's map of normals doesn't change the coat's, which has one of its own (KHR_materials_clearcoat).
    var coat_normal = place.normal;
    if HAS_COAT {
        look.coat = material.coat * map_texel(place, detail, SLOT_CLEARCOAT).r;
        look.coat_roughness = material.coat_roughness * map_texel(place, detail, SLOT_CLEARCOAT_ROUGHNESS).g;
        if has_map(SLOT_CLEARCOAT_NORMAL) && HAS_DETAILS && !IS_DRAFT {
            let direction = map_direction(map_texel(place, detail, SLOT_CLEARCOAT_NORMAL).rgb, material.coat_normal_scale);
            coat_normal = mapped_normal(coat_normal, detail.tangent, detail.bitangent_sign, direction);
        }
    }
    look.coat_normal = facing_normal(place, coat_normal);
    if HAS_SHEEN {
        look.sheen_color = material.sheen_color * map_texel(place, detail, SLOT_SHEEN_COLOR).rgb;
        look.sheen_roughness = material.sheen_roughness * map_texel(place, detail, SLOT_SHEEN_ROUGHNESS).a;
        look.sheen_albedo = environment_sheen(clamp(dot(normal, place.to_eye), 0.0, 1.0), look.sheen_roughness);
    }
    if HAS_ANISOTROPY {
        look.anisotropy = material.anisotropy;
        var along = material.anisotropy_direction;
        if has_map(SLOT_ANISOTROPY) {
            let numbers = map_texel(place, detail, SLOT_ANISOTROPY);
            look.anisotropy *= numbers.b;
            along = mat2x2<f32>(along, vec2<f32>(-along.y, along.x)) * (2.0 * numbers.rg - 1.0);
        }
        let stretch = stretch_direction(place, detail, along, normal);
        // Without a direction, highlights are round.
        look.anisotropy = select(look.anisotropy, 0.0, dot(stretch, stretch) < LEAST_TANGENT);
        look.direction = stretch * inverseSqrt(max(dot(stretch, stretch), LEAST_TANGENT));
    }
    return look;
}

// A direction of tangent space in the plane across the shown normal, of any length: it is 0 where tangents say nothing.
fn stretch_direction(place: SurfacePlace, detail: PlaceDetail, along: vec2<f32>, normal: vec3<f32>) -> vec3<f32> {
    let tangent = detail.tangent - place.normal * dot(detail.tangent, place.normal);
    let bitangent = detail.bitangent_sign * cross(place.normal, tangent);
    let direction = along.x * tangent + along.y * bitangent;
    return direction - normal * dot(direction, normal);
}

// Radiance towards the eye of what the lights of the file shine on.
fn lights_reflection(look: LookAt, normal: vec3<f32>, place: SurfacePlace) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < LIGHT_COUNT; i++) {
        let light = direct_light(lights[i], place.position);
        sum += light.illuminance * direct_reflection(look, normal, place.to_eye, light.to_light);
    }
    return sum;
}

fn base_color(place: SurfacePlace, detail: PlaceDetail) -> vec4<f32> {
    return material.base_color * detail.color * texel(base_texture, base_sampler, place.own);
}

fn transmission_at(place: SurfacePlace, detail: PlaceDetail) -> f32 {
    if !HAS_TRANSMISSION {
        return 0.0;
    }
    return material.transmission * map_texel(place, detail, SLOT_TRANSMISSION).r;
}

// Whether the surface is there, but doesn't hide all that is behind it. Such places are drawn in layers, and all others before.
fn shows_behind(place: SurfacePlace) -> bool {
    let detail = place_detail(place);
    let alpha = base_color(place, detail).a;
    let blends = material.blends > 0.5;
    let is_there = alpha >= select(material.cutoff, LEAST_SEEN, blends);
    // A place that is opaque but for a rounding may be drawn twice. None is left out.
    // Not &&, which would branch on a uniform.
    let is_sheer = blends & (alpha < 1.0 - 0.5 * LEAST_SEEN);
    return is_there && (is_sheer || transmission_at(place, detail) >= LEAST_SEEN);
}

// A unit normal of the front as one on the side that is seen. A map may tilt it until it faces away from the eye. It is mirrored then:
// a surface that is seen from the very side would reflect all of the light.
fn facing_normal(place: SurfacePlace, front_normal: vec3<f32>) -> vec3<f32> {
    // From behind, all of the relief is seen the other way round (section 3.9.5).
    let normal = select(-front_normal, front_normal, place.front);
    return normal - 2.0 * min(dot(normal, place.to_eye), 0.0) * place.to_eye;
}

// The unit shading normal on the side that is seen, which a map may tilt.
fn shown_normal(place: SurfacePlace, detail: PlaceDetail) -> vec3<f32> {
    var normal = place.normal;
    if has_map(SLOT_NORMAL) && HAS_DETAILS && !IS_DRAFT {
        let direction = map_direction(map_texel(place, detail, SLOT_NORMAL).rgb, material.normal_scale);
        normal = mapped_normal(normal, detail.tangent, detail.bitangent_sign, direction);
    }
    return facing_normal(place, normal);
}

// The colour that a picture shows of the surface, in linear light.
fn surface_radiance(
    place: SurfacePlace,
    detail: PlaceDetail,
    base: vec3<f32>,
    look: LookAt,
    normal: vec3<f32>,
) -> vec3<f32> {
    let emitted = material.emissive * map_texel(place, detail, SLOT_EMISSIVE).rgb;
    var radiance = ambient_reflection(look, normal, place.to_eye) + emitted * coat_transmission(look, place.to_eye);
    if LIGHT_COUNT > 0u {
        radiance += lights_reflection(look, normal, place);
    }
    return select(exposed(radiance), base, material.unlit > 0.5);
}

// The colour that a picture shows of a place which hides what is behind it, in linear light; and 0 in place of 1 where there is no
// such surface.
fn material_color(place: SurfacePlace) -> vec4<f32> {
    let detail = place_detail(place);
    let base = base_color(place, detail);
    let normal = shown_normal(place, detail);
    let color = surface_radiance(place, detail, base.rgb, look_at(place, detail, base.rgb, normal), normal);
    let is_draft_of_blend = IS_DRAFT && material.blends > 0.5;
    var hides = !HAS_MASK || base.a >= select(material.cutoff, 0.5, is_draft_of_blend);
    if HAS_TRANSMISSION {
        hides = hides && transmission_at(place, detail) < select(LEAST_SEEN, 0.5, IS_DRAFT);
    }
    return vec4<f32>(color, f32(hides));
}
