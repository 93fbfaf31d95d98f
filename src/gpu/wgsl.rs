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

// Files that several passes share. A file that only one pass has is declared where that pass is.
pub(crate) static QUOTIENTS: WgslFile = WgslFile::new("quotients", &[]);
pub static FACTORS: WgslFile = WgslFile::new("factors", &[&QUOTIENTS]);
pub(crate) static DOMAIN_ROW: WgslFile = WgslFile::new("domain_row", &[&FACTORS]);
pub static RINGS: WgslFile = WgslFile::new("rings", &[]);
/// A module has it beside [`DOMAIN`].
pub static ROWS: WgslFile = WgslFile::new("rows", &[&DOMAIN_ROW, &FACTORS, &QUOTIENTS]);
pub(crate) static SUBTRIANGULATION: WgslFile = WgslFile::new("subtriangulation", &[&FACTORS]);
/// Beside it a module has [`CONNECTIVITY`] or [`CONNECTIVITY_TABLE`], which declare the same functions.
pub static DOMAIN: WgslFile = WgslFile::new("domain", &[&DOMAIN_ROW, &FACTORS, &RINGS, &ROWS, &SUBTRIANGULATION]);
pub static CONNECTIVITY: WgslFile = WgslFile::new("connectivity", &[&DOMAIN, &RINGS]);
pub static CONNECTIVITY_TABLE: WgslFile = WgslFile::new("connectivity_table", &[&DOMAIN, &RINGS]);
pub static CONVENTION: WgslFile = WgslFile::new("convention", &[&FACTORS]);
pub static SURFACE: WgslFile = WgslFile::new("surface", &[&FACTORS]);
pub static CONTROL_POINTS: WgslFile = WgslFile::new("control_points", &[&SURFACE]);
pub static CULL: WgslFile = WgslFile::new("cull", &[&LOD, &SURFACE]);
pub static OCTAHEDRAL_NORMAL: WgslFile = WgslFile::new("octahedral_normal", &[]);
pub static NORMAL: WgslFile = WgslFile::new("normal", &[&FACTORS, &SURFACE]);
pub static CURVATURE: WgslFile = WgslFile::new("curvature", &[&FACTORS, &SURFACE]);
pub static LOD: WgslFile = WgslFile::new("lod", &[]);
pub static TYPES: WgslFile = WgslFile::new("types", &[&LOD]);
pub(crate) static DISPLACEMENT_FACTOR: WgslFile = WgslFile::new("displacement_factor", &[&LOD, &TYPES]);
pub(crate) static PIECE_ERROR: WgslFile = WgslFile::new("piece_error", &[&LOD, &SURFACE]);
pub(crate) static FLAT_PATCH: WgslFile = WgslFile::new("flat_patch", &[&LOD, &PIECE_ERROR, &SURFACE]);
/// The module that has it declares the buffers that it reads.
pub(crate) static SLIDES: WgslFile = WgslFile::new("slides", &[&FLAT_PATCH, &LEAST_FACTORS, &LOAD_NET, &PIECE_ERROR]);
pub(crate) static SEARCH_GROUP: WgslFile = WgslFile::new("search_group", &[]);
/// The module that has it declares the buffers that it reads.
pub(crate) static SEARCH_STATE: WgslFile = WgslFile::new("search_state", &[&DISPLACEMENT_FACTOR]);
pub(crate) static LEAST_FACTORS: WgslFile =
    WgslFile::new("least_factors", &[&CONNECTIVITY, &DOMAIN, &FACTORS, &LOD, &PIECE_ERROR, &SEARCH_GROUP]);
pub(crate) static LEAST_ROWS: WgslFile =
    WgslFile::new("least_rows", &[&FACTORS, &LEAST_FACTORS, &PIECE_ERROR, &SEARCH_GROUP]);
pub(crate) static HEIGHT_LIST: WgslFile = WgslFile::new("height_list", &[&TYPES]);
/// The module that has it also has `HEIGHT_LIST`, or a file that declares the same functions.
pub static DISPLACE: WgslFile = WgslFile::new("displace", &[&FACTORS, &NORMAL, &SURFACE, &TYPES]);
/// The module that has it declares the buffers that it reads.
pub(crate) static DISPLACEMENT_SHARES: WgslFile = WgslFile::new("displacement_shares", &[&TYPES]);
/// The module that has it declares the buffers that it reads, and has [`LOADS`] or functions of the same names.
pub static LOAD_NET: WgslFile = WgslFile::new("load_net", &[&SURFACE, &TYPES]);
pub static LOADS: WgslFile = WgslFile::new("loads", &[&TYPES]);
pub static WORKGROUP_SCAN: WgslFile = WgslFile::new("workgroup_scan", &[&TYPES]);

impl WgslFile {
    /// The file of this name in `shaders/`, whose declarations use those of other files.
    pub const fn new(name: &'static str, needs: &'static [&'static Self]) -> Self {
        Self { name, text: shaders::text(name), needs }
    }

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
pub fn joined(files: &[&WgslFile]) -> String {
    files.iter().map(|file| file.text).collect::<Vec<_>>().join("\n")
}
