//! `pnaen adjacency`: writes PN-AEN's index buffer, or compares a file with it.

use std::path::{Path, PathBuf};

use super::{
    CliError, WeldOption, file_of, files_of_heights, keep_apart, load_apart, note, options, read_bytes, refuse,
    write_bytes,
};
use geometry::mesh::adjacency::{Layout, Part};
use geometry::names::shown_path;
use geometry::tessellate::displaced_corners;
use inspect::adjacency_file::{Format, read};
use inspect::engine::{Loaded, Preparation};
use inspect::measure::{IndexDifference, Meaning, index_differences};
use inspect::settings::Choice;
use inspect::shot::files::write_adjacency;
use load::{HeightSource, Source};

#[derive(Debug, clap::Args)]
pub struct Args {
    #[arg(help = super::options::mesh_help(), value_parser = super::options::source())]
    pub file: Source,
    #[command(flatten)]
    pub weld: WeldOption,
    /// Indices per patch
    #[arg(long, value_parser = options::choice::<Layout>(), default_value = Layout::Nine.name())]
    pub indices: Layout,
    /// File to write (- for standard output); may be left out with --against
    #[arg(short, long, value_name = "OUT.json|OUT.bin")]
    pub output: Option<PathBuf>,
    /// What to write; by default bin if the output's name ends in .bin, and otherwise json
    #[arg(long, value_parser = options::choice::<Format>(), requires = "output")]
    pub format: Option<Format>,
    /// Compare this file with the computed indices (- for standard input). It is JSON as this command writes it, or bare indices
    /// as in a .bin file. Standard error lists which patches differ and what that means; the command fails if any differs
    #[arg(long, value_name = "FILE")]
    pub against: Option<PathBuf>,
    /// Also write what exported shaders that displace need of every corner, 40 bytes each. These are the direction in which its
    /// point moves, gradients of both texture coordinates, and the length of the point's shortest edge in px of the image
    #[arg(long, value_name = "OUT.bin", requires = "height")]
    pub corners: Option<PathBuf>,
    /// The height image of --corners: a PNG, JPEG, WebP, TGA, KTX2, TIFF or EXR image over all materials, or `material`, the materials' base colour image
    #[arg(long, value_name = "IMAGE|material", requires = "corners", value_parser = options::heights())]
    pub height: Option<HeightSource>,
}

/// How many differences standard error lists.
const SAID: usize = 10;

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    refuse(
        args.output.is_none() && args.against.is_none() && args.corners.is_none(),
        "give -o to write a file, --against to compare one with the mesh, or --corners for what displacement needs",
    )?;
    let written = [args.output.as_deref(), args.corners.as_deref()];
    let read_files = [file_of(&args.file), args.against.as_deref()].into_iter();
    keep_apart(read_files.chain(files_of_heights(args.height.as_slice())), written)?;
    let given = args.against.as_deref().map(read_bytes).transpose()?;
    let preparation = Preparation { heights: args.height.clone(), ..args.weld.preparation() };
    let loaded = load_apart(&args.file, &preparation, &written)?;
    args.weld.parts.say_idle(|own| own.is_of_tessellation(), "a surface or detail of --part has no effect on indices");
    if let Some(path) = &args.corners {
        // What displacement needs of every corner: 32-bit floating-point numbers, little-endian.
        let corners = displaced_corners(&loaded.mesh, &loaded.topology);
        let corners = corners.ok_or_else(|| CliError::NotOneImage { file: loaded.source.to_string() })?;
        let bytes: Vec<u8> = corners.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        write_bytes(path, &bytes)?;
    }
    let computed = args.indices.indices(&loaded.topology);
    if let Some(path) = &args.output {
        let format = args.format.unwrap_or(Format::from_name(path));
        write_adjacency(&loaded, args.indices, &computed, format, path)?;
        let (left_out, all) = (loaded.topology.degenerate, loaded.mesh.triangles.len());
        if format == Format::Bin && left_out > 0 {
            note(&format!(
                "{left_out} of {all} triangles are degenerate and have no patch; the JSON's patch_triangles has the triangle \
                 of each patch"
            ));
        }
    }
    match args.against.as_deref().zip(given) {
        Some((path, bytes)) => compare_with(args.indices, path, &bytes, &loaded, &computed),
        None => Ok(()),
    }
}

/// Reports on standard error where a file's indices differ from those of the mesh.
fn compare_with(layout: Layout, path: &Path, bytes: &[u8], loaded: &Loaded, computed: &[u32]) -> Result<(), CliError> {
    let (mesh, topology) = (&loaded.mesh, &loaded.topology);
    let name = if path.as_os_str() == "-" { "standard input".to_owned() } else { shown_path(path) };
    let given =
        read(path, bytes, mesh, topology, layout).map_err(|fault| CliError::Indices { path: name.clone(), fault })?;
    let differences = index_differences(mesh, topology, layout, &given, computed);
    let patches = topology.patches.len();
    if differences.is_empty() {
        note(&format!("{name}: 0 of {patches} patches differ"));
        return Ok(());
    }
    if differences.len() > SAID {
        note(&format!("the first {SAID} of {} differences:", differences.len()));
    }
    for difference in differences.iter().take(SAID) {
        note(&difference_text(loaded, difference, &given, computed));
    }
    let worst: Vec<_> = differences
        .chunk_by(|a, b| a.patch == b.patch)
        .filter_map(|patch| patch.iter().map(|difference| difference.meaning).max())
        .collect();
    Err(CliError::OtherIndices { path: name, different: worst.len(), patches, meanings: counted(worst) })
}

fn difference_text(loaded: &Loaded, difference: &IndexDifference, given: &[u32], computed: &[u32]) -> String {
    let IndexDifference { patch, part, places, meaning } = difference;
    let own = loaded.topology.patches[*patch as usize];
    let corners = |indices: &[u32]| {
        let indices = &indices[places.clone()];
        let list = indices.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
        let is_own = |k: u32| indices == [k, (k + 1) % 3].map(|k| loaded.topology.corners(&own)[k as usize]);
        if matches!(part, Part::Side(k) if is_own(*k)) { format!("{list} (the patch's own)") } else { list }
    };
    // Patches and triangles have the same numbers up to the first degenerate triangle.
    let triangle = if own.triangle == *patch { String::new() } else { format!(" (triangle {})", own.triangle) };
    let part = match part {
        Part::Corners => "corners".to_owned(),
        Part::Side(k) => format!("side {k}-{}", (k + 1) % 3),
        Part::Dominant => "dominant corners".to_owned(),
        Part::DominantSide(k) => format!("dominant side of {k}-{}", (k + 1) % 3),
    };
    let (given, computed) = (corners(given), corners(computed));
    format!("patch {patch}{triangle}, {part}: the file has {given} instead of {computed}: {}", meaning.text())
}

/// Returns the number of patches for each meaning, the least harmful first.
fn counted(mut meanings: Vec<Meaning>) -> String {
    meanings.sort_unstable();
    let runs = meanings.chunk_by(|a, b| a == b).map(|run| format!("{} ({})", run.len(), run[0].text()));
    runs.collect::<Vec<_>>().join(", ")
}
