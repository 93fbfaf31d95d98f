//! The WGSL texts of pnaen: each file of this folder, by its name.

macro_rules! texts {
    ($($name:literal)*) => {
        /// The name of every file, without `.wgsl`, and its text.
        pub const TEXTS: &[(&str, &str)] = &[$(($name, include_str!(concat!($name, ".wgsl")))),*];
    };
}

texts! {
    "connectivity"
    "connectivity_table"
    "control_points"
    "convention"
    "coverage"
    "cull"
    "curvature"
    "deform"
    "displace"
    "displacement_factor"
    "displacement_shares"
    "domain"
    "domain_row"
    "draw_background"
    "draw_clear"
    "draw_density"
    "draw_ground"
    "draw_layers"
    "draw_leaks"
    "draw_light"
    "draw_lines"
    "draw_lit"
    "draw_lit_layers"
    "draw_looks"
    "draw_mask"
    "draw_material"
    "draw_normal"
    "draw_overlays"
    "draw_pick"
    "draw_plain"
    "draw_silhouette"
    "draw_surface"
    "draw_surface_color"
    "draw_surface_inputs"
    "draw_surface_layers"
    "draw_surface_vertices"
    "draw_types"
    "draw_window"
    "environment"
    "factors"
    "flat_patch"
    "height_list"
    "layers_multisampled"
    "layers_single"
    "least_factors"
    "least_rows"
    "load_net"
    "loads"
    "lod"
    "lod_contract"
    "mipmap"
    "normal"
    "octahedral_normal"
    "own_edge_factor"
    "own_edge_points"
    "own_inside_factor"
    "own_work"
    "pass_asked"
    "pass_chunks"
    "pass_counts"
    "pass_coverage"
    "pass_deform"
    "pass_displace"
    "pass_domain"
    "pass_emit"
    "pass_exported"
    "pass_factors"
    "pass_least"
    "pass_levels"
    "pass_mipmap"
    "pass_nets"
    "pass_own_lod"
    "pass_own_surface"
    "pass_prefilter"
    "pass_scan"
    "pass_uniform"
    "piece_error"
    "prefilter"
    "punctual"
    "quotients"
    "reflectance"
    "rings"
    "rows"
    "search_group"
    "search_state"
    "sheen"
    "slides"
    "stage_displaced"
    "stage_heights"
    "stage_patch"
    "subtriangulation"
    "surface"
    "surface_contract"
    "tone"
    "types"
    "workgroup_scan"
}

/// The text of `name.wgsl`. A name without a file doesn't compile where the call is a constant.
///
/// # Panics
/// If there is no such file.
pub const fn text(name: &str) -> &'static str {
    let mut i = 0;
    while i < TEXTS.len() {
        if is_same(TEXTS[i].0.as_bytes(), name.as_bytes()) {
            return TEXTS[i].1;
        }
        i += 1;
    }
    panic!("no such file of WGSL")
}

const fn is_same(a: &[u8], b: &[u8]) -> bool {
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_of_the_folder_has_its_text() {
        let folder = std::fs::read_dir(env!("CARGO_MANIFEST_DIR")).expect("the folder");
        let names = folder.map(|entry| entry.expect("an entry").file_name().into_string().expect("a name in UTF-8"));
        let mut files: Vec<_> = names.filter_map(|name| name.strip_suffix(".wgsl").map(str::to_owned)).collect();
        files.sort();
        assert_eq!(files, TEXTS.iter().map(|(name, _)| *name).collect::<Vec<_>>());
        assert!(files.iter().all(|name| text(name).ends_with('\n')));
    }
}
