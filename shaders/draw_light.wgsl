// How the surface is lit, in linear light.

struct Lights {
    key: vec3<f32>,
    fill: vec3<f32>,
    // Unit direction.
    to_eye: vec3<f32>,
}

// The unit direction towards the eye from what is seen at a place of the picture, in px. All points on that line of sight
// have one x / w and one y / w, so it lies in two planes, whose normals come from rows of the matrix. This needs no
// position from the vertex shader.
fn toward_eye(clip_from_object: mat4x4<f32>, viewport: vec2<f32>, px: vec2<f32>) -> vec3<f32> {
    let at = vec2<f32>(2.0, -2.0) * px / viewport + vec2<f32>(-1.0, 1.0);
    let rows = transpose(clip_from_object);
    return normalize(cross(rows[0].xyz - at.x * rows[3].xyz, rows[1].xyz - at.y * rows[3].xyz));
}

// How bright a matte white surface is.
fn brightness(lights: Lights, normal: vec3<f32>) -> f32 {
    let key = max(dot(normal, lights.key), 0.0);
    let fill = 0.5 + 0.5 * dot(normal, lights.fill);
    return 0.62 * key + 0.22 * fill + 0.04;
}

fn shade(lights: Lights, base: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let half_way = normalize(lights.key + lights.to_eye);
    let gloss = pow(max(dot(normal, half_way), 0.0), 48.0) * 0.08;
    return base * brightness(lights, normal) + vec3<f32>(gloss);
}
