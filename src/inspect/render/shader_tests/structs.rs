//! Tests that every struct in both Rust and WGSL has the same size, and the same fields at the same offsets.

use std::mem::{offset_of, size_of};

use super::modules;
use crate::for_tests::reflectance::LookAt;
use crate::render::coverage::Sieve;
use crate::render::environment::Surroundings;
use crate::render::irradiance::LightPart;
use crate::render::layout::{Frame, MapPlace, Material, Pick};
use crate::render::mipmap_pass::MipParams;
use crate::render::prefilter_pass::PrefilterParams;
use crate::render::punctual::PunctualLight;
use geometry::tessellate::CoverageView;
use gpu::DomainParams;
use gpu::layout::{
    Binding, Chunk, Corner, CornerDetail, Curve, CurveNet, Delta, DrawArgs, EmitArgs, HeightMap, JointMatrix, LodView,
    Params, Patch, PatchFactors, PatchRelief, Share, Slab, Vertex,
};

/// The size of a struct in WGSL, and the name and offset of each member.
fn wgsl_struct(name: &str) -> (usize, Vec<(String, usize)>) {
    let found = modules().iter().find_map(|(_, module)| {
        module.types.iter().find_map(|(_, ty)| match &ty.inner {
            naga::TypeInner::Struct { members, span } if ty.name.as_deref() == Some(name) => {
                let member = |m: &naga::StructMember| (m.name.clone().unwrap_or_default(), m.offset as usize);
                Some((*span as usize, members.iter().map(member).collect()))
            }
            _ => None,
        })
    });
    found.unwrap_or_else(|| panic!("no shader has a struct {name}"))
}

/// Compares a Rust struct with the WGSL struct of its name: all members of both, except the padding that Rust spells out.
macro_rules! same {
    ($name:ident { $($field:ident),* $(,)? }) => {
        let (size, members) = wgsl_struct(stringify!($name));
        assert_eq!(size, size_of::<$name>(), "size of {}", stringify!($name));
        let rust = vec![$((stringify!($field).to_owned(), offset_of!($name, $field))),*];
        assert_eq!(members, rust, "members of {}", stringify!($name));
    };
}

#[test]
fn shared_structs_have_the_same_layout() {
    same!(Binding { position, first_delta, normal, delta_count, joints, weights });
    same!(Delta { position, weight, normal, tangent });
    same!(JointMatrix { x, y, z });
    same!(LodView { clip_from_object, half_viewport, reach, eye, radius });
    same!(Params {
        view,
        factor,
        pixels_per_segment,
        surface,
        partitioning,
        lod,
        clip,
        point_count,
        patch_count,
        factor_count,
        curve_count,
        edges,
        tolerance,
        near,
        far,
        culls_back,
        convention,
        alpha,
        normals,
        displacement,
        height_scale,
        midlevel,
        chosen_surface,
    });
    same!(Share { direction, level, dominant });
    same!(PatchRelief { form, longest, range, slope, losses });
    same!(HeightMap { size, levels, start, wrap, has_amount, scale, midlevel });
    same!(Patch { points, corners, curves, factors });
    same!(Corner { normal, uv });
    same!(CornerDetail { uvs, color, tangent });
    same!(Curve { points, first_side, side_count });
    same!(CurveNet { ab, ba });
    same!(PatchFactors { outside, inside });
    same!(Chunk { first_patch, patch_end, first_vertex, first_triangle, vertex_count, triangle_count });
    same!(EmitArgs { vertices, triangles, displaced });
    same!(DrawArgs {
        index_count,
        instance_count,
        first_index,
        base_vertex,
        first_instance,
        pull_vertex_count,
        pull_instance_count,
        pull_first_vertex,
        pull_first_instance,
    });
    same!(DomainParams { partitioning, set_count });
    same!(Frame {
        clip_from_object,
        key_light,
        fill_light,
        eye,
        viewport,
        overlays,
        ulp,
        convention,
        scale_least,
        scale_most,
        px_per_unit,
        ground,
        scale,
        left,
        coarseness,
        shift,
        kind,
        zebra_axis,
        zebra_stripes,
        checker_squares,
    });
    same!(LightPart { direction, light });
    same!(Surroundings { light_from_object, brightness, exposure, tone_curve });
    same!(PunctualLight { origin, intensity, inverse_range, direction, cone_scale, cone_offset });
    same!(LookAt {
        base_color,
        metallic,
        specular_color,
        specular,
        coat_normal,
        coat,
        direction,
        anisotropy,
        roughness,
        coat_roughness,
        ior,
        occlusion,
        sheen_color,
        transmission,
        sheen_roughness,
        sheen_albedo,
    });
    same!(PrefilterParams { roughness, sample_count, size, source_size });
    same!(MipParams {
        source_size,
        target_size,
        source_start,
        source_stride,
        target_start,
        target_stride,
        level,
        mip_filter,
        least_alpha,
        wanted,
    });
    same!(CoverageView { clip_from_object, slack, viewport, sample_count, fronts_only, snap });
    same!(Material {
        base_color,
        emissive,
        metallic,
        specular_color,
        roughness,
        ior,
        specular,
        coat,
        coat_roughness,
        normal_scale,
        occlusion_strength,
        cutoff,
        unlit,
        blends,
        transmission,
        coat_normal_scale,
        anisotropy,
        sheen_color,
        sheen_roughness,
        absorption,
        thickness,
        anisotropy_direction,
        maps,
    });
    same!(MapPlace { u, v });
    same!(Sieve { view, triangle_count, material_count, first_draw });
    same!(Pick { vertices, found, patch_index, triangle, weight });
    same!(Slab {
        first_patch,
        patch_count,
        vertex_capacity,
        triangle_capacity,
        chunk_vertices,
        chunk_triangles,
        chunk_capacity,
        material_count,
    });
}

#[test]
fn a_vertex_is_eight_words() {
    // In WGSL a vector of three would start at a multiple of 16, so position and key are scalars there.
    let (size, members) = wgsl_struct("Vertex");
    assert_eq!(size, size_of::<Vertex>());
    let [position, key] = [offset_of!(Vertex, position), offset_of!(Vertex, key)];
    let rust = [
        ("x", position),
        ("y", position + 4),
        ("z", position + 8),
        ("normal", offset_of!(Vertex, normal)),
        ("key0", key),
        ("key1", key + 4),
        ("uv", offset_of!(Vertex, uv)),
    ];
    assert_eq!(members, rust.map(|(name, offset)| (name.to_owned(), offset)));
}
