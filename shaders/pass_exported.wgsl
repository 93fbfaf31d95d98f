// Exported compute passes: tessellates patches of nine indices (eighteen if they are displaced) without any other preparation by the
// host. It runs hull_main with an invocation a patch, then offsets_main in one workgroup, and then emit_main with a workgroup a
// patch.
// With: connectivity

// Indices a patch, which src/inspect/shader_files puts in place of this.
const PATCH_INDICES: u32 = 9u;

@group(0) @binding(0) var<uniform> constants: StageConstants;
// The mesh's corners, 8 numbers each: position (object units), unit normal, texture coordinates.
@group(0) @binding(1) var<storage, read> corners: array<f32>;
// The indices of the patches, which `pnaen adjacency` writes.
@group(0) @binding(2) var<storage, read> indices: array<u32>;
@group(0) @binding(3) var<storage, read_write> hulls: array<Hull>;
// Where the output of each patch begins: its vertices (x) and its triangles (y). offsets_main makes that of their numbers.
@group(0) @binding(4) var<storage, read_write> offsets: array<vec2<u32>>;
// The output: 8 numbers a vertex, as of corners, and 3 indices a triangle.
@group(0) @binding(5) var<storage, read_write> out_vertices: array<f32>;
@group(0) @binding(6) var<storage, read_write> out_indices: array<u32>;
@group(0) @binding(7) var<storage, read_write> status: Status;
@group(0) @binding(8) var<uniform> height_constants: HeightConstants;
// What displacement needs of every corner, 10 numbers each: the unit vector along which its point moves, the gradients of both
// texture coordinates in object space, and the length of the point's shortest edge in px of level 0.
@group(0) @binding(9) var<storage, read> relief_corners: array<f32>;
// Mip levels as kept_level keeps them: of every patch's three sides, and then of every point, at its dominant corner. The host
// fills them with zeros before hull_main.
@group(0) @binding(11) var<storage, read_write> kept_levels: array<atomic<u32>>;

// What hull_main computes for a patch.
struct Hull {
    net: ControlNet,
    factors: PatchFactors,
}

// Arguments of an indexed indirect draw of all that was emitted, and how much that is. Patches that don't fit the output's
// buffers are left out; then `vertices` and `triangles`, which count all, are more than the buffers hold.
struct Status {
    index_count: u32,
    instance_count: u32,
    first_index: u32,
    base_vertex: i32,
    first_instance: u32,
    vertices: u32,
    triangles: u32,
}

// Invocations of a workgroup.
const EXPORTED_WORKGROUP: u32 = 64u;
const SCAN_WORKGROUP: u32 = 256u;

fn patch_count() -> u32 {
    return arrayLength(&indices) / PATCH_INDICES;
}

fn exported_position(corner: u32) -> vec3<f32> {
    return vec3<f32>(corners[8u * corner], corners[8u * corner + 1u], corners[8u * corner + 2u]);
}

fn exported_normal(corner: u32) -> vec3<f32> {
    return vec3<f32>(corners[8u * corner + 3u], corners[8u * corner + 4u], corners[8u * corner + 5u]);
}

fn exported_uv(corner: u32) -> vec2<f32> {
    return vec2<f32>(corners[8u * corner + 6u], corners[8u * corner + 7u]);
}

// What a hull shader's invocation for side `k` computes.
fn patch_side(first: u32, k: u32) -> HullSide {
    let start = indices[first + k];
    let end = indices[first + (k + 1u) % 3u];
    let across_start = indices[first + 3u + 2u * k];
    let across_end = indices[first + 4u + 2u * k];
    return hull_side(
        constants,
        exported_position(start),
        exported_position(end),
        SideNormals(exported_normal(start), exported_normal(end)),
        SideNormals(exported_normal(across_start), exported_normal(across_end)),
    );
}

// Where the mip level of the point at corner `k` of a patch is kept. The patch's indices begin at `first`.
fn point_place(first: u32, k: u32) -> u32 {
    return 3u * patch_count() + indices[first + 9u + k];
}

// Keeps the mip levels of a patch's sides, to which LOD gives the factors `sides`, and the finest level of the sides at each point.
fn keep_levels(index: u32, sides: vec3<f32>) {
    let first = PATCH_INDICES * index;
    for (var k = 0u; k < 3u; k++) {
        let start = exported_uv(indices[first + 12u + 2u * k]);
        let end = exported_uv(indices[first + 13u + 2u * k]);
        let level = kept_level(side_level(height_constants, sides[k], start, end));
        atomicStore(&kept_levels[3u * index + k], level);
        atomicMax(&kept_levels[point_place(first, k)], level);
        atomicMax(&kept_levels[point_place(first, (k + 1u) % 3u)], level);
    }
}

// Computes a patch's control net and factors, and counts what it will emit.
@compute @workgroup_size(EXPORTED_WORKGROUP)
fn hull_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = (workgroup.y * workgroups.x + workgroup.x) * EXPORTED_WORKGROUP + local;
    if index >= patch_count() {
        return;
    }
    var net: ControlNet;
    var sides: vec3<f32>;
    for (var k = 0u; k < 3u; k++) {
        let side = patch_side(PATCH_INDICES * index, k);
        net.corners[k] = exported_position(indices[PATCH_INDICES * index + k]);
        net.edges[2u * k] = side.near_start;
        net.edges[2u * k + 1u] = side.near_end;
        sides[k] = side.factor;
    }
    if CHOSEN_DISPLACEMENT != DISPLACEMENT_OFF && CHOSEN_LOD != LOD_UNIFORM {
        // Also of patches that are left out: levels don't depend on what is in view.
        keep_levels(index, sides);
    }
    net.center = center_control_point(net.corners, net.edges);
    let written = tessellation_factors(constants, net, sides);
    let factors = process(CHOSEN_PARTITIONING, written.xyz, written.w);
    hulls[index] = Hull(net, factors);
    offsets[index] = vec2<u32>(point_count(factors), triangle_count(factors));
}

var<workgroup> partial_sums: array<vec2<u32>, SCAN_WORKGROUP>;

// Turns counts into offsets, in one workgroup: each invocation adds up a run of patches (Blelloch 1990, section 1.2, with one
// level).
@compute @workgroup_size(SCAN_WORKGROUP)
fn offsets_main(@builtin(local_invocation_index) local: u32) {
    let count = patch_count();
    let run = (count + SCAN_WORKGROUP - 1u) / SCAN_WORKGROUP;
    let first = min(local * run, count);
    let end = min(first + run, count);
    var sum = vec2<u32>(0u);
    for (var i = first; i < end; i++) {
        sum += offsets[i];
    }
    partial_sums[local] = sum;
    workgroupBarrier();
    var before = vec2<u32>(0u);
    for (var i = 0u; i < local; i++) {
        before += partial_sums[i];
    }
    for (var i = first; i < end; i++) {
        let own = offsets[i];
        offsets[i] = before;
        before += own;
        if has_room(before) {
            atomicMax(&fitting_triangles, before.y);
        }
    }
    workgroupBarrier();
    if local == SCAN_WORKGROUP - 1u {
        status = Status(3u * atomicLoad(&fitting_triangles), 1u, 0u, 0, 0u, before.x, before.y);
    }
}

var<workgroup> fitting_triangles: atomic<u32>;

// Whether the output has room for so many vertices (x) and triangles (y).
fn has_room(counts: vec2<u32>) -> bool {
    return counts.x <= arrayLength(&out_vertices) / 8u && counts.y <= arrayLength(&out_indices) / 3u;
}

fn patch_hull(index: u32) -> StagePatch {
    let a = indices[PATCH_INDICES * index];
    let b = indices[PATCH_INDICES * index + 1u];
    let c = indices[PATCH_INDICES * index + 2u];
    return StagePatch(
        hulls[index].net,
        array<vec3<f32>, 3>(exported_normal(a), exported_normal(b), exported_normal(c)),
        array<vec2<f32>, 3>(exported_uv(a), exported_uv(b), exported_uv(c)),
    );
}

// What displacement needs of a corner, whose numbers begin at `first`.
fn relief_vector(corner: u32, first: u32) -> vec3<f32> {
    let at = 10u * corner + first;
    return vec3<f32>(relief_corners[at], relief_corners[at + 1u], relief_corners[at + 2u]);
}

fn height_place(corner: u32) -> HeightPlace {
    return HeightPlace(exported_uv(corner), relief_vector(corner, 3u), relief_vector(corner, 6u));
}

// What displacement needs of a patch.
fn patch_relief(index: u32, uvs: array<vec2<f32>, 3>) -> StageRelief {
    let first = PATCH_INDICES * index;
    var relief: StageRelief;
    for (var k = 0u; k < 3u; k++) {
        let own = indices[first + k];
        let start = indices[first + 12u + 2u * k];
        let end = indices[first + 13u + 2u * k];
        relief.directions[k] = relief_vector(own, 0u);
        relief.own[k] = height_place(own);
        relief.dominant[k] = height_place(indices[first + 9u + k]);
        relief.sides[2u * k] = height_place(start);
        relief.sides[2u * k + 1u] = height_place(end);
        if CHOSEN_LOD == LOD_UNIFORM {
            let factor = constants.factor;
            relief.corner_levels[k] = corner_level(height_constants, factor, relief_corners[10u * own + 9u]);
            relief.side_levels[k] = side_level(height_constants, factor, exported_uv(start), exported_uv(end));
        } else {
            relief.corner_levels[k] = level_of(atomicLoad(&kept_levels[point_place(first, k)]));
            relief.side_levels[k] = level_of(atomicLoad(&kept_levels[3u * index + k]));
        }
    }
    let segments = f32(inside_value(hulls[index].factors)) * UNIT;
    relief.inside_level = level_inside(height_constants, segments, uvs);
    return relief;
}

fn put_vertex(index: u32, made: StageVertex) {
    out_vertices[8u * index] = made.position.x;
    out_vertices[8u * index + 1u] = made.position.y;
    out_vertices[8u * index + 2u] = made.position.z;
    out_vertices[8u * index + 3u] = made.normal.x;
    out_vertices[8u * index + 4u] = made.normal.y;
    out_vertices[8u * index + 5u] = made.normal.z;
    out_vertices[8u * index + 6u] = made.uv.x;
    out_vertices[8u * index + 7u] = made.uv.y;
}

// Emits the vertices and triangles of a patch: the fixed-function tessellator's points, numbered and joined as it does, each
// put through what a domain shader would do.
@compute @workgroup_size(EXPORTED_WORKGROUP)
fn emit_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = workgroup.y * workgroups.x + workgroup.x;
    if index >= patch_count() {
        return;
    }
    let factors = hulls[index].factors;
    let counts = vec2<u32>(point_count(factors), triangle_count(factors));
    let start = offsets[index];
    if counts.x == 0u || !has_room(start + counts) {
        return;
    }
    let hull = patch_hull(index);
    let plan = domain_plan(factors);
    if CHOSEN_DISPLACEMENT == DISPLACEMENT_OFF {
        for (var i = local; i < counts.x; i += EXPORTED_WORKGROUP) {
            put_vertex(start.x + i, stage_vertex(hull, domain_point(plan, i)));
        }
    } else {
        let relief = patch_relief(index, hull.uvs);
        for (var i = local; i < counts.x; i += EXPORTED_WORKGROUP) {
            put_vertex(start.x + i, displaced_vertex(height_constants, hull, relief, domain_point(plan, i)));
        }
    }
    for (var t = local; t < counts.y; t += EXPORTED_WORKGROUP) {
        let triangle = domain_triangle(plan, t);
        let at = 3u * (start.y + t);
        out_indices[at] = start.x + triangle.x;
        out_indices[at + 1u] = start.x + triangle.y;
        out_indices[at + 2u] = start.x + triangle.z;
    }
}
