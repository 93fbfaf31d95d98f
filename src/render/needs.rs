//! What the shader that lights a mesh's materials must have.

use crate::mesh::{Alpha, Mesh};

/// What a mesh's materials need of the shader that lights them. What they don't need is left out of it when its pipeline is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Needs {
    /// Images beside that of the base colour.
    pub maps: bool,
    /// Details of corners: colours, tangents, or further texture coordinates.
    pub details: bool,
    /// A clear coat.
    pub coat: bool,
    /// Places where there is no surface.
    pub mask: bool,
}

impl Needs {
    /// Everything that any mesh needs.
    pub(super) const ALL: Self = Self { maps: true, details: true, coat: true, mask: true };

    /// What a mesh needs.
    pub(super) fn of(mesh: &Mesh) -> Self {
        let mut needs = Self { maps: false, details: mesh.details.is_some(), coat: false, mask: false };
        for look in mesh.materials.iter().map(|material| &material.look) {
            needs.maps |= look.maps.iter().any(Option::is_some);
            needs.coat |= look.clearcoat > 0.0;
            needs.mask |= matches!(look.alpha, Alpha::Mask(_));
        }
        needs
    }

    /// The values of the constants of `shaders/draw_material.wgsl`.
    pub(super) fn constants(self) -> [(&'static str, f64); 4] {
        [("HAS_MAPS", self.maps), ("HAS_DETAILS", self.details), ("HAS_COAT", self.coat), ("HAS_MASK", self.mask)]
            .map(|(name, is_needed)| (name, f64::from(u8::from(is_needed))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Material, Shape};

    #[test]
    fn a_mesh_needs_what_any_of_its_materials_does() {
        let mut mesh = Shape::CubeSplit.build();
        let nothing = Needs { maps: false, details: false, coat: false, mask: false };
        assert_eq!(Needs::of(&mesh), nothing);
        let mut coated = Material::plain("coated", [1.0; 4]);
        coated.look.clearcoat = 0.5;
        mesh.materials.push(coated);
        assert_eq!(Needs::of(&mesh), Needs { coat: true, ..nothing });
        let mut leaves = Material::plain("leaves", [1.0; 4]);
        leaves.look.alpha = Alpha::Mask(0.5);
        mesh.materials.push(leaves);
        assert_eq!(Needs::of(&mesh), Needs { coat: true, mask: true, ..nothing });
    }
}
