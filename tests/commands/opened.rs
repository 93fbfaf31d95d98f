//! Which files the program opens for a model whose names lead outside its folder, as `strace` sees it. `setup.sh` installs that. A system
//! that lets no program trace another can't run this test; it says so.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::json;

use crate::Folder;

/// A folder with a model's folder in it, and with files beside that, to which the model's names lead.
struct Models {
    folder: Folder,
    model: PathBuf,
    /// What the model calls them.
    names: Vec<String>,
}

impl Models {
    fn new() -> Self {
        let folder = Folder::new();
        // Without links, as the system's own list of open files has it.
        let root = folder.0.path().canonicalize().expect("a folder");
        let (model, secrets) = (root.join("model"), root.join("secrets"));
        for made in [&model, &secrets] {
            std::fs::create_dir(made).expect("a writable folder");
        }
        let outside = [root.join("secret.png"), secrets.join("secret.png"), secrets.join("secret.mtl")];
        for path in &outside {
            let color = image::RgbImage::from_pixel(1, 1, image::Rgb([255, 0, 0]));
            match path.extension() {
                Some(ending) if ending == "png" => color.save(path).expect("a picture"),
                _ => std::fs::write(path, "newmtl wood\nKd 1 0 0\n").expect("a file"),
            }
        }
        std::os::unix::fs::symlink(&outside[1], model.join("link.png")).expect("a link");
        std::os::unix::fs::symlink(&secrets, model.join("folder")).expect("a link");
        std::os::unix::fs::symlink(&outside[2], model.join("link.mtl")).expect("a link");
        let absolute = outside[1].display().to_string();
        let names = vec![
            "../secret.png".to_owned(),
            "..%2Fsecret.png".to_owned(),
            "%2e%2e/secret.png".to_owned(),
            "..\\secret.png".to_owned(),
            "folder/../../secret.png".to_owned(),
            "folder/secret.png".to_owned(),
            "link.png".to_owned(),
            format!("file://{absolute}"),
            absolute.replace('/', "%2F"),
            absolute,
        ];
        Self { folder, model, names }
    }

    fn write(&self, name: &str, text: &str) -> String {
        let path = self.model.join(name);
        std::fs::write(&path, text).expect("a writable folder");
        path.display().to_string()
    }

    /// A glTF document of a triangle for every name, whose material has that as its image.
    fn gltf(&self) -> String {
        let positions: Vec<u8> =
            [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
        std::fs::write(self.model.join("own.bin"), &positions).expect("a writable folder");
        let each = 0..self.names.len();
        let document = json!({
            "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
            "meshes": [{ "primitives": each.clone().map(|i| json!({
                "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "material": i,
            })).collect::<Vec<_>>() }],
            "materials": each.clone().map(|i| json!({
                "pbrMetallicRoughness": { "baseColorTexture": { "index": i } },
            })).collect::<Vec<_>>(),
            "textures": each.map(|i| json!({ "source": i })).collect::<Vec<_>>(),
            "images": self.names.iter().map(|name| json!({ "uri": name })).collect::<Vec<_>>(),
            "accessors": [
                { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" },
                { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2" },
            ],
            "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
            "buffers": [{ "byteLength": 36, "uri": "own.bin" }],
        });
        self.write("outside.gltf", &document.to_string())
    }

    /// An OBJ file with a material file for every name, and with one of its own whose materials have them as textures.
    fn obj(&self) -> String {
        let own = |(i, name): (usize, &String)| format!("newmtl own{i}\nmap_Kd {name}\n");
        self.write("own.mtl", &self.names.iter().enumerate().map(own).collect::<String>());
        let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nmtllib own.mtl link.mtl\n".to_owned();
        for (i, name) in self.names.iter().enumerate() {
            text += &format!("mtllib {}\nusemtl own{i}\nf 1/1 2/1 3/1\n", name.replace(".png", ".mtl"));
        }
        self.write("outside.obj", &(text + "usemtl wood\nf 1/1 2/1 3/1\n"))
    }

    /// A text file of FBX with a square for every name, whose material has that as its texture.
    fn fbx(&self) -> String {
        let (mut objects, mut links) = (String::new(), String::new());
        for (i, name) in self.names.iter().enumerate() {
            let [mesh, node, paint, texture] = [1, 2, 3, 4].map(|kind| 1000 * kind + i);
            objects += &format!(
                "Geometry: {mesh}, \"Geometry::m\", \"Mesh\" {{\n Vertices: *9 {{ a: 0,0,0,1,0,0,0,1,0 }}\n PolygonVertexIndex: *3 {{ \
                 a: 0,1,-3 }}\n}}\nModel: {node}, \"Model::n\", \"Mesh\" {{\n}}\nMaterial: {paint}, \"Material::p\", \"\" {{\n \
                 ShadingModel: \"phong\"\n}}\nTexture: {texture}, \"Texture::t\", \"\" {{\n FileName: \"{name}\"\n RelativeFilename: \
                 \"{name}\"\n}}\n"
            );
            links += &format!(
                "C: \"OO\",{node},0\nC: \"OO\",{mesh},{node}\nC: \"OO\",{paint},{node}\nC: \"OP\",{texture},{paint}, \"DiffuseColor\"\n"
            );
        }
        let head = "; FBX 7.4.0 project file\nFBXHeaderExtension: {\n FBXVersion: 7400\n}\n";
        self.write("outside.fbx", &format!("{head}Objects: {{\n{objects}}}\nConnections: {{\n{links}}}\n"))
    }
}

/// The files that a run of the program opens, with links resolved. The run must succeed.
fn opened(folder: &Folder, arguments: &[&str]) -> BTreeSet<PathBuf> {
    let log = folder.path("strace.log");
    let output = Command::new("strace")
        // Of every call that opens a file, with the path that the system gives the opened file.
        .args(["-f", "-y", "-qq", "-s", "4096", "-e", "trace=open,openat,openat2,creat", "-o", &log])
        .arg(env!("CARGO_BIN_EXE_pnaen"))
        .args(arguments)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .output()
        .expect("strace, which ./setup.sh installs");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    let log = std::fs::read_to_string(log).expect("what strace wrote");
    let opened = log.lines().filter_map(|line| {
        let (_, result) = line.rsplit_once(" = ")?;
        let (descriptor, path) = result.split_once('<')?;
        descriptor.parse::<u32>().ok().map(|_| PathBuf::from(path.trim_end_matches('>')))
    });
    opened.collect()
}

/// Whether this system lets a program trace another.
fn can_trace(folder: &Folder) -> bool {
    let traced = Command::new("strace").args(["-qq", "-o", &folder.path("probe.log"), "true"]).status();
    traced.expect("strace, which ./setup.sh installs").success()
}

/// Checks that the model is among these files, and that of those around its folder none is but what the program has written.
fn assert_inside(models: &Models, opened: &BTreeSet<PathBuf>, file: &str, written: &Path) {
    assert!(opened.contains(Path::new(file)), "strace saw no model: {opened:?}");
    let around = models.model.parent().expect("the folder that holds the model's");
    for path in opened.iter().filter(|path| path.starts_with(around)) {
        assert!(path.starts_with(&models.model) || path.starts_with(written), "{file}: it opened {}", path.display());
    }
}

#[test]
fn no_file_outside_the_models_folder_is_opened() {
    let models = Models::new();
    if !can_trace(&models.folder) {
        println!("this system lets no program trace another, so the files that are opened weren't looked at");
        return;
    }
    let written = models.folder.0.path().canonicalize().expect("a folder").join("written");
    std::fs::create_dir(&written).expect("a writable folder");
    let picture = written.join("out.png").display().to_string();
    for file in [models.gltf(), models.obj(), models.fbx()] {
        let info = opened(&models.folder, &["info", &file]);
        assert_inside(&models, &info, &file, &written);
        let render = opened(&models.folder, &["render", &file, "--factor", "1", "--size", "64x48", "-o", &picture]);
        assert_inside(&models, &render, &file, &written);
        assert!(render.iter().any(|path| path.starts_with(&written)), "{render:?}");
    }
}
