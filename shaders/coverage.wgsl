// A conservative test for triangles that cover no sample of the picture, however the rasteriser rounds their corners.
// Twin: src/geometry/tessellate/coverage.rs.

// The picture that triangles are drawn into.
struct CoverageView {
    clip_from_object: mat4x4<f32>,
    // The rounding error of clip coordinates for each unit of a position's distance from the origin along each axis.
    slack: mat4x4<f32>,
    // Width and height in px.
    viewport: vec2<f32>,
    // Samples per pixel: 1 or 4.
    sample_count: u32,
    // 1 if back faces are not drawn, else 0.
    fronts_only: u32,
    // The largest distance in px by which the rasteriser moves a corner when it rounds it to its subpixel grid.
    snap: f32,
}

// A triangle's corner on screen.
struct ScreenCorner {
    // The position in px from the picture's upper left corner.
    at: vec2<f32>,
    // The largest distance in px between `at` and the rasterised corner, along x and along y. Negative if the corner
    // may be nearer than the near plane.
    reach: f32,
}

// The x coordinates of samples within their pixel, in px. A pixel has as many rows of samples as samples (1 or 4), with
// one sample in each row, half a row's height below the row's upper edge. These are the standard positions of Vulkan,
// Metal and Direct3D.
const ROW_SAMPLES: array<f32, 4> = array<f32, 4>(0.375, 0.875, 0.125, 0.625);

// Projects a position in object units to the screen, and bounds the error of the projection.
fn screen_corner(view: CoverageView, position: vec3<f32>) -> ScreenCorner {
    let clip = view.clip_from_object * vec4<f32>(position, 1.0);
    let off = view.slack * vec4<f32>(abs(position), 1.0);
    let least_w = clip.w - off.w;
    if !(least_w > 0.0 && clip.z + off.z <= least_w) {
        return ScreenCorner(vec2<f32>(0.0), -1.0);
    }
    let place = clip.xy / clip.w;
    let half_size = 0.5 * view.viewport;
    let reach = (off.xy + (abs(place) + 1.0) * off.w) / least_w * half_size;
    return ScreenCorner(half_size + place * vec2<f32>(half_size.x, -half_size.y), view.snap + max(reach.x, reach.y));
}

// Returns the z coordinate of the cross product.
fn cross_2d(a: vec2<f32>, b: vec2<f32>) -> f32 {
    return a.x * b.y - a.y * b.x;
}

// Returns the Manhattan length.
fn manhattan_length(a: vec2<f32>) -> f32 {
    return abs(a.x) + abs(a.y);
}

// Returns whether a triangle is a back face wherever its corners are within `reach` px of `a`, `b` and `c`. Y points
// down.
fn is_back_face(a: vec2<f32>, b: vec2<f32>, c: vec2<f32>, reach: f32) -> bool {
    let ab = b - a;
    let ac = c - a;
    return cross_2d(ab, ac) > 2.0 * reach * (manhattan_length(ab) + manhattan_length(ac) + 4.0 * reach);
}

// Returns whether a triangle whose corners are within `reach` px of `a`, `b` and `c` may cover the place `at`.
fn may_cover(at: vec2<f32>, a: vec2<f32>, b: vec2<f32>, c: vec2<f32>, reach: f32) -> bool {
    let to_a = a - at;
    let to_b = b - at;
    let to_c = c - at;
    let areas = vec3<f32>(cross_2d(to_a, to_b), cross_2d(to_b, to_c), cross_2d(to_c, to_a));
    let lengths = vec3<f32>(manhattan_length(to_a), manhattan_length(to_b), manhattan_length(to_c));
    let change = reach * (lengths + lengths.yzx + 2.0 * reach);
    return all(areas >= -change) || all(areas <= change);
}

// Returns the x coordinate within their pixel of the samples in row `row`, in px.
fn row_sample(view: CoverageView, row: f32) -> f32 {
    if view.sample_count == 1u {
        return 0.5;
    }
    return ROW_SAMPLES[u32(row) & 3u];
}

// Returns whether no part of a triangle can be seen. Of triangles larger than 2 px in x or y it only tests whether they
// lie outside the picture or are back faces.
fn covers_nothing(view: CoverageView, a: ScreenCorner, b: ScreenCorner, c: ScreenCorner) -> bool {
    if min(min(a.reach, b.reach), c.reach) < 0.0 {
        return false;
    }
    let reach = max(max(a.reach, b.reach), c.reach);
    let low = min(min(a.at, b.at), c.at) - reach;
    let high = max(max(a.at, b.at), c.at) + reach;
    if any(high < vec2<f32>(0.0)) || any(low > view.viewport) {
        return true;
    }
    if view.fronts_only != 0u && is_back_face(a.at, b.at, c.at, reach) {
        return true;
    }
    if any(high - low > vec2<f32>(2.0)) {
        return false;
    }
    // Rows above the picture have no samples.
    let rows = f32(view.sample_count);
    let last = high.y * rows - 0.5;
    for (var row = ceil(max(low.y, 0.0) * rows - 0.5); row <= last; row += 1.0) {
        let sample = row_sample(view, row);
        for (var x = ceil(low.x - sample) + sample; x <= high.x; x += 1.0) {
            if may_cover(vec2<f32>(x, (row + 0.5) / rows), a.at, b.at, c.at, reach) {
                return false;
            }
        }
    }
    return true;
}
