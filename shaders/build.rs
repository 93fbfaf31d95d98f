//! Lists the files of this folder, for `lib.rs`.

use std::error::Error;
use std::path::Path;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = env::var("CARGO_MANIFEST_DIR")?;
    println!("cargo::rerun-if-changed={folder}");
    let paths = fs::read_dir(&folder)?.map(|entry| entry.map(|entry| entry.path())).collect::<Result<Vec<_>, _>>()?;
    let mut files: Vec<_> = paths.iter().filter(|path| path.extension().is_some_and(|own| own == "wgsl")).collect();
    files.sort();
    let text = |path: &&Path| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        format!("({name:?}, include_str!({:?})),\n", path.to_string_lossy())
    };
    let all: String = files.iter().map(|path| text(&path.as_path())).collect();
    fs::write(Path::new(&env::var("OUT_DIR")?).join("texts.rs"), format!("&[\n{all}]\n"))?;
    Ok(())
}
