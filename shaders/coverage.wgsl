// Which triangles cover no sample of the picture, wherever rounding puts their corners. Twin: src/tessellate/coverage.rs.

struct CoverageView {
    clip_from_object: mat4x4<f32>,
    // How far clip coordinates may be off for every unit that a position is from the origin along each axis.
    slack: mat4x4<f32>,
    // Width and height in px.
    viewport: vec2<f32>,
    // 1 or 4.
    sample_count: u32,
    // 1 where what faces away isn't drawn either.
    fronts_only: u32,
    // How far a corner is moved when it is rounded to the rasteriser's grid, in px.
    snap: f32,
}

// A corner on screen.
struct ScreenCorner {
    // Px from the upper left.
    at: vec2<f32>,
    // How far from there it may be rasterised along x and along y, in px. Below 0 where it may be nearer than the near
    // plane.
    reach: f32,
}

// Samples lie in rows, one a pixel in each: how many rows a pixel has (1 or 4), and how far a row's samples are from their
// pixels' left. A row is half a row's height below its upper side. So have it Vulkan, Metal and Direct3D.
const ROW_SAMPLES: array<f32, 4> = array<f32, 4>(0.375, 0.875, 0.125, 0.625);

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

fn cross_2d(a: vec2<f32>, b: vec2<f32>) -> f32 {
    return a.x * b.y - a.y * b.x;
}

fn taxicab(a: vec2<f32>) -> f32 {
    return abs(a.x) + abs(a.y);
}

// Whether a triangle faces away, wherever its corners are within reach. Y goes down.
fn turns_away(a: vec2<f32>, b: vec2<f32>, c: vec2<f32>, reach: f32) -> bool {
    let ab = b - a;
    let ac = c - a;
    return cross_2d(ab, ac) > 2.0 * reach * (taxicab(ab) + taxicab(ac) + 4.0 * reach);
}

// Whether a triangle may cover a place within its box if its corners are within reach: twice the areas that the place spans
// with its sides have one sign then.
fn may_cover(at: vec2<f32>, a: vec2<f32>, b: vec2<f32>, c: vec2<f32>, reach: f32) -> bool {
    let to_a = a - at;
    let to_b = b - at;
    let to_c = c - at;
    let areas = vec3<f32>(cross_2d(to_a, to_b), cross_2d(to_b, to_c), cross_2d(to_c, to_a));
    let lengths = vec3<f32>(taxicab(to_a), taxicab(to_b), taxicab(to_c));
    let change = reach * (lengths + lengths.yzx + 2.0 * reach);
    return all(areas >= -change) || all(areas <= change);
}

// How far a row's samples are from their pixels' left.
fn row_sample(view: CoverageView, row: f32) -> f32 {
    if view.sample_count == 1u {
        return 0.5;
    }
    return ROW_SAMPLES[u32(row) & 3u];
}

// Whether nothing of a triangle can be seen. Triangles of more than two px either way are not looked at closely.
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
    if view.fronts_only != 0u && turns_away(a.at, b.at, c.at, reach) {
        return true;
    }
    if any(high - low > vec2<f32>(2.0)) {
        return false;
    }
    // Above the picture and left of it are no samples.
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
