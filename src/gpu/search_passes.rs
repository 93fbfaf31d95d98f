//! The passes of LOD by error in which patches look for factors: see `shaders/pass_asked.wgsl` and `shaders/pass_uniform.wgsl`.

use super::GpuError;
use super::bound_pass::{Step, Workgroups};
use super::compute_pipeline::Pass;
use super::pass_inputs::PassInputs;
use super::pipelines::{WORKGROUP, grid};
use geometry::tessellate::rounds;

const ASKED_FACTORS: Pass = Pass::new("pass_asked", "asked_factors_main");
const FIRST_PATTERNS: Pass = Pass::new("pass_asked", "first_patterns_main");
const COUNT_WORKGROUPS: Pass = Pass::new("pass_asked", "search_workgroups_main");
const ROUND_WORKGROUPS: Pass = Pass::new("pass_asked", "round_workgroups_main");
const SEARCH_ASKED_FACTORS: Pass = Pass::new("pass_asked", "search_asked_factors_main");
const INSIDE_FACTORS: Pass = Pass::new("pass_asked", "inside_factors_main");
const SEARCH_INSIDE_FACTORS: Pass = Pass::new("pass_asked", "search_inside_factors_main");
const KEEP_FACTORS: Pass = Pass::new("pass_asked", "keep_factors_main");
const SUM_TRIANGLES: Pass = Pass::new("pass_uniform", "sum_triangles_main");
const CANDIDATES: Pass = Pass::new("pass_uniform", "candidates_main");
const SEARCH_UNIFORM_FACTOR: Pass = Pass::new("pass_uniform", "search_uniform_factor_main");
const TAKE_UNIFORM_FACTOR: Pass = Pass::new("pass_uniform", "take_uniform_factor_main");

/// Software drivers take time for what has nothing to do, and GPUs take less for that than for counting what has.
const SOFTWARE_ONLY: [Pass; 3] = [FIRST_PATTERNS, COUNT_WORKGROUPS, ROUND_WORKGROUPS];

/// `ALONE` in `shaders/pass_asked.wgsl` for a software driver, which computes few invocations of a workgroup side by side.
const ALONE: u32 = 32;

/// The most workgroups of a search: enough for the largest GPUs.
const SEARCH_WORKGROUPS: u32 = 8192;

/// For one factor for all edges: the most workgroups that add up triangles (each of so few patches that 32 bits hold the sum), and
/// the most that search. Mostly each looks at one patch, and then no factor is left. First on a GPU, then on a software driver.
const UNIFORM_WORKGROUPS: [[u32; 2]; 2] = [[1024, 2048], [32, 128]];

/// The places of `search_workgroups`, as in `shaders/pass_asked.wgsl` and `shaders/search_state.wgsl`.
pub const SEARCH_ASKED: u32 = 0;
pub const SEARCH_INSIDE: u32 = 1;
pub const SEARCH_AGAIN: u32 = 2;
pub const NEXT_PATCHES: u32 = 3;
pub const NEXT_EDGES: u32 = 4;

/// All passes in their order, for rows or for the patterns of Direct3D.
///
/// # Errors
/// A pipeline can't be made: out of memory, or a lost device.
pub(super) fn search_steps(on: &PassInputs, has_rows: bool) -> Result<Vec<Step>, GpuError> {
    let (mesh, software) = (on.mesh, on.gpu.is_software());
    let patches = mesh.patch_count;
    let [each_patch, each_edge] = [patches, mesh.factor_count].map(|items| Workgroups::Grid(grid(items)));
    let line = |workgroups| Workgroups::Grid([workgroups, 1, 1]);
    let counted = |place: u32, otherwise: Workgroups| match software {
        true => Workgroups::Counted(mesh.search_workgroups.clone(), u64::from(place) * size_of::<[u32; 3]>() as u64),
        false => otherwise,
    };
    let searched = |search| counted(search, line(patches.min(SEARCH_WORKGROUPS)));
    let (next_patches, next_edges) =
        (counted(NEXT_PATCHES, each_patch.clone()), counted(NEXT_EDGES, each_edge.clone()));
    let [adding, searching] = UNIFORM_WORKGROUPS[usize::from(software)];
    let sized = |pass| on.pipelines.search(on.gpu, pass, patches);
    let [search_asked, search_inside] =
        [SEARCH_ASKED_FACTORS, SEARCH_INSIDE_FACTORS].map(|pass| sized(pass).with("SEARCHES_ROWS", has_rows.into()));
    let take_insides =
        |each| [(INSIDE_FACTORS, each), (COUNT_WORKGROUPS, line(1)), (search_inside, searched(SEARCH_INSIDE))];
    let asked = if software { ASKED_FACTORS.with("ALONE", ALONE) } else { ASKED_FACTORS };

    let mut steps =
        vec![(asked, each_patch.clone()), (COUNT_WORKGROUPS, line(1)), (FIRST_PATTERNS, next_patches.clone())];
    steps.extend([(COUNT_WORKGROUPS, line(1)), (search_asked, searched(SEARCH_ASKED))]);
    steps.extend(take_insides(each_patch));
    for round in 1..rounds(has_rows) {
        steps.push((KEEP_FACTORS, if round == 1 { each_edge.clone() } else { next_edges.clone() }));
        steps.extend([(ROUND_WORKGROUPS, line(1)), (search_asked, searched(SEARCH_AGAIN))]);
        steps.extend(take_insides(next_patches.clone()));
    }
    steps.push((KEEP_FACTORS, next_edges));
    steps.push((SUM_TRIANGLES, line(patches.div_ceil(WORKGROUP).min(adding))));
    steps.extend([(CANDIDATES, line(1)), (sized(SEARCH_UNIFORM_FACTOR), line(patches.min(searching)))]);
    steps.push((TAKE_UNIFORM_FACTOR, each_edge));
    steps.extend(take_insides(next_patches));

    steps.retain(|(pass, _)| software || !SOFTWARE_ONLY.contains(pass));
    steps.into_iter().map(|(pass, workgroups)| Ok(Step { bound: on.bound(pass)?, workgroups })).collect()
}
