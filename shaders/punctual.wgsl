// Lights that shine from a place or from one direction, as glTF's KHR_lights_punctual describes them. Places and directions are in
// object space, whose units count as metres. src/inspect/for_tests/punctual.rs has the same functions.

// The greatest number of lights.
const MOST_LIGHTS: u32 = 16u;

struct PunctualLight {
    // The light's place (w = 1); or the unit direction towards it, if it is infinitely far away (w = 0).
    origin: vec4<f32>,
    // Linear RGB: luminous intensity in cd, or the illuminance in lx of a light that is infinitely far away.
    intensity: vec3<f32>,
    // 1 divided by the range; 0 without one.
    inverse_range: f32,
    // The unit direction that a spot light shines in.
    direction: vec3<f32>,
    // A spot light's brightness is the square of a linear function of the cosine of the angle to its direction.
    cone_scale: f32,
    cone_offset: f32,
}

// What reaches a place from a light.
struct DirectLight {
    // Of unit length.
    to_light: vec3<f32>,
    // Of a surface across the light, in linear RGB.
    illuminance: vec3<f32>,
}

// The light that reaches a place (KHR_lights_punctual, sections "Range Property" and "Inner and Outer Cone Angles").
fn direct_light(light: PunctualLight, place: vec3<f32>) -> DirectLight {
    let toward = light.origin.xyz - light.origin.w * place;
    // 1 for a direction.
    let square = max(dot(toward, toward), 1e-12);
    let to_light = toward * inverseSqrt(square);
    let part = square * light.inverse_range * light.inverse_range;
    let attenuation = clamp(1.0 - part * part, 0.0, 1.0) / square;
    let cone = clamp(light.cone_offset - light.cone_scale * dot(to_light, light.direction), 0.0, 1.0);
    return DirectLight(to_light, light.intensity * (attenuation * cone * cone));
}
