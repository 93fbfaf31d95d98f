// Averages texels for smaller levels of images. src/geometry/mesh/mipmap.rs has the same functions, and says where they come from.

// For each byte the linear light that sRGB encodes as it; then for each the least light that is encoded as it.
@group(0) @binding(2) var<storage, read> srgb_table: array<f32, 512>;

// The texels along a side that a texel of the next level is made of: the first and up to two more.
struct Taps {
    first: u32,
    // Whole numbers, so that sums are exact.
    weights: vec3<f32>,
}

fn taps_of(target_texel: u32, source: u32) -> Taps {
    let half = source / 2u;
    var weights = vec3<u32>(1u, 1u, 0u);
    if source == 1u {
        weights = vec3<u32>(1u, 0u, 0u);
    } else if source % 2u == 1u {
        weights = vec3<u32>(half - target_texel, half, target_texel + 1u);
    }
    return Taps(2u * target_texel, vec3<f32>(weights));
}

// A sum of texels.
struct MipSum {
    // Of channels that are decoded.
    plain: vec3<f32>,
    // Of weights.
    total: f32,
    // Of channels times alpha, and of alpha, 0 to 255.
    weighted: vec4<f32>,
}

// What bytes stand for. Normals are 255 times as long, so that their sums are exact.
fn mip_decoded(bytes: vec3<u32>, mip_filter: u32) -> vec3<f32> {
    if mip_filter == MIP_NUMBERS {
        return vec3<f32>(bytes);
    }
    if mip_filter == MIP_NORMALS {
        return 2.0 * vec3<f32>(bytes) - 255.0;
    }
    return vec3<f32>(srgb_table[bytes.x], srgb_table[bytes.y], srgb_table[bytes.z]);
}

fn mip_added(sum: MipSum, texel: vec4<u32>, weight: f32, mip_filter: u32) -> MipSum {
    let decoded = mip_decoded(texel.rgb, mip_filter);
    let covered = weight * f32(texel.a);
    return MipSum(sum.plain + decoded * weight, sum.total + weight, sum.weighted + vec4<f32>(decoded * covered, covered));
}

// The byte that sRGB encodes linear light as. Looked up, so that all devices agree.
fn mip_encoded_channel(light: f32) -> f32 {
    var byte = 0u;
    for (var step = 128u; step > 0u; step /= 2u) {
        if srgb_table[256u + byte + step] <= light {
            byte += step;
        }
    }
    return f32(byte);
}

fn mip_encoded(color: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(mip_encoded_channel(color.x), mip_encoded_channel(color.y), mip_encoded_channel(color.z));
}

// The direction of a sum of normals, or straight up if they cancel out.
fn mip_unit(normal: vec3<f32>) -> vec3<f32> {
    let length = sqrt(dot(normal, normal));
    if length > 0.0 {
        return normal / length;
    }
    return vec3<f32>(0.0, 0.0, 1.0);
}

fn mip_texel(sum: MipSum, mip_filter: u32) -> vec4<u32> {
    var color = sum.plain / sum.total;
    if mip_filter == MIP_NORMALS {
        color = 127.5 * mip_unit(sum.plain) + 127.5;
    } else if mip_filter == MIP_ALPHA_WEIGHTED && sum.weighted.a > 0.0 {
        color = mip_encoded(sum.weighted.rgb / sum.weighted.a);
    } else if mip_filter != MIP_NUMBERS {
        color = mip_encoded(color);
    }
    return vec4<u32>(vec4<f32>(color, sum.weighted.a / sum.total) + 0.5);
}

// An alpha that reaches `least` only if it was at least `start`.
fn scaled_alpha(alpha: u32, start: u32, least: u32) -> u32 {
    return min(alpha * least / start, 255u);
}
