//! The numbers of Rust's enums as constants of WGSL, so that a value is declared once.

use std::fmt::Debug;

use geometry::mesh::mipmap::MipFilter;
use geometry::mesh::{EdgeKind, Look, Slot, Wrap};
use geometry::tessellate::{Clip, Convention, CurvatureKind, Displacement, Edges, Lod, Normals, Partitioning, Surface};

/// All values of an enum, with their numbers.
macro_rules! numbered {
    ($type:ident) => {
        $type::ALL.map(|value| (value, value as u32))
    };
}

/// The constants that belong to a file: those of LOD begin with `LOD_`, such as `LOD_EDGE_LENGTH`.
pub fn enum_constants(file: &str) -> String {
    match file {
        "convention" => constants("CONVENTION", numbered!(Convention)),
        "curvature" => constants("CURVATURE", numbered!(CurvatureKind)),
        "cull" => constants("CLIP", numbered!(Clip)),
        "displace" => {
            let wraps = [Wrap::Clamp, Wrap::Repeat, Wrap::Mirror].map(|value| (value, value as u32));
            constants("DISPLACEMENT", numbered!(Displacement)) + &constants("WRAP", wraps)
        }
        "draw_material" => constants("SLOT", numbered!(Slot)) + &images(),
        "draw_surface_color" => constants("EDGE", numbered!(EdgeKind)),
        "factors" => constants("PARTITIONING", numbered!(Partitioning)),
        "lod" => constants("LOD", numbered!(Lod)),
        "mipmap" => constants("MIP", numbered!(MipFilter)),
        "normal" => constants("NORMALS", numbered!(Normals)),
        "surface" => constants("SURFACE", numbered!(Surface)),
        "types" => constants("EDGES", numbered!(Edges)),
        _ => String::new(),
    }
}

/// The binding of the image in one of the places that shaders have for those of a material beside that of the base colour. That
/// of its sampler comes next.
pub fn image_binding(place: usize) -> u32 {
    36 + 2 * place as u32
}

/// The images in these places, and what the one in a place says.
fn images() -> String {
    let (mut bound, mut cases) = (String::new(), String::new());
    for place in 0..Look::MOST_IMAGES {
        let image = image_binding(place);
        bound += &format!("@group(1) @binding({image}) var image_{place}: texture_2d<f32>;\n");
        bound += &format!("@group(1) @binding({}) var sampler_{place}: sampler;\n", image + 1);
        cases += &format!("case {place}u: {{ return image_texel(image_{place}, sampler_{place}, at); }}\n");
    }
    let otherwise = "default: { return vec4<f32>(1.0); }";
    bound
        + &format!(
            "fn placed_texel(place: u32, at: ImagePlace) -> vec4<f32> {{ switch place {{\n{cases}{otherwise}\n}} }}\n"
        )
}

/// One line for each value: the prefix and its name in capitals, and its number.
fn constants<T: Debug, const N: usize>(prefix: &str, values: [(T, u32); N]) -> String {
    let line = |(value, number): (T, u32)| {
        format!("const {prefix}_{}: u32 = {number}u;\n", in_capitals(&format!("{value:?}")))
    };
    values.map(line).concat()
}

/// `EdgeLength` as `EDGE_LENGTH`.
fn in_capitals(name: &str) -> String {
    let mut capitals = String::new();
    for (at, letter) in name.char_indices() {
        if at > 0 && letter.is_ascii_uppercase() {
            capitals.push('_');
        }
        capitals.push(letter.to_ascii_uppercase());
    }
    capitals
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_their_names_in_capitals() {
        assert_eq!(
            enum_constants("cull"),
            "const CLIP_OFF: u32 = 0u;\nconst CLIP_FRUSTUM: u32 = 1u;\nconst CLIP_PAPER: u32 = 2u;\n"
        );
        assert_eq!(["D3d11", "PnAen", "Pow2"].map(in_capitals), ["D3D11", "PN_AEN", "POW2"]);
        assert_eq!(enum_constants("tone"), "");
    }
}
