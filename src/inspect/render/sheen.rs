//! The sheen of cloth: functions of `shaders/sheen.wgsl`, which explains them. They make the table of directional albedos.

use std::f32::consts::PI;

/// The least alpha.
pub(crate) const LEAST_SHEEN_ALPHA: f32 = 1e-4;

pub(crate) fn charlie_distribution(sine: f32, alpha: f32) -> f32 {
    (2.0 + 1.0 / alpha) * sine.powf(1.0 / alpha) / (2.0 * PI)
}

fn charlie_curve(cosine: f32, alpha: f32) -> f32 {
    let smoothness = (1.0 - alpha) * (1.0 - alpha);
    let mix = |rough: f32, smooth: f32| rough + (smooth - rough) * smoothness;
    let a = mix(21.5473, 25.3245);
    let b = mix(3.82987, 3.32435);
    let c = mix(0.19823, 0.16801);
    let d = mix(-1.9776, -1.27393);
    let e = mix(-4.32054, -4.85967);
    a / (1.0 + b * cosine.powf(c)) + d * cosine + e
}

pub(crate) fn charlie_lambda(cosine: f32, alpha: f32) -> f32 {
    if cosine < 0.5 {
        return charlie_curve(cosine, alpha).exp();
    }
    (2.0 * charlie_curve(0.5, alpha) - charlie_curve(1.0 - cosine, alpha)).exp()
}
