//! What the files of an export say about themselves: the comment at the top of each, and README.md.

use super::displaced::Relief;
use super::{Export, Language};
use crate::settings::Choice;
use geometry::names;
use geometry::tessellate::{Displacement, Edges, Lod, Tessellation};

/// The numbers of the constant buffer: offset in bytes, name, and what it is.
fn constants(own: &Tessellation) -> Vec<(u32, &'static str, String)> {
    let view = "what LOD and culling are computed for; depth is reversed, 1 at the near plane";
    let reach = match own.displacement.is_on() {
        false => "0",
        true => {
            "the largest distance by which displacement moves a point, in object units: the largest of `scale` * (height - \
             `midlevel`), without its sign"
        }
    };
    vec![
        (0, "clip_from_object", "4x4 matrix, column after column: what vertices are drawn with".to_owned()),
        (64, "view.clip_from_object", format!("4x4 matrix, column after column: {view}")),
        (128, "view.half_viewport", "half the width and half the height of the view, in px".to_owned()),
        (136, "view.reach", reach.to_owned()),
        (144, "view.eye", "3 numbers: where the camera is, in object units".to_owned()),
        (156, "view.radius", format!("the bounding radius in object units: {BOUNDING_RADIUS}")),
        (
            160,
            "factor",
            format!("here {}: the factor of uniform LOD, and the largest of LOD by distance, 1 to 64", own.factor),
        ),
        (164, "pixels_per_segment", format!("here {}: the length of a segment on screen, in px", own.pixels)),
        (168, "near", format!("here {}: the distance up to which edges get `factor`, in bounding radii", own.near)),
        (172, "far", format!("here {}: the distance from which on edges get 1, in bounding radii", own.far)),
        (176, "alpha", format!("here {}: the strength of Phong tessellation, 0 to 1", own.alpha)),
    ]
}

/// What a bounding radius is.
const BOUNDING_RADIUS: &str = "the greatest distance of a corner from the middle of the bounding box";

/// The size of the constant buffer in bytes.
const CONSTANTS_BYTES: u32 = 192;

/// The numbers of the constant buffer of displacement.
fn height_constants(own: &Tessellation) -> Vec<(u32, &'static str, String)> {
    let scale =
        format!("how far white is above black, in object units: here {} times the bounding radius", own.height_scale);
    vec![
        (0, "size", "2 whole numbers: width and height of the image's level 0, in px".to_owned()),
        (8, "levels", "whole number: how many mip levels it has".to_owned()),
        (12, "wrap", "whole number: beyond it 0 border, 1 again, 2 mirrored; along u + 4 times along v".to_owned()),
        (16, "scale", scale),
        (20, "midlevel", format!("here {}: the height, 0 to 1, that stays where it is", own.midlevel)),
    ]
}

/// The size of that buffer in bytes.
const HEIGHT_CONSTANTS_BYTES: u32 = 32;

/// What displacement needs of every corner.
fn relief_text(relief: Relief) -> String {
    let last = match relief {
        Relief::LodByView => "a number that is read under uniform LOD alone",
        Relief::Off | Relief::UniformLod => "the length of the point's shortest edge in px of the image's level 0",
    };
    format!(
        "40 bytes a corner: the unit vector along which its point moves (3 numbers), the gradients of both texture coordinates in \
         1 / object unit (3 and 3), and {last}"
    )
}

/// What the third vertex buffer holds where a compute shader of its own finds the levels at points, and the name of its file.
fn levels_text(export: &Export) -> Option<String> {
    let file = match export.language {
        _ if export.relief() != Relief::LodByView => return None,
        Language::Hlsl => "levels.hlsl",
        Language::Glsl => "levels.comp",
        // The passes keep levels in a buffer of their own.
        Language::Wgsl => return None,
    };
    Some(format!(
        "4 bytes a corner, a 32-bit whole number: at the dominant corner of a point the mip level there, which {file} writes"
    ))
}

/// The height image.
const IMAGE_TEXT: &str = "one number a px, 0 to 1, in a texture with all mip levels down to 1 x 1 px; texels are fetched, so it needs no filter";

/// Which corners a patch's indices are.
fn index_text(export: &Export) -> &'static str {
    match export.indices() {
        18 => {
            "18 a patch: its corners 0, 1, 2; the two corners that the neighbour has along side 0-1, along 1-2 and along 2-0, in the \
             patch's own direction; the dominant corners on the points of its corners; and the two corners of each edge's dominant \
             side, in the patch's own direction (`pnaen adjacency FILE --indices 18 -o OUT.bin --height IMAGE --corners \
             CORNERS.bin`)"
        }
        9 => {
            "9 a patch: its corners 0, 1, 2, then the two corners that the neighbour has along side 0-1, along 1-2 and along 2-0, \
             in the patch's own direction; at a boundary the patch's own corners (`pnaen adjacency FILE --indices 9 -o OUT.bin`)"
        }
        _ => "3 a patch: the mesh's own index buffer",
    }
}

/// The tessellation in words.
fn title(own: &Tessellation) -> String {
    let edges =
        if own.edges == Edges::PerEdge { "shared edges computed once" } else { "every edge computed by each patch" };
    let displaced = match own.displacement.is_on() {
        false => String::new(),
        true => format!(", displacement {}", own.displacement.name()),
    };
    let is_culled = own.cull_back_faces && !own.displacement.is_on();
    format!(
        "surface {}, LOD {}, partitioning {}, clipping {}, back faces {}, convention {}, {} normals, {edges}{displaced}",
        own.surface.name(),
        own.used_lod().name(),
        own.partitioning.name(),
        own.clip.name(),
        if is_culled { "culled" } else { "kept" },
        own.convention.name(),
        own.normals.name(),
    )
}

/// Returns the comment at the top of every file.
pub(super) fn header(export: &Export) -> String {
    let own = export.tessellation;
    let mut lines = vec![
        "SPDX-License-Identifier: MIT OR Apache-2.0".to_owned(),
        "Copyright (c) 2026 the pnaen authors. You may use this file under either licence, at your option.".to_owned(),
        String::new(),
        format!("Made by pnaen {}: {}", env!("CARGO_PKG_VERSION"), export.command),
    ];
    lines.extend(wrapped(&title(own)));
    lines.push(String::new());
    lines.push("Vertex buffer: 32 bytes a corner: position (3 numbers, object units), unit normal (3), texture coordinates (2).".to_owned());
    lines.extend(wrapped(&format!("Index buffer: 32-bit numbers, {}.", index_text(export).replace('`', ""))));
    if export.relief() != Relief::Off {
        lines.extend(wrapped(&format!("Second vertex buffer: {}.", relief_text(export.relief()))));
        lines.extend(levels_text(export).iter().flat_map(|text| wrapped(&format!("Third vertex buffer: {text}."))));
        lines.extend(wrapped(&format!("Height image: {IMAGE_TEXT}.")));
    }
    lines.push(format!("Constant buffer: {CONSTANTS_BYTES} bytes, std140. Offsets in bytes:"));
    lines.extend(listed(&constants(own)));
    if export.relief() != Relief::Off {
        lines.push(format!("Second constant buffer: {HEIGHT_CONSTANTS_BYTES} bytes, std140. Offsets in bytes:"));
        lines.extend(listed(&height_constants(own)));
    }
    lines.iter().map(|line| format!("// {line}").trim_end().to_owned() + "\n").collect()
}

/// The lines that list the numbers of a constant buffer.
fn listed(constants: &[(u32, &'static str, String)]) -> Vec<String> {
    let of = |(offset, name, text): &(u32, &'static str, String)| {
        let own = wrapped(&format!("{offset} {name}: {}", text.replace('`', "")));
        let indented = |(i, line): (usize, String)| format!("{}{line}", if i == 0 { "  " } else { "    " });
        own.into_iter().enumerate().map(indented).collect::<Vec<_>>()
    };
    constants.iter().flat_map(of).collect()
}

/// Breaks a text into the lines of a comment.
fn wrapped(text: &str) -> Vec<String> {
    names::wrapped(text, 112)
}

/// Returns README.md.
pub(super) fn text(export: &Export) -> String {
    let own = export.tessellation;
    let (name, host) = match export.language {
        Language::Hlsl => ("HLSL for Direct3D 11 and 12", include_str!("templates/hlsl.md")),
        Language::Glsl => ("GLSL for Vulkan and OpenGL", include_str!("templates/glsl.md")),
        Language::Wgsl => ("WGSL for WebGPU", include_str!("templates/wgsl.md")),
    };
    let relief = if export.relief() == Relief::Off { String::new() } else { displaced_text(export) };
    let lod = match own.used_lod() {
        Lod::Uniform => "LOD is uniform: of the constants it reads `factor`.",
        Lod::Distance => "LOD by distance reads `factor`, `near`, `far`, `view.eye` and `view.radius`.",
        Lod::EdgeLength if export.relief() != Relief::Off => {
            "LOD reads `pixels_per_segment`, `view.clip_from_object`, `view.half_viewport` and `view.reach`."
        }
        Lod::EdgeLength | Lod::Paper => {
            "LOD reads `pixels_per_segment`, `view.clip_from_object` and `view.half_viewport`."
        }
        Lod::Error => "LOD by error can't be exported.",
    };
    let edges = match own.edges {
        Edges::AsPublished => {
            "Each patch computes its edges for itself, as published: the sides of an edge differ in their last bits."
        }
        Edges::PerEdge if own.surface.tears() => {
            "The surface tears where the sides of an edge have different normals. Elsewhere both sides compute an edge in the same \
             direction, from the end that comes first by x, y and z, and get the same bits."
        }
        Edges::PerEdge => {
            "Both sides compute an edge in the same direction, from the end that comes first by x, y and z, and get the same bits, if \
             the tessellator puts points at t and at 1 - t. An edge of three triangles or more has no neighbours in the index \
             buffer: its sides follow their own normals."
        }
    };
    format!(
        "# Tessellation shaders: {name}\n\nMade by pnaen {}: `{}`\n\n{}. All parts of a mesh have the same: styles of `--part` aren't \
         exported.\n\n{lod} {edges}\n\n## Buffers\n\nVertex buffer, 32 bytes \
         a corner: position (3 x f32, object units), unit normal (3 x f32), texture coordinates (2 x f32).\n\nIndex buffer, u32: \
         {}.\n\nConstant buffer, {CONSTANTS_BYTES} bytes:\n\n{}\n{relief}{}\n## Licence\n\nMIT OR Apache-2.0, at your option. \
         Copyright (c) 2026 the pnaen authors.\n",
        env!("CARGO_PKG_VERSION"),
        export.command,
        title(own),
        index_text(export),
        table(&constants(own)),
        export.relief().chosen_lines(host).replace("@INDICES@", &export.indices().to_string()),
    )
}

/// A constant buffer as a Markdown table.
fn table(constants: &[(u32, &'static str, String)]) -> String {
    let row = |(offset, name, text): &(u32, &'static str, String)| format!("| {offset} | `{name}` | {text} |\n");
    let rows: String = constants.iter().map(row).collect();
    format!("| offset in bytes | name | what it is |\n| ---: | --- | --- |\n{rows}")
}

/// What README.md says of displacement.
fn displaced_text(export: &Export) -> String {
    let own = export.tessellation;
    let agreement = match own.displacement {
        Displacement::Off => "",
        Displacement::On => {
            "Patches agree on the height and on the direction of what they share, so that displacement opens no cracks."
        }
        Displacement::AsPublished => {
            "Patches agree on the height of what they share, and move along their own normals: split normals crack."
        }
        Displacement::PerPatch => {
            "Patches read heights at their own texture coordinates and move along their own normals: texture seams and split normals \
             crack."
        }
    };
    include_str!("templates/displaced.md")
        .replace("@CORNERS@", &relief_text(export.relief()))
        .replace("@IMAGE@", IMAGE_TEXT)
        .replace("@BYTES@", &HEIGHT_CONSTANTS_BYTES.to_string())
        .replace("@CONSTANTS@\n", &table(&height_constants(own)))
        .replace("@AGREEMENT@", agreement)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader_files::STAGES;

    /// The size of a struct of the shaders, and the places of its members, in bytes.
    fn members(name: &str) -> (u32, Vec<(u32, String)>) {
        let module = naga::front::wgsl::parse_str(&STAGES.text()).expect("valid WGSL");
        let (_, own) = module.types.iter().find(|(_, own)| own.name.as_deref() == Some(name)).expect("the struct");
        let naga::TypeInner::Struct { members, span } = &own.inner else { panic!("{name} is no struct") };
        (*span, members.iter().map(|member| (member.offset, member.name.clone().unwrap_or_default())).collect())
    }

    #[test]
    fn constants_lie_where_the_files_say() {
        let (size, outer) = members("StageConstants");
        let (_, view) = members("LodView");
        let mut expected = Vec::new();
        for (offset, name) in outer {
            if name == "view" {
                expected.extend(view.iter().map(|(inner, name)| (offset + inner, format!("view.{name}"))));
            } else {
                expected.push((offset, name));
            }
        }
        let said = constants(&Tessellation::default());
        assert!(said.iter().map(|(offset, name, _)| (*offset, (*name).to_owned())).eq(expected));
        assert_eq!(size, CONSTANTS_BYTES);
        let (size, expected) = members("HeightConstants");
        let said = height_constants(&Tessellation::default());
        assert!(said.iter().map(|(offset, name, _)| (*offset, (*name).to_owned())).eq(expected));
        // A uniform buffer's size is a multiple of 16.
        assert_eq!(size.next_multiple_of(16), HEIGHT_CONSTANTS_BYTES);
    }

    #[test]
    fn the_bounding_radius_is_that_of_the_glossary() {
        let page = documents::in_repository("docs/manual/glossary.md");
        let glossary = std::fs::read_to_string(page).expect("a page").to_lowercase();
        let said = constants(&Tessellation::default()).into_iter().find(|(_, name, _)| *name == "view.radius");
        let said = said.expect("the constant").2;
        assert!(
            said.contains(BOUNDING_RADIUS) && glossary.contains(&format!("| bounding radius | {BOUNDING_RADIUS}")),
            "{said}"
        );
    }

    #[test]
    fn long_lines_are_wrapped_between_words() {
        let text = "one two three ".repeat(30);
        let lines = wrapped(text.trim_end());
        assert!(lines.iter().all(|line| line.len() <= 112 && !line.ends_with(' ')), "{lines:?}");
        assert_eq!(lines.join(" "), text.trim_end());
    }
}
