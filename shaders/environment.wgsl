// The light from all around, which src/inspect/render/environment.rs makes: a cube map that is blurred by roughness from level to
// level, one of irradiance, and a table of directional albedos. Directions are in object space.

struct Surroundings {
    // Turns a direction in object space into the light's own.
    light_from_object: mat3x3<f32>,
    // Factor of all light.
    brightness: f32,
    // Factor of what the camera sees, 2 to the power of the exposure value.
    exposure: f32,
    // TONE_CURVE_*.
    tone_curve: u32,
}

// Whether highlights may be longer along a direction.
override HAS_ANISOTROPY: bool = true;

// Levels of the first cube: from a mirror's to that of roughness 1.
const ENVIRONMENT_LEVELS: u32 = 6u;

// The level of the second cube that has irradiance, divided by PI.
const IRRADIANCE_LEVEL: u32 = 1u;

// Width and height of the table, in texels. The first and the last are for cosine and roughness 0 and 1.
const DFG_SIZE: u32 = 64u;

@group(1) @binding(16) var environment_map: texture_cube_array<f32>;
@group(1) @binding(17) var environment_sampler: sampler;
@group(1) @binding(18) var dfg_table: texture_2d<f32>;
// No branch depends on this uniform, nor on those of materials and lights: see draw_surface_inputs.wgsl. Where a material has no coat or no
// sheen, these count as 0; where no material of the mesh has one, compilers leave them out.
@group(1) @binding(19) var<uniform> surroundings: Surroundings;

// The level of the cube map that has a roughness. Levels are closer where surfaces are smooth.
fn level_of_roughness(roughness: f32) -> f32 {
    return f32(ENVIRONMENT_LEVELS - 1u) * pow(roughness, 2.0 / 3.0);
}

// Radiance from a direction, blurred as a surface of that roughness would.
fn environment_radiance(direction: vec3<f32>, roughness: f32) -> vec3<f32> {
    return environment_light(direction, 0, level_of_roughness(roughness));
}

// Irradiance of a surface with that normal, divided by PI.
fn environment_irradiance(normal: vec3<f32>) -> vec3<f32> {
    return environment_light(normal, 1, f32(IRRADIANCE_LEVEL));
}

fn environment_light(direction: vec3<f32>, cube: i32, level: f32) -> vec3<f32> {
    let turned = surroundings.light_from_object * direction;
    return surroundings.brightness * textureSampleLevel(environment_map, environment_sampler, turned, cube, level).rgb;
}

// Factors of f0 and f90 in the part of light that microfacets reflect at once.
fn environment_dfg(facing: f32, roughness: f32) -> vec2<f32> {
    return dfg_texel(facing, roughness).rg;
}

fn dfg_texel(facing: f32, roughness: f32) -> vec4<f32> {
    let size = f32(DFG_SIZE);
    let at = (vec2<f32>(facing, roughness) * (size - 1.0) + 0.5) / size;
    return textureSampleLevel(dfg_table, environment_sampler, at, 0.0);
}

// The part of light that a white sheen reflects.
fn environment_sheen(facing: f32, roughness: f32) -> f32 {
    return dfg_texel(facing, roughness).b;
}

// Round highlights that make up a long one.
const LEANS: u32 = 16u;

// Radiance that a surface with long highlights reflects: the mean of round ones, of microfacets that lean along the direction.
// Each stands for the same part of them: the slopes of GGX along a direction are those of angles whose sines are spread evenly.
// Each is so much rougher that no gaps are left.
fn long_reflection(look: LookAt, normal: vec3<f32>, to_eye: vec3<f32>) -> vec3<f32> {
    let squares = stretched_alphas(look) * stretched_alphas(look);
    let more = max(squares.x - squares.y, 0.0);
    let roughness = sqrt(sqrt(squares.y + more / f32(LEANS * LEANS)));
    var sum = vec4<f32>(0.0);
    for (var index = 0u; index < LEANS; index++) {
        let sine = (2.0 * f32(index) + 1.0) / f32(LEANS) - 1.0;
        let leaning = normalize(normal - sqrt(more) * sine * inverseSqrt(1.0 - sine * sine) * look.direction);
        let direction = dominant_direction(leaning, to_eye, roughness);
        // At least a little, so that there is a mean where all lean away.
        let weight = max(dot(normal, direction), 1e-4);
        sum += weight * vec4<f32>(environment_radiance(direction, roughness), 1.0);
    }
    return sum.rgb / sum.a;
}

// Radiance towards the eye from a surface under this light. `normal` and `to_eye` are of unit length.
fn ambient_reflection(look: LookAt, normal: vec3<f32>, to_eye: vec3<f32>) -> vec3<f32> {
    var light: AmbientLight;
    light.diffuse = environment_irradiance(normal);
    light.facing = clamp(dot(normal, to_eye), 0.0, 1.0);
    light.reflected = environment_radiance(dominant_direction(normal, to_eye, look.roughness), look.roughness);
    if HAS_ANISOTROPY {
        light.reflected = select(light.reflected, long_reflection(look, normal, to_eye), look.anisotropy > 0.0);
    }
    light.dfg = environment_dfg(light.facing, mean_roughness(look));
    light.coat_facing = clamp(dot(look.coat_normal, to_eye), 0.0, 1.0);
    let coat_direction = dominant_direction(look.coat_normal, to_eye, look.coat_roughness);
    light.coat_reflected = environment_radiance(coat_direction, look.coat_roughness);
    light.coat_dfg = environment_dfg(light.coat_facing, look.coat_roughness);
    light.sheen = environment_irradiance(sheen_direction(normal, to_eye));
    return reflect_ambient(look, light);
}

// The part of emitted light that gets through the coat towards the eye.
fn coat_transmission(look: LookAt, to_eye: vec3<f32>) -> f32 {
    let facing = clamp(dot(look.coat_normal, to_eye), 0.0, 1.0);
    return select(1.0, 1.0 - coat_albedo(look, environment_dfg(facing, look.coat_roughness)), look.coat > 0.0);
}

// The part of the light from right behind a thin surface that comes through it towards the eye.
fn transmitted_through(look: LookAt, normal: vec3<f32>, to_eye: vec3<f32>) -> vec3<f32> {
    let facing = clamp(dot(normal, to_eye), 0.0, 1.0);
    let coat_facing = clamp(dot(look.coat_normal, to_eye), 0.0, 1.0);
    return transmitted(look, environment_dfg(facing, mean_roughness(look)), environment_dfg(coat_facing, look.coat_roughness));
}

// What the screen shows of radiance towards the eye, in linear RGB.
fn exposed(radiance: vec3<f32>) -> vec3<f32> {
    return tone_mapped(radiance * surroundings.exposure, surroundings.tone_curve);
}
