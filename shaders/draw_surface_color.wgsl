// The colour of a surface with overlays: its own or that of an overlay, with marks and lines over it.

// Colours that legends show too, in linear light. src/inspect/render/layout.rs has them in sRGB.
const FOLD_COLOR: vec3<f32> = vec3<f32>(0.515, 0.061, 1.0);
const BACK_FACE_COLOR: vec3<f32> = vec3<f32>(0.753, 0.013, 0.156);
const SECTION_COLOR: vec3<f32> = vec3<f32>(0.434, 0.305, 0.188);
const SMOOTH_EDGE_COLOR: vec3<f32> = vec3<f32>(0.40, 0.43, 0.47);
const SPLIT_EDGE_COLOR: vec3<f32> = vec3<f32>(0.791, 0.347, 0.0);
const SEAM_EDGE_COLOR: vec3<f32> = vec3<f32>(0.0, 0.342, 0.171);
const BOUNDARY_EDGE_COLOR: vec3<f32> = vec3<f32>(0.093, 0.456, 0.815);
const NON_MANIFOLD_EDGE_COLOR: vec3<f32> = vec3<f32>(0.604, 0.191, 0.386);

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
    let to_eye = toward_eye(frame.clip_from_object, frame.viewport, unmoved(in.clip, frame.shift).xy);
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
    if !front && (frame.overlays & OVERLAY_SECTION) != 0u {
        // Unlit, so that the inside of a closed mesh looks like a plane in the cut.
        return vec4<f32>(SECTION_COLOR, 1.0);
    }
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

const WIRE_COLOR: vec4<f32> = vec4<f32>(0.008, 0.010, 0.014, 1.0);

struct SurfaceColor {
    // The colour of the surface with lines over it, and how much of the place marks and lines cover.
    color: vec4<f32>,
    // How opaque the wireframe is in a picture that is compared: there it is drawn over the difference, and the picture keeps it
    // as what it lacks of alpha 1.
    wire: f32,
}

fn surface_color(in: Varyings, own_normal: vec3<f32>, front: bool, lit: vec4<f32>) -> SurfaceColor {
    // Derivatives first: they need uniform control flow.
    let edge_heights = heights(in.domain);
    let to_edges = in.domain * edge_heights;
    let side_heights = heights(in.corner);
    let to_sides = in.corner * side_heights;
    var color = bare_color(in, own_normal, front, lit, to_edges, edge_heights);
    var wire = 0.0;
    if (frame.overlays & OVERLAY_WIREFRAME) != 0u {
        let opacity = 0.75 * sides_opacity(to_sides, side_heights, 0.5 / frame.coarseness);
        wire = select(0.0, opacity, (frame.overlays & OVERLAY_COMPARED) != 0u);
        color = mix(color, WIRE_COLOR, opacity - wire);
    }
    if (frame.overlays & OVERLAY_PATCHES) != 0u {
        let opacity = sides_opacity(to_edges, edge_heights, 0.9 / frame.coarseness);
        color = mix(color, vec4<f32>(0.93, 0.94, 0.96, 1.0), opacity);
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
        let covered = opacity * line_coverage(nearest_edge, select(1.75, 0.75, is_smooth) / frame.coarseness);
        color = mix(color, vec4<f32>(edge_color(kind), 1.0), covered);
    }
    return SurfaceColor(color, wire);
}

// The same where nothing behind is seen.
fn opaque_surface_color(in: Varyings, own_normal: vec3<f32>, front: bool, lit: vec4<f32>) -> vec4<f32> {
    let own = surface_color(in, own_normal, front, lit);
    return vec4<f32>(own.color.rgb, 1.0 - own.wire);
}
