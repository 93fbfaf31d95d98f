#version 450
@HEADER@
// Vertex stage: hands a corner of the mesh on.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
@D@// The second vertex buffer.
@D@layout(location = 3) in vec3 direction;
@D@layout(location = 4) in vec3 along_u;
@D@layout(location = 5) in vec3 along_v;
@U@layout(location = 6) in float texels;
@V@// The third vertex buffer: the mip level at a point, which levels.comp keeps at the point's dominant corner.
@V@layout(location = 6) in uint level;

layout(location = 0) out vec3 vertex_position;
layout(location = 1) out vec3 vertex_normal;
layout(location = 2) out vec2 vertex_uv;
@D@layout(location = 3) out vec3 vertex_direction;
@D@layout(location = 4) out vec3 vertex_along_u;
@D@layout(location = 5) out vec3 vertex_along_v;
@U@layout(location = 6) out float vertex_texels;
@V@layout(location = 6) out uint vertex_level;

void main() {
    vertex_position = position;
    vertex_normal = normal;
    vertex_uv = uv;
@D@    vertex_direction = direction;
@D@    vertex_along_u = along_u;
@D@    vertex_along_v = along_v;
@U@    vertex_texels = texels;
@V@    vertex_level = level;
}
