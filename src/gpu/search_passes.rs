//! The passes of LOD by error in which patches look for factors: see `shaders/pass_requests.wgsl` and `shaders/pass_uniform.wgsl`.

use super::compute_pipeline::{Pass, Workgroups};
use super::pass_inputs::PassInputs;
use super::pipelines::{WORKGROUP, grid};
use geometry::tessellate::rounds;

const LIST_PATCHES: Pass = Pass::new("pass_requests", "list_patches_main");
const COUNT_WORKGROUPS: Pass = Pass::new("pass_requests", "search_workgroups_main");
const SEARCH_PATCHES: Pass = Pass::new("pass_requests", "search_patches_main");
const SUM_TRIANGLES: Pass = Pass::new("pass_uniform", "sum_triangles_main");
const CANDIDATES: Pass = Pass::new("pass_uniform", "candidates_main");
const SEARCH_UNIFORM_FACTOR: Pass = Pass::new("pass_uniform", "search_uniform_factor_main");
const TAKE_UNIFORM_FACTOR: Pass = Pass::new("pass_uniform", "take_uniform_factor_main");

/// The most workgroups of a search: as many as the largest GPUs run at once. Each says that it is done, one after the other.
const SEARCH_WORKGROUPS: u32 = 4096;

/// For one factor for all edges: the most workgroups that add up triangles (each of so few patches that 32 bits hold the sum), and
/// the most that search. Mostly each looks at one patch, and then no factor is left. First on a GPU, then on a software driver.
const UNIFORM_WORKGROUPS: [[u32; 2]; 2] = [[1024, 2048], [32, 128]];

/// All passes in their order, for rows or for the patterns of Direct3D.
pub(super) fn search_passes(on: &PassInputs, has_rows: bool) -> Vec<(Pass, Workgroups)> {
    let (mesh, software) = (on.mesh, on.gpu.is_software());
    let patches = mesh.patch_count;
    let [each_patch, each_edge] = [patches, mesh.factor_count].map(|items| Workgroups::Grid(grid(items)));
    let line = |workgroups| Workgroups::Grid([workgroups, 1, 1]);
    let search = on.pipelines.search(on.gpu, SEARCH_PATCHES, patches);
    let search = search.with("SEARCHES_ROWS", has_rows.into()).with("ROUNDS", rounds(has_rows));
    // Software drivers take time for what has nothing to do, and GPUs take less for that than for counting what has.
    let search = match software {
        true => vec![(COUNT_WORKGROUPS, line(1)), (search, Workgroups::Counted(mesh.search_workgroups.clone()))],
        false => vec![(search, line(patches.min(SEARCH_WORKGROUPS)))],
    };
    let list = [(LIST_PATCHES, each_patch)];
    let first = [&list[..], &search].concat();
    let round = [&first[..], &search].concat();
    let [adding, searching] = UNIFORM_WORKGROUPS[usize::from(software)];
    // Where a software driver ends loops, invocations that it computes together stop together. Others would no longer meet at barriers,
    // and a factor that isn't enough would be taken.
    let uniform_search = on.pipelines.search(on.gpu, SEARCH_UNIFORM_FACTOR, if software { u32::MAX } else { patches });
    let uniform = [
        (SUM_TRIANGLES, line(patches.div_ceil(WORKGROUP).min(adding))),
        (CANDIDATES, line(1)),
        (uniform_search, line(patches.min(searching))),
        (TAKE_UNIFORM_FACTOR, each_edge),
    ];
    let rounds = (0..rounds(has_rows)).flat_map(|_| round.clone());
    first.iter().cloned().chain(rounds).chain(uniform).chain(first.iter().cloned()).collect()
}
