// How surfaces reflect light: the materials of glTF 2.0 (specification, appendix B) with the extensions KHR_materials_ior,
// KHR_materials_specular, KHR_materials_clearcoat, KHR_materials_transmission, KHR_materials_volume, KHR_materials_sheen and
// KHR_materials_anisotropy. Nothing here reads a texture or a buffer. src/inspect/for_tests/reflectance.rs has the same functions.

const PI: f32 = 3.14159265;

// How much a clear coat of refraction index 1.5 reflects head-on (KHR_materials_clearcoat).
const COAT_F0: f32 = 0.04;

// The least square of the perceptual roughness for light from a single direction, of which a mirror would reflect nothing.
const LEAST_ALPHA: f32 = 0.001;

// What is known of the material at a place of the surface.
struct LookAt {
    // Linear RGB.
    base_color: vec3<f32>,
    metallic: f32,
    // Linear RGB of a dielectric's reflection, and its strength (KHR_materials_specular).
    specular_color: vec3<f32>,
    specular: f32,
    // The unit normal of the coat, and how much of the surface it covers.
    coat_normal: vec3<f32>,
    coat: f32,
    // The unit direction across the normal that highlights are longer along, and by how much, 0 to 1.
    direction: vec3<f32>,
    anisotropy: f32,
    // Perceptual roughness of the surface and of the coat, 0 to 1.
    roughness: f32,
    coat_roughness: f32,
    // Index of refraction of a dielectric.
    ior: f32,
    // How much of the light from all around reaches the place, 0 to 1.
    occlusion: f32,
    // Linear RGB of the sheen; 0 without one.
    sheen_color: vec3<f32>,
    // How much of a dielectric's light goes through it in place of being scattered, 0 to 1.
    transmission: f32,
    // Perceptual roughness of the sheen.
    sheen_roughness: f32,
    // The part of an even light from all around that a white sheen reflects towards the eye, from the table. It may exceed 1.
    sheen_albedo: f32,
}

// The light from all around that matters at a place.
struct AmbientLight {
    // Irradiance divided by PI.
    diffuse: vec3<f32>,
    // Radiance from the dominant direction, blurred by the surface's roughness, and by the coat's.
    reflected: vec3<f32>,
    coat_reflected: vec3<f32>,
    // Irradiance of the sheen divided by PI.
    sheen: vec3<f32>,
    // From the table of directional albedos, for the surface and for the coat.
    dfg: vec2<f32>,
    coat_dfg: vec2<f32>,
    // Cosines of the angles between the normals and the direction towards the eye.
    facing: f32,
    coat_facing: f32,
}

fn fifth_power(x: f32) -> f32 {
    return x * x * x * x * x;
}

// What a dielectric reflects head-on.
fn dielectric_f0(look: LookAt) -> vec3<f32> {
    let root = (look.ior - 1.0) / (look.ior + 1.0);
    return min(root * root * look.specular_color, vec3<f32>(1.0)) * look.specular;
}

fn largest_component(color: vec3<f32>) -> f32 {
    return max(color.x, max(color.y, color.z));
}

// Density of microfacets whose normal is `half_way` (Trowbridge and Reitz; Walter et al. 2007, equation 33). `alphas` are
// squares of the perceptual roughness along a unit direction across the normal, and across both (Heitz 2014, equation 85). The
// sine comes from a cross product: 1 - cos^2 would cancel where surfaces are smooth.
fn ggx_distribution(normal: vec3<f32>, half_way: vec3<f32>, alphas: vec2<f32>, direction: vec3<f32>) -> f32 {
    let cosine = max(dot(normal, half_way), 0.0);
    let across = cross(normal, half_way);
    let aside = dot(across, direction);
    let ratio = alphas.x / alphas.y;
    let spread = cosine * cosine * alphas.x * alphas.x + dot(across, across) + (ratio * ratio - 1.0) * aside * aside;
    return ratio * alphas.x * alphas.x / (PI * spread * spread);
}

// Smith's masking and shadowing, correlated by height, divided by 4 times both cosines (Heitz 2014, equation 99). `along` are the
// cosines of the angles of light and eye to the direction.
fn ggx_visibility(lit: f32, facing: f32, alphas: vec2<f32>, along: vec2<f32>) -> f32 {
    let square = alphas.y * alphas.y;
    let more = (alphas.x * alphas.x - square) * along * along;
    let eye_part = lit * sqrt(facing * facing * (1.0 - square) + square + more.y);
    let light_part = facing * sqrt(lit * lit * (1.0 - square) + square + more.x);
    return 0.5 / max(eye_part + light_part, 1e-7);
}

// Squares of the perceptual roughness along the direction of long highlights and across it (KHR_materials_anisotropy).
fn stretched_alphas(look: LookAt) -> vec2<f32> {
    let alpha = look.roughness * look.roughness;
    return vec2<f32>(mix(alpha, 1.0, look.anisotropy * look.anisotropy), alpha);
}

// The perceptual roughness whose directional albedo is about that of a surface with long highlights: tests say how near it is.
fn mean_roughness(look: LookAt) -> f32 {
    let alphas = stretched_alphas(look);
    return select(look.roughness, sqrt(sqrt(0.5 * dot(alphas, alphas))), look.anisotropy > 0.0);
}

// The part of an even light from all around that microfacets reflect at once: the split sum (Karis 2013).
fn albedo_at_once(f0: vec3<f32>, f90: f32, dfg: vec2<f32>) -> vec3<f32> {
    return f0 * dfg.x + vec3<f32>(f90 * dfg.y);
}

// The part that they reflect after it has met several of them (Fdez-Aguera 2019, equations 15 to 18).
fn albedo_of_more(f0: vec3<f32>, f90: f32, dfg: vec2<f32>) -> vec3<f32> {
    let missing = 1.0 - dfg.x - dfg.y;
    let average = f0 + (vec3<f32>(f90) - f0) / 21.0;
    return missing * albedo_at_once(f0, f90, dfg) * average / (vec3<f32>(1.0) - missing * average);
}

// The part of reflected light that occlusion leaves (Lagarde and de Rousiers 2014, section 4.10.2).
fn unoccluded_reflection(occlusion: f32, facing: f32, roughness: f32) -> f32 {
    let alpha = roughness * roughness;
    let base = max(facing + occlusion, 0.0);
    return clamp(pow(base, exp2(-16.0 * alpha - 1.0)) - 1.0 + occlusion, 0.0, 1.0);
}

// The direction that the light which a rough surface reflects towards the eye comes from, on average: nearer to the normal than
// a mirror's (Lagarde and de Rousiers 2014, section 4.9.3). Of unit length.
fn dominant_direction(normal: vec3<f32>, to_eye: vec3<f32>, roughness: f32) -> vec3<f32> {
    let alpha = roughness * roughness;
    let mirrored = (1.0 - alpha) * (sqrt(1.0 - alpha) + alpha);
    return normalize(mix(normal, reflect(-to_eye, normal), mirrored));
}

// The part of the light that the coat reflects, of a light that is the same from all sides.
fn coat_albedo(look: LookAt, coat_dfg: vec2<f32>) -> f32 {
    let f0 = vec3<f32>(COAT_F0);
    return look.coat * (albedo_at_once(f0, 1.0, coat_dfg).x + albedo_of_more(f0, 1.0, coat_dfg).x);
}

// The direction about which a sheen gathers light, of unit length. Fibres reflect light from far around, and more of it backwards than
// a mirror's way. Half way to the eye is an approximation: tests say how near it is.
fn sheen_direction(normal: vec3<f32>, to_eye: vec3<f32>) -> vec3<f32> {
    let between = normal + to_eye;
    return between * inverseSqrt(max(dot(between, between), 1e-12));
}

fn has_sheen(look: LookAt) -> bool {
    return largest_component(look.sheen_color) > 0.0;
}

// The part of light that gets through the sheen to what is below it, and from there to the eye (KHR_materials_sheen, "Albedo-scaling
// technique", with the cosine towards the eye alone).
fn sheen_scaling(look: LookAt) -> f32 {
    return 1.0 - largest_component(look.sheen_color) * min(look.sheen_albedo, 1.0);
}

// Radiance towards the eye under light from all around.
fn reflect_ambient(look: LookAt, light: AmbientLight) -> vec3<f32> {
    let diffuse = light.diffuse * look.occlusion;
    let reflected = light.reflected * unoccluded_reflection(look.occlusion, light.facing, look.roughness);
    let f0 = dielectric_f0(look);
    let once = albedo_at_once(f0, look.specular, light.dfg);
    let more = albedo_of_more(f0, look.specular, light.dfg);
    let left = max(1.0 - largest_component(once + more), 0.0);
    let dielectric = once * reflected + (more + left * (1.0 - look.transmission) * look.base_color) * diffuse;
    let metal = albedo_at_once(look.base_color, 1.0, light.dfg) * reflected
        + albedo_of_more(look.base_color, 1.0, light.dfg) * diffuse;
    var base = mix(dielectric, metal, look.metallic);
    let sheen = look.sheen_color * light.sheen * (look.occlusion * min(look.sheen_albedo, 1.0));
    base = select(base, base * sheen_scaling(look) + sheen, has_sheen(look));
    let coat_f0 = vec3<f32>(COAT_F0);
    let coat_reflected =
        light.coat_reflected * unoccluded_reflection(look.occlusion, light.coat_facing, look.coat_roughness);
    let coat = albedo_at_once(coat_f0, 1.0, light.coat_dfg) * coat_reflected
        + albedo_of_more(coat_f0, 1.0, light.coat_dfg) * diffuse;
    return select(base, base * (1.0 - coat_albedo(look, light.coat_dfg)) + look.coat * coat, look.coat > 0.0);
}

// The part of the light from right behind a thin surface that comes through it towards the eye: what isn't reflected, in the base
// colour (KHR_materials_transmission, thin surfaces).
fn transmitted(look: LookAt, dfg: vec2<f32>, coat_dfg: vec2<f32>) -> vec3<f32> {
    let f0 = dielectric_f0(look);
    let reflected = albedo_at_once(f0, look.specular, dfg) + albedo_of_more(f0, look.specular, dfg);
    let left = max(1.0 - largest_component(reflected), 0.0);
    let through = (1.0 - look.metallic) * look.transmission * left * look.base_color;
    return through * (sheen_scaling(look) * (1.0 - coat_albedo(look, coat_dfg)));
}

// Radiance towards the eye per irradiance that a surface across the light would get, for light from a single direction. All
// directions are of unit length.
fn direct_reflection(look: LookAt, normal: vec3<f32>, to_eye: vec3<f32>, to_light: vec3<f32>) -> vec3<f32> {
    let half_way = normalize(to_eye + to_light);
    let schlick = fifth_power(1.0 - clamp(dot(half_way, to_eye), 0.0, 1.0));
    var base = direct_base_reflection(look, normal, to_eye, to_light, half_way, schlick);
    let sheen = look.sheen_color * direct_sheen(look, normal, to_eye, to_light, half_way);
    base = select(base, base * sheen_scaling(look) + sheen, has_sheen(look));
    let coat_fresnel = COAT_F0 + (1.0 - COAT_F0) * fifth_power(1.0 - abs(dot(look.coat_normal, to_eye)));
    let coat = look.coat * coat_fresnel;
    let coat_alphas = vec2<f32>(look.coat_roughness * look.coat_roughness);
    let coat_lobe = direct_lobe(look.coat_normal, to_eye, to_light, half_way, coat_alphas, look.direction);
    return select(base, base * (1.0 - coat) + coat * coat_lobe, look.coat > 0.0);
}

// Reflection by microfacets that are perfect mirrors.
fn direct_lobe(
    normal: vec3<f32>,
    to_eye: vec3<f32>,
    to_light: vec3<f32>,
    half_way: vec3<f32>,
    alphas: vec2<f32>,
    direction: vec3<f32>,
) -> f32 {
    let lit = dot(normal, to_light);
    let facing = dot(normal, to_eye);
    if lit <= 0.0 || facing <= 0.0 {
        return 0.0;
    }
    let rough = max(alphas, vec2<f32>(LEAST_ALPHA));
    let along = vec2<f32>(dot(direction, to_light), dot(direction, to_eye));
    return ggx_distribution(normal, half_way, rough, direction) * ggx_visibility(lit, facing, rough, along) * lit;
}

// Reflection by a white sheen. Where it would reflect more of an even light than there is, which smooth ones do that are seen from
// the side, it is scaled down to all of it.
fn direct_sheen(look: LookAt, normal: vec3<f32>, to_eye: vec3<f32>, to_light: vec3<f32>, half_way: vec3<f32>) -> f32 {
    let lit = dot(normal, to_light);
    let facing = dot(normal, to_eye);
    if lit <= 0.0 || facing <= 0.0 {
        return 0.0;
    }
    let alpha = max(look.sheen_roughness * look.sheen_roughness, LEAST_SHEEN_ALPHA);
    let sine = min(length(cross(normal, half_way)), 1.0);
    let lobe = charlie_distribution(sine, alpha) * charlie_visibility(lit, facing, alpha);
    return lobe / max(look.sheen_albedo, 1.0);
}

// The same as direct_reflection without coat and sheen; `schlick` is the fifth power in Schlick's approximation.
fn direct_base_reflection(
    look: LookAt,
    normal: vec3<f32>,
    to_eye: vec3<f32>,
    to_light: vec3<f32>,
    half_way: vec3<f32>,
    schlick: f32,
) -> vec3<f32> {
    let lobe = direct_lobe(normal, to_eye, to_light, half_way, stretched_alphas(look), look.direction);
    let f0 = dielectric_f0(look);
    let fresnel = f0 + (vec3<f32>(look.specular) - f0) * schlick;
    let lit = select(0.0, max(dot(normal, to_light), 0.0), dot(normal, to_eye) > 0.0);
    let left = (1.0 - largest_component(fresnel)) * (1.0 - look.transmission);
    let dielectric = look.base_color * (left * lit / PI) + fresnel * lobe;
    let metal = (look.base_color + (vec3<f32>(1.0) - look.base_color) * schlick) * lobe;
    return mix(dielectric, metal, look.metallic);
}
