// Which patches emit nothing. Twin: src/tessellate/cull.rs.

const CLIP_OFF: u32 = 0u;
const CLIP_PAPER: u32 = 1u;

// IsClipped of the PN-AEN white paper: outside -w <= x, y, z <= w.
fn is_clipped(clip: vec4<f32>) -> bool {
    let inside = all(abs(clip.xyz) <= clip.www);
    return !inside;
}

fn outside_view(view: LodView, position: vec3<f32>) -> bool {
    return is_clipped(view.clip_from_object * vec4<f32>(position, 1.0));
}

fn patch_is_clipped(view: LodView, net: ControlNet) -> bool {
    var clipped = outside_view(view, net.center);
    for (var i = 0u; i < 3u; i++) {
        clipped = clipped && outside_view(view, net.corners[i]);
    }
    for (var i = 0u; i < 6u; i++) {
        clipped = clipped && outside_view(view, net.edges[i]);
    }
    return clipped;
}
