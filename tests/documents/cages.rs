//! The cage of a subdivision surface: a cube, as an OBJ file.

/// The corners of the cube.
pub const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n";

/// Its squares.
pub const QUADS: &str = "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";

/// The whole file.
pub fn cube() -> String {
    [CUBE, QUADS].concat()
}
