//! Prints what was measured as Markdown tables.

use geometry::tessellate::Partitioning;

use crate::VIEWPORT;
use crate::jumps::Jumps;
use crate::method::Method;
use crate::paths::Motion;

/// What was measured along one path.
pub(crate) struct Measured {
    pub mesh: usize,
    pub motion: Motion,
    pub method: Method,
    pub tolerance: f32,
    pub jumps: Jumps,
}

/// Adds up what was measured along some paths.
fn sum<'a>(measured: impl Iterator<Item = &'a Measured>) -> (usize, Jumps) {
    measured.fold((0, Jumps::default()), |(paths, mut sum), one| {
        sum.merge(&one.jumps);
        (paths + 1, sum)
    })
}

/// Prints the tables of one tolerance, with a row for each mesh if `each_mesh` is set.
pub(crate) fn print(meshes: &[&str], tolerance: f32, measured: &[&Measured], each_mesh: bool) {
    println!("\nTolerance {tolerance} px, {}x{} px\n", VIEWPORT.x, VIEWPORT.y);
    println!(
        "| paths of | partitioning | paths | frames | triangles, mean | silhouette, largest px | surface, largest px | surface, 99th percentile px | normals, largest degrees | normals, 99th percentile degrees | patches with another pattern, a frame |"
    );
    println!("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for (name, own) in groups(meshes, measured, each_mesh) {
        for method in Method::ALL {
            print_row(&name, method, own.iter().copied().filter(|one| one.method == method));
        }
    }
    print_bases(meshes, measured, each_mesh);
    println!();
    for method in Method::ALL.into_iter().filter(|method| method.keeps_tolerance()) {
        print_check(tolerance, method, measured.iter().copied().filter(|one| one.method == method));
    }
}

/// All paths, those of each kind, and those of each mesh, with their names.
fn groups<'a>(meshes: &[&str], measured: &[&'a Measured], each_mesh: bool) -> Vec<(String, Vec<&'a Measured>)> {
    let of = |is_own: &dyn Fn(&Measured) -> bool| measured.iter().copied().filter(|one| is_own(one)).collect();
    let mut groups = vec![("all".to_owned(), of(&|_| true))];
    groups.extend(Motion::ALL.map(|motion| (motion.name().to_owned(), of(&|one| one.motion == motion))));
    if each_mesh {
        let own = |(mesh, name): (usize, &&str)| ((*name).to_owned(), of(&|one| one.mesh == mesh));
        groups.extend(meshes.iter().enumerate().map(own));
    }
    groups
}

fn print_row<'a>(name: &str, method: Method, measured: impl Iterator<Item = &'a Measured>) {
    let (paths, jumps) = sum(measured);
    let Jumps { frames, triangles, silhouette, surface, normals, patches, patterns, .. } = jumps;
    println!(
        "| {name} | {} | {paths} | {frames} | {:.0} | {silhouette:.3} | {:.3} | {:.3} | {:.1} | {:.2} | {:.1} % |",
        method.name(),
        triangles as f64 / frames.max(1) as f64,
        surface.largest,
        surface.percentile_99(),
        normals.largest,
        normals.percentile_99(),
        percent(patterns, patches),
    );
}

/// Prints how often bases change.
fn print_bases(meshes: &[&str], measured: &[&Measured], each_mesh: bool) {
    println!("\nRows: patches with another base, a frame\n");
    println!(
        "| paths of | another base | another base, but no fewer triangles | another base beside the same segments of edges | surface where the base changed, largest px | 99th percentile px |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: |");
    for (name, own) in groups(meshes, measured, each_mesh) {
        let (_, jumps) = sum(own.into_iter().filter(|one| one.method.partitioning == Partitioning::Rows));
        let Jumps { patches, bases, flips, beside_same_edges, surface_of_bases, .. } = jumps;
        println!(
            "| {name} | {:.2} % | {:.2} % | {:.2} % | {:.3} | {:.3} |",
            percent(bases, patches),
            percent(flips, patches),
            percent(beside_same_edges, patches),
            surface_of_bases.largest,
            surface_of_bases.percentile_99(),
        );
    }
}

/// Prints whether no jump is larger than twice the tolerance: both frames' surfaces are within it of the limit surface.
fn print_check<'a>(tolerance: f32, method: Method, measured: impl Iterator<Item = &'a Measured>) {
    let (_, jumps) = sum(measured);
    let [jump, most] = [jumps.surface.largest, 2.0 * f64::from(tolerance)];
    let holds = if jump <= most { "holds" } else { "FAILS" };
    println!(
        "{}: no jump beyond twice the tolerance {holds}: {jump:.3} of {most} px. The emitted surface is up to {:.3} px from the limit surface, that of the frame before up to {:.3} px. {} of {} changed patches have the largest factor and aren't compared.",
        method.name(),
        jumps.error,
        jumps.error_before,
        jumps.capped,
        jumps.patterns,
    );
}

fn percent(part: u64, all: u64) -> f64 {
    100.0 * part as f64 / all.max(1) as f64
}
