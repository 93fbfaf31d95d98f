// Makes a level of an image from the one before, and scales its alpha so that as large a part of it passes the test of a mask as of
// the image. Levels but the first lie in one buffer, row by row; rows begin at multiples of 64 texels, as copies to images need it.

struct MipParams {
    // Width and height of the level that is read, and of the one that is made, in texels.
    source_size: vec2<u32>,
    target_size: vec2<u32>,
    // Where they begin in the buffer, and how long their rows are, in texels. The first level isn't there but in the image.
    source_start: u32,
    source_stride: u32,
    target_start: u32,
    target_stride: u32,
    // Level that is made.
    level: u32,
    mip_filter: u32,
    // The least alpha that passes the test of a mask, and how many texels of the level that is made should pass it.
    least_alpha: u32,
    wanted: u32,
}

@group(0) @binding(0) var<uniform> params: MipParams;
@group(0) @binding(1) var image: texture_2d<f32>;
@group(0) @binding(3) var<storage, read_write> levels: array<u32>;
// Of each level how many texels have each alpha, and then the alpha that is scaled to the least one that passes.
@group(0) @binding(4) var<storage, read_write> alphas: array<atomic<u32>>;

const ALPHAS: u32 = 257u;

fn source_texel(at: vec2<u32>) -> vec4<u32> {
    if params.level == 1u {
        return vec4<u32>(255.0 * textureLoad(image, at, 0) + 0.5);
    }
    let packed = levels[params.source_start + at.y * params.source_stride + at.x];
    return vec4<u32>(packed & 255u, (packed >> 8u) & 255u, (packed >> 16u) & 255u, packed >> 24u);
}

@compute @workgroup_size(8, 8)
fn mip_main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= params.target_size) {
        return;
    }
    let across = taps_of(id.x, params.source_size.x);
    let down = taps_of(id.y, params.source_size.y);
    var sum: MipSum;
    for (var y = 0u; y < 3u; y += 1u) {
        for (var x = 0u; x < 3u; x += 1u) {
            let weight = down.weights[y] * across.weights[x];
            if weight > 0.0 {
                let texel = source_texel(vec2<u32>(across.first + x, down.first + y));
                sum = mip_added(sum, texel, weight, params.mip_filter);
            }
        }
    }
    let texel = mip_texel(sum, params.mip_filter);
    levels[params.target_start + id.y * params.target_stride + id.x] =
        texel.r | (texel.g << 8u) | (texel.b << 16u) | (texel.a << 24u);
}

@compute @workgroup_size(8, 8)
fn mip_count(@builtin(global_invocation_id) id: vec3<u32>) {
    if all(id.xy < params.target_size) {
        let alpha = levels[params.target_start + id.y * params.target_stride + id.x] >> 24u;
        atomicAdd(&alphas[params.level * ALPHAS + alpha], 1u);
    }
}

// Chooses the alpha from which on the number of texels is nearest to what is wanted, and of these the one nearest to the least that
// passes.
@compute @workgroup_size(1)
fn mip_choose() {
    let first = params.level * ALPHAS;
    var best = 256u;
    var best_error = params.wanted;
    var count = 0u;
    for (var alpha = 255u; alpha > 0u; alpha -= 1u) {
        count += atomicLoad(&alphas[first + alpha]);
        let error = max(count, params.wanted) - min(count, params.wanted);
        let distance = max(alpha, params.least_alpha) - min(alpha, params.least_alpha);
        let best_distance = max(best, params.least_alpha) - min(best, params.least_alpha);
        if error < best_error || (error == best_error && distance < best_distance) {
            best = alpha;
            best_error = error;
        }
    }
    atomicStore(&alphas[first + 256u], best);
}

@compute @workgroup_size(8, 8)
fn mip_cover(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= params.target_size) {
        return;
    }
    let at = params.target_start + id.y * params.target_stride + id.x;
    let packed = levels[at];
    let start = atomicLoad(&alphas[params.level * ALPHAS + 256u]);
    levels[at] = (packed & 0xffffffu) | (scaled_alpha(packed >> 24u, start, params.least_alpha) << 24u);
}
