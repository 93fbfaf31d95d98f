// Draws the surface with overlays: the emitted triangles, or the input triangles. Emitted triangles are drawn indexed; or,
// where an overlay looks at whole triangles, without an index buffer, so that the shader fetches each corner itself and
// knows the barycentric coordinates.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(4) var<storage, read> vertex_halves: array<vec4<u32>>;
@group(0) @binding(5) var<storage, read> indices: array<u32>;
// Only for emitted triangles.
@group(2) @binding(0) var<uniform> slab: Slab;
@group(2) @binding(1) var<storage, read> patch_factors: array<PatchFactors>;

// How far triangles are from the true surface, from src/measure/field.rs: the number of steps that each edge is divided
// into, then the samples of one triangle after another. A sample below 0 is unknown.
@group(3) @binding(0) var<storage, read> deviations: array<f32>;
// The own least of every patch of the mesh: see pass_least.wgsl. One element if it isn't known.
@group(3) @binding(1) var<storage, read> least_triangles: array<u32>;

// One of LOOK_*, or 0. The code of other looks is left out when the pipeline is made.
override LOOK: u32 = 0u;
// Whether the input triangles are drawn, whose surface is flat.
override DRAWS_SOURCE: bool = false;

struct Varyings {
    // Invariant, since draws of one layer must agree on depths.
    @builtin(position) @invariant clip: vec4<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Domain coordinates in the patch.
    @location(3) domain: vec3<f32>,
    // Barycentric coordinates in the drawn triangle; all 1 where they are not known.
    @location(4) corner: vec3<f32>,
    @location(5) @interpolate(flat) patch_index: u32,
    // 1 if the drawn triangle faces away from where its patch faces.
    @location(6) @interpolate(flat) folded: u32,
    // Factors of the edges where u, v and w is 0, and inside; 0 for input triangles.
    @location(7) @interpolate(flat) factors: vec4<f32>,
    // 1 if they are all below 2.
    @location(8) @interpolate(flat) low: u32,
    // Size of the drawn triangle in px.
    @location(9) @interpolate(flat) size: f32,
    // Number of the emitted triangle in its chunk, or of the input triangle.
    @location(10) @interpolate(flat) triangle: u32,
    // How many times as many triangles the patch has as its own least; 0 for input triangles.
    @location(11) @interpolate(flat) excess: f32,
}

fn varyings(
    position: vec3<f32>,
    normal: vec3<f32>,
    uv: vec2<f32>,
    patch_index: u32,
    domain: vec2<u32>,
    corner: vec3<f32>,
) -> Varyings {
    var out: Varyings;
    out.clip = frame.clip_from_object * vec4<f32>(position, 1.0);
    out.normal = normal;
    out.uv = uv;
    out.domain = vec3<f32>(f32(domain.x), f32(domain.y), f32(FIXED_ONE - domain.x - domain.y)) * UNIT;
    out.corner = corner;
    out.patch_index = patch_index;
    return out;
}

fn facing(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> vec3<f32> {
    return cross(b - a, c - a);
}

// As in src/measure/folds.rs, in f32.
fn is_folded(patch_index: u32, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> bool {
    let at = patches[patch_index].points;
    let patch_facing = facing(points[at[0]].xyz, points[at[1]].xyz, points[at[2]].xyz);
    let own = facing(a, b, c);
    let longest = max(max(distance(a, b), distance(b, c)), distance(c, a));
    return dot(own, patch_facing) < 0.0 && length(own) > 8.0 * frame.ulp * longest;
}

// Whether the triangle is already turned over in the patch's domain, so that the surface is not what turns it over.
fn runs_back(a: vec2<u32>, b: vec2<u32>, c: vec2<u32>) -> bool {
    let ab = vec2<f32>(vec2<i32>(b) - vec2<i32>(a));
    let ac = vec2<f32>(vec2<i32>(c) - vec2<i32>(a));
    return ab.x * ac.y - ab.y * ac.x <= 0.0;
}

fn drawn_vertex(index: u32) -> Vertex {
    let at = indices[index];
    return vertex_of(vertex_halves[at], vertex_halves[arrayLength(&vertex_halves) / 2u + at]);
}

fn vertex_position(index: u32) -> vec3<f32> {
    return bitcast<vec3<f32>>(vertex_halves[indices[index]].xyz);
}

fn vertex_domain(index: u32) -> vec2<u32> {
    let vertex = drawn_vertex(index);
    return key_uv(vec2<u32>(vertex.key0, vertex.key1));
}

fn factor_value(word: u32) -> f32 {
    return f32(word & FACTOR_VALUE) * UNIT;
}

fn with_factors(varyings: Varyings, patch_index: u32) -> Varyings {
    var out = varyings;
    if (frame.overlays & (OVERLAY_FACTORS | OVERLAY_LOW_FACTORS)) != 0u {
        let own = patch_factors[patch_index - slab.first_patch];
        for (var i = 0u; i < 3u; i++) {
            // Opposite side s is corner s + 2.
            out.factors[(domain_side(frame.convention, i) + 2u) % 3u] = factor_value(own.outside[i]);
        }
        out.factors.w = factor_value(own.inside);
        out.low = u32(patch_is_low(own));
    }
    if (frame.overlays & OVERLAY_EXCESS) != 0u && patch_index < arrayLength(&least_triangles) {
        let count = triangle_count(patch_factors[patch_index - slab.first_patch]);
        out.excess = f32(count) / f32(max(least_triangles[patch_index], 1u));
    }
    return out;
}

// As in src/measure/sizes.rs, in f32. The largest size if the triangle crosses the near plane.
fn size_px(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> f32 {
    let corners = array<vec3<f32>, 3>(a, b, c);
    var places: array<vec2<f32>, 3>;
    for (var k = 0u; k < 3u; k++) {
        let clip = frame.clip_from_object * vec4<f32>(corners[k], 1.0);
        if clip.w <= 0.0 || clip.z > clip.w {
            return frame.scale_most;
        }
        places[k] = clip.xy / clip.w * 0.5 * frame.viewport;
    }
    let ab = places[1] - places[0];
    let ac = places[2] - places[0];
    return sqrt(abs(ab.x * ac.y - ab.y * ac.x));
}

fn unit_corner(k: u32) -> vec3<f32> {
    return vec3<f32>(f32(k == 0u), f32(k == 1u), f32(k == 2u));
}

@vertex
fn indexed_vertex(
    @location(0) position: vec3<f32>,
    @location(1) normal: u32,
    @location(2) key: vec2<u32>,
    @location(3) uv: vec2<f32>,
) -> Varyings {
    let out = varyings(position, unpack_normal(normal), uv, key_patch(key), key_uv(key), vec3<f32>(1.0));
    return with_factors(out, key_patch(key));
}

@vertex
fn pulled_vertex(@builtin(vertex_index) index: u32) -> Varyings {
    let vertex = drawn_vertex(index);
    let key = vec2<u32>(vertex.key0, vertex.key1);
    let position = vec3<f32>(vertex.x, vertex.y, vertex.z);
    let normal = unpack_normal(vertex.normal);
    var out = varyings(position, normal, vertex.uv, key_patch(key), key_uv(key), unit_corner(index % 3u));
    let first = index - index % 3u;
    out.triangle = index / 3u;
    if (frame.overlays & OVERLAY_FOLDS) != 0u {
        let back = runs_back(vertex_domain(first), vertex_domain(first + 1u), vertex_domain(first + 2u));
        let a = vertex_position(first);
        let opposes = is_folded(key_patch(key), a, vertex_position(first + 1u), vertex_position(first + 2u));
        out.folded = u32(opposes && !back);
    }
    if (frame.overlays & OVERLAY_TRIANGLE_SIZE) != 0u {
        out.size = size_px(vertex_position(first), vertex_position(first + 1u), vertex_position(first + 2u));
    }
    return with_factors(out, key_patch(key));
}

@vertex
fn source_vertex(@builtin(vertex_index) index: u32) -> Varyings {
    let k = index % 3u;
    let corner = corners[patches[index / 3u].corners[k]];
    let position = points[patches[index / 3u].points[k]].xyz;
    let domain = vec2<u32>(select(0u, FIXED_ONE, k == 0u), select(0u, FIXED_ONE, k == 1u));
    var out = varyings(position, corner.normal, corner.uv, index / 3u, domain, unit_corner(k));
    out.triangle = index / 3u;
    if (frame.overlays & OVERLAY_TRIANGLE_SIZE) != 0u {
        let at = patches[index / 3u].points;
        out.size = size_px(points[at[0]].xyz, points[at[1]].xyz, points[at[2]].xyz);
    }
    return out;
}

// Colours that legends show too, in linear light. src/render/layout.rs has them in sRGB.
const FOLD_COLOR: vec3<f32> = vec3<f32>(0.515, 0.061, 1.0);
const BACK_FACE_COLOR: vec3<f32> = vec3<f32>(0.753, 0.013, 0.156);
const WASTE_COLOR: vec3<f32> = vec3<f32>(0.665, 0.112, 0.0);
const SMOOTH_EDGE_COLOR: vec3<f32> = vec3<f32>(0.40, 0.43, 0.47);
const SPLIT_EDGE_COLOR: vec3<f32> = vec3<f32>(0.791, 0.347, 0.0);
const SEAM_EDGE_COLOR: vec3<f32> = vec3<f32>(0.0, 0.342, 0.171);
const BOUNDARY_EDGE_COLOR: vec3<f32> = vec3<f32>(0.093, 0.456, 0.815);
const NON_MANIFOLD_EDGE_COLOR: vec3<f32> = vec3<f32>(0.604, 0.191, 0.386);

// Kinds of edges, as a patch's factors have them.
const EDGE_SMOOTH: u32 = 0u;
const EDGE_SPLIT: u32 = 1u;
const EDGE_SEAM: u32 = 2u;
const EDGE_BOUNDARY: u32 = 3u;
const EDGE_NON_MANIFOLD: u32 = 4u;

fn edge_color(kind: u32) -> vec3<f32> {
    var color = SMOOTH_EDGE_COLOR;
    if kind == EDGE_SPLIT {
        color = SPLIT_EDGE_COLOR;
    } else if kind == EDGE_SEAM {
        color = SEAM_EDGE_COLOR;
    } else if kind == EDGE_BOUNDARY {
        color = BOUNDARY_EDGE_COLOR;
    } else if kind == EDGE_NON_MANIFOLD {
        color = NON_MANIFOLD_EDGE_COLOR;
    }
    return color;
}

// The distance in px over which each barycentric coordinate changes by 1: the triangle's heights.
fn heights(coordinates: vec3<f32>) -> vec3<f32> {
    let dx = dpdx(coordinates);
    let dy = dpdy(coordinates);
    return 1.0 / max(sqrt(dx * dx + dy * dy), vec3<f32>(1e-12));
}

fn least(numbers: vec3<f32>) -> f32 {
    return min(min(numbers.x, numbers.y), numbers.z);
}

// How opaque the sides of a triangle are at a pixel, which are `to_sides` px away. All fade together where the triangle is thin,
// since of a thin triangle only one side would be left.
fn sides_opacity(to_sides: vec3<f32>, side_heights: vec3<f32>, half_width: f32) -> f32 {
    return left_by_density(least(side_heights)) * line_coverage(least(to_sides), half_width);
}

// Lit very little, so that colours can be compared with a legend: unchanged where the surface faces the eye.
fn shade_flat(base: vec3<f32>, normal: vec3<f32>, to_eye: vec3<f32>) -> vec3<f32> {
    return base * (0.7 + 0.3 * abs(dot(normal, to_eye)));
}

fn from_srgb(color: vec3<f32>) -> vec3<f32> {
    return select(pow((color + 0.055) / 1.055, vec3<f32>(2.4)), color / 12.92, color <= vec3<f32>(0.04045));
}

// As in src/render/scale.rs, in linear light.
fn scale_color(number: f32) -> vec3<f32> {
    return color_at_place(log(number / frame.scale_least) / log(frame.scale_most / frame.scale_least));
}

// The same on an even scale.
fn even_scale_color(number: f32) -> vec3<f32> {
    return color_at_place((number - frame.scale_least) / (frame.scale_most - frame.scale_least));
}

fn color_at_place(place: f32) -> vec3<f32> {
    let at = clamp(place, 0.0, 1.0) * f32(SCALE_STOPS - 1u);
    let below = min(u32(at), SCALE_STOPS - 2u);
    return from_srgb(mix(frame.scale[below].rgb, frame.scale[below + 1u].rgb, at - f32(below)));
}

// The inside of a patch in the colour of its inside factor, and a band along each edge in the colour of that edge's factor.
// Bands are about 5 px wide, wider in large patches and narrower in small ones, which bands would otherwise fill.
fn factor_color(factors: vec4<f32>, to_edges: vec3<f32>, edge_heights: vec3<f32>) -> vec3<f32> {
    var nearest = 0u;
    for (var k = 1u; k < 3u; k++) {
        nearest = select(nearest, k, to_edges[k] < to_edges[nearest]);
    }
    let width = min(0.14 * edge_heights[nearest], max(5.0, 0.05 * edge_heights[nearest]));
    let on_edge = line_coverage(to_edges[nearest], width);
    return mix(scale_color(factors.w), scale_color(factors[nearest]), on_edge);
}

// The deviation at a place of a triangle, linear between the samples around it. Below 0 if it is unknown.
fn deviation_at(triangle: u32, corner: vec3<f32>) -> f32 {
    let steps = u32(deviations[0]);
    let count = (steps + 1u) * (steps + 2u) / 2u;
    let first = 1u + triangle * count;
    if first + count > arrayLength(&deviations) {
        return -1.0;
    }
    if steps == 0u {
        return deviations[first];
    }
    // At a triangle's border the middle of a pixel may lie outside the triangle.
    let inside = max(corner, vec3<f32>(0.0));
    let at = inside.yz / (inside.x + inside.y + inside.z) * f32(steps);
    let i = min(u32(at.x), steps - 1u);
    let j = min(u32(at.y), steps - 1u - i);
    let rest = min(at - vec2<f32>(f32(i), f32(j)), vec2<f32>(1.0));
    // Row i has steps + 1 - i samples.
    let here = first + i * (steps + 1u) - i * (i - min(i, 1u)) / 2u + j;
    let next = here + steps + 1u - i;
    let along = deviations[here + 1u];
    let across = deviations[next];
    if rest.x + rest.y <= 1.0 || i + j + 2u > steps {
        return deviations[here] + rest.x * (across - deviations[here]) + rest.y * (along - deviations[here]);
    }
    let beyond = deviations[next + 1u];
    return beyond + (1.0 - rest.x) * (along - beyond) + (1.0 - rest.y) * (across - beyond);
}

fn deviation_color(in: Varyings) -> vec4<f32> {
    let distance = deviation_at(in.triangle, in.corner);
    // The position of a fragment has 1 / w as its fourth component.
    let number = select(distance, distance * frame.px_per_unit * in.clip.w, frame.px_per_unit > 0.0);
    return vec4<f32>(scale_color(max(number, frame.scale_least)), f32(distance >= 0.0));
}

// The surface that patches are drawn as.
fn drawn_surface() -> u32 {
    return select(params.surface, SURFACE_FLAT, DRAWS_SOURCE);
}

// The mean curvature of the patch itself, without displacement, in 1 / object unit.
fn curvature_at(in: Varyings) -> f32 {
    let place = patch_place(in.domain.xy);
    let surface = drawn_surface();
    let net = load_net(in.patch_index);
    let second = patch_second_derivatives(surface, net, place.x, place.y);
    return mean_curvature(patch_tangents(surface, net, place.x, place.y), second);
}

// The colour that an overlay gives the surface in place of the material's, and 1 if there is one.
fn meaning(in: Varyings, change: Changes, to_edges: vec3<f32>, edge_heights: vec3<f32>) -> vec4<f32> {
    if LOOK == LOOK_CURVATURE {
        return vec4<f32>(even_scale_color(curvature_at(in)), 1.0);
    }
    if LOOK == LOOK_TEXEL_DENSITY {
        let density = texel_density(textureDimensions(base_texture), change.uv_right, change.uv_below);
        return vec4<f32>(scale_color(max(density, frame.scale_least)), f32(density > 0.0));
    }
    if (frame.overlays & OVERLAY_FACTORS) != 0u && in.factors.w > 0.0 {
        return vec4<f32>(factor_color(in.factors, to_edges, edge_heights), 1.0);
    }
    if (frame.overlays & OVERLAY_TRIANGLE_SIZE) != 0u {
        return vec4<f32>(select(scale_color(in.size), WASTE_COLOR, in.size < frame.scale_least), 1.0);
    }
    if (frame.overlays & OVERLAY_EXCESS) != 0u {
        return vec4<f32>(scale_color(max(in.excess, frame.scale_least)), f32(in.excess > 0.0));
    }
    if (frame.overlays & OVERLAY_DEVIATION) != 0u {
        return deviation_color(in);
    }
    return vec4<f32>(WASTE_COLOR, f32(in.low));
}

// The last argument is the colour of the material in light from all around: none, since the lights at the camera take its place.
@fragment
fn surface_fragment(in: Varyings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return vec4<f32>(surface_color(in, in.normal, front, vec4<f32>(0.0)).rgb, 1.0);
}

@fragment
fn pixel_surface_fragment(in: Varyings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let normal = pixel_normal(in.patch_index, in.domain.xy);
    return vec4<f32>(surface_color(in, normal, front, vec4<f32>(0.0)).rgb, 1.0);
}

@fragment
fn lit_surface_fragment(in: Varyings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return lit_surface_color(in, in.normal, front);
}

@fragment
fn pixel_lit_surface_fragment(in: Varyings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return lit_surface_color(in, pixel_normal(in.patch_index, in.domain.xy), front);
}

// A pixel of a surface with a mask, and which of its samples the mask leaves.
struct MaskedSurfacePixel {
    @location(0) color: vec4<f32>,
    @builtin(sample_mask) samples: u32,
}

@fragment
fn masked_surface_fragment(in: Varyings, @builtin(front_facing) front: bool) -> MaskedSurfacePixel {
    return masked_surface_pixel(in, in.normal, front);
}

@fragment
fn pixel_masked_surface_fragment(in: Varyings, @builtin(front_facing) front: bool) -> MaskedSurfacePixel {
    return masked_surface_pixel(in, pixel_normal(in.patch_index, in.domain.xy), front);
}

fn masked_surface_pixel(in: Varyings, normal: vec3<f32>, front: bool) -> MaskedSurfacePixel {
    let place = lit_surface_place(in, normal, front);
    let own = material_color(place);
    let color = surface_color(in, normal, front, vec4<f32>(own.rgb, 1.0));
    let samples = mask_samples(place);
    if samples == 0u {
        discard;
    }
    return MaskedSurfacePixel(vec4<f32>(color.rgb, 1.0), samples);
}

// The same with the lights at the camera.
@fragment
fn cut_samples_fragment(in: Varyings, @builtin(front_facing) front: bool) -> MaskedSurfacePixel {
    return cut_samples_pixel(in, in.normal, front);
}

@fragment
fn pixel_cut_samples_fragment(in: Varyings, @builtin(front_facing) front: bool) -> MaskedSurfacePixel {
    return cut_samples_pixel(in, pixel_normal(in.patch_index, in.domain.xy), front);
}

fn cut_samples_pixel(in: Varyings, normal: vec3<f32>, front: bool) -> MaskedSurfacePixel {
    let place = lit_surface_place(in, normal, front);
    let color = surface_color(in, normal, front, vec4<f32>(0.0));
    let samples = mask_samples(place);
    if samples == 0u {
        discard;
    }
    return MaskedSurfacePixel(vec4<f32>(color.rgb, 1.0), samples);
}

@fragment
fn cut_surface_fragment(in: Varyings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return cut_surface_color(in, in.normal, front);
}

@fragment
fn pixel_cut_surface_fragment(in: Varyings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return cut_surface_color(in, pixel_normal(in.patch_index, in.domain.xy), front);
}

fn cut_surface_color(in: Varyings, normal: vec3<f32>, front: bool) -> vec4<f32> {
    let place = lit_surface_place(in, normal, front);
    let color = surface_color(in, normal, front, vec4<f32>(0.0));
    if base_color(place, place_detail(place)).a < material.cutoff {
        discard;
    }
    return vec4<f32>(color.rgb, 1.0);
}

fn lit_surface_place(in: Varyings, normal: vec3<f32>, front: bool) -> SurfacePlace {
    let to_eye = toward_eye(frame.clip_from_object, frame.viewport, in.clip.xy);
    var position: vec3<f32>;
    if LIGHT_COUNT > 0u {
        position = fragment_place(frame.clip_from_object, frame.viewport, in.clip);
    }
    return surface_place(in.uv, in.domain.xy, in.patch_index, normalize(normal), front, to_eye, position);
}

fn lit_surface_color(in: Varyings, normal: vec3<f32>, front: bool) -> vec4<f32> {
    let own = material_color(lit_surface_place(in, normal, front));
    let color = surface_color(in, normal, front, vec4<f32>(own.rgb, 1.0));
    if (HAS_MASK || HAS_TRANSMISSION) && own.a == 0.0 {
        discard;
    }
    return vec4<f32>(color.rgb, 1.0);
}

// How varyings change from a pixel to the next one on the right, and below. Only varyings have derivatives that can be relied on:
// for pixels beside a triangle, which derivatives are taken with, some drivers read no buffers.
struct Changes {
    normal_right: vec3<f32>,
    normal_below: vec3<f32>,
    uv_right: vec2<f32>,
    uv_below: vec2<f32>,
}

fn changes(in: Varyings) -> Changes {
    let normal = normalize(in.normal);
    return Changes(dpdx(normal), dpdy(normal), dpdx(in.uv), dpdy(in.uv));
}

// The place on the zebra's stripes that is seen at a place of the picture, in px.
fn zebra_place(normal: vec3<f32>, px: vec2<f32>) -> f32 {
    let to_eye = toward_eye(frame.clip_from_object, frame.viewport, px);
    return reflected_place(frame.clip_from_object, normalize(normal), to_eye);
}

// The unit normal of the patch itself, without displacement, or the shading normal where it has none.
fn geometric_normal(in: Varyings, shading_normal: vec3<f32>) -> vec3<f32> {
    let place = patch_place(in.domain.xy);
    return surface_normal(drawn_surface(), load_net(in.patch_index), place.x, place.y, shading_normal);
}

fn normal_color(normal: vec3<f32>) -> vec3<f32> {
    return from_srgb(0.5 + 0.5 * normal);
}

// The colour of a surface that isn't lit, and 1 if there is one.
fn unlit(in: Varyings, normal: vec3<f32>, change: Changes) -> vec4<f32> {
    if (frame.overlays & OVERLAY_ZEBRA) != 0u {
        let px = in.clip.xy;
        let place = zebra_place(normal, px);
        let right = zebra_place(normal + change.normal_right, px + vec2<f32>(1.0, 0.0));
        let below = zebra_place(normal + change.normal_below, px + vec2<f32>(0.0, 1.0));
        return vec4<f32>(zebra_color(place, length(vec2<f32>(right - place, below - place))), 1.0);
    }
    if (frame.overlays & OVERLAY_SHADING_NORMALS) != 0u {
        return vec4<f32>(normal_color(normal), 1.0);
    }
    if LOOK == LOOK_SURFACE_NORMALS {
        return vec4<f32>(normal_color(geometric_normal(in, normal)), 1.0);
    }
    if (frame.overlays & OVERLAY_UV_CHECKER) != 0u {
        let right = change.uv_right;
        let below = change.uv_below;
        return vec4<f32>(checker_color(in.uv, sqrt(right * right + below * below)), 1.0);
    }
    return vec4<f32>(0.0);
}

// The colour of the matcap, which is bound in place of the material's image, at a unit normal of the side that is seen.
fn matcap_color(normal: vec3<f32>, to_eye: vec3<f32>, change: Changes) -> vec3<f32> {
    let place = matcap_place(frame.clip_from_object, to_eye, normal);
    let right = matcap_place(frame.clip_from_object, to_eye, normal + change.normal_right) - place;
    let below = matcap_place(frame.clip_from_object, to_eye, normal + change.normal_below) - place;
    return textureSampleGrad(base_texture, base_sampler, place, right, below).rgb;
}

// The colour of the surface without lines over it. `lit` is the material's in light from all around, if its fourth component isn't
// 0. The fourth component of the result is 1 if an overlay marks the place in a colour of its own.
fn bare_color(
    in: Varyings,
    own_normal: vec3<f32>,
    front: bool,
    lit: vec4<f32>,
    to_edges: vec3<f32>,
    edge_heights: vec3<f32>,
) -> vec4<f32> {
    let normal = normalize(select(-own_normal, own_normal, front));
    let to_eye = toward_eye(frame.clip_from_object, frame.viewport, in.clip.xy);
    // Samples and derivatives first: both need uniform control flow.
    let texel = textureSample(base_texture, base_sampler, in.uv);
    let change = changes(in);
    var base = material.base_color.rgb * texel.rgb;
    let is_measured = (frame.overlays & (OVERLAY_LOW_FACTORS | OVERLAY_EXCESS | OVERLAY_DEVIATION)) != 0u;
    if is_measured || LOOK == LOOK_TEXEL_DENSITY {
        // Grey, since the mesh's own colours could be mistaken for the overlay's.
        base = vec3<f32>(0.5);
    }
    let marked_back = (frame.overlays & OVERLAY_BACK_FACES) != 0u && !front;
    if (frame.overlays & OVERLAY_BARYCENTRIC) != 0u {
        base = clamp(in.domain, vec3<f32>(0.0), vec3<f32>(1.0));
    }
    if marked_back {
        base = BACK_FACE_COLOR;
    }
    let meant = meaning(in, change, to_edges, edge_heights);
    let lights = Lights(frame.key_light.xyz, frame.fill_light.xyz, to_eye);
    var color = shade(lights, base, normal);
    if marked_back {
        return vec4<f32>(select(color, FOLD_COLOR, in.folded != 0u), 1.0);
    }
    if lit.a > 0.0 {
        color = lit.rgb;
    }
    if (frame.overlays & OVERLAY_CLAY) != 0u {
        color = CLAY_COLOR * brightness(lights, normal);
    }
    if (frame.overlays & OVERLAY_SILHOUETTE) != 0u {
        color = CLAY_UNDER_OUTLINES * CLAY_COLOR * brightness(lights, normal);
    }
    if meant.a > 0.0 {
        color = shade_flat(meant.rgb, normal, to_eye);
    }
    // Its normals are as they are, also seen from behind.
    let unlit_color = unlit(in, normalize(own_normal), change);
    if unlit_color.a > 0.0 {
        color = unlit_color.rgb;
    }
    if LOOK == LOOK_MATCAP {
        color = matcap_color(normal, to_eye, change);
    }
    // Unlit, since folds mostly face away from the light.
    return vec4<f32>(select(color, FOLD_COLOR, in.folded != 0u), f32(in.folded != 0u));
}

// The colour of the surface with lines over it, and how much of the place marks and lines cover.
fn surface_color(in: Varyings, own_normal: vec3<f32>, front: bool, lit: vec4<f32>) -> vec4<f32> {
    // Derivatives first: they need uniform control flow.
    let edge_heights = heights(in.domain);
    let to_edges = in.domain * edge_heights;
    let side_heights = heights(in.corner);
    let to_sides = in.corner * side_heights;
    var color = bare_color(in, own_normal, front, lit, to_edges, edge_heights);
    if (frame.overlays & OVERLAY_WIREFRAME) != 0u {
        let opacity = 0.75 * sides_opacity(to_sides, side_heights, 0.5);
        color = mix(color, vec4<f32>(0.008, 0.010, 0.014, 1.0), opacity);
    }
    if (frame.overlays & OVERLAY_PATCHES) != 0u {
        color = mix(color, vec4<f32>(0.93, 0.94, 0.96, 1.0), sides_opacity(to_edges, edge_heights, 0.9));
    }
    if (frame.overlays & OVERLAY_ADJACENCY) != 0u {
        let nearest_edge = least(to_edges);
        // The edge where u, v or w is 0 is opposite corner 0, 1 or 2, and so side 1, 2 or 0.
        var side = 0u;
        if to_edges.x <= nearest_edge {
            side = 1u;
        } else if to_edges.y <= nearest_edge {
            side = 2u;
        }
        let kind = patches[in.patch_index].factors[side] & 7u;
        // Smooth edges are the most frequent and the least interesting, so their lines are thin, and fade where they are dense.
        let is_smooth = kind == EDGE_SMOOTH;
        let opacity = select(1.0, left_by_density(least(edge_heights)), is_smooth);
        let covered = opacity * line_coverage(nearest_edge, select(1.75, 0.75, is_smooth));
        color = mix(color, vec4<f32>(edge_color(kind), 1.0), covered);
    }
    return color;
}
