#version 450
@HEADER@
// Vertex stage: hands a corner of the mesh on.

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;

layout(location = 0) out vec3 vertex_position;
layout(location = 1) out vec3 vertex_normal;
layout(location = 2) out vec2 vertex_uv;

void main() {
    vertex_position = position;
    vertex_normal = normal;
    vertex_uv = uv;
}
