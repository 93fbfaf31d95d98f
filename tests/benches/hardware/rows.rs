//! The tables with one row for each comparison.

use super::copy::Copies;
use super::numbers::{ms, or_none, ratio, table, whole};
use super::versus::Versus;

/// The name of a comparison, and its measurements.
pub(crate) type Named = (String, Versus);

/// The rate of our tessellation, in bytes per second.
pub(crate) fn rate_of(row: &Versus) -> f64 {
    row.bytes as f64 / (row.ours.tessellation.median * 1e-3)
}

pub(crate) fn tessellation(rows: &[Named], copies: Option<&Copies>) -> String {
    let row = |(name, row): &Named| {
        let (ours, theirs) = (&row.ours.tessellation, row.peer.as_ref().map(|peer| peer.tessellation));
        let throughput = |ms: f64| format!("{:.0}", row.triangles as f64 / ms * 1e-3);
        vec![
            name.clone(),
            whole(row.patches.into()),
            whole(row.triangles),
            ours.to_string(),
            or_none(theirs.map(|theirs| theirs.to_string())),
            or_none(theirs.map(|theirs| ratio(theirs.median, ours.median))),
            throughput(ours.median),
            or_none(theirs.map(|theirs| throughput(theirs.median))),
            format!("{:.1}", rate_of(row) * 1e-9),
            or_none(copies.map(|copies| format!("{:.3}", rate_of(row) / copies.best()))),
        ]
    };
    let head = "factors | patches | triangles | ours | theirs | theirs / ours | ours, Mtriangles/s | theirs, Mtriangles/s \
                | ours, GB/s | part of copying";
    table(head, &rows.iter().map(row).collect::<Vec<_>>())
}

pub(crate) fn frames(rows: &[Named]) -> String {
    let row = |(name, row): &Named| {
        let (ours, theirs) = (&row.ours, row.peer.as_ref());
        vec![
            name.clone(),
            whole(row.triangles),
            ours.draw.to_string(),
            ours.frame.to_string(),
            or_none(theirs.map(|theirs| theirs.frame.to_string())),
            or_none(theirs.map(|theirs| ratio(theirs.frame.median, ours.frame.median))),
            ours.wall.to_string(),
            or_none(theirs.map(|theirs| theirs.wall.to_string())),
            or_none(theirs.map(|theirs| ratio(theirs.wall.median, ours.wall.median))),
        ]
    };
    let head = "factors | triangles | ours, drawing alone | ours, GPU | theirs, GPU | theirs / ours | ours, host \
                | theirs, host | theirs / ours";
    table(head, &rows.iter().map(row).collect::<Vec<_>>())
}

/// What was drawn, and the times of both ways in which the peer reads nets.
pub(crate) fn drawn(rows: &[Named]) -> String {
    let row = |(name, row): &Named| {
        let peer = row.peer.as_ref();
        let counted = peer.and_then(|peer| peer.counted);
        let way = |index: usize| or_none(peer.map(|peer| peer.ways[index].map(ms).join(", ")));
        vec![
            name.clone(),
            whole(row.triangles),
            or_none(counted.map(|counted| whole(counted.triangles))),
            whole(row.vertices),
            or_none(counted.map(|counted| whole(counted.evaluations))),
            row.chunks.to_string(),
            or_none(row.covering.filter(|_| row.chunks == 1).map(whole)),
            or_none(peer.map(|peer| format!("{:.5}", peer.difference))),
            way(0),
            way(1),
        ]
    };
    let head = "factors | ours, triangles | theirs, triangles | ours, vertices | theirs, evaluations | ours, chunks \
                | ours that cover a sample | pictures differ by | theirs, nets in attributes: tessellation, frame \
                | theirs, nets in memory: tessellation, frame";
    table(head, &rows.iter().map(row).collect::<Vec<_>>())
}

pub(crate) fn passes(rows: &[Named]) -> String {
    const PASSES: [&str; 8] = ["nets", "factors", "counts", "scan", "chunks", "emit", "coverage", "draw"];
    let row = |(name, row): &Named| {
        let time = |pass: &str| {
            let time = row.ours.passes.iter().find(|time| time.pass == pass);
            or_none(time.map(|time| ms(time.ms)))
        };
        [name.clone(), whole(row.triangles)].into_iter().chain(PASSES.map(time)).collect()
    };
    table(&format!("factors | triangles | {}", PASSES.join(" | ")), &rows.iter().map(row).collect::<Vec<_>>())
}

/// Compares each row with the first.
pub(crate) fn growth(steps: &[Named]) -> String {
    let Some((_, base)) = steps.first() else { return String::new() };
    let row = |(name, step): &Named| {
        let theirs = |of: &Versus| of.peer.as_ref().map(|peer| peer.tessellation.median);
        vec![
            name.clone(),
            whole(step.patches.into()),
            whole(step.triangles),
            ratio(step.triangles as f64, base.triangles as f64),
            step.ours.tessellation.to_string(),
            ratio(step.ours.tessellation.median, base.ours.tessellation.median),
            or_none(step.peer.as_ref().map(|peer| peer.tessellation.to_string())),
            or_none(theirs(step).zip(theirs(base)).map(|(step, base)| ratio(step, base))),
        ]
    };
    let head = "fractional, by distance | patches | triangles | times base | ours | times base | theirs | times base";
    table(head, &steps.iter().map(row).collect::<Vec<_>>())
}
