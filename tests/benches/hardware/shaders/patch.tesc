#version 450
// The hull shader: passes on a patch's corners, and sets the factors that our passes used for it.

layout(std430, set = 0, binding = 1) readonly buffer Factors {
    // The edges opposite corners 0, 1 and 2, then the inside.
    vec4 factors[];
};

#ifdef NETS_IN_MEMORY
layout(vertices = 1) out;
#else
layout(vertices = 3) out;

layout(location = 0) in vec4 position_u[];
layout(location = 1) in vec4 normal_v[];
layout(location = 2) in vec4 near_center[];
layout(location = 3) in vec4 far[];
layout(location = 0) out vec4 position_u_out[];
layout(location = 1) out vec4 normal_v_out[];
layout(location = 2) out vec4 near_center_out[];
layout(location = 3) out vec4 far_out[];
#endif

void main() {
#ifndef NETS_IN_MEMORY
    position_u_out[gl_InvocationID] = position_u[gl_InvocationID];
    normal_v_out[gl_InvocationID] = normal_v[gl_InvocationID];
    near_center_out[gl_InvocationID] = near_center[gl_InvocationID];
    far_out[gl_InvocationID] = far[gl_InvocationID];
#endif
    if (gl_InvocationID == 0) {
        vec4 own = factors[gl_PrimitiveID];
        gl_TessLevelOuter[0] = own.x;
        gl_TessLevelOuter[1] = own.y;
        gl_TessLevelOuter[2] = own.z;
        gl_TessLevelInner[0] = own.w;
    }
}
