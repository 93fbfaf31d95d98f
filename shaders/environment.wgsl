// The light from all around, which src/render/environment.rs makes: a cube map that is blurred by roughness from level to level, a
// table of directional albedos, and irradiance as spherical harmonics. Directions are in object space.

struct Surroundings {
    // Irradiance divided by PI: coefficients of 1, y, z, x, xy, yz, 3zz - 1, xz and xx - yy, in linear RGB.
    irradiance: array<vec4<f32>, 9>,
    // Turns a direction in object space into the light's own.
    light_from_object: mat3x3<f32>,
    // Factor of all light.
    brightness: f32,
    // Factor of what the camera sees, 2 to the power of the exposure value.
    exposure: f32,
    // TONE_CURVE_*.
    tone_curve: u32,
}

// Levels of the cube map. Roughness grows evenly from 0 at the first to 1 at the last.
const ENVIRONMENT_LEVELS: u32 = 6u;

// Width and height of the table, in texels. The first and the last are for cosine and roughness 0 and 1.
const DFG_SIZE: u32 = 64u;

@group(1) @binding(16) var environment_map: texture_cube<f32>;
@group(1) @binding(17) var environment_sampler: sampler;
@group(1) @binding(18) var dfg_table: texture_2d<f32>;
@group(1) @binding(19) var<uniform> surroundings: Surroundings;

// Radiance from a direction, blurred as a surface of that roughness would.
fn environment_radiance(direction: vec3<f32>, roughness: f32) -> vec3<f32> {
    let level = roughness * f32(ENVIRONMENT_LEVELS - 1u);
    let turned = surroundings.light_from_object * direction;
    return surroundings.brightness * textureSampleLevel(environment_map, environment_sampler, turned, level).rgb;
}

// Irradiance of a surface with that normal, divided by PI (Ramamoorthi and Hanrahan 2001, equation 11).
fn environment_irradiance(normal: vec3<f32>) -> vec3<f32> {
    let n = surroundings.light_from_object * normal;
    let c = surroundings.irradiance;
    let sum = c[0] + c[1] * n.y + c[2] * n.z + c[3] * n.x + c[4] * (n.x * n.y) + c[5] * (n.y * n.z)
        + c[6] * (3.0 * n.z * n.z - 1.0) + c[7] * (n.x * n.z) + c[8] * (n.x * n.x - n.y * n.y);
    return surroundings.brightness * max(sum.rgb, vec3<f32>(0.0));
}

// Factors of f0 and f90 in the part of light that microfacets reflect at once.
fn environment_dfg(facing: f32, roughness: f32) -> vec2<f32> {
    let size = f32(DFG_SIZE);
    let at = (vec2<f32>(facing, roughness) * (size - 1.0) + 0.5) / size;
    return textureSampleLevel(dfg_table, environment_sampler, at, 0.0).rg;
}

// Radiance towards the eye from a surface under this light. `normal` and `to_eye` are of unit length.
fn ambient_reflection(look: LookAt, normal: vec3<f32>, to_eye: vec3<f32>) -> vec3<f32> {
    var light: AmbientLight;
    light.diffuse = environment_irradiance(normal);
    light.facing = clamp(dot(normal, to_eye), 0.0, 1.0);
    light.reflected = environment_radiance(reflect(-to_eye, normal), look.roughness);
    light.dfg = environment_dfg(light.facing, look.roughness);
    if look.coat > 0.0 {
        light.coat_facing = clamp(dot(look.coat_normal, to_eye), 0.0, 1.0);
        light.coat_reflected = environment_radiance(reflect(-to_eye, look.coat_normal), look.coat_roughness);
        light.coat_dfg = environment_dfg(light.coat_facing, look.coat_roughness);
    }
    return reflect_ambient(look, light);
}

// The part of emitted light that gets through the coat towards the eye.
fn coat_transmission(look: LookAt, to_eye: vec3<f32>) -> f32 {
    if look.coat <= 0.0 {
        return 1.0;
    }
    let facing = clamp(dot(look.coat_normal, to_eye), 0.0, 1.0);
    return 1.0 - coat_albedo(look, environment_dfg(facing, look.coat_roughness));
}

// What the screen shows of radiance towards the eye, in linear RGB.
fn exposed(radiance: vec3<f32>) -> vec3<f32> {
    return tone_mapped(radiance * surroundings.exposure, surroundings.tone_curve);
}
