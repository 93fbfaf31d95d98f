//! Decides what draws the surface of each material, by what a picture shows.

use super::draws::{Draw, Faces, Triangles};
use super::layout::overlay_bits;
use super::look::Look;
use super::needs::{Cut, Needs, PictureKind};
use crate::settings::{Colors, NormalsAt, Overlays, Settings};
use geometry::mesh::{Material, Mesh};
use geometry::tessellate::{Displacement, Tessellation};

/// The pipeline for emitted triangles of a material, in such pictures.
pub(super) fn surface_draw(
    settings: &Settings,
    mesh: &Mesh,
    material: &Material,
    faces: Faces,
    kind: PictureKind,
) -> Draw {
    let places = settings.used_normals_at(mesh);
    let triangles = emitted_triangles(settings);
    if let Some(cut) = Cut::of(settings, mesh, material, kind) {
        let triangles = if triangles == Triangles::Lit { Triangles::Indexed } else { triangles };
        return Draw::Cut(triangles, faces, places, cut);
    }
    match (triangles, Look::of(settings.overlays.colors)) {
        _ if settings.shows_materials() => {
            let draw = match triangles {
                Triangles::Pulled => Draw::LitPulled,
                Triangles::Indexed => Draw::LitIndexed,
                _ => Draw::Lit,
            };
            let faces = own_faces(settings, material).unwrap_or(faces);
            draw(faces, places, Needs::of(mesh, material, settings, kind).own(material, kind))
        }
        (Triangles::Pulled, Some(look)) => Draw::LookPulled(faces, places, look),
        (_, Some(look)) => Draw::LookIndexed(faces, places, look),
        (Triangles::Pulled, None) => Draw::Pulled(faces, places),
        (Triangles::Indexed, None) => Draw::Indexed(faces, places),
        _ if places == NormalsAt::Pixels => Draw::PixelNormals(faces),
        _ if material.texture.is_some() => Draw::Textured(faces),
        _ => Draw::Plain(faces),
    }
}

/// The faces of a material that are drawn whatever hides the backs of others. Backs that show through fronts would count twice, so that
/// single-sided materials that show what is behind them have none, as glTF 2.0 says (specification, section 3.9.5). Two overlays show
/// faces from behind.
pub(super) fn own_faces(settings: &Settings, material: &Material) -> Option<Faces> {
    let Overlays { folds, back_faces, .. } = settings.overlays;
    let has_fronts_only = material.shows_behind() && !material.double_sided && !folds && !back_faces;
    has_fronts_only.then_some(Faces::Fronts)
}

/// The settings of the mesh without tessellation.
pub(super) fn undisplaced(settings: &Settings) -> Settings {
    settings.with(Tessellation { displacement: Displacement::Off, ..settings.tessellation })
}

/// How pipelines get emitted triangles.
pub(super) fn emitted_triangles(settings: &Settings) -> Triangles {
    // These overlays need data of whole triangles.
    let Overlays { wireframe, folds, colors, .. } = settings.overlays;
    if wireframe || folds || matches!(colors, Colors::TriangleSize | Colors::Deviation) {
        Triangles::Pulled
    } else if overlay_bits(&settings.overlays) != 0 {
        Triangles::Indexed
    } else {
        Triangles::Lit
    }
}

/// The pipeline for input triangles of a material, in such pictures.
pub(super) fn source_draw(settings: &Settings, mesh: &Mesh, material: &Material, kind: PictureKind) -> Draw {
    if let Some(cut) = Cut::of(settings, mesh, material, kind) {
        return Draw::Cut(Triangles::Source, Faces::Both, NormalsAt::Vertices, cut);
    }
    match Look::of(settings.overlays.colors) {
        _ if settings.shows_materials() => {
            let faces = own_faces(settings, material).unwrap_or(Faces::Both);
            Draw::LitSource(faces, Needs::of(mesh, material, &undisplaced(settings), kind).own(material, kind))
        }
        Some(look) => Draw::LookSource(look),
        None => Draw::Source,
    }
}
