//! Layers of properties, blended one over the other.
//!
//! Source: 3MF Materials and Properties Extension 1.2.1, chapter 5.

use glam::Vec4;

/// How a layer is blended with those below it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Method {
    /// It covers them as much as its alpha says.
    #[default]
    Mix,
    Multiply,
}

/// Returns the colour of layers at a point, the lowest first: linear RGBA with straight alpha. If the lowest one is a material, the
/// others are blended by themselves first, with how much they cover, and then cover it. White without layers.
pub(super) fn blended(layers: &[(Vec4, Method)], has_material: bool) -> Vec4 {
    let (material, surface) = match layers {
        [(material, _), surface @ ..] if has_material => (Some(*material), surface),
        _ => (None, layers),
    };
    let Some(((lowest, method), above)) = surface.split_first() else { return material.unwrap_or(Vec4::ONE) };
    let covers = if material.is_some() && *method == Method::Mix { lowest.w } else { 1.0 };
    let start = lowest.truncate().extend(covers);
    let surface = above.iter().fold(start, |below, (layer, method)| match method {
        Method::Mix => layer.with_w(1.0) * layer.w + below * (1.0 - layer.w),
        Method::Multiply => *layer * below,
    });
    let Some(material) = material else { return surface.with_w(1.0) };
    let shows = material.w * (1.0 - surface.w);
    let alpha = surface.w + shows;
    match alpha > 0.0 {
        true => ((surface * surface.w + material * shows) / alpha).with_w(alpha),
        false => material,
    }
}

#[cfg(test)]
mod tests {
    use glam::vec4;

    use super::Method::{Mix, Multiply};
    use super::*;

    const RED: Vec4 = vec4(1.0, 0.0, 0.0, 1.0);
    const BLUE: Vec4 = vec4(0.0, 0.0, 1.0, 1.0);

    fn assert_blended(layers: &[(Vec4, Method)], has_material: bool, expected: [f32; 4]) {
        let found = blended(layers, has_material);
        assert!(found.distance(expected.into()) < 1e-6, "{layers:?} {has_material} {found}");
    }

    #[test]
    fn layers_without_a_material_are_opaque() {
        assert_blended(&[], false, [1.0; 4]);
        assert_blended(&[(RED.with_w(0.1), Mix)], false, [1.0, 0.0, 0.0, 1.0]);
        assert_blended(&[(RED, Mix), (BLUE.with_w(0.25), Mix)], false, [0.75, 0.0, 0.25, 1.0]);
        let grey = vec4(0.5, 0.5, 0.5, 0.5);
        assert_blended(&[(RED, Mix), (grey, Multiply), (BLUE.with_w(0.5), Mix)], false, [0.25, 0.0, 0.5, 1.0]);
    }

    /// Expected numbers follow the specification's equations by hand.
    #[test]
    fn a_material_is_covered_by_all_others_together() {
        assert_blended(&[(RED.with_w(0.5), Mix)], true, [1.0, 0.0, 0.0, 0.5]);
        assert_blended(&[(RED, Mix), (BLUE.with_w(0.25), Mix)], true, [0.75, 0.0, 0.25, 1.0]);
        // The first of the others covers it whole where it multiplies.
        assert_blended(&[(RED, Mix), (BLUE.with_w(0.25), Multiply)], true, [0.0, 0.0, 1.0, 1.0]);
        // The alphas 0.5 and 0.5 make 0.75, and the colours are half green and half blue.
        let green = vec4(0.0, 1.0, 0.0, 0.5);
        assert_blended(&[(RED, Mix), (BLUE.with_w(0.5), Mix), (green, Mix)], true, [0.25, 0.375, 0.375, 1.0]);
        // A factor's alpha uncovers it.
        assert_blended(&[(RED, Mix), (BLUE, Mix), (Vec4::splat(0.5), Multiply)], true, [0.5, 0.0, 0.25, 1.0]);
        assert_blended(&[(RED.with_w(0.5), Mix), (BLUE.with_w(0.5), Mix)], true, [1.0 / 3.0, 0.0, 2.0 / 3.0, 0.75]);
        assert_blended(&[(RED.with_w(0.0), Mix), (BLUE.with_w(0.0), Mix)], true, [1.0, 0.0, 0.0, 0.0]);
    }
}
