// Makes one level of an environment's cube map: the source, blurred as a surface of one roughness reflects it when the eye looks
// along the normal (Karis 2013). Or makes a level of irradiance. An invocation makes a texel.

struct PrefilterParams {
    roughness: f32,
    // Directions that a texel is blurred from; 0 for irradiance.
    sample_count: u32,
    // Width of a face of this level, and of the source's first level, in texels.
    size: u32,
    source_size: u32,
}

@group(0) @binding(0) var source: texture_cube_array<f32>;
@group(0) @binding(1) var source_sampler: sampler;
@group(0) @binding(2) var<uniform> params: PrefilterParams;
@group(0) @binding(3) var filtered: texture_storage_2d_array<rgba16float, write>;
@group(0) @binding(4) var<storage, read> parts: array<LightPart>;

// The light from a small part of all directions: see src/inspect/render/irradiance.rs.
struct LightPart {
    // The mean of its unit directions, by their light.
    direction: vec3<f32>,
    // Linear RGB times the solid angle, divided by PI.
    light: vec3<f32>,
}

fn blurred(normal: vec3<f32>) -> vec3<f32> {
    let across = directions_across(normal);
    let alpha = params.roughness * params.roughness;
    var sum = vec4<f32>(0.0);
    for (var i = 0u; i < params.sample_count; i += 1u) {
        let light = light_and_density(hammersley(i, params.sample_count), alpha);
        if light.z > 0.0 {
            let direction = across[0] * light.x + across[1] * light.y + normal * light.z;
            let level = sample_level(light.w, params.sample_count, f32(params.source_size));
            sum += light.z * vec4<f32>(textureSampleLevel(source, source_sampler, direction, 0, level).rgb, 1.0);
        }
    }
    return sum.rgb / sum.w;
}

// Irradiance of a surface with that normal, divided by PI; no more than half floats hold.
fn gathered(normal: vec3<f32>) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < arrayLength(&parts); i += 1u) {
        sum += max(dot(normal, parts[i].direction), 0.0) * parts[i].light;
    }
    return min(sum, vec3<f32>(65504.0));
}

@compute @workgroup_size(8, 8)
fn prefilter_main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= vec2<u32>(params.size)) {
        return;
    }
    let at = (2.0 * vec2<f32>(id.xy) + 1.0) / f32(params.size) - 1.0;
    let normal = normalize(cube_direction(id.z, at));
    var light: vec3<f32>;
    if params.sample_count == 0u {
        light = gathered(normal);
    } else if params.roughness == 0.0 {
        light = textureSampleLevel(source, source_sampler, normal, 0, 0.0).rgb;
    } else {
        light = blurred(normal);
    }
    textureStore(filtered, id.xy, id.z, vec4<f32>(light, 1.0));
}
