//! The WGSL files that passes are made of, and how a shader module is put together from them.

/// One file of `shaders/`.
///
/// WGSL has no imports: a module is one text. Declarations may stand in any order, and names are unique across all files, so a
/// module is the text of its files, one after another.
pub struct WgslFile {
    /// The file's name without its folder and `.wgsl`.
    pub name: &'static str,
    pub text: &'static str,
    /// The files that declare what this one uses.
    pub needs: &'static [&'static WgslFile],
}

/// A [`WgslFile`] by its name, with the statics of the files that it needs.
macro_rules! wgsl {
    ($name:literal $(, $needed:path)* $(,)?) => {
        $crate::gpu::WgslFile {
            name: $name,
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", $name, ".wgsl")),
            needs: &[$(&$needed),*],
        }
    };
}
pub(crate) use wgsl;

// Files that several passes share. A file that only one pass has is declared where that pass is.
pub(crate) static QUOTIENTS: WgslFile = wgsl!("quotients");
pub(crate) static FACTORS: WgslFile = wgsl!("factors", QUOTIENTS);
pub(crate) static DOMAIN_ROW: WgslFile = wgsl!("domain_row", FACTORS);
pub(crate) static RINGS: WgslFile = wgsl!("rings");
/// A module has it beside [`DOMAIN`].
pub(crate) static ROWS: WgslFile = wgsl!("rows", DOMAIN_ROW, FACTORS, QUOTIENTS);
pub(crate) static SUBTRIANGULATION: WgslFile = wgsl!("subtriangulation", FACTORS);
/// Beside it a module has [`CONNECTIVITY`] or [`CONNECTIVITY_TABLE`], which declare the same functions.
pub(crate) static DOMAIN: WgslFile = wgsl!("domain", DOMAIN_ROW, FACTORS, RINGS, ROWS, SUBTRIANGULATION);
pub(crate) static CONNECTIVITY: WgslFile = wgsl!("connectivity", DOMAIN, RINGS);
pub(crate) static CONNECTIVITY_TABLE: WgslFile = wgsl!("connectivity_table", DOMAIN, RINGS);
pub(crate) static CONVENTION: WgslFile = wgsl!("convention", FACTORS);
pub(crate) static SURFACE: WgslFile = wgsl!("surface", FACTORS);
pub(crate) static CONTROL_POINTS: WgslFile = wgsl!("control_points", SURFACE);
pub(crate) static CULL: WgslFile = wgsl!("cull", LOD, SURFACE);
pub(crate) static OCTAHEDRAL_NORMAL: WgslFile = wgsl!("octahedral_normal");
pub(crate) static NORMAL: WgslFile = wgsl!("normal", FACTORS, SURFACE);
pub(crate) static CURVATURE: WgslFile = wgsl!("curvature", FACTORS, SURFACE);
pub(crate) static LOD: WgslFile = wgsl!("lod");
pub(crate) static TYPES: WgslFile = wgsl!("types", LOD);
pub(crate) static DISPLACEMENT_FACTOR: WgslFile = wgsl!("displacement_factor", LOD, TYPES);
pub(crate) static PIECE_ERROR: WgslFile = wgsl!("piece_error", LOD, SURFACE);
pub(crate) static FLAT_PATCH: WgslFile = wgsl!("flat_patch", LOD, PIECE_ERROR, SURFACE);
/// The module that has it declares the buffers that it reads.
pub(crate) static SLIDES: WgslFile = wgsl!("slides", FLAT_PATCH, LEAST_FACTORS, LOAD_NET, PIECE_ERROR);
pub(crate) static SEARCH_GROUP: WgslFile = wgsl!("search_group");
/// The module that has it declares the buffers that it reads.
pub(crate) static SEARCH_STATE: WgslFile = wgsl!("search_state", DISPLACEMENT_FACTOR);
pub(crate) static LEAST_FACTORS: WgslFile =
    wgsl!("least_factors", CONNECTIVITY, DOMAIN, FACTORS, LOD, PIECE_ERROR, SEARCH_GROUP);
pub(crate) static LEAST_ROWS: WgslFile = wgsl!("least_rows", FACTORS, LEAST_FACTORS, PIECE_ERROR, SEARCH_GROUP);
pub(crate) static HEIGHT_LIST: WgslFile = wgsl!("height_list", TYPES);
/// The module that has it also has [`HEIGHT_LIST`], or a file that declares the same functions.
pub(crate) static DISPLACE: WgslFile = wgsl!("displace", FACTORS, NORMAL, SURFACE, TYPES);
/// The module that has it declares the buffers that it reads.
pub(crate) static DISPLACEMENT_SHARES: WgslFile = wgsl!("displacement_shares", TYPES);
/// The module that has it declares the buffers that it reads, and has [`LOADS`] or functions of the same names.
pub(crate) static LOAD_NET: WgslFile = wgsl!("load_net", SURFACE, TYPES);
pub(crate) static LOADS: WgslFile = wgsl!("loads", TYPES);
pub(crate) static WORKGROUP_SCAN: WgslFile = wgsl!("workgroup_scan", TYPES);

impl WgslFile {
    /// The files of the module whose entry points are in this file: this one, and whatever it needs directly or through others.
    /// Each is there once, after those that it needs.
    pub fn module_files(&'static self) -> Vec<&'static Self> {
        let mut files = Vec::new();
        self.add_to(&mut files);
        files
    }

    fn add_to(&'static self, files: &mut Vec<&'static Self>) {
        if files.iter().all(|file| file.name != self.name) {
            self.needs.iter().for_each(|needed| needed.add_to(files));
            files.push(self);
        }
    }

    /// The text of that module.
    pub fn module_text(&'static self) -> String {
        joined(&self.module_files())
    }
}

/// One text of these files.
pub(crate) fn joined(files: &[&WgslFile]) -> String {
    files.iter().map(|file| file.text).collect::<Vec<_>>().join("\n")
}
