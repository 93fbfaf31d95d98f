//! Replacing a file: it is replaced as a whole or not at all.

use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{Folder, failure, output, run, sentence};

const OLD: &str = "what was there";

/// Writes indices over `path`.
fn writes(path: &str) -> [&str; 4] {
    ["adjacency", "shape:torus", "-o", path]
}

/// Makes a file with old contents.
fn old(folder: &Folder, name: &str) -> String {
    let path = folder.path(name);
    std::fs::write(&path, OLD).expect("a writable folder");
    path
}

fn is_old(path: &str) -> bool {
    std::fs::read_to_string(path).expect("a text") == OLD
}

fn names(folder: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect()
}

fn permit(path: &str, mode: u32) {
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode)).expect("one's own file");
}

#[test]
fn a_read_only_file_is_not_replaced() {
    let folder = Folder::new();
    let path = old(&folder, "out.json");
    permit(&path, 0o444);
    sentence(&writes(&path), &["out.json", "could not be written", "it is read-only"]);
    assert!(is_old(&path));
    permit(&path, 0o640);
    output(&writes(&path));
    assert!(!is_old(&path));
    let mode = std::fs::metadata(&path).expect("a file").permissions().mode();
    assert_eq!(mode & 0o777, 0o640, "permissions stay");
}

#[test]
fn a_read_only_folder_keeps_its_files() {
    let folder = Folder::new();
    let path = old(&folder, "out.json");
    sentence(&writes(&format!("{path}/below.json")), &["below.json", "there is no folder", "out.json"]);
    permit(&folder.path(""), 0o555);
    // The administrator may write even here.
    let may_write = std::fs::write(folder.path("tried"), "").is_ok();
    let done = run(&writes(&path));
    permit(&folder.path(""), 0o755);
    assert_eq!(done.status.code(), Some(i32::from(!may_write)));
    assert_eq!(is_old(&path), !may_write);
    assert_eq!(names(folder.0.path()).len(), 1 + usize::from(may_write), "nothing is left beside it");
}

#[test]
fn a_link_stays_a_link_and_its_target_is_written() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("there")).expect("a writable folder");
    let target = old(&folder, "there/target.json");
    let [near, far, dangling] = ["near.json", "far.json", "dangling.json"].map(|name| folder.path(name));
    for (link, names) in [(&near, "there/target.json"), (&far, "near.json"), (&dangling, "there/new.json")] {
        symlink(names, link).expect("a file system with links");
    }
    output(&writes(&far));
    assert!(!is_old(&target));
    output(&writes(&dangling));
    let whole = std::fs::read(&target).expect("a file");
    assert_eq!(std::fs::read(folder.path("there/new.json")).expect("a file"), whole);
    for link in [near, far, dangling] {
        assert!(Path::new(&link).is_symlink(), "{link}");
    }
    let circle = folder.path("circle.json");
    symlink("circle.json", &circle).expect("a file system with links");
    sentence(&writes(&format!("{circle}/below.json")), &["below.json", "there is no folder"]);
}

/// Runs the program with a limit of a few kilobytes on the size of files, after the shell command `before`.
fn with_little_room(before: &str, path: &str) -> std::process::Output {
    let script = format!("{before} ulimit -f 4; exec \"$0\" \"$@\"");
    let mut shell = Command::new("sh");
    shell.args(["-c", &script, env!("CARGO_BIN_EXE_pnaen")]).args(writes(path));
    shell.output().expect("a shell")
}

#[test]
fn a_full_disk_leaves_the_old_file_whole_and_nothing_beside_it() {
    let folder = Folder::new();
    let path = old(&folder, "out.json");
    // With the signal ignored, the limit is an error of the write, like a full disk.
    let done = with_little_room("trap '' XFSZ;", &path);
    let errors = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(1), "{errors}");
    assert!(errors.contains("out.json: could not be written") && errors.lines().count() == 1, "{errors}");
    assert!(is_old(&path));
    assert_eq!(names(folder.0.path()), [PathBuf::from(&path)]);
}

#[test]
fn a_kill_while_writing_leaves_the_old_file_whole() {
    let folder = Folder::new();
    let path = old(&folder, "out.json");
    let done = with_little_room("", &path);
    assert_eq!(done.status.code(), None, "a signal ends the program");
    assert!(is_old(&path));
    output(&writes(&path));
    assert!(!is_old(&path));
}

#[test]
fn a_command_does_not_overwrite_its_input() {
    let folder = Folder::new();
    let path = |name: &str| folder.path(name);
    let (mesh, picture, factors) = (path("in.glb"), path("in.png"), path("in.csv"));
    std::fs::copy(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/vase.glb"), &mesh).expect("a writable folder");
    image::RgbImage::new(2, 2).save(&picture).expect("a writable folder");
    run(&["factors", &mesh, "-o", &factors, "--device", "cpu"]);
    symlink(&mesh, path("link.glb")).expect("a writable folder");
    let link = path("link.glb");
    let before = [&mesh, &picture, &factors].map(|path| std::fs::read(path).expect("a file"));
    let out = path("out.png");
    let read: [&[&str]; 8] = [
        &["tessellate", &mesh, "-o", &mesh],
        &["tessellate", &mesh, "-o", &link],
        &["render", &mesh, "-o", &out, "--stats", &mesh],
        &["render", &mesh, "-o", &picture, "--height", &picture],
        &["render", &mesh, "-o", &out, "--factors", &factors, "--stats", &factors],
        &["render", "shape:torus", "-o", &out, "--reference-surface", &mesh, "--stats", &mesh],
        &["factors", &mesh, "-o", &mesh],
        &["chart", &mesh, "-o", &out, "--csv", &mesh],
    ];
    for arguments in read {
        sentence(arguments, &[" is read by the same command"]);
    }
    sentence(&["render", "shape:torus", "-o", &out, "--stats", &out], &["out.png is written by the same command"]);
    sentence(&["chart", "shape:torus", "-o", &out, "--csv", &out], &["out.png is written by the same command"]);
    assert_eq!([&mesh, &picture, &factors].map(|path| std::fs::read(path).expect("a file")), before);
    assert!(!Path::new(&out).exists(), "nothing was written");
    // Files that the mesh's file refers to are inputs as well.
    let (parts, buffer) = (path("parts.gltf"), path("parts.bin"));
    std::fs::write(
        &buffer,
        [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
            .as_flattened()
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect::<Vec<_>>(),
    )
    .expect("a writable folder");
    let document = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"parts.bin"}]}"#;
    std::fs::write(&parts, document).expect("a writable folder");
    let before = std::fs::read(&buffer).expect("a file");
    for arguments in [&["factors", &parts, "-o", &buffer][..], &["render", &parts, "-o", &out, "--stats", &buffer]] {
        let said = failure(arguments, 1);
        assert!(said.contains("parts.bin is read by the same command"), "{said}");
    }
    assert_eq!(std::fs::read(&buffer).expect("a file"), before);
}
