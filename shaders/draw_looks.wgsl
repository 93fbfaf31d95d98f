// Colours that show how a surface is shaped, and how a texture would lie on it.

// Values of LOOK. src/inspect/render/colors.rs has the same.
const LOOK_SURFACE_NORMALS: u32 = 1u;
const LOOK_CURVATURE: u32 = 2u;
const LOOK_MATCAP: u32 = 3u;
const LOOK_TEXEL_DENSITY: u32 = 4u;

// How far the sphere of a matcap reaches, as a part of half of its picture.
const MATCAP_REACH: f32 = 0.98;

// A matte warm grey, light enough that shadows show.
const CLAY_COLOR: vec3<f32> = vec3<f32>(0.82, 0.73, 0.64);
// How bright clay is under outlines, which must stand out from it.
const CLAY_UNDER_OUTLINES: f32 = 0.1;

// Stripes over half a turn of the normal.
const ZEBRA_STRIPES: f32 = 24.0;
// The direction along the stripes, to the right and up in the view. It is askew, since most meshes have edges that lie level or
// upright: on stripes along an edge one wouldn't see a kink.
const ZEBRA_AXIS: vec2<f32> = vec2<f32>(0.8, 0.6);
const ZEBRA_DARK: f32 = 0.012;
const ZEBRA_LIGHT: f32 = 0.85;

// In one unit of u or v.
const CHECKER_SQUARES: f32 = 8.0;
const CHECKER_LIGHT: f32 = 0.62;
const CHECKER_DARK: f32 = 0.22;
// What light and dark are multiplied by where u, or v, comes to the next whole number.
const CHECKER_U: vec3<f32> = vec3<f32>(1.15, 0.6, 0.55);
const CHECKER_V: vec3<f32> = vec3<f32>(0.6, 1.1, 0.55);
const CHECKER_LINE: vec3<f32> = vec3<f32>(0.014, 0.051, 0.352);

// What is left of stripes or squares if this many are in one pixel: all of it where they are some px wide, and nothing where they
// are not wider than a px, since pixels would make a pattern of their own.
fn left_of_stripes(in_pixel: f32) -> f32 {
    return smoothstep(1.0, 3.0, 1.0 / max(in_pixel, 1e-6));
}

// The mean over a pixel of a wave that is 1 between 0 and 1, and -1 between 1 and 2. It fades where it is dense.
fn stripes(place: f32, in_pixel: f32) -> f32 {
    // Not so narrow that rounding shows.
    let width = max(in_pixel, 1e-3);
    let middle = 2.0 * fract(0.5 * place);
    let ends = vec2<f32>(middle - 0.5 * width, middle + 0.5 * width);
    // The wave's integral, but for its sign, is a triangle wave.
    let integral = abs(fract(0.5 * ends) - 0.5);
    return 2.0 * (integral.x - integral.y) / width * left_of_stripes(width);
}

// The place on the stripes around the mesh that a mirror shows. The stripes lie in planes through one line, and come together where
// a surface reflects what is behind it, which only its outline does. Either side of the mirror shows the same. `clip_from_object`
// says where right and up are in the view.
fn reflected_place(clip_from_object: mat4x4<f32>, normal: vec3<f32>, to_eye: vec3<f32>) -> f32 {
    let rows = transpose(clip_from_object);
    let right = normalize(rows[0].xyz);
    let up = normalize(rows[1].xyz);
    let back = cross(right, up);
    // Half way between the direction that is reflected and the one out of the picture.
    let half_way = reflect(-to_eye, normal) + back;
    let across = dot(half_way, ZEBRA_AXIS.x * up - ZEBRA_AXIS.y * right);
    return ZEBRA_STRIPES / 3.14159265 * atan2(across, max(dot(half_way, back), 1e-6));
}

// The place on a matcap, a picture of a lit sphere (Sloan et al. 2001), where the sphere has a normal. Right and up are taken across
// the line of sight, so that a sphere shows all of the matcap wherever it is in the view.
fn matcap_place(clip_from_object: mat4x4<f32>, to_eye: vec3<f32>, normal: vec3<f32>) -> vec2<f32> {
    let right = normalize(cross(transpose(clip_from_object)[1].xyz, to_eye));
    let up = cross(to_eye, right);
    return 0.5 + 0.5 * MATCAP_REACH * vec2<f32>(dot(right, normal), -dot(up, normal));
}

fn zebra_color(place: f32, in_pixel: f32) -> vec3<f32> {
    return vec3<f32>(mix(ZEBRA_DARK, ZEBRA_LIGHT, 0.5 + 0.5 * stripes(place, in_pixel)));
}

// The checker at texture coordinates that change by `in_pixel` from one pixel to the next. Where all of a triangle has the same
// ones, it is plain grey.
fn checker_color(uv: vec2<f32>, in_pixel: vec2<f32>) -> vec3<f32> {
    if max(in_pixel.x, in_pixel.y) < 1e-6 {
        return vec3<f32>(0.5 * (CHECKER_DARK + CHECKER_LIGHT));
    }
    let squares = CHECKER_SQUARES * in_pixel;
    let sign = stripes(CHECKER_SQUARES * uv.x, squares.x) * stripes(CHECKER_SQUARES * uv.y, squares.y);
    // Tints and lines fade as the squares do.
    let left = vec2<f32>(left_of_stripes(squares.x), left_of_stripes(squares.y));
    let part = mix(vec2<f32>(0.5), fract(uv), left);
    let tint = mix(vec3<f32>(1.0), CHECKER_U, part.x) * mix(vec3<f32>(1.0), CHECKER_V, part.y);
    let color = mix(CHECKER_DARK, CHECKER_LIGHT, 0.5 + 0.5 * sign) * tint;
    let to_line = abs(fract(uv + 0.5) - 0.5) / max(in_pixel, vec2<f32>(1e-6));
    let on_line = left * vec2<f32>(line_coverage(to_line.x, 1.25), line_coverage(to_line.y, 1.25));
    return mix(color, CHECKER_LINE, max(on_line.x, on_line.y));
}

// The sides in px of the image that texel density is counted in where a material has none.
const TEXELS_WITHOUT_IMAGE: f32 = 1024.0;

// How many texels of an image lie side by side in a pixel: the root of the area in texels that the pixel covers, where texture
// coordinates change this much to the next pixel on the right, and below. 0 where they don't change. A material without an image
// has one of a single texel.
fn texel_density(image: vec2<u32>, right: vec2<f32>, below: vec2<f32>) -> f32 {
    let size = select(vec2<f32>(image), vec2<f32>(TEXELS_WITHOUT_IMAGE), image.x * image.y == 1u);
    return sqrt(abs(right.x * below.y - right.y * below.x) * size.x * size.y);
}
