//! Numbers that are usual on a mesh, which colour scales are made for.

use glam::{Vec2, Vec3};

use super::deviation::DEVIATION_PX_SCALE;
use super::layout::TEXELS_WITHOUT_IMAGE;
use super::scale::{DENSITY_SCALE, EXCESS_SCALE, FACTOR_SCALE, SIZE_SCALE, Scale, curvature_scale};
use crate::settings::{Colors, Settings, SurfaceUnit};
use geometry::mesh::{Material, Mesh, Topology};
use geometry::tessellate::CurvatureKind;

/// How many patches are looked at, at most; in a larger mesh they lie evenly among all.
const MOST_PATCHES: usize = 1 << 16;
/// Sides of patches count as curved from this curvature on, in 1 / bounding radius.
const LEAST_CURVATURE: f32 = 0.01;
/// The scale of curvature ends so many times beyond what this part of the curved sides doesn't exceed. So a few sharp fillets leave
/// the rest its colours, and a sphere isn't at the end.
const CURVED_PART: f32 = 0.9;
const BEYOND: f32 = 1.5;
/// Where it ends if no side is curved, in 1 / bounding radius.
const FLAT_CURVATURE: f32 = 4.0;

/// Numbers that are usual on a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Usual {
    /// The bounding radius, in object units.
    pub radius: f32,
    /// Where the scale of curvature ends, in 1 / object unit.
    pub curvature: f32,
    /// The same of Gaussian curvature, in 1 / object unit squared.
    pub gaussian: f32,
    /// Texels along an object unit on half of the patches, as a power of two.
    pub texels: f32,
}

impl Usual {
    /// Looks at a mesh at rest. A side's curvature is how far the normals at its ends are apart, divided by its length: on a sphere of
    /// radius r it is 1 / r. It doesn't depend on the surface that patches become, so that scales stay when that changes.
    pub fn new(mesh: &Mesh, topology: &Topology, radius: f32) -> Self {
        let (mut curvatures, mut products, mut densities) = (Vec::new(), Vec::new(), Vec::new());
        let step = topology.patches.len().div_ceil(MOST_PATCHES).max(1);
        for patch in (0..topology.patches.len() as u32).step_by(step) {
            let corners = topology.patch_corners(patch).map(|corner| &mesh.corners[corner as usize]);
            let (uvs, places) = (corners.map(|corner| corner.uv), corners.map(|corner| corner.position));
            let bent = [(0, 1), (1, 2), (2, 0)]
                .map(|(a, b)| corners[a].normal.distance(corners[b].normal) / places[a].distance(places[b]));
            let is_curved = |bent: &f32| bent.is_finite() && *bent * radius > LEAST_CURVATURE;
            curvatures.extend(bent.iter().filter(|bent| is_curved(bent)));
            // A patch bends the most and the least about as its sides do.
            products.extend(bent.iter().all(is_curved).then(|| {
                let ends = bent.iter().fold([f32::MAX, 0.0], |[least, most], own| [least.min(*own), most.max(*own)]);
                ends[0] * ends[1]
            }));
            densities.extend(texel_density(&mesh.materials[topology.material_of(patch)], uvs, places));
        }
        let curvature = quantile(curvatures, CURVED_PART).map_or(FLAT_CURVATURE / radius, |bent| BEYOND * bent);
        let gaussian = quantile(products, CURVED_PART).map_or(curvature * curvature, |bent| BEYOND * BEYOND * bent);
        let texels = quantile(densities, 0.5).map_or(1.0, |density| density.log2().round().exp2());
        Self { radius, curvature, gaussian, texels }
    }

    /// The scale for the numbers that a picture's colours stand for; any scale if they stand for none. `known` is that of distances in
    /// object units, once they are known.
    pub fn scale(&self, settings: &Settings, known: Option<Scale>) -> Scale {
        match settings.overlays.colors {
            Colors::Deviation => match settings.deviation_in {
                SurfaceUnit::Units => known.unwrap_or(DEVIATION_PX_SCALE),
                SurfaceUnit::Px => DEVIATION_PX_SCALE,
            },
            Colors::Curvature => {
                let set = settings.curvature_scale.map(|ends| f64::from(ends / self.radius));
                curvature_scale(match settings.curvature_kind {
                    CurvatureKind::Gaussian => set.map_or(self.gaussian.into(), |ends| ends * ends),
                    CurvatureKind::Mean | CurvatureKind::Largest | CurvatureKind::Least => {
                        set.unwrap_or(self.curvature.into())
                    }
                })
            }
            Colors::TexelDensity => {
                let middle = if settings.texel_density_per == SurfaceUnit::Units { self.texels } else { 1.0 };
                let [least, most] = [DENSITY_SCALE.least, DENSITY_SCALE.most].map(|end| end * middle);
                Scale { least, most, ..DENSITY_SCALE }
            }
            Colors::TriangleSize => SIZE_SCALE,
            Colors::Excess => EXCESS_SCALE,
            _ => FACTOR_SCALE,
        }
    }
}

/// The number that this part of all doesn't exceed; none of none.
fn quantile(mut numbers: Vec<f32>, part: f32) -> Option<f32> {
    let at = (numbers.len().checked_sub(1)? as f32 * part) as usize;
    Some(*numbers.select_nth_unstable_by(at, f32::total_cmp).1)
}

/// How many texels of a material's image lie side by side along a unit of a triangle's corners, whose texture coordinates are these;
/// none where the image has no place. A material without an image counts as if it had one of [`TEXELS_WITHOUT_IMAGE`].
pub fn texel_density(material: &Material, uvs: [Vec2; 3], corners: [Vec3; 3]) -> Option<f32> {
    let image = material.texture.as_ref().map(|image| image.size).filter(|size| *size != [1, 1]);
    let size = image.map_or(Vec2::splat(TEXELS_WITHOUT_IMAGE), |size| size.map(|side| side as f32).into());
    let texels = ((uvs[1] - uvs[0]) * size).perp_dot((uvs[2] - uvs[0]) * size).abs();
    let density = (texels / (corners[1] - corners[0]).cross(corners[2] - corners[0]).length()).sqrt();
    (density > 0.0 && density.is_finite()).then_some(density)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::Shape;

    fn usual(mesh: &Mesh) -> Usual {
        Usual::new(mesh, &Topology::new(mesh), mesh.bounds().radius())
    }

    #[test]
    fn the_scale_of_curvature_is_made_for_the_mesh() {
        let sphere = usual(&Shape::Icosphere.build());
        let own = sphere.curvature * sphere.radius;
        assert!((1.2..1.8).contains(&own), "a sphere has 1 / radius, and the scale goes on: {own}");
        let mut large = Shape::Icosphere.build();
        large.corners.iter_mut().for_each(|corner| corner.position *= 50.0);
        assert!((sphere.gaussian / sphere.curvature.powi(2) - 1.0).abs() < 0.2, "all of a sphere bends alike");
        let ratio = sphere.curvature / usual(&large).curvature;
        assert!((ratio / 50.0 - 1.0).abs() < 1e-3, "{ratio}");
        // No side of a cube with hard edges is curved.
        let mut cube = Shape::CubeSplit.build();
        for corner in &mut cube.corners {
            let along = corner.normal.abs().max_element();
            corner.normal = corner.normal.map(|x| if x.abs() == along { x.signum() } else { 0.0 });
        }
        let cube = usual(&cube);
        assert_eq!(cube.curvature, FLAT_CURVATURE / cube.radius);
    }

    #[test]
    fn few_sharp_places_leave_the_scale_of_curvature_as_it_is() {
        let mut mesh = Shape::Icosphere.build();
        let before = usual(&mesh).curvature;
        let sharp = (mesh.corners.len() / 100).max(1);
        for corner in &mut mesh.corners[..sharp] {
            corner.normal = corner.normal.any_orthonormal_vector();
        }
        let after = usual(&mesh).curvature;
        assert!((after / before - 1.0).abs() < 0.2, "{before} and {after}");
    }

    #[test]
    fn the_user_sets_the_ends_in_bounding_radii_and_gaussian_curvature_has_their_square() {
        let usual = Usual { radius: 2.0, curvature: 3.0, gaussian: 5.0, texels: 256.0 };
        let mut settings = Settings::default();
        settings.overlays.colors = Colors::Curvature;
        let most = |settings: &Settings| usual.scale(settings, None).most;
        assert_eq!(most(&settings), 3.0);
        settings.curvature_scale = Some(4.0);
        assert_eq!(most(&settings), 2.0);
        settings.curvature_kind = CurvatureKind::Gaussian;
        assert_eq!(most(&settings), 4.0);
        settings.overlays.colors = Colors::TexelDensity;
        assert_eq!(usual.scale(&settings, None), DENSITY_SCALE);
        settings.texel_density_per = SurfaceUnit::Units;
        let Scale { least, most, .. } = usual.scale(&settings, None);
        assert_eq!((least, most), (32.0, 2048.0));
    }

    #[test]
    fn texels_are_counted_along_a_unit() {
        let material = Material::plain("none", [1.0; 4]);
        let uvs = [Vec2::ZERO, Vec2::X, Vec2::Y];
        // 1024 texels along 4 units, whichever way the triangle is turned.
        let corners = [Vec3::ONE, Vec3::ONE + 4.0 * Vec3::Z, Vec3::ONE + 4.0 * Vec3::X];
        assert_eq!(texel_density(&material, uvs, corners), Some(256.0));
        assert_eq!(texel_density(&material, uvs.map(|uv| 0.5 * Vec2::new(-uv.x, uv.y)), corners), Some(128.0));
        assert_eq!(texel_density(&material, [Vec2::ONE; 3], corners), None);
        assert_eq!(texel_density(&material, uvs, [Vec3::ONE; 3]), None);
    }
}
