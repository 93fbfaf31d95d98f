#version 450
@HEADER@
// Tessellation evaluation stage: a vertex of a patch.

@FUNCTIONS@

#ifdef VULKAN
layout(std140, set = 0, binding = 0) uniform Tessellation {
#else
layout(std140, binding = 0) uniform Tessellation {
#endif
    StageConstants constants;
};

@D@#ifdef VULKAN
@D@layout(std140, set = 0, binding = 1) uniform Heights {
@D@#else
@D@layout(std140, binding = 1) uniform Heights {
@D@#endif
@D@    HeightConstants height_constants;
@D@};
@D@
// Triangles keep the winding of the mesh. Vulkan's domain has its origin at the upper left, OpenGL's at the lower left.
#ifdef VULKAN
layout(triangles, @SPACING@_spacing, cw) in;
#else
layout(triangles, @SPACING@_spacing, ccw) in;
#endif

layout(location = 0) in vec3 corner_position[];
layout(location = 1) in vec3 corner_normal[];
layout(location = 2) in vec2 corner_uv[];
layout(location = 3) in vec3 near_start[];
layout(location = 4) in vec3 near_end[];
layout(location = 6) patch in vec3 center;
@D@layout(location = 7) in vec3 corner_direction[];
@D@layout(location = 8) in vec3 corner_along_u[];
@D@layout(location = 9) in vec3 corner_along_v[];
@D@layout(location = 10) in vec2 dominant_uv[];
@D@layout(location = 11) in vec3 dominant_along_u[];
@D@layout(location = 12) in vec3 dominant_along_v[];
@D@layout(location = 13) in vec4 side_uvs[];
@D@layout(location = 14) in vec3 start_along_u[];
@D@layout(location = 15) in vec3 start_along_v[];
@D@layout(location = 16) in vec3 end_along_u[];
@D@layout(location = 17) in vec3 end_along_v[];
@D@layout(location = 18) patch in vec3 corner_levels;
@D@layout(location = 19) patch in vec3 side_levels;
@D@layout(location = 20) patch in float inside_level;

// In object units; a unit vector; texture coordinates.
layout(location = 0) precise out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec2 uv;

@D@StageRelief patch_relief() {
@D@    StageRelief relief;
@D@    for (int k = 0; k < 3; k++) {
@D@        relief.directions[k] = corner_direction[k];
@D@        relief.own[k] = HeightPlace(corner_uv[k], corner_along_u[k], corner_along_v[k]);
@D@        relief.dominant[k] = HeightPlace(dominant_uv[k], dominant_along_u[k], dominant_along_v[k]);
@D@        relief.sides[2 * k] = HeightPlace(side_uvs[k].xy, start_along_u[k], start_along_v[k]);
@D@        relief.sides[2 * k + 1] = HeightPlace(side_uvs[k].zw, end_along_u[k], end_along_v[k]);
@D@    }
@D@    relief.corner_levels = corner_levels;
@D@    relief.side_levels = side_levels;
@D@    relief.inside_level = inside_level;
@D@    return relief;
@D@}
@D@
void main() {
    vec3 corners[3] = vec3[3](corner_position[0], corner_position[1], corner_position[2]);
    vec3 edges[6] = vec3[6](near_start[0], near_end[0], near_start[1], near_end[1], near_start[2], near_end[2]);
    vec3 normals[3] = vec3[3](corner_normal[0], corner_normal[1], corner_normal[2]);
    vec2 uvs[3] = vec2[3](corner_uv[0], corner_uv[1], corner_uv[2]);
    StagePatch hull = StagePatch(ControlNet(corners, edges, center), normals, uvs);
@N@    precise StageVertex made = stage_vertex(hull, fixed_location(gl_TessCoord));
@D@    uvec2 domain = fixed_location(gl_TessCoord);
@D@    precise StageVertex made = displaced_vertex(height_constants, hull, patch_relief(), domain);
    position = made.position;
    normal = made.normal;
    uv = made.uv;
    // The same bits on both sides of an edge give the same place on screen only if nothing is fused here either.
    precise vec4 place = constants.clip_from_object * vec4(position, 1.0);
    gl_Position = place;
}
