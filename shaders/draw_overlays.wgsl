// The colours that overlays give a surface in place of its material's.

// A legend shows it too, in linear light. src/inspect/render/layout.rs has it in sRGB.
const WASTE_COLOR: vec3<f32> = vec3<f32>(0.665, 0.112, 0.0);

fn from_srgb(color: vec3<f32>) -> vec3<f32> {
    return select(pow((color + 0.055) / 1.055, vec3<f32>(2.4)), color / 12.92, color <= vec3<f32>(0.04045));
}

// As in src/inspect/render/scale.rs, in linear light.
fn scale_color(number: f32) -> vec3<f32> {
    var place = (number - frame.scale_least) / (frame.scale_most - frame.scale_least);
    if frame.scale_least > 0.0 {
        place = log(number / frame.scale_least) / log(frame.scale_most / frame.scale_least);
    }
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
    let width = min(0.14 * edge_heights[nearest], max(5.0 / frame.coarseness, 0.05 * edge_heights[nearest]));
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

// The colour that an overlay gives the surface in place of the material's, and 1 if there is one.
fn meaning(in: Varyings, change: Changes, to_edges: vec3<f32>, edge_heights: vec3<f32>) -> vec4<f32> {
    if LOOK == LOOK_CURVATURE {
        let place = patch_place(in.domain.xy);
        let net = load_net(in.patch_index);
        return vec4<f32>(scale_color(patch_curvature(frame.kind, params.surface, net, place.x, place.y)), 1.0);
    }
    if LOOK == LOOK_TEXEL_DENSITY {
        let in_px = spanned_area(change.uv_right, change.uv_below);
        let density = texel_density(textureDimensions(base_texture), select(in.size, in_px, frame.kind != 0u));
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
    return frame.zebra_stripes * reflected_place(frame.clip_from_object, frame.zebra_axis, normalize(normal), to_eye);
}

// The unit normal of the patch itself, without displacement, or the shading normal where it has none.
fn geometric_normal(in: Varyings, shading_normal: vec3<f32>) -> vec3<f32> {
    let place = patch_place(in.domain.xy);
    return surface_normal(params.surface, load_net(in.patch_index), place.x, place.y, shading_normal);
}

fn normal_color(normal: vec3<f32>) -> vec3<f32> {
    return from_srgb(0.5 + 0.5 * normal);
}

// The colour of a surface that isn't lit, and 1 if there is one.
fn unlit(in: Varyings, normal: vec3<f32>, change: Changes) -> vec4<f32> {
    if (frame.overlays & OVERLAY_ZEBRA) != 0u {
        let px = unmoved(in.clip, frame.shift).xy;
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
        return vec4<f32>(checker_color(frame.checker_squares, in.uv, sqrt(right * right + below * below)), 1.0);
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
