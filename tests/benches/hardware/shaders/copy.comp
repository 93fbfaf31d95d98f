#version 450
// Copies 16 bytes per invocation.

layout(local_size_x = 256) in;

layout(std430, set = 0, binding = 0) readonly buffer From {
    uvec4 from[];
};
layout(std430, set = 0, binding = 1) writeonly buffer To {
    uvec4 to[];
};

void main() {
    uint workgroup = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint index = workgroup * 256u + gl_LocalInvocationIndex;
    if (index < to.length()) {
        to[index] = from[index];
    }
}
