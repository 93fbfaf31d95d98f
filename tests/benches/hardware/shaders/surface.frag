#version 450
#extension GL_GOOGLE_include_directive : require
// What surface_fragment of shaders/draw_surface.wgsl does without overlays; the material's texture, which is white there,
// left out.

#include "frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal_in;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 color;

vec3 shade(vec3 base, vec3 normal, vec3 position) {
    vec3 to_eye = normalize(frame.eye.xyz - position * frame.eye.w);
    float key = max(dot(normal, frame.key_light.xyz), 0.0);
    float fill = 0.5 + 0.5 * dot(normal, frame.fill_light.xyz);
    vec3 half_way = normalize(frame.key_light.xyz + to_eye);
    float gloss = pow(max(dot(normal, half_way), 0.0), 48.0) * 0.08;
    return base * (0.62 * key + 0.22 * fill + 0.04) + vec3(gloss);
}

void main() {
    vec3 normal = normalize(gl_FrontFacing ? normal_in : -normal_in);
    // Texture coordinates are used, so that no compiler leaves them out.
    vec3 base = frame.base_color.rgb * clamp(uv.x + 2.0, 0.0, 1.0);
    color = vec4(shade(base, normal, position), 1.0);
}
