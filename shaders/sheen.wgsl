// The sheen of cloth: light that is reflected by fibres which stand up from the surface (KHR_materials_sheen; Conty and Kulla 2017,
// "Production Friendly Microfacet Sheen BRDF"). `alpha` is the square of the perceptual roughness. src/inspect/render/sheen.rs has the same
// functions, but for the last, which src/inspect/for_tests/reflectance.rs has.

// The least alpha. Smoother fibres would reflect light only along the surface.
const LEAST_SHEEN_ALPHA: f32 = 1e-4;

// Density of fibres by the sine of the angle between the normal and their half vector (Conty and Kulla 2017, equation 2).
fn charlie_distribution(sine: f32, alpha: f32) -> f32 {
    return (2.0 + 1.0 / alpha) * pow(sine, 1.0 / alpha) / (2.0 * PI);
}

// The curve that was fitted to the logarithm of Smith's lambda (section 3). Its constants lie between those of roughness 1 and 0.
fn charlie_curve(cosine: f32, alpha: f32) -> f32 {
    let smoothness = (1.0 - alpha) * (1.0 - alpha);
    let a = mix(21.5473, 25.3245, smoothness);
    let b = mix(3.82987, 3.32435, smoothness);
    let c = mix(0.19823, 0.16801, smoothness);
    let d = mix(-1.9776, -1.27393, smoothness);
    let e = mix(-4.32054, -4.85967, smoothness);
    return a / (1.0 + b * pow(cosine, c)) + d * cosine + e;
}

// Smith's lambda for directions above the surface: fibres that a direction doesn't reach, for each that it does. The curve is
// continued about its middle.
fn charlie_lambda(cosine: f32, alpha: f32) -> f32 {
    if cosine < 0.5 {
        return exp(charlie_curve(cosine, alpha));
    }
    return exp(2.0 * charlie_curve(0.5, alpha) - charlie_curve(1.0 - cosine, alpha));
}

// Masking and shadowing, divided by 4 times the cosine towards the eye: the cosine towards the light is left out, with which light
// that comes from a single direction is multiplied.
fn charlie_visibility(lit: f32, facing: f32, alpha: f32) -> f32 {
    return 0.25 / (facing * (1.0 + charlie_lambda(facing, alpha) + charlie_lambda(lit, alpha)));
}
