// Displacement: heights that are read from an image at texture coordinates, and the normals of the displaced surface. The
// module that has it also has height_list.wgsl or stage_heights.wgsl, which read single px. Twin:
// src/geometry/tessellate/displace.rs.

// Returns the fractional part of a texture coordinate, which repeats the image.
fn wrapped(x: f32) -> f32 {
    return x - floor(x);
}

// Returns where the texture coordinate `x` lies along a row or column of `size` px: in px from the centre of px 0. In
// images that repeat, `size` is added, so that the result isn't negative.
fn pixel_coordinate(wrap: u32, x: f32, size: u32) -> f32 {
    if wrap == WRAP_REPEAT {
        return wrapped(x) * f32(size) + f32(size) - 0.5;
    }
    // There and back again.
    let turned = 2.0 * wrapped(0.5 * x);
    let place = select(x, min(turned, 2.0 - turned), wrap == WRAP_MIRROR);
    return clamp(place * f32(size) - 0.5, 0.0, f32(size - 1u));
}

// Returns the height of a mip level at a texture coordinate, bilinearly interpolated.
fn bilinear_height(map: HeightMap, level: u32, uv: vec2<f32>) -> f32 {
    let width = max(map.size.x >> level, 1u);
    let height = max(map.size.y >> level, 1u);
    let x = pixel_coordinate(map.wrap & 3u, uv.x, width);
    let y = pixel_coordinate(map.wrap >> 2u, uv.y, height);
    let left = u32(x) % width;
    let upper = u32(y) % height;
    // Images that don't repeat give weight 0 to a px beyond the last one.
    let right = (left + 1u) % width;
    let lower = (upper + 1u) % height;
    let place = level_place(map, level);
    let a = fetch_height(map, place, vec2<u32>(left, upper));
    let b = fetch_height(map, place, vec2<u32>(right, upper));
    let c = fetch_height(map, place, vec2<u32>(left, lower));
    let d = fetch_height(map, place, vec2<u32>(right, lower));
    let across = x - floor(x);
    let down = y - floor(y);
    let above = a + (b - a) * across;
    let below = c + (d - c) * across;
    return above + (below - above) * down;
}

// Returns the height at a texture coordinate, linearly interpolated between the two mip levels around `level`.
fn height_at(map: HeightMap, level: f32, uv: vec2<f32>) -> f32 {
    let least = u32(level);
    let part = level - f32(least);
    let fine = bilinear_height(map, least, uv);
    if part <= 0.0 {
        return fine;
    }
    return fine + (bilinear_height(map, least + 1u, uv) - fine) * part;
}

// Returns the derivatives of the height by both texture coordinates, as central differences over one px of the level.
fn height_slopes(map: HeightMap, level: f32, uv: vec2<f32>) -> vec2<f32> {
    let px = exp2(level) / vec2<f32>(map.size);
    let across = vec2<f32>(0.5 * px.x, 0.0);
    let down = vec2<f32>(0.0, 0.5 * px.y);
    let along_x = height_at(map, level, uv + across) - height_at(map, level, uv - across);
    let along_y = height_at(map, level, uv + down) - height_at(map, level, uv - down);
    return vec2<f32>(along_x / px.x, along_y / px.y);
}

// Returns the mip level at which one px is as long as a segment of an edge. The edge is `texels` px of level 0 long and
// is cut into `segments`.
fn segment_level(map: HeightMap, texels: f32, segments: f32) -> f32 {
    let level = log2(max(texels, 1e-6) / segments);
    return clamp(level, 0.0, f32(map.levels - 1u));
}

// Returns the distance between two texture coordinates in px of level 0.
fn texel_length(map: HeightMap, a: vec2<f32>, b: vec2<f32>) -> f32 {
    return length((b - a) * vec2<f32>(map.size));
}

// Where a point lies on its patch: at corner `index`, on side `index` with weight t of its far end, or inside.
struct Spot {
    kind: u32,
    index: u32,
    t: u32,
}

const AT_CORNER: u32 = 0u;
const ON_SIDE: u32 = 1u;
const INSIDE: u32 = 2u;

// Returns where the domain point (u, v) lies on its patch.
fn spot(u: u32, v: u32) -> Spot {
    let weights = vec3<u32>(u, v, FIXED_ONE - u - v);
    for (var k = 0u; k < 3u; k++) {
        if weights[k] == FIXED_ONE {
            return Spot(AT_CORNER, k, 0u);
        }
    }
    let at = outline_place(u, v);
    if at.side < 3u {
        return Spot(ON_SIDE, at.side, at.t);
    }
    return Spot(INSIDE, 0u, 0u);
}

// Returns the derivatives by u and by v of the unit vector along a u + b v + c w, where a, b and c are `directions` and
// w = 1 - u - v. `direction` is that unit vector, and `length` is the length of the sum. Zero if the sum is nearly
// zero.
fn direction_slopes(directions: array<vec3<f32>, 3>, direction: vec3<f32>, length: f32) -> array<vec3<f32>, 2> {
    let along_u = directions[0] - directions[2];
    let along_v = directions[1] - directions[2];
    if length <= 1e-6 {
        return array<vec3<f32>, 2>(vec3<f32>(0.0), vec3<f32>(0.0));
    }
    let flat_u = along_u - direction * dot(direction, along_u);
    let flat_v = along_v - direction * dot(direction, along_v);
    return array<vec3<f32>, 2>(flat_u * (1.0 / length), flat_v * (1.0 / length));
}

// The gradients of both texture coordinates over a flat triangle, each times `area`, which is twice the triangle's
// area.
struct UvGradients {
    u: vec3<f32>,
    v: vec3<f32>,
    area: f32,
}

// Returns the gradients of both texture coordinates over a flat triangle, each times twice the triangle's area, and
// twice that area.
fn uv_gradients(corners: array<vec3<f32>, 3>, uvs: array<vec2<f32>, 3>) -> UvGradients {
    let none = UvGradients(vec3<f32>(0.0), vec3<f32>(0.0), 0.0);
    let along = corners[1] - corners[0];
    let beside = corners[2] - corners[0];
    let largest = max(abs(along), abs(beside));
    let size = max(max(largest.x, largest.y), largest.z);
    if size == 0.0 {
        return none;
    }
    // Scale the sides, so that products of very short or very long ones neither underflow nor overflow.
    let a = along * (1.0 / size);
    let b = beside * (1.0 / size);
    let facing = cross(a, b);
    let area = length(facing);
    if area <= 1e-12 {
        return none;
    }
    let normal = facing * (1.0 / area);
    let first = uvs[1] - uvs[0];
    let second = uvs[2] - uvs[0];
    let across = cross(b, normal);
    let down = cross(normal, a);
    return UvGradients(
        (across * first.x + down * second.x) * size,
        (across * first.y + down * second.y) * size,
        area * size * size,
    );
}

// Returns the unit normal of a surface that is shaded with `normal` and whose height has this gradient (Mikkelsen 2008,
// the surface gradient). The gradient points uphill in object space; its length is the slope.
fn raised_normal(gradient: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return unit_or(normal - (gradient - normal * dot(gradient, normal)), normal);
}
