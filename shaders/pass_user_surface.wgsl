// Control points that a function of the user's own computes for every side, in place of those of a surface. Every side has a curve
// of its own, so that nothing hides where two sides disagree. In the module that runs, the names of all files but
// surface_contract.wgsl begin with pnaen_ (src/gpu/user_functions.rs), so that they are none of the user's.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> params: Params;
@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> corner_attributes: array<Corner>;
@group(0) @binding(3) var<storage, read> curves: array<Curve>;
// Of each curve the corners of the side itself, then those of the side across the edge if there is exactly one.
@group(0) @binding(4) var<storage, read> curve_sides: array<vec2<u32>>;
@group(0) @binding(5) var<storage, read> patches: array<Patch>;
@group(0) @binding(6) var<storage, read_write> curve_nets: array<CurveNet>;
@group(0) @binding(9) var<storage, read_write> report: UserReport;

fn user_surface_triangle(patch_index: u32) -> SurfaceTriangle {
    let own = patches[patch_index];
    let positions = array<vec3<f32>, 3>(
        points[own.points[0]].xyz,
        points[own.points[1]].xyz,
        points[own.points[2]].xyz,
    );
    let at_corners = array<vec3<f32>, 3>(
        corner_attributes[own.corners[0]].normal,
        corner_attributes[own.corners[1]].normal,
        corner_attributes[own.corners[2]].normal,
    );
    return SurfaceTriangle(patch_index, positions, at_corners);
}

@compute @workgroup_size(1)
fn user_surface_start_main() {
    clear_report();
}

// The control points of every side. One invocation for each, so that all sides run the same code: compilers may round differently in
// copies of it.
@compute @workgroup_size(256)
fn user_surface_points_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= 3u * params.patch_count || has_stopped() {
        return;
    }
    let patch_index = index / 3u;
    let side = index % 3u;
    let next = (side + 1u) % 3u;
    let reference = patches[patch_index].curves[side];
    let runs_against = (reference & 1u) == 1u;
    let curve = curves[reference >> 1u];
    var across = curve_sides[curve.first_side + curve.side_count - 1u];
    if runs_against {
        across = across.yx;
    }
    var triangle = user_surface_triangle(patch_index);
    let edge = SurfaceEdge(
        triangle.corners[side],
        triangle.corners[next],
        triangle.normals[side],
        triangle.normals[next],
        corner_attributes[across.x].normal,
        corner_attributes[across.y].normal,
        curve.side_count > 1u,
        side,
    );
    let made = edge_points(edge, triangle);
    set_curve_net(reference >> 1u, select(made.ab, made.ba, runs_against), select(made.ba, made.ab, runs_against));
}

// What is beside them, the style of the parts there, stays.
fn set_curve_net(index: u32, ab: vec3<f32>, ba: vec3<f32>) {
    curve_nets[index].ab = ab;
    curve_nets[index].ba = ba;
}

// Whether no coordinate is infinite or NaN, whatever a compiler makes of comparisons with these.
fn has_numbers(point: vec3<f32>) -> bool {
    let exponents = bitcast<vec3<u32>>(point) & vec3<u32>(0x7f800000u);
    return all(exponents != vec3<u32>(0x7f800000u));
}

// Makes a side straight if its control points aren't numbers, and counts it. If there was too much work, makes all sides straight.
@compute @workgroup_size(256)
fn user_surface_finish_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= params.curve_count {
        return;
    }
    let is_void = has_stopped();
    if !is_void && has_numbers(curve_nets[index].ab) && has_numbers(curve_nets[index].ba) {
        return;
    }
    let a = points[curves[index].points[0]].xyz;
    let b = points[curves[index].points[1]].xyz;
    set_curve_net(index, straight_control_point(a, b), straight_control_point(b, a));
    if !is_void {
        atomicAdd(&report.not_numbers, 1u);
    }
}
