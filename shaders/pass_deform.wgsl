// Deforms the mesh into a pose: every corner's normal and tangent, then every point's position, all from the mesh at rest. A point is
// computed once, from the first of its corners, so that it stays one point in every pose.

@group(0) @binding(0) var<storage, read> bindings: array<Binding>;
@group(0) @binding(1) var<storage, read> deltas: array<Delta>;
@group(0) @binding(2) var<storage, read> palette: array<JointMatrix>;
@group(0) @binding(3) var<storage, read> morph_weights: array<f32>;
@group(0) @binding(4) var<storage, read> point_corners: array<u32>;
@group(0) @binding(5) var<storage, read_write> corners: array<Corner>;
// Points, then the control point at every patch's centre.
@group(0) @binding(6) var<storage, read_write> points: array<vec4<f32>>;

// Each corner's tangent at rest, and the sign of its bitangent. Behind them are displacements of tangents by morph targets. A mesh
// without tangents has one element, of zeros.
@group(0) @binding(7) var<storage, read> tangents: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> corner_details: array<CornerDetail>;

// Morph targets come first, then joints (glTF 2.0, section 3.7.2.2).
fn posed_position(corner: u32) -> vec3<f32> {
    let bound = bindings[corner];
    var position = bound.position;
    for (var i = 0u; i < bound.delta_count; i++) {
        let delta = deltas[bound.first_delta + i];
        position += delta.position * morph_weights[delta.weight];
    }
    return deform_position(posed_matrix(bound), position);
}

// The unit normal of a corner that morph targets have turned.
fn morphed_normal(bound: Binding) -> vec3<f32> {
    var normal = bound.normal;
    for (var i = 0u; i < bound.delta_count; i++) {
        let delta = deltas[bound.first_delta + i];
        normal += delta.normal * morph_weights[delta.weight];
    }
    return unit_or(normal, bound.normal);
}

// The unit tangent of a corner that morph targets have displaced.
fn displaced_tangent(bound: Binding, own: vec3<f32>) -> vec3<f32> {
    var tangent = own;
    for (var i = 0u; i < bound.delta_count; i++) {
        let delta = deltas[bound.first_delta + i];
        tangent += tangents[delta.tangent].xyz * morph_weights[delta.weight];
    }
    return scaled_unit_or(tangent, own);
}

// Morph targets that don't displace tangents turn a corner's tangent along with its normal.
fn posed_tangent(corner: u32, normal: vec3<f32>) -> vec4<f32> {
    let bound = bindings[corner];
    let own = tangents[corner];
    var tangent = own.xyz;
    if bound.delta_count > 0u {
        if deltas[bound.first_delta].tangent > 0u {
            tangent = displaced_tangent(bound, own.xyz);
        } else {
            tangent = turn_along(own.xyz, unit_or(bound.normal, bound.normal), normal);
        }
    }
    return deform_tangent(posed_matrix(bound), vec4<f32>(tangent, own.w));
}

fn posed_matrix(bound: Binding) -> JointMatrix {
    let j = bound.joints;
    return blend(palette[j.x], palette[j.y], palette[j.z], palette[j.w], bound.weights);
}

@compute @workgroup_size(256)
fn deform_corners_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index < arrayLength(&bindings) {
        let bound = bindings[index];
        let normal = morphed_normal(bound);
        corners[index].normal = deform_normal(posed_matrix(bound), normal);
        if index < arrayLength(&tangents) {
            corner_details[index].tangent = posed_tangent(index, normal);
        }
    }
}

@compute @workgroup_size(256)
fn deform_points_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index < arrayLength(&point_corners) {
        points[index] = vec4<f32>(posed_position(point_corners[index]), 0.0);
    }
}
