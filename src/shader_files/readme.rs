//! What the files of an export say about themselves: the comment at the top of each, and README.md.

use super::{Export, Language};
use crate::settings::Choice;
use crate::tessellate::{Edges, Lod, Tessellation};

/// The numbers of the constant buffer: offset in bytes, name, and what it is.
fn constants(own: &Tessellation) -> Vec<(u32, &'static str, String)> {
    let view = "what LOD and culling are computed for; depth is reversed, 1 at the near plane";
    vec![
        (0, "clip_from_object", "4x4 matrix, column after column: what vertices are drawn with".to_owned()),
        (64, "view.clip_from_object", format!("4x4 matrix, column after column: {view}")),
        (128, "view.half_viewport", "half the width and half the height of the view, in px".to_owned()),
        (136, "view.reach", "0".to_owned()),
        (144, "view.eye", "3 numbers: where the camera is, in object units".to_owned()),
        (156, "view.radius", "half the diagonal of the mesh's bounding box, in object units".to_owned()),
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

/// The size of the constant buffer in bytes.
const CONSTANTS_BYTES: u32 = 192;

/// Which corners a patch's indices are.
fn index_text(export: &Export) -> &'static str {
    match export.indices() {
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
    format!(
        "surface {}, LOD {}, partitioning {}, clipping {}, back faces {}, convention {}, {} normals, {edges}",
        own.surface.name(),
        own.used_lod().name(),
        own.partitioning.name(),
        own.clip.name(),
        if own.cull_back_faces { "culled" } else { "kept" },
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
    lines.push(format!("Constant buffer: {CONSTANTS_BYTES} bytes, std140. Offsets in bytes:"));
    for (offset, name, text) in constants(own) {
        let own = wrapped(&format!("{offset} {name}: {}", text.replace('`', "")));
        lines.extend(own.iter().enumerate().map(|(i, line)| format!("{}{line}", if i == 0 { "  " } else { "    " })));
    }
    lines.iter().map(|line| format!("// {line}").trim_end().to_owned() + "\n").collect()
}

/// Breaks a text into lines of at most 112 characters.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.last_mut().filter(|line| line.len() + 1 + word.len() <= 112);
        match last {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) => *line += &format!(" {word}"),
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Returns README.md.
pub(super) fn text(export: &Export) -> String {
    let own = export.tessellation;
    let (name, host) = match export.language {
        Language::Hlsl => ("HLSL for Direct3D 11 and 12", include_str!("templates/hlsl.md")),
        Language::Glsl => ("GLSL for Vulkan and OpenGL", include_str!("templates/glsl.md")),
        Language::Wgsl => ("WGSL for WebGPU", include_str!("templates/wgsl.md")),
    };
    let rows: String =
        constants(own).iter().map(|(offset, name, text)| format!("| {offset} | `{name}` | {text} |\n")).collect();
    let lod = match own.used_lod() {
        Lod::Uniform => "LOD is uniform: of the constants it reads `factor`.",
        Lod::Distance => "LOD by distance reads `factor`, `near`, `far`, `view.eye` and `view.radius`.",
        _ => "LOD reads `pixels_per_segment`, `view.clip_from_object` and `view.half_viewport`.",
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
        "# Tessellation shaders: {name}\n\nMade by pnaen {}: `{}`\n\n{}.\n\n{lod} {edges}\n\n## Buffers\n\nVertex buffer, 32 bytes \
         a corner: position (3 x f32, object units), unit normal (3 x f32), texture coordinates (2 x f32).\n\nIndex buffer, u32: \
         {}.\n\nConstant buffer, {CONSTANTS_BYTES} bytes:\n\n| offset in bytes | name | what it is |\n| ---: | --- | --- \
         |\n{rows}\n{}\n## Licence\n\nMIT OR Apache-2.0, at your option. Copyright (c) 2026 the pnaen authors.\n",
        env!("CARGO_PKG_VERSION"),
        export.command,
        title(own),
        index_text(export),
        host.replace("@INDICES@", &export.indices().to_string()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader_files::STAGE_PATCH;

    /// The size of a struct of the shaders, and the places of its members, in bytes.
    fn members(name: &str) -> (u32, Vec<(u32, String)>) {
        let module = naga::front::wgsl::parse_str(&STAGE_PATCH.module_text()).expect("valid WGSL");
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
    }

    #[test]
    fn long_lines_are_wrapped_between_words() {
        let text = "one two three ".repeat(30);
        let lines = wrapped(text.trim_end());
        assert!(lines.iter().all(|line| line.len() <= 112 && !line.ends_with(' ')), "{lines:?}");
        assert_eq!(lines.join(" "), text.trim_end());
    }
}
