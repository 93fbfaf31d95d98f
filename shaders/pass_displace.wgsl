// Displaces the vertices of one chunk after they were emitted, and turns their normals: one invocation a vertex. Twin:
// src/geometry/tessellate/mesh_displacement.rs.
// With: height_list

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> slab: Slab;
@group(0) @binding(2) var<storage, read> chunks: array<Chunk>;
@group(0) @binding(4) var<storage, read> patch_factors: array<PatchFactors>;
@group(0) @binding(5) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> patches: array<Patch>;
@group(0) @binding(7) var<storage, read> curve_nets: array<CurveNet>;
@group(0) @binding(8) var<storage, read> corners: array<Corner>;
@group(0) @binding(9) var<storage, read_write> vertex_halves: array<vec4<u32>>;
@group(0) @binding(11) var<storage, read> shares: array<Share>;
@group(1) @binding(0) var<uniform> chunk_index: u32;

// Where heights are looked up for a point: a patch, weights in it, and a level.
struct Lookup {
    patch_index: u32,
    u: u32,
    v: u32,
    level: f32,
}

fn side_weights(side: u32, t: u32) -> vec2<u32> {
    if side == 0u {
        return vec2<u32>(FIXED_ONE - t, t);
    }
    return select(vec2<u32>(t, 0u), vec2<u32>(0u, FIXED_ONE - t), side == 1u);
}

fn inside_level(patch_index: u32, segments: f32) -> f32 {
    let map = map_of(patch_index);
    if map == 0u {
        return 0.0;
    }
    let uvs = patch_uvs(patch_index);
    let own = maps[map - 1u];
    let longest = max(max(texel_length(own, uvs[0], uvs[1]), texel_length(own, uvs[1], uvs[2])), texel_length(own, uvs[2], uvs[0]));
    return segment_level(own, longest, segments);
}

fn side_factor(patch_index: u32, side: u32) -> u32 {
    return patches[patch_index].factors[side] >> 3u;
}

// Whether a patch's side runs as its edge's dominant side does.
fn runs_along(patch_index: u32, side: u32, dominant: u32) -> bool {
    return patches[patch_index].points[side] == patches[dominant / 4u].points[dominant % 4u];
}

// Where a patch would look up its point's height by itself.
fn own_lookup(patch_index: u32, u: u32, v: u32, at: Spot, segments: f32) -> Lookup {
    if at.kind == AT_CORNER {
        return Lookup(patch_index, u, v, shares[patches[patch_index].points[at.index]].level);
    }
    if at.kind == ON_SIDE {
        return Lookup(patch_index, u, v, share_of_factor(side_factor(patch_index, at.index)).level);
    }
    return Lookup(patch_index, u, v, inside_level(patch_index, segments));
}

// Where all patches that meet at the point look up its height, so that they agree.
fn shared_lookup(own: Lookup, at: Spot) -> Lookup {
    if at.kind == AT_CORNER {
        let dominant = shares[patches[own.patch_index].points[at.index]].dominant;
        let u = select(0u, FIXED_ONE, dominant % 4u == 0u);
        let v = select(0u, FIXED_ONE, dominant % 4u == 1u);
        return Lookup(dominant / 4u, u, v, own.level);
    }
    if at.kind == ON_SIDE {
        let dominant = share_of_factor(side_factor(own.patch_index, at.index)).dominant;
        let t = select(FIXED_ONE - at.t, at.t, runs_along(own.patch_index, at.index, dominant));
        let weights = side_weights(dominant % 4u, t);
        return Lookup(dominant / 4u, weights.x, weights.y, own.level);
    }
    return own;
}

// On a side it is computed in the dominant side's direction, so that all sides compute the same.
fn direction_at(patch_index: u32, u: u32, v: u32, at: Spot) -> vec3<f32> {
    var directions = corner_directions(patch_index);
    if at.kind == AT_CORNER {
        return directions[at.index];
    }
    if at.kind == ON_SIDE {
        let a = directions[at.index];
        let b = directions[(at.index + 1u) % 3u];
        let dominant = share_of_factor(side_factor(patch_index, at.index)).dominant;
        let along = runs_along(patch_index, at.index, dominant);
        return edge_normal(select(b, a, along), select(a, b, along), select(FIXED_ONE - at.t, at.t, along));
    }
    return linear_normal(directions, u, v);
}

fn lookup_level(map: HeightMap, at: Lookup) -> f32 {
    return min(at.level, f32(map.levels - 1u));
}

fn offset_at(at: Lookup) -> f32 {
    let map = map_of(at.patch_index);
    if map == 0u {
        return 0.0;
    }
    let own = maps[map - 1u];
    let uv = linear_uv(patch_uvs(at.patch_index), at.u, at.v);
    // LOD by error bounds the distance from what level 0 has.
    let level = select(lookup_level(own, at), 0.0, params.lod == LOD_ERROR);
    let midlevel = select(params.midlevel, own.midlevel, own.has_amount != 0u);
    return map_scale(own) * (height_at(own, level, uv) - midlevel);
}

// The gradient of the height in object space, from the gradients of texture coordinates at the patch's corners.
fn uphill_at(at: Lookup) -> vec3<f32> {
    let map = map_of(at.patch_index);
    if map == 0u {
        return vec3<f32>(0.0);
    }
    let own = maps[map - 1u];
    let uv = linear_uv(patch_uvs(at.patch_index), at.u, at.v);
    let rises = height_slopes(own, lookup_level(own, at), uv) * map_scale(own);
    let at_corners = patches[at.patch_index].corners;
    let x = f32(at.u) * UNIT;
    let y = f32(at.v) * UNIT;
    let z = f32(FIXED_ONE - at.u - at.v) * UNIT;
    let along_u = corner_gradient(at_corners[0], 0u) * x
        + corner_gradient(at_corners[1], 0u) * y
        + corner_gradient(at_corners[2], 0u) * z;
    let along_v = corner_gradient(at_corners[0], 1u) * x
        + corner_gradient(at_corners[1], 1u) * y
        + corner_gradient(at_corners[2], 1u) * z;
    return along_u * rises.x + along_v * rises.y;
}

// The slopes of a patch's height along u and v, and the tangents of the patch moved outwards by `offset`.
struct Rise {
    slopes: vec2<f32>,
    tangents: array<vec3<f32>, 2>,
}

fn rise_at(at: Lookup, offset: f32) -> Rise {
    let uvs = patch_uvs(at.patch_index);
    let tangents = patch_tangents(params.surface, load_net(at.patch_index), at.u, at.v);
    let directions = corner_directions(at.patch_index);
    let x = f32(at.u) * UNIT;
    let y = f32(at.v) * UNIT;
    let z = f32(FIXED_ONE - at.u - at.v) * UNIT;
    let sum = directions[0] * x + directions[1] * y + directions[2] * z;
    let direction = unit_or(sum, linear_normal(directions, at.u, at.v));
    let turns = direction_slopes(directions, direction, length(sum));
    var rise: Rise;
    rise.tangents = array<vec3<f32>, 2>(tangents[0] + turns[0] * offset, tangents[1] + turns[1] * offset);
    let map = map_of(at.patch_index);
    if map > 0u {
        let own = maps[map - 1u];
        let uv = linear_uv(uvs, at.u, at.v);
        let rises = height_slopes(own, lookup_level(own, at), uv) * map_scale(own);
        rise.slopes = vec2<f32>(dot(rises, uvs[0] - uvs[2]), dot(rises, uvs[1] - uvs[2]));
    }
    return rise;
}

@compute @workgroup_size(256)
fn displace_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= chunks[chunk_index].vertex_count {
        return;
    }
    let vertex = vertex_of(vertex_halves[index], vertex_halves[arrayLength(&vertex_halves) / 2u + index]);
    let key = vec2<u32>(vertex.key0, vertex.key1);
    let patch_index = key_patch(key);
    let uv = key_uv(key);
    let segments = f32(inside_value(patch_factors[patch_index - slab.first_patch])) * UNIT;
    let at = spot(uv.x, uv.y);
    let own = own_lookup(patch_index, uv.x, uv.y, at, segments);
    var requested = own;
    if params.displacement != DISPLACEMENT_PER_PATCH {
        requested = shared_lookup(own, at);
    }
    let direction = direction_at(patch_index, uv.x, uv.y, at);
    let offset = offset_at(requested);
    let normal = unpack_normal(vertex.normal);
    var raised: vec3<f32>;
    if params.normals == NORMALS_SURFACE {
        // Every patch's own, as without displacement.
        let rise = rise_at(own, offset);
        let along_u = rise.tangents[0] + direction * rise.slopes.x;
        let along_v = rise.tangents[1] + direction * rise.slopes.y;
        raised = facing_or(array<vec3<f32>, 2>(along_u, along_v), normal);
    } else {
        raised = raised_normal(uphill_at(requested), normal);
    }
    let p = vec3<f32>(vertex.x, vertex.y, vertex.z) + direction * offset;
    vertex_halves[index] = vertex_place(p, pack_normal(raised));
}
