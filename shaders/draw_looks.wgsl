// Colours that show how a surface is shaped, and how a texture would lie on it.

// Values of LOOK: numbers of Colors in src/inspect/settings/overlays.rs.
const LOOK_SURFACE_NORMALS: u32 = 5u;
const LOOK_CURVATURE: u32 = 6u;
const LOOK_MATCAP: u32 = 2u;
const LOOK_TEXEL_DENSITY: u32 = 8u;

// How far the sphere of a matcap reaches, as a part of half of its picture.
const MATCAP_REACH: f32 = 0.98;

// A matte warm grey, light enough that shadows show.
const CLAY_COLOR: vec3<f32> = vec3<f32>(0.82, 0.73, 0.64);
// How bright clay is under outlines, which must stand out from it.
const CLAY_UNDER_OUTLINES: f32 = 0.1;

const ZEBRA_DARK: f32 = 0.012;
const ZEBRA_LIGHT: f32 = 0.85;

const CHECKER_LIGHT: f32 = 0.62;
const CHECKER_DARK: f32 = 0.22;
// What light and dark are multiplied by where u, or v, comes to the next whole number.
const CHECKER_U: vec3<f32> = vec3<f32>(1.15, 0.6, 0.55);
const CHECKER_V: vec3<f32> = vec3<f32>(0.6, 1.1, 0.55);
const CHECKER_LINE: vec3<f32> = vec3<f32>(0.014, 0.051, 0.352);
// The digits and a letter F, of 3 by 5 cells each: a bit a cell, from the lower right one, row by row upwards.
const GLYPHS: array<u32, 11> = array<u32, 11>(
    0x7b6fu, 0x2c97u, 0x73e7u, 0x73cfu, 0x5bc9u, 0x79cfu,
    0x79efu, 0x7249u, 0x7befu, 0x7bcfu, 0x79a4u,
);
const GLYPH_F: u32 = 10u;
// A square of the checker is so many cells wide.
const SQUARE_CELLS: f32 = 22.0;

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

// The place across the stripes around the mesh that a mirror shows, in half turns of the normal. The stripes lie in planes through one
// line along `axis`, to the right and up in the view, and come together where a surface reflects what is behind it, which only its
// outline does. Either side of the mirror shows the same. `clip_from_object` says where right and up are in the view.
fn reflected_place(clip_from_object: mat4x4<f32>, axis: vec2<f32>, normal: vec3<f32>, to_eye: vec3<f32>) -> f32 {
    let rows = transpose(clip_from_object);
    let right = normalize(rows[0].xyz);
    let up = normalize(rows[1].xyz);
    let back = cross(right, up);
    // Half way between the direction that is reflected and the one out of the picture.
    let half_way = reflect(-to_eye, normal) + back;
    let across = dot(half_way, axis.x * up - axis.y * right);
    return atan2(across, max(dot(half_way, back), 1e-6)) / 3.14159265;
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

// 1 where a square of the checker has ink: on a letter F, which no mirror or turn leaves as it is, and to its right the square's
// column, counted from 1, above its row. `at` is the place in squares.
fn ink(at: vec2<f32>) -> f32 {
    // From the upper left corner of the writing, which is 20 cells wide and 12 high: the F is twice as large as digits.
    let cell = SQUARE_CELLS * fract(at) - vec2<f32>(1.0, 5.0);
    if any(cell < vec2<f32>(0.0)) || any(cell >= vec2<f32>(20.0, 12.0)) {
        return 0.0;
    }
    var glyph = GLYPH_F;
    var place = vec2<u32>(0.5 * cell);
    if cell.x >= 8.0 {
        let digit = u32(cell.x - 8.0) / 4u;
        let number = u32(select(floor(at.x), floor(at.y), cell.y >= 6.0)) + 1u;
        let rest = number / select(select(1u, 10u, digit == 1u), 100u, digit == 0u);
        if rest == 0u {
            return 0.0;
        }
        glyph = rest % 10u;
        place = vec2<u32>(u32(cell.x) % 4u, u32(cell.y) % 6u);
    }
    if place.x > 2u || place.y > 4u {
        return 0.0;
    }
    return f32((GLYPHS[glyph] >> (14u - 3u * place.y - place.x)) & 1u);
}

// The checker, with so many squares in a unit of u or v, at texture coordinates that change by `in_pixel` from one pixel to the next.
// Where all of a triangle has the same ones, it is plain grey.
fn checker_color(count: f32, uv: vec2<f32>, in_pixel: vec2<f32>) -> vec3<f32> {
    if max(in_pixel.x, in_pixel.y) < 1e-6 {
        return vec3<f32>(0.5 * (CHECKER_DARK + CHECKER_LIGHT));
    }
    let squares = count * in_pixel;
    // Four places in the pixel are looked at. What is written fades where cells are narrower than a px.
    var covered = 0.0;
    for (var k = 0u; k < 4u; k++) {
        let aside = vec2<f32>(vec2<u32>(k % 2u, k / 2u)) * 0.5 - 0.25;
        covered += 0.25 * ink(count * fract(uv + aside * in_pixel));
    }
    covered *= left_of_stripes(0.5 * SQUARE_CELLS * max(squares.x, squares.y));
    let sign = (1.0 - 1.4 * covered) * stripes(count * uv.x, squares.x) * stripes(count * uv.y, squares.y);
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

// The area that two vectors span.
fn spanned_area(a: vec2<f32>, b: vec2<f32>) -> f32 {
    return abs(a.x * b.y - a.y * b.x);
}

// How many texels of an image lie side by side where this area of texture coordinates is on a square: in a pixel, or in an object
// unit. A material without an image has one of a single texel.
fn texel_density(image: vec2<u32>, uv_area: f32) -> f32 {
    let size = select(vec2<f32>(image), vec2<f32>(TEXELS_WITHOUT_IMAGE), image.x * image.y == 1u);
    return sqrt(uv_area * size.x * size.y);
}
