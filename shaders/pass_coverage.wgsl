// Removes from a chunk the triangles that cover no sample: marks the others, counts how many come before each, and copies
// their indices, in their order.

@group(0) @binding(0) var<storage, read> sieve: Sieve;
@group(0) @binding(1) var<storage, read> vertex_halves: array<vec4<u32>>;
@group(0) @binding(2) var<storage, read> indices: array<u32>;
// One bit for each triangle: 1 if it is kept.
@group(0) @binding(3) var<storage, read_write> marks: array<u32>;
// First how many triangles are kept of each tile, then how many are kept of all tiles before it.
@group(0) @binding(4) var<storage, read_write> tile_starts: array<u32>;
@group(0) @binding(5) var<storage, read> draw_args: array<DrawArgs>;
@group(0) @binding(6) var<storage, read_write> kept_args: array<DrawArgs>;
@group(0) @binding(7) var<storage, read_write> kept_indices: array<u32>;

// The chunk that is looked at.
struct Sieve {
    view: CoverageView,
    triangle_count: u32,
    material_count: u32,
    // Index of the chunk's first draw arguments among those of its slab.
    first_draw: u32,
}

// Each workgroup looks at one tile: this many consecutive triangles, with one bit each in this many words of marks.
const TILE: u32 = 2048u;
const TILE_WORDS: u32 = TILE / 32u;
// Triangles that each invocation looks at.
const ROUNDS: u32 = TILE / WORKGROUP;

// The marks that each invocation made, one bit for each round.
var<workgroup> kept_in_rounds: array<u32, 256>;

fn corner_of(index: u32) -> ScreenCorner {
    return screen_corner(sieve.view, bitcast<vec3<f32>>(vertex_halves[indices[index]].xyz));
}

fn is_kept(triangle: u32) -> bool {
    if triangle >= sieve.triangle_count {
        return false;
    }
    return !covers_nothing(sieve.view, corner_of(3u * triangle), corner_of(3u * triangle + 1u), corner_of(3u * triangle + 2u));
}

fn tile_of(workgroup: vec3<u32>, workgroups: vec3<u32>) -> u32 {
    return workgroup.y * workgroups.x + workgroup.x;
}

@compute @workgroup_size(256)
fn coverage_marks_main(invocation: Invocation) {
    let tile = tile_of(invocation.workgroup, invocation.workgroups);
    var own = 0u;
    for (var round = 0u; round < ROUNDS; round++) {
        own |= u32(is_kept(tile * TILE + round * WORKGROUP + invocation.local)) << round;
    }
    kept_in_rounds[invocation.local] = own;
    workgroupBarrier();
    // A word of marks comes from 32 neighbouring invocations, in one round.
    var word = 0u;
    if invocation.local < TILE_WORDS {
        let first = invocation.local % 8u * 32u;
        for (var i = 0u; i < 32u; i++) {
            word |= ((kept_in_rounds[first + i] >> (invocation.local / 8u)) & 1u) << i;
        }
        if (tile * TILE_WORDS + invocation.local) * 32u < sieve.triangle_count {
            marks[tile * TILE_WORDS + invocation.local] = word;
        }
    }
    let count = countOneBits(word);
    let before = workgroup_scan(invocation.local, vec2<u32>(count, 0u)).x;
    if invocation.local == WORKGROUP - 1u && tile * TILE < sieve.triangle_count {
        tile_starts[tile] = before + count;
    }
}

// How many triangles are kept of those before this one. It may be one past the last.
fn kept_before(triangle: u32) -> u32 {
    let tile = triangle / TILE;
    let words = triangle % TILE / 32u;
    var sum = tile_starts[tile];
    for (var i = 0u; i < words; i++) {
        sum += countOneBits(marks[tile * TILE_WORDS + i]);
    }
    if triangle % 32u > 0u {
        sum += countOneBits(marks[triangle / 32u] & ((1u << triangle % 32u) - 1u));
    }
    return sum;
}

@compute @workgroup_size(256)
fn coverage_starts_main(@builtin(local_invocation_index) local: u32) {
    let tiles = (sieve.triangle_count + TILE - 1u) / TILE;
    let run = (tiles + WORKGROUP - 1u) / WORKGROUP;
    let first = local * run;
    let end = min(first + run, tiles);
    var sum = 0u;
    for (var i = first; i < end; i++) {
        sum += tile_starts[i];
    }
    var running = workgroup_scan(local, vec2<u32>(sum, 0u)).x;
    for (var i = first; i < end; i++) {
        let count = tile_starts[i];
        tile_starts[i] = running;
        running += count;
    }
    if local == WORKGROUP - 1u {
        tile_starts[tiles] = running;
    }
    storageBarrier();
    for (var material = local; material < sieve.material_count; material += WORKGROUP) {
        let all = draw_args[sieve.first_draw + material];
        let start = kept_before(all.first_index / 3u);
        let count = kept_before((all.first_index + all.index_count) / 3u) - start;
        kept_args[material] = DrawArgs(3u * count, 1u, 3u * start, 0, 0u, 0u, 0u, 0u, 0u);
    }
}

var<workgroup> tile_marks: array<u32, TILE_WORDS>;
var<workgroup> word_starts: array<u32, TILE_WORDS>;

@compute @workgroup_size(256)
fn coverage_keep_main(invocation: Invocation) {
    let tile = tile_of(invocation.workgroup, invocation.workgroups);
    var word = 0u;
    if invocation.local < TILE_WORDS && (tile * TILE_WORDS + invocation.local) * 32u < sieve.triangle_count {
        word = marks[tile * TILE_WORDS + invocation.local];
    }
    let before = workgroup_scan(invocation.local, vec2<u32>(countOneBits(word), 0u)).x;
    if invocation.local < TILE_WORDS {
        tile_marks[invocation.local] = word;
        word_starts[invocation.local] = before;
    }
    workgroupBarrier();
    let start = tile_starts[min(tile, arrayLength(&tile_starts) - 1u)];
    for (var round = 0u; round < ROUNDS; round++) {
        let triangle = round * WORKGROUP + invocation.local;
        let own = tile_marks[triangle / 32u];
        let bit = 1u << triangle % 32u;
        if (own & bit) != 0u {
            let place = 3u * (start + word_starts[triangle / 32u] + countOneBits(own & (bit - 1u)));
            let source = 3u * (tile * TILE + triangle);
            kept_indices[place] = indices[source];
            kept_indices[place + 1u] = indices[source + 1u];
            kept_indices[place + 2u] = indices[source + 2u];
        }
    }
}
