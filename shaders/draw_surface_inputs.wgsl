// What the shaders of surfaces with overlays read, and what vertex shaders hand to pixel shaders.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(4) var<storage, read> vertex_halves: array<vec4<u32>>;
@group(0) @binding(5) var<storage, read> indices: array<u32>;
@group(2) @binding(0) var<uniform> slab: Slab;
@group(2) @binding(1) var<storage, read> patch_factors: array<PatchFactors>;

// How far triangles are from the true surface, from src/inspect/measure/deviation_field.rs: the number of steps that each edge is
// divided into, then the samples of one triangle after another. A sample below 0 is unknown.
@group(3) @binding(0) var<storage, read> deviations: array<f32>;
// The own least of every patch of the mesh: see pass_least.wgsl. One element if it isn't known.
@group(3) @binding(1) var<storage, read> least_triangles: array<u32>;

// One of LOOK_*, or 0. The code of other looks is left out when the pipeline is made.
override LOOK: u32 = 0u;

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
    // Factors of the edges where u, v and w is 0, and inside.
    @location(7) @interpolate(flat) factors: vec4<f32>,
    // 1 if they are all below 2.
    @location(8) @interpolate(flat) low: u32,
    // Size of the drawn triangle in px; or under texel density, the area of texture coordinates on a square object unit of it.
    @location(9) @interpolate(flat) size: f32,
    // Number of the emitted triangle in its chunk.
    @location(10) @interpolate(flat) triangle: u32,
    // How many times as many triangles the patch has as its own least.
    @location(11) @interpolate(flat) excess: f32,
}
