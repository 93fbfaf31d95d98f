#version 450
#extension GL_GOOGLE_include_directive : require
// What plain_fragment of shaders/draw_plain.wgsl does.

#include "frame.glsl"

layout(location = 0) in vec3 normal_in;
layout(location = 0) out vec4 color;

vec3 toward_eye(vec2 px) {
    vec2 at = vec2(2.0, -2.0) * px / frame.viewport.xy + vec2(-1.0, 1.0);
    mat4 rows = transpose(frame.clip_from_object);
    return normalize(cross(rows[0].xyz - at.x * rows[3].xyz, rows[1].xyz - at.y * rows[3].xyz));
}

vec3 shade(vec3 base, vec3 normal, vec3 to_eye) {
    float key = max(dot(normal, frame.key_light.xyz), 0.0);
    float fill = 0.5 + 0.5 * dot(normal, frame.fill_light.xyz);
    vec3 half_way = normalize(frame.key_light.xyz + to_eye);
    float gloss = pow(max(dot(normal, half_way), 0.0), 48.0) * 0.08;
    return base * (0.62 * key + 0.22 * fill + 0.04) + vec3(gloss);
}

void main() {
    vec3 normal = normalize(gl_FrontFacing ? normal_in : -normal_in);
    color = vec4(shade(frame.base_color.rgb, normal, toward_eye(gl_FragCoord.xy)), 1.0);
}
