//! The constants of shaders that the options of an export decide.

use geometry::tessellate::{Clip, Convention, Displacement, Edges, Lod, Normals, Partitioning, Surface, Tessellation};

/// Returns the constants that a tessellation decides, each with the name of its value, as the shaders have them.
pub(super) fn choices(own: &Tessellation) -> [(&'static str, &'static str); 10] {
    // Displaced patches may show their fronts where the surface shows its back, so they are never culled.
    let is_culled = own.cull_back_faces && own.displacement == Displacement::Off;
    [
        ("CHOSEN_SURFACE", surface_constant(own.surface)),
        ("CHOSEN_EDGES", if own.edges == Edges::PerEdge { "EDGES_PER_EDGE" } else { "EDGES_AS_PUBLISHED" }),
        ("CHOSEN_LOD", lod_constant(own.used_lod())),
        ("CHOSEN_PARTITIONING", partitioning_constant(own.partitioning)),
        ("CHOSEN_CLIP", clip_constant(own.clip)),
        ("CHOSEN_CULLING", if is_culled { "CULLING_ON" } else { "CULLING_OFF" }),
        ("CHOSEN_CONVENTION", convention_constant(own.convention)),
        ("CHOSEN_NORMALS", normals_constant(own.normals)),
        ("CHOSEN_DISPLACEMENT", displacement_constant(own.displacement)),
        ("PATCH_INDICES", if own.displacement == Displacement::Off { "9u" } else { "18u" }),
    ]
}

fn surface_constant(surface: Surface) -> &'static str {
    match surface {
        Surface::Flat => "SURFACE_FLAT",
        Surface::Pn => "SURFACE_PN",
        Surface::PnAen => "SURFACE_PN_AEN",
        Surface::PnCrease => "SURFACE_PN_CREASE",
        Surface::Phong => "SURFACE_PHONG",
        Surface::PhongAen => "SURFACE_PHONG_AEN",
        Surface::Nagata => "SURFACE_NAGATA",
        Surface::NagataAen => "SURFACE_NAGATA_AEN",
    }
}

fn lod_constant(lod: Lod) -> &'static str {
    match lod {
        Lod::Uniform => "LOD_UNIFORM",
        Lod::Paper => "LOD_PAPER",
        Lod::EdgeLength => "LOD_EDGE_LENGTH",
        Lod::Error => "LOD_ERROR",
        Lod::Distance => "LOD_DISTANCE",
    }
}

fn partitioning_constant(partitioning: Partitioning) -> &'static str {
    match partitioning {
        Partitioning::Integer => "PARTITIONING_INTEGER",
        Partitioning::Pow2 => "PARTITIONING_POW2",
        Partitioning::FractionalOdd => "PARTITIONING_FRACTIONAL_ODD",
        Partitioning::FractionalEven => "PARTITIONING_FRACTIONAL_EVEN",
        Partitioning::Subtriangulation => "PARTITIONING_SUBTRIANGULATION",
        Partitioning::Rows => "PARTITIONING_ROWS",
    }
}

fn clip_constant(clip: Clip) -> &'static str {
    match clip {
        Clip::Off => "CLIP_OFF",
        Clip::Paper => "CLIP_PAPER",
        Clip::Frustum => "CLIP_FRUSTUM",
    }
}

fn convention_constant(convention: Convention) -> &'static str {
    match convention {
        Convention::D3d11 => "CONVENTION_D3D11",
        Convention::AmdPn => "CONVENTION_AMD_PN",
        Convention::EdgeOrder => "CONVENTION_EDGE_ORDER",
        Convention::Rotated => "CONVENTION_ROTATED",
        Convention::Mirrored => "CONVENTION_MIRRORED",
    }
}

fn normals_constant(normals: Normals) -> &'static str {
    match normals {
        Normals::Linear => "NORMALS_LINEAR",
        Normals::Quadratic => "NORMALS_QUADRATIC",
        Normals::Surface => "NORMALS_SURFACE",
    }
}

fn displacement_constant(displacement: Displacement) -> &'static str {
    match displacement {
        Displacement::Off => "DISPLACEMENT_OFF",
        Displacement::On => "DISPLACEMENT_ON",
        Displacement::AsPublished => "DISPLACEMENT_AS_PUBLISHED",
        Displacement::PerPatch => "DISPLACEMENT_PER_PATCH",
    }
}
