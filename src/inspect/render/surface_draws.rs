//! Decides what draws the surface of each material, by what a picture shows.

use super::draws::{Draw, Faces, LOOKS, Shading, SurfaceDraw, Triangles};
use super::layout::overlay_bits;
use super::needs::{Cut, Needs, PictureKind};
use crate::settings::{Colors, NormalsAt, Overlays, Settings};
use geometry::mesh::{Material, Mesh};

/// The pipeline for emitted triangles of a material, in such pictures.
pub(super) fn surface_draw(
    settings: &Settings,
    mesh: &Mesh,
    material: &Material,
    faces: Faces,
    kind: PictureKind,
) -> Draw {
    let (mut triangles, normals) = (emitted_triangles(settings), settings.used_normals_at(mesh));
    let (shading, faces) = shading(settings, mesh, material, faces, kind);
    if triangles == Triangles::Bare && matches!(shading, Shading::Cut(_)) {
        triangles = Triangles::Indexed;
    }
    // Where nothing but the colour is drawn, no texture is read either.
    let is_plain = triangles == Triangles::Bare && normals == NormalsAt::Vertices && material.texture.is_none();
    let shading = if is_plain && shading == Shading::Textured { Shading::Plain } else { shading };
    Draw::Surface(SurfaceDraw { triangles, faces, normals, shading, layer: None })
}

/// What colours a material, and which of its faces are drawn: these, unless it has fronts only.
fn shading(settings: &Settings, mesh: &Mesh, material: &Material, faces: Faces, kind: PictureKind) -> (Shading, Faces) {
    if let Some(cut) = Cut::new(settings, mesh, material, kind) {
        return (Shading::Cut(cut), faces);
    }
    if settings.shows_materials() {
        let needs = Needs::new(mesh, material, settings, kind).own(material, kind);
        return (Shading::Lit(needs), own_faces(settings, material).unwrap_or(faces));
    }
    let colors = settings.overlays.colors;
    (if LOOKS.contains(&colors) { Shading::Look(colors) } else { Shading::Textured }, faces)
}

/// The faces of a material that are drawn whatever hides the backs of others. Backs that show through fronts would count twice,
/// so that single-sided materials that show what is behind them have none, as glTF 2.0 says (specification, section 3.9.5), nor
/// have bodies that refract light, whose thickness stands for their other side. Two overlays show faces from behind.
pub(super) fn own_faces(settings: &Settings, material: &Material) -> Option<Faces> {
    let Overlays { folds, back_faces, .. } = settings.overlays;
    let is_single = !material.double_sided || material.look.refracts();
    let has_fronts_only = material.shows_behind() && is_single && !folds && !back_faces;
    has_fronts_only.then_some(Faces::Fronts)
}

/// How pipelines get emitted triangles.
pub(super) fn emitted_triangles(settings: &Settings) -> Triangles {
    // These overlays need data of whole triangles.
    let Overlays { wireframe, folds, colors, .. } = settings.overlays;
    if wireframe || folds || matches!(colors, Colors::TriangleSize | Colors::TexelDensity | Colors::Deviation) {
        Triangles::Pulled
    } else if overlay_bits(&settings.overlays) != 0 {
        Triangles::Indexed
    } else {
        Triangles::Bare
    }
}
