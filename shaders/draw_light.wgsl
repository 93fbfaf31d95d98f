// How the surface is lit, in linear light.

struct Lights {
    key: vec3<f32>,
    fill: vec3<f32>,
    // Unit direction.
    to_eye: vec3<f32>,
}

// Where a fragment would be if all that is drawn weren't moved to the right by so many columns.
fn unmoved(fragment: vec4<f32>, shift: f32) -> vec4<f32> {
    return fragment - vec4<f32>(shift, 0.0, 0.0, 0.0);
}

// The unit direction towards the eye from what is seen at a place of the picture, in px. All points on that line of sight
// have one x / w and one y / w, so it lies in two planes, whose normals come from rows of the matrix. This needs no
// position from the vertex shader.
fn toward_eye(clip_from_object: mat4x4<f32>, viewport: vec2<f32>, px: vec2<f32>) -> vec3<f32> {
    let at = vec2<f32>(2.0, -2.0) * px / viewport + vec2<f32>(-1.0, 1.0);
    let rows = transpose(clip_from_object);
    return normalize(cross(rows[0].xyz - at.x * rows[3].xyz, rows[1].xyz - at.y * rows[3].xyz));
}

// The place in object space that a fragment is of, by its builtin position. It lies in three planes, whose equations come from rows
// of the matrix.
fn fragment_place(clip_from_object: mat4x4<f32>, viewport: vec2<f32>, fragment: vec4<f32>) -> vec3<f32> {
    let at = vec2<f32>(2.0, -2.0) * fragment.xy / viewport + vec2<f32>(-1.0, 1.0);
    let rows = transpose(clip_from_object);
    let a = rows[0] - at.x * rows[3];
    let b = rows[1] - at.y * rows[3];
    let c = rows[2] - fragment.z * rows[3];
    let bc = cross(b.xyz, c.xyz);
    let sum = a.w * bc + b.w * cross(c.xyz, a.xyz) + c.w * cross(a.xyz, b.xyz);
    return -sum / dot(a.xyz, bc);
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
