// Structs and constants that draws share. src/inspect/render/layout.rs has the same; tests compare them.

// Colours that a scale runs through.
const SCALE_STOPS: u32 = 7u;

// What all draws of one picture read.
struct Frame {
    clip_from_object: mat4x4<f32>,
    // Unit directions in object space towards the two lights, which move with the camera.
    key_light: vec4<f32>,
    fill_light: vec4<f32>,
    // The eye's position (w = 1), or the direction towards it when the projection is orthographic (w = 0).
    eye: vec4<f32>,
    // Width and height in px.
    viewport: vec2<f32>,
    // Bits of OVERLAY_*.
    overlays: u32,
    // One unit in the last place of the mesh's largest coordinate.
    ulp: f32,
    // Which side each of a patch's factors lies on: CONVENTION_*.
    convention: u32,
    // The ends of the colour scale, if the surface's colours stand for numbers.
    scale_least: f32,
    scale_most: f32,
    // Px of an object unit where w is 1, if deviations are shown in px; else 0.
    px_per_unit: f32,
    // The middle of the ground, and how far apart its lines are, in object units.
    ground: vec4<f32>,
    // The scale's colours in sRGB, 0 to 1; the fourth component is unused.
    scale: array<vec4<f32>, SCALE_STOPS>,
    // The first column of pixels of the half that is drawn, in px.
    left: f32,
    // Px of the full picture that one px stands for, along each axis: more than 1 in coarse previews.
    coarseness: f32,
    // By how many columns all that is drawn is moved to the right.
    shift: f32,
    // The kind of the numbers that colours stand for: CURVATURE_*, or under texel density 0 for texels along an object unit and
    // 1 for those in a px.
    kind: u32,
    // The unit direction along the zebra's stripes, to the right and up in the view.
    zebra_axis: vec2<f32>,
    // Stripes over half a turn of the normal.
    zebra_stripes: f32,
    // Squares of the checker in one unit of u or v.
    checker_squares: f32,
}

// Images of a material beside that of the base colour.
const MAP_COUNT: u32 = 14u;

struct Material {
    // Linear RGBA.
    base_color: vec4<f32>,
    // Linear RGB that it emits.
    emissive: vec3<f32>,
    metallic: f32,
    // Linear RGB, with the strength below: how a dielectric reflects.
    specular_color: vec3<f32>,
    // Perceptual roughness, as that of the coat.
    roughness: f32,
    ior: f32,
    specular: f32,
    // How much of the surface a clear coat covers.
    coat: f32,
    coat_roughness: f32,
    // 0 without a normal map.
    normal_scale: f32,
    occlusion_strength: f32,
    // With less alpha there is no surface, or if it blends, none that hides what is behind.
    cutoff: f32,
    // 1 if the base colour is shown as it is.
    unlit: f32,
    // 1 if alpha says how much of a place the surface covers.
    blends: f32,
    // How much of a dielectric's light goes through it.
    transmission: f32,
    // 0 without a normal map of the coat.
    coat_normal_scale: f32,
    // How much longer highlights are along a direction than across it.
    anisotropy: f32,
    // Linear RGB of the sheen; 0 without one.
    sheen_color: vec3<f32>,
    sheen_roughness: f32,
    // What the body behind the surface absorbs in an object unit, and how far light goes through it.
    absorption: vec3<f32>,
    thickness: f32,
    // The direction of long highlights: along the tangent, and along the bitangent.
    anisotropy_direction: vec2<f32>,
    maps: array<MapPlace, MAP_COUNT>,
}

// Where an image is read: u' = u.x u + u.y v + u.z, and v' likewise. u.w is 0 for the texture coordinates of the base colour, and 1 or
// 2 for the first or second of the corners' details.
struct MapPlace {
    u: vec4<f32>,
    v: vec4<f32>,
}

// What is in front at a pixel.
struct Pick {
    // As emitted; zero for an input triangle.
    vertices: array<Vertex, 3>,
    // One of FOUND_*, or 0 for nothing.
    found: u32,
    patch_index: u32,
    // Number of the emitted triangle within its patch.
    triangle: u32,
    // The weight (0 u, 1 v, 2 w) that is fewest px from 0.
    weight: u32,
}

const FOUND_EMITTED: u32 = 1u;
const FOUND_SOURCE: u32 = 2u;

const OVERLAY_WIREFRAME: u32 = 1u;
const OVERLAY_PATCHES: u32 = 2u;
const OVERLAY_ADJACENCY: u32 = 4u;
const OVERLAY_FOLDS: u32 = 8u;
const OVERLAY_BACK_FACES: u32 = 16u;
const OVERLAY_CLAY: u32 = 32u;
const OVERLAY_ZEBRA: u32 = 128u;
const OVERLAY_SHADING_NORMALS: u32 = 256u;
const OVERLAY_UV_CHECKER: u32 = 2048u;
const OVERLAY_BARYCENTRIC: u32 = 8192u;
const OVERLAY_FACTORS: u32 = 16384u;
const OVERLAY_TRIANGLE_SIZE: u32 = 32768u;
const OVERLAY_LOW_FACTORS: u32 = 65536u;
const OVERLAY_EXCESS: u32 = 131072u;
const OVERLAY_DEVIATION: u32 = 262144u;
const OVERLAY_SILHOUETTE: u32 = 524288u;
const OVERLAY_SECTION: u32 = 1048576u;
const OVERLAY_COMPARED: u32 = 2097152u;

// An emitted vertex as draws get it: its two halves (see Vertex in types.wgsl).
struct EmittedVertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: u32,
    @location(2) key: vec2<u32>,
    @location(3) uv: vec2<f32>,
}
