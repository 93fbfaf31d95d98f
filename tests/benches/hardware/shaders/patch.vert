#version 450
#extension GL_GOOGLE_include_directive : require
// Passes a corner of a patch on to the hull shader. If the domain shader reads control nets from memory, a patch is one point
// without attributes.

#ifndef NETS_IN_MEMORY
#include "net.glsl"

layout(location = 0) out vec4 position_u;
layout(location = 1) out vec4 normal_v;
layout(location = 2) out vec4 near_center;
layout(location = 3) out vec4 far;
#endif

void main() {
#ifndef NETS_IN_MEMORY
    NetCorner corner = net_corners[gl_VertexIndex];
    position_u = corner.position_u;
    normal_v = corner.normal_v;
    near_center = corner.near_center;
    far = corner.far;
#endif
}
