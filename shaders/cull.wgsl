// Which patches emit nothing. Twin: src/tessellate/cull.rs.

const CLIP_OFF: u32 = 0u;
const CLIP_PAPER: u32 = 1u;
const CLIP_FRUSTUM: u32 = 2u;

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

// Bits: left, right, below, above, beyond far, nearer than near. Linear also behind the eye.
fn planes_outside(clip: vec4<f32>) -> u32 {
    return u32(clip.x < -clip.w)
        | u32(clip.x > clip.w) << 1u
        | u32(clip.y < -clip.w) << 2u
        | u32(clip.y > clip.w) << 3u
        | u32(clip.z < 0.0) << 4u
        | u32(clip.z > clip.w) << 5u;
}

fn patch_is_outside(view: LodView, net: ControlNet) -> bool {
    let m = view.clip_from_object;
    var shared_planes = planes_outside(m * vec4<f32>(net.center, 1.0));
    for (var i = 0u; i < 3u; i++) {
        shared_planes &= planes_outside(m * vec4<f32>(net.corners[i], 1.0));
    }
    for (var i = 0u; i < 6u; i++) {
        shared_planes &= planes_outside(m * vec4<f32>(net.edges[i], 1.0));
    }
    return shared_planes != 0u;
}

fn patch_is_unseen(clip: u32, view: LodView, net: ControlNet) -> bool {
    if clip == CLIP_PAPER {
        return patch_is_clipped(view, net);
    }
    return clip == CLIP_FRUSTUM && patch_is_outside(view, net);
}
