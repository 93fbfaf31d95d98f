// Draws the ground: lines at multiples of a round number of object units, in a plane under the mesh.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> frame: Frame;

// How far the ground reaches from its middle, in cells, and where it begins to fade, as a part of that.
const GROUND_REACH: f32 = 25.0;
const GROUND_FADES_FROM: f32 = 0.3;

const GROUND_COLOR: vec3<f32> = vec3<f32>(0.23, 0.24, 0.26);
const GROUND_OPACITY: f32 = 0.75;
// Of the axes x, y and z, in linear light. src/inspect/render/layout.rs has them in sRGB.
const X_AXIS_COLOR: vec3<f32> = vec3<f32>(0.807, 0.084, 0.107);
const Z_AXIS_COLOR: vec3<f32> = vec3<f32>(0.089, 0.262, 0.871);

struct GroundVaryings {
    @builtin(position) clip: vec4<f32>,
    // Along x and z from the ground's middle, in cells.
    @location(0) cells: vec2<f32>,
}

@vertex
fn ground_vertex(@builtin(vertex_index) index: u32) -> GroundVaryings {
    // Two triangles: corners 0 1 2 and 3 2 1.
    let corner = select(index, 6u - index, index >= 3u);
    let cells = GROUND_REACH * (vec2<f32>(f32(corner & 1u), f32(corner >> 1u)) * 2.0 - 1.0);
    let place = frame.ground.xyz + frame.ground.w * vec3<f32>(cells.x, 0.0, cells.y);
    return GroundVaryings(frame.clip_from_object * vec4<f32>(place, 1.0), cells);
}

@fragment
fn ground_fragment(in: GroundVaryings) -> @location(0) vec4<f32> {
    let dx = dpdx(in.cells);
    let dy = dpdy(in.cells);
    // Px between neighbouring lines of either direction.
    let apart = 1.0 / max(sqrt(dx * dx + dy * dy), vec2<f32>(1e-12));
    let to_line = abs(fract(in.cells + 0.5) - 0.5) * apart;
    let near = 1.0 - smoothstep(GROUND_FADES_FROM * GROUND_REACH, GROUND_REACH, length(in.cells));
    let along_z = left_by_density(apart.x) * line_coverage(to_line.x, 0.5 / frame.coarseness);
    let along_x = left_by_density(apart.y) * line_coverage(to_line.y, 0.5 / frame.coarseness);
    // The lines under the axes have the axes' colours, and don't fade by density, as each is alone.
    let to_axis = abs(in.cells + frame.ground.xz / frame.ground.w) * apart;
    let under_x = line_coverage(to_axis.y, 0.9 / frame.coarseness);
    let under_z = line_coverage(to_axis.x, 0.9 / frame.coarseness);
    var color = mix(GROUND_COLOR, Z_AXIS_COLOR, under_z);
    color = mix(color, X_AXIS_COLOR, under_x);
    let opacity = max(GROUND_OPACITY * max(along_x, along_z), max(under_x, under_z));
    return vec4<f32>(color, near * opacity);
}
