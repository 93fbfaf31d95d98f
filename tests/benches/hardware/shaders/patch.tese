#version 450
#extension GL_GOOGLE_include_directive : require
// The domain shader: a point of the PN patch with its normal, as in shaders/surface.wgsl and shaders/normal.wgsl. Texture
// coordinates, which ours makes too, are left out: no pixel needs them. Vulkan's domain has its origin at the upper left, so that clockwise there is counter-clockwise in the
// order of a patch's corners.

#ifdef EQUAL_SPACING
layout(triangles, equal_spacing, cw) in;
#else
layout(triangles, fractional_odd_spacing, cw) in;
#endif

#include "frame.glsl"

#ifdef NETS_IN_MEMORY
#include "net.glsl"

#define CORNER(k, field) net_corners[3 * gl_PrimitiveID + k].field
#else
layout(location = 0) in vec4 position_u[];
layout(location = 1) in vec4 normal_v[];
layout(location = 2) in vec4 near_center[];
layout(location = 3) in vec4 far[];

#define CORNER(k, field) field[k]
#endif

layout(location = 0) out vec3 normal_out;

void main() {
    float x = gl_TessCoord.x;
    float y = gl_TessCoord.y;
    float z = gl_TessCoord.z;
    vec4 a = CORNER(0, position_u);
    vec4 b = CORNER(1, position_u);
    vec4 c = CORNER(2, position_u);
    vec4 at_a = CORNER(0, normal_v);
    vec4 at_b = CORNER(1, normal_v);
    vec4 at_c = CORNER(2, normal_v);
    vec4 near_a = CORNER(0, near_center);
    vec4 near_b = CORNER(1, near_center);
    vec4 near_c = CORNER(2, near_center);
    vec3 center = vec3(near_a.w, near_b.w, near_c.w);
    vec3 position = a.xyz * (x * x * x)
        + b.xyz * (y * y * y)
        + c.xyz * (z * z * z)
        + near_a.xyz * (3.0 * x * x * y)
        + CORNER(0, far).xyz * (3.0 * x * y * y)
        + near_b.xyz * (3.0 * y * y * z)
        + CORNER(1, far).xyz * (3.0 * y * z * z)
        + near_c.xyz * (3.0 * z * z * x)
        + CORNER(2, far).xyz * (3.0 * z * x * x)
        + center * (6.0 * x * y * z);
    normal_out = normalize(at_a.xyz * x + at_b.xyz * y + at_c.xyz * z);
    gl_Position = frame.clip_from_object * vec4(position, 1.0);
}
