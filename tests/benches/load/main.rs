//! Times loading a mesh of two million triangles, and `pnaen info` of it, for each format: `cargo bench --bench load`. Both elapsed time
//! and processor time are measured.
//!
//! With `PNAEN_PYTHON=/path/to/python` it also times how long trimesh and pymeshlab load the same files; both must be installed
//! for that Python. All take turns, and what is printed are medians of the turns. Arguments after `--` are the only formats that
//! are measured: `-- ply obj`.

mod files;

use std::hint::black_box;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use geometry::progress::Progress;
use load::{Limits, load};

/// How many quads the mesh has along each direction.
const SIDE: u32 = 1000;

/// The number of turns.
const RUNS: usize = 3;

/// The other programs, as `peers.py` calls them.
const PEERS: [&str; 2] = ["trimesh", "pymeshlab"];

/// Elapsed time and processor time, in s. The second is what all threads took together, and says more on a busy machine; NaN where the
/// system doesn't tell it.
type Times = [f64; 2];

/// Returns how long it takes to read a file into a mesh.
fn loading(path: &Path) -> Times {
    let (start, before) = (Instant::now(), processor(0));
    let loaded = load(path, &Limits::default(), &Progress::new()).expect("a file without a fault");
    let taken = [start.elapsed().as_secs_f64(), processor(0) - before];
    assert_eq!(black_box(loaded).mesh.triangles.len() as u32, 2 * SIDE * SIDE);
    taken
}

/// Returns how long the program takes to start, load a file, and check and describe the mesh.
fn describing(path: &Path) -> Times {
    let (start, before) = (Instant::now(), processor(2));
    let mut info = Command::new(env!("CARGO_BIN_EXE_pnaen"));
    let status = info.arg("info").arg(path).stdout(Stdio::null()).status().expect("the program");
    assert!(status.success(), "{status}");
    [start.elapsed().as_secs_f64(), processor(2) - before]
}

/// Returns the processor time of this process, or of those that it waited for, in s: the sum of two fields of Linux's
/// `/proc/self/stat`, counted from `utime` on.
fn processor(first: usize) -> f64 {
    /// How many ticks a second has in that file.
    const TICKS: f64 = 100.0;
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The name of the program may have spaces; `utime` is the twelfth field after it.
    let fields = stat.rsplit_once(')').map_or("", |(_, fields)| fields);
    let ticks: Vec<f64> =
        fields.split_whitespace().skip(11 + first).take(2).filter_map(|field| field.parse().ok()).collect();
    if ticks.len() == 2 { ticks.iter().sum::<f64>() / TICKS } else { f64::NAN }
}

/// Returns how long another program takes to load a file; not to start.
fn peer(python: &str, name: &str, path: &Path) -> Times {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/benches/load/peers.py");
    let output = Command::new(python).args([script, name]).arg(path).output().expect("PNAEN_PYTHON names a Python");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8_lossy(&output.stdout);
    let last = said.lines().last().unwrap_or_default().split_whitespace();
    let seconds: Vec<f64> = last.filter_map(|number| number.parse().ok()).collect();
    seconds.try_into().expect("two numbers of seconds")
}

fn median(numbers: impl IntoIterator<Item = f64>) -> f64 {
    let mut numbers = Vec::from_iter(numbers);
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn main() {
    let python = std::env::var("PNAEN_PYTHON").ok();
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let wanted: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    let mut rows = [Vec::new(), Vec::new()];
    for (name, write) in files::FORMATS {
        if !wanted.is_empty() && !wanted.iter().any(|format| name.ends_with(&format!(".{format}"))) {
            continue;
        }
        let path = folder.path().join(name);
        write(&path, SIDE).expect("a writable temporary folder");
        // One turn: loading, info, and the others.
        let turns: Vec<[Times; 4]> = (0..RUNS)
            .map(|_| {
                let others =
                    PEERS.map(|name| python.as_ref().map_or([f64::NAN; 2], |python| peer(python, name, &path)));
                [loading(&path), describing(&path), others[0], others[1]]
            })
            .collect();
        for (kind, rows) in rows.iter_mut().enumerate() {
            rows.push(row(name, turns.iter().map(|turn| turn.map(|times| times[kind])).collect()));
        }
        std::fs::remove_file(&path).expect("a writable temporary folder");
    }
    for (kind, rows) in ["Elapsed time", "Processor time"].into_iter().zip(rows) {
        println!("\n{kind}, s:\n");
        println!("| format | load | `info` | `info` / load | trimesh | pymeshlab | faster of the two / load |");
        println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
        rows.iter().for_each(|row| println!("{row}"));
    }
}

/// The medians of a format's turns: loading, info, and the others; and of their ratios.
fn row(name: &str, turns: Vec<[f64; 4]>) -> String {
    let [load, info, trimesh, pymeshlab] = [0, 1, 2, 3].map(|k| median(turns.iter().map(|turn| turn[k])));
    let of_info = median(turns.iter().map(|turn| turn[1] / turn[0]));
    let of_peers = median(turns.iter().map(|turn| turn[2].min(turn[3]) / turn[0]));
    format!("| {name} | {load:.2} | {info:.2} | {of_info:.2} | {trimesh:.2} | {pymeshlab:.2} | {of_peers:.2} |")
}
