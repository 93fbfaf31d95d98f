// Patches under LOD by error as they are seen: flat ones, and displaced ones. The module declares the buffers.

// Returns whether nothing on a patch depends on where its points slide.
fn is_plain(patch_index: u32) -> bool {
    let own = patches[patch_index].corners;
    let agree = normals_agree(corners[own[0]].normal, corners[own[1]].normal, corners[own[2]].normal);
    return params.displacement == 0u && !is_textured(patch_index) && agree;
}

// Returns a patch as it is seen.
fn load_seen(patch_index: u32) -> SeenPatch {
    let net = load_net(patch_index);
    let view = magnified(params.view, detail_of(patch_index));
    var seen = seen_patch(view, net);
    if is_plain(patch_index) {
        seen.off_plane = plane_error(view, net);
        seen.off_line = line_error(view, net);
    }
    if params.displacement != 0u {
        let directions = array<vec3<f32>, 3>(
            corner_direction(patch_index, 0u),
            corner_direction(patch_index, 1u),
            corner_direction(patch_index, 2u),
        );
        // Where no image displaces a patch, its relief says so.
        let height_scale = map_scale(maps[max(map_of(patch_index), 1u) - 1u]);
        seen.relief = seen_relief(view, seen.scale, directions, height_scale, reliefs[patch_index]);
    }
    return seen;
}

// Returns the factors that a patch requests at least, of the edges U == 0, V == 0 and W == 0: `least`. Where points may slide
// along an edge, what the edge needs at the same places doesn't count.
fn first_least(seen: ptr<function, SeenPatch>, least: vec3<f32>) -> vec3<f32> {
    if may_slide(seen, params.tolerance) {
        return vec3<f32>(whole_segments(params.partitioning, 1.0));
    }
    let heights = min(heights_need(seen, params.tolerance, params.partitioning), vec4<f32>(last_factor(params.partitioning)));
    return max(least, vec3<f32>(
        whole_segments(params.partitioning, heights.y),
        whole_segments(params.partitioning, heights.z),
        whole_segments(params.partitioning, heights.x),
    ));
}
