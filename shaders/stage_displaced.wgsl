// What exported shaders do where a surface is displaced: the part of a hull shader and of a domain shader that doesn't depend on
// their language. A patch has eighteen indices: the nine of stage_patch.wgsl, the dominant corner on each of its three points,
// and for each of its sides the two corners of the edge's dominant side (McDonald 2011). pass_levels.wgsl and
// pass_displace.wgsl do the same for a whole mesh.
// With: stage_heights

// What patches agree on where they meet, which src/inspect/shader_files puts in place of this.
const CHOSEN_DISPLACEMENT: u32 = DISPLACEMENT_ON;

// The height image, and how it displaces.
struct HeightConstants {
    // The width and height of level 0 of the image in px, and the number of its levels.
    size: vec2<u32>,
    levels: u32,
    // What is beyond the image, a WRAP: along u in the lowest two bits, along v in the next.
    wrap: u32,
    // How far white is above black, in object units.
    scale: f32,
    // The height, 0 to 1, that stays where it is.
    midlevel: f32,
}

// A place in the height image: texture coordinates, and the gradients of both in object space.
struct HeightPlace {
    uv: vec2<f32>,
    along_u: vec3<f32>,
    along_v: vec3<f32>,
}

// What the domain shader reads of a patch that is displaced, besides StagePatch.
struct StageRelief {
    // The unit vectors along which the points of its corners move.
    directions: array<vec3<f32>, 3>,
    // Where the patch's own corners are in the image, and the dominant corners on the same points.
    own: array<HeightPlace, 3>,
    dominant: array<HeightPlace, 3>,
    // Where the dominant sides are: that of side k at its start (2k) and at its end (2k + 1).
    sides: array<HeightPlace, 6>,
    // The mip levels from which heights are read: at the corners, on the sides, and inside.
    corner_levels: vec3<f32>,
    side_levels: vec3<f32>,
    inside_level: f32,
}

// Returns the height image as the functions that read it take it.
fn height_map(constants: HeightConstants) -> HeightMap {
    return HeightMap(constants.size, constants.levels, 0u, constants.wrap, 1u, constants.scale, constants.midlevel);
}

// Returns the mip level on an edge to which LOD gives `factor`, and whose dominant side has these texture coordinates at its ends.
fn side_level(constants: HeightConstants, factor: f32, start: vec2<f32>, end: vec2<f32>) -> f32 {
    let map = height_map(constants);
    return segment_level(map, texel_length(map, start, end), clamp(written_factor(factor), 1.0, 64.0));
}

// Returns the mip level at a point under uniform LOD: the finest of its edges. All have the same factor, and the shortest of them
// is `texels` px of level 0 long.
fn corner_level(constants: HeightConstants, factor: f32, texels: f32) -> f32 {
    return segment_level(height_map(constants), texels, clamp(written_factor(factor), 1.0, 64.0));
}

// Returns a mip level as buffers keep it, so that an atomic maximum finds the finest one: bits of numbers that aren't negative are
// in the order of the numbers, and inverted they are largest at the finest level. A kept level is never 0, with which buffers begin.
fn kept_level(level: f32) -> u32 {
    // A zero may have a sign.
    return ~(bitcast<u32>(level) & 0x7fffffffu);
}

// Returns the mip level that a buffer keeps like this.
fn level_of(kept: u32) -> f32 {
    return bitcast<f32>(~kept);
}

// Returns the mip level inside a patch that has these texture coordinates, and so many segments inside.
fn level_inside(constants: HeightConstants, segments: f32, uvs: array<vec2<f32>, 3>) -> f32 {
    let map = height_map(constants);
    let longest = max(max(texel_length(map, uvs[0], uvs[1]), texel_length(map, uvs[1], uvs[2])), texel_length(map, uvs[2], uvs[0]));
    return segment_level(map, longest, segments);
}

// Returns the number of segments inside a patch whose hull shader writes these factors: of the edges, and inside.
fn segments_inside(factors: vec4<f32>) -> f32 {
    return f32(inside_value(process(CHOSEN_PARTITIONING, factors.xyz, factors.w))) * UNIT;
}

// Returns the place at weights `u` and `v` between a patch's own corners.
fn inner_place(relief: StageRelief, u: u32, v: u32) -> HeightPlace {
    let x = f32(u) * UNIT;
    let y = f32(v) * UNIT;
    let z = f32(FIXED_ONE - u - v) * UNIT;
    let a = relief.own[0];
    let b = relief.own[1];
    let c = relief.own[2];
    return HeightPlace(
        a.uv * x + b.uv * y + c.uv * z,
        a.along_u * x + b.along_u * y + c.along_u * z,
        a.along_v * x + b.along_v * y + c.along_v * z,
    );
}

// Returns the place at `t` between the ends of an edge.
fn edge_place(a: HeightPlace, b: HeightPlace, t: u32) -> HeightPlace {
    let x = f32(FIXED_ONE - t) * UNIT;
    let y = f32(t) * UNIT;
    return HeightPlace(a.uv * x + b.uv * y, a.along_u * x + b.along_u * y, a.along_v * x + b.along_v * y);
}

// Returns whether a displaced side runs against its edge, whose direction all its sides see alike.
fn relief_is_reversed(hull: StagePatch, side: u32) -> bool {
    return comes_before(hull.net.corners[(side + 1u) % 3u], hull.net.corners[side]);
}

// Returns where the height of a vertex is read, so that all patches agree that have it: on an edge at its dominant side, and at a
// point at its dominant corner.
fn shared_place(hull: StagePatch, relief: StageRelief, at: Spot, u: u32, v: u32) -> HeightPlace {
    if CHOSEN_DISPLACEMENT == DISPLACEMENT_PER_PATCH {
        return inner_place(relief, u, v);
    }
    if at.kind == AT_CORNER {
        return relief.dominant[at.index];
    }
    if at.kind == ON_SIDE {
        let reversed = relief_is_reversed(hull, at.index);
        let a = relief.sides[2u * at.index + u32(reversed)];
        let b = relief.sides[2u * at.index + u32(!reversed)];
        return edge_place(a, b, select(at.t, FIXED_ONE - at.t, reversed));
    }
    return inner_place(relief, u, v);
}

// Returns the mip level from which the height of a vertex is read.
fn level_at(relief: StageRelief, at: Spot) -> f32 {
    if at.kind == AT_CORNER {
        return relief.corner_levels[at.index];
    }
    if at.kind == ON_SIDE {
        return relief.side_levels[at.index];
    }
    return relief.inside_level;
}

// Returns the unit vectors along which a patch's corners move: those of their points or, as published, the corners' own normals.
fn chosen_directions(hull: StagePatch, relief: StageRelief) -> array<vec3<f32>, 3> {
    if CHOSEN_DISPLACEMENT == DISPLACEMENT_ON {
        return relief.directions;
    }
    return hull.normals;
}

// Returns the unit vector along which a vertex moves.
fn moving_direction(hull: StagePatch, relief: StageRelief, at: Spot, u: u32, v: u32) -> vec3<f32> {
    var directions = chosen_directions(hull, relief);
    if at.kind == AT_CORNER {
        return directions[at.index];
    }
    if at.kind == ON_SIDE {
        let next = (at.index + 1u) % 3u;
        let reversed = relief_is_reversed(hull, at.index);
        let a = directions[select(at.index, next, reversed)];
        let b = directions[select(next, at.index, reversed)];
        return edge_normal(a, b, select(at.t, FIXED_ONE - at.t, reversed));
    }
    return linear_normal(directions, u, v);
}

// Returns how far a vertex moves, in object units.
fn height_offset(constants: HeightConstants, place: HeightPlace, level: f32) -> f32 {
    return constants.scale * (height_at(height_map(constants), level, place.uv) - constants.midlevel);
}

// Returns the unit normal of the displaced patch itself, or `otherwise` where it has none. `direction` and `offset` are how the
// vertex moved.
fn displaced_surface_normal(
    constants: HeightConstants,
    hull: StagePatch,
    relief: StageRelief,
    level: f32,
    weights: vec2<u32>,
    direction: vec3<f32>,
    offset: f32,
    otherwise: vec3<f32>,
) -> vec3<f32> {
    let x = f32(weights.x) * UNIT;
    let y = f32(weights.y) * UNIT;
    let z = f32(FIXED_ONE - weights.x - weights.y) * UNIT;
    let directions = chosen_directions(hull, relief);
    let sum = directions[0] * x + directions[1] * y + directions[2] * z;
    let own = unit_or(sum, linear_normal(directions, weights.x, weights.y));
    let turns = direction_slopes(directions, own, length(sum));
    let tangents = patch_tangents(CHOSEN_SURFACE, hull.net, weights.x, weights.y);
    let place = inner_place(relief, weights.x, weights.y);
    let rises = height_slopes(height_map(constants), level, place.uv) * constants.scale;
    let rise_u = dot(rises, hull.uvs[0] - hull.uvs[2]);
    let rise_v = dot(rises, hull.uvs[1] - hull.uvs[2]);
    let along_u = tangents[0] + turns[0] * offset + direction * rise_u;
    let along_v = tangents[1] + turns[1] * offset + direction * rise_v;
    return facing_or(array<vec3<f32>, 2>(along_u, along_v), otherwise);
}

// Returns a shading normal tilted by the heights at a place.
fn tilted_normal(constants: HeightConstants, place: HeightPlace, level: f32, normal: vec3<f32>) -> vec3<f32> {
    let rises = height_slopes(height_map(constants), level, place.uv) * constants.scale;
    return raised_normal(place.along_u * rises.x + place.along_v * rises.y, normal);
}

// Returns the position of a vertex that the surface has at `position`, displaced.
fn moved(position: vec3<f32>, direction: vec3<f32>, offset: f32) -> vec3<f32> {
    return position + direction * offset;
}

// Returns the displaced vertex at a domain point that the tessellator gives as U and V, in 16.16 fixed point.
fn displaced_vertex(
    constants: HeightConstants,
    hull: StagePatch,
    relief: StageRelief,
    domain: vec2<u32>,
) -> StageVertex {
    let made = stage_vertex(hull, domain);
    let weights = corner_weights(CHOSEN_CONVENTION, domain);
    let at = spot(weights.x, weights.y);
    let place = shared_place(hull, relief, at, weights.x, weights.y);
    let level = level_at(relief, at);
    let direction = moving_direction(hull, relief, at, weights.x, weights.y);
    let offset = height_offset(constants, place, level);
    let position = moved(made.position, direction, offset);
    if CHOSEN_NORMALS == NORMALS_SURFACE {
        let own = displaced_surface_normal(constants, hull, relief, level, weights, direction, offset, made.normal);
        return StageVertex(position, own, made.uv);
    }
    return StageVertex(position, tilted_normal(constants, place, level, made.normal), made.uv);
}
