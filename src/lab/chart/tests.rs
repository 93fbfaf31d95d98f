use proptest::prelude::*;

use super::labels::{LabelRequest, Rect, place};
use super::*;
use geometry::tessellate::{Clip, Lod, Normals, Partitioning, Surface, Tessellation};
use inspect::settings::Settings;

fn method(surface: Surface, lod: LodKind) -> Method {
    Method { surface, normals: Normals::Linear, partitioning: Partitioning::Integer, lod }
}

/// A row with this time in ms, this many triangles, and this error, both as a part of the diagonal and in px.
pub(super) fn row(surface: Surface, lod: LodKind, value: f32, (ms, triangles, error): (f64, u64, f64)) -> Row {
    Row {
        mesh: "shape:torus".into(),
        adapter: "an adapter, made up".into(),
        setting: Setting { method: method(surface, lod), value },
        probe: Probe {
            triangles,
            vertices: 3 * triangles,
            time: Time { tessellate: 0.25 * ms, draw: 0.75 * ms },
            errors: Some(Errors {
                largest: Interval { at_least: error, at_most: error },
                rms: 0.5 * error,
                normal_degrees: 3.0,
            }),
            max_error_px: Some(error),
            triangles_by_error: Some(triangles.div_ceil(2)),
        },
    }
}

pub(super) fn subject(reference_shape: Option<&str>, rows: Vec<Row>) -> Subject {
    let reference_shape = reference_shape.map(str::to_owned);
    Subject { title: "Torus <7>".into(), reference_shape, adapter: "an adapter".into(), size: [1280, 720], rows }
}

/// Rows in which flat has the mesh's error at every factor, and PN-AEN comes closer.
pub(super) fn some_rows() -> Vec<Row> {
    use LodKind::{Error, Uniform};
    vec![
        row(Surface::Flat, Uniform, 1.0, (1.0, 10, 0.03)),
        row(Surface::Flat, Uniform, 2.0, (1.5, 40, 0.03)),
        row(Surface::PnAen, Uniform, 2.0, (2.0, 40, 0.02)),
        row(Surface::PnAen, Uniform, 4.0, (4.0, 160, 0.004)),
        row(Surface::PnAen, Uniform, 8.0, (9.0, 640, 0.0008)),
        row(Surface::PnAen, Error, 4.0, (2.5, 90, 0.004)),
        row(Surface::PnAen, Error, 1.0, (3.0, 300, 0.0004)),
    ]
}

#[test]
fn an_error_that_is_due_to_rounding_is_0() {
    let shown = |reference_shape, error| subject(reference_shape, Vec::new()).shown_error(error);
    assert_eq!([2.93e-14, 1.94].map(|px| shown(None, px)), ["0", "1.94"]);
    assert_eq!([5e-8, 0.0593].map(|part| shown(Some("it"), part)), ["0", "5.93"], "in percent");
}

#[test]
fn the_front_has_the_points_that_no_other_beats() {
    assert_eq!(front(&[]), [0usize; 0]);
    assert_eq!(front(&[(1.0, 5.0), (2.0, 6.0), (2.0, 4.0), (3.0, 4.0), (4.0, 1.0)]), [0, 2, 4]);
    assert_eq!(front(&[(1.0, 1.0), (1.0, 1.0)]), [0], "the first of equal points");
    let subject = subject(Some("it"), some_rows());
    let races = subject.races();
    let [race] = &races[..] else { panic!("one reference surface makes one group, not {}", races.len()) };
    let labels = |front: Vec<(&Row, f64)>| front.iter().map(|(row, _)| row.setting.to_string()).collect::<Vec<_>>();
    assert_eq!(labels(race.front(|row| row.probe.time.total())), ["factor 1", "factor 2", "error 4 px", "error 1 px"]);
    assert_eq!(
        labels(race.front(|row| row.probe.triangles as f64)),
        ["factor 1", "factor 2", "error 4 px", "error 1 px"],
        "factor 4 is beaten: it takes 160 triangles for an error that 90 reach"
    );
}

proptest! {
    #[test]
    fn no_point_beats_one_of_the_front(points in prop::collection::vec((0u8..20, 0u8..20), 1..60)) {
        let points: Vec<(f64, f64)> = points.into_iter().map(|(a, b)| (a.into(), b.into())).collect();
        let found = front(&points);
        let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
        for &index in &found {
            prop_assert!(!points.iter().any(|&other| beats(other, points[index])));
        }
        for &point in &points {
            prop_assert!(found.iter().any(|&index| points[index] == point || beats(points[index], point)));
        }
    }

    #[test]
    fn labels_cover_neither_each_other_nor_points(at in prop::collection::vec((0.0..300.0, 0.0..200.0), 1..80)) {
        let points: Vec<[f64; 2]> = at.into_iter().map(|(x, y)| [x, y]).collect();
        let wanted: Vec<_> = points.iter().map(|&at| LabelRequest { at, size: [30.0, 12.0] }).collect();
        let lines: Vec<_> = points.windows(2).take(3).map(|ends| [ends[0], ends[1]]).collect();
        let bounds = Rect { min: [0.0; 2], max: [300.0, 200.0] };
        let placed: Vec<Rect> = place(&wanted, &points, &lines, bounds).into_iter().flatten().collect();
        for (index, label) in placed.iter().enumerate() {
            prop_assert!(bounds.contains(label));
            prop_assert!(placed[..index].iter().all(|other| !label.overlaps(other)));
            prop_assert!(points.iter().all(|&point| !label.overlaps(&Rect::around(point, 2.0))));
            for [a, b] in &lines {
                // Points along the line, in steps of about a px.
                let inside = |k: u32| {
                    let t = f64::from(k) / 400.0;
                    let at = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
                    label.overlaps(&Rect::around(at, 0.0))
                };
                prop_assert!(!(0..=400).any(inside));
            }
        }
    }
}

#[test]
fn a_single_point_has_its_label_beside_it() {
    let wanted = [LabelRequest { at: [50.0, 50.0], size: [20.0, 10.0] }];
    let all = Rect { min: [0.0; 2], max: [100.0; 2] };
    let [Some(label)] = place(&wanted, &[[50.0, 50.0]], &[], all)[..] else { panic!("there is room") };
    assert!(Rect::around([50.0, 50.0], 20.0).overlaps(&label));
    let tight = Rect { min: [40.0; 2], max: [60.0; 2] };
    assert_eq!(place(&wanted, &[[50.0, 50.0]], &[], tight), [None]);
}

#[test]
fn the_fastest_row_is_found_and_the_next_is_of_another_method() {
    let subject = subject(Some("it"), some_rows());
    let race = &subject.races()[0];
    let win = race.win(0.005).expect("three rows reach it");
    assert_eq!((win.fastest.setting.to_string(), win.fastest.probe.time.total()), ("error 4 px".into(), 2.5));
    assert_eq!(win.next.map(|next| next.setting.to_string()), Some("factor 4".into()));
    assert_eq!(race.win(0.0005).and_then(|win| win.next), None);
    assert_eq!(race.win(0.0001), None);
    let levels = race.levels(3, 1e-7);
    assert_eq!(levels.len(), 3);
    for (level, expected) in levels.iter().zip([0.02, 0.005, 0.0005]) {
        assert!((level - expected).abs() < 1e-9, "{levels:?}");
    }
}

#[test]
fn sentences_name_the_fastest_methods() {
    let expected = [
        "At 2 % of the diagonal pn-aen by uniform LOD (2) is fastest: 2.00 ms, 40 triangles; 1.2 times faster than pn-aen by error LOD (4 px).",
        "At 0.5 % of the diagonal pn-aen by error LOD (4 px) is fastest: 2.50 ms, 90 triangles; 1.6 times faster than pn-aen by uniform LOD (4).",
        "At 0.05 % of the diagonal pn-aen by error LOD (1 px) is fastest: 3.00 ms, 300 triangles; and nothing else reaches it.",
        "Closest comes pn-aen by error LOD (1 px), to 0.0400 % of the diagonal.",
    ];
    assert_eq!(subject(Some("it"), some_rows()).sentences(), expected);
    // Each surface is compared with its own limit. Flat has no error then, and isn't compared with PN-AEN.
    let mut rows = some_rows();
    for row in &mut rows {
        row.probe.errors = None;
        let flat = row.setting.method.surface == Surface::Flat;
        row.probe.max_error_px = row.probe.max_error_px.map(|px| if flat { 1e-6 } else { 100.0 * px });
    }
    let sentences = subject(None, rows).sentences();
    assert_eq!(sentences.len(), 3, "{sentences:?}");
    assert!(sentences.iter().all(|said| said.contains(" px pn-aen") && !said.contains("flat")), "{sentences:?}");
}

#[test]
fn names_have_only_what_tells_methods_apart() {
    let mut rows = some_rows();
    let plain = rows[2].setting.method;
    assert_eq!(subject(None, rows.clone()).name(plain), "pn-aen by uniform LOD");
    rows[0].setting.method.partitioning = Partitioning::Pow2;
    rows[5].setting.method.normals = Normals::Surface;
    assert_eq!(subject(None, rows).name(plain), "pn-aen by uniform LOD, integer, linear normals");
}

#[test]
fn rows_read_back_from_csv() {
    let mut rows = some_rows();
    rows[1].probe.errors = None;
    rows[1].probe.max_error_px = None;
    rows[2].probe.time.draw = 0.1 + 0.2;
    rows[2].probe.triangles_by_error = None;
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns()).expect("a header");
    rows.iter().for_each(|row| writer.write_record(row.record()).expect("a row"));
    let bytes = writer.into_inner().expect("a buffer");
    let mut reader = csv::Reader::from_reader(&bytes[..]);
    let header = "mesh,adapter,surface,normals,partitioning,lod,setting,triangles,vertices,bytes,ms_tessellate,ms_draw,\
                  ms_total,max_error,rms_error,max_error_px,normal_error_deg,\
                  triangles_by_error,max_error_at_most";
    assert_eq!(reader.headers().expect("a header").iter().collect::<Vec<_>>().join(","), header);
    let records: Vec<_> = reader.records().map(|record| record.expect("whole")).collect();
    assert_eq!(records.len(), rows.len());
    for (record, row) in records.iter().zip(&rows) {
        assert_eq!(record.iter().collect::<Vec<_>>(), row.record());
        assert_eq!(record[12].parse(), Ok(row.probe.time.total()));
        assert_eq!(record[13].parse().ok(), row.probe.errors.map(|errors| errors.largest.at_least));
        assert_eq!(record[17].parse().ok(), row.probe.triangles_by_error);
        assert_eq!(record[9].parse(), Ok(3 * row.probe.triangles * 32 + 12 * row.probe.triangles));
    }
    assert_eq!((&records[2][2], &records[2][5], &records[2][6]), ("pn-aen", "uniform", "factor 2"));
    assert_eq!((&records[6][0], &records[6][6], &records[1][15]), ("shape:torus", "error 1 px", ""));
}

#[test]
fn time_counts_the_passes_that_a_view_makes_run_again() {
    let passes = ["nets", "factors", "counts", "scan", "chunks", "emit", "draw"];
    let times = passes.map(|pass| PassTime { pass, ms: 1.0 });
    assert_eq!(Time::new(&times), Time { tessellate: 5.0, draw: 1.0 });
}

#[test]
fn every_listed_setting_is_tried_once() {
    let plan = Plan {
        surfaces: vec![Surface::Flat, Surface::PnAen],
        normals: vec![Normals::Linear],
        partitionings: Vec::new(),
        lods: LodKind::ALL.to_vec(),
        factors: vec![1.0, 2.0, 2.0],
        pixels: vec![4.0],
        tolerances: vec![0.25],
    };
    let names = |plan: &Plan| -> Vec<String> { plan.settings().iter().map(Setting::to_string).collect() };
    let each = ["factor 1", "factor 2", "paper 4 px", "error 0.25 px", "error, rows 0.25 px"];
    assert_eq!(names(&plan), [each, each].concat());
    let by_error = plan.settings()[3];
    assert_eq!(by_error.method.partitioning, Partitioning::Integer);
    let applied = |setting: Setting| setting.applied(&Settings::default());
    assert_eq!(
        (applied(by_error).tessellation.tolerance, applied(plan.settings()[2]).tessellation.pixels),
        (0.25, 4.0)
    );
    let rows = Plan {
        partitionings: vec![Partitioning::Rows],
        lods: vec![LodKind::Error, LodKind::ErrorRows],
        ..plan.clone()
    };
    assert_eq!(names(&rows), ["error, rows 0.25 px"; 2], "LOD by error under rows is tried once");
    let lods = vec![LodKind::Uniform, LodKind::Paper, LodKind::Error];
    let only = Plan { partitionings: vec![Partitioning::Subtriangulation], lods, ..plan };
    assert_eq!(names(&only), ["factor 1", "factor 2", "factor 1", "factor 2"], "subtriangulation has only uniform LOD");
}

#[test]
fn a_setting_is_applied_and_read_back_and_changes_nothing_else() {
    let own = Settings::opening().with(Tessellation {
        alpha: 0.5,
        midlevel: 0.25,
        factor: 7.0,
        ..Settings::opening().tessellation
    });
    for setting in Plan::default().settings() {
        let applied = setting.applied(&own);
        assert_eq!(Setting::new(&applied), Some(setting));
        let Tessellation { surface, normals, partitioning, lod, factor, pixels, tolerance, .. } = applied.tessellation;
        assert_eq!(
            applied,
            own.with(Tessellation {
                surface,
                normals,
                partitioning,
                lod,
                factor,
                pixels,
                tolerance,
                ..own.tessellation
            })
        );
    }
    assert_eq!(
        Setting::new(&own.with(Tessellation { lod: Lod::Distance, ..own.tessellation })),
        None,
        "charts don't try LOD by distance"
    );
    let equal =
        own.with(Tessellation { lod: Lod::Distance, partitioning: Partitioning::Subtriangulation, ..own.tessellation });
    assert_eq!(
        Setting::new(&equal).map(|setting| setting.to_string()),
        Some("factor 7".into()),
        "subtriangulation is uniform under any LOD"
    );
}

#[test]
fn measured_settings_leave_nothing_out_and_keep_the_surface() {
    let own = Settings {
        tessellation: Tessellation { alpha: 0.5, ..Settings::opening().tessellation },
        split: Some(0.5),
        ..Settings::opening()
    };
    let measured = whole(&own);
    assert_eq!(
        (measured.tessellation.clip, measured.tessellation.cull_back_faces, measured.split),
        (Clip::Off, false, None)
    );
    assert!(!measured.overlays.wireframe, "overlays are off");
    assert_eq!(
        (measured.tessellation.alpha, measured.tessellation.lod, measured.tessellation.tolerance),
        (0.5, own.tessellation.lod, own.tessellation.tolerance)
    );
}

#[test]
fn the_coarsest_of_every_method_come_first() {
    let plan = Plan { surfaces: vec![Surface::Flat, Surface::PnAen], ..Plan::default() };
    let all = coarse_first(plan.settings());
    assert_eq!(all.len(), plan.settings().len());
    assert!(plan.settings().iter().all(|setting| all.contains(setting)));
    let methods: Vec<Method> = all[..6].iter().map(|setting| setting.method).collect();
    assert!((0..6).all(|k| !methods[..k].contains(&methods[k])), "each method once");
    let factors = all.iter().filter(|setting| setting.method == methods[0]).map(|setting| setting.value);
    assert_eq!(factors.collect::<Vec<_>>(), plan.factors, "factors in their order");
}

#[test]
fn the_ending_decides_how_a_chart_is_saved() {
    let shown = subject(Some("the exact surface"), some_rows());
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let saved = |name: &str| {
        save(&folder.path().join(name), std::slice::from_ref(&shown)).expect("it is written");
        std::fs::read(folder.path().join(name)).expect("it is there")
    };
    assert!(saved("a.svg").starts_with(b"<svg "));
    assert_eq!(saved("a.PNG")[1..4], *b"PNG");
    let table = String::from_utf8(saved("a.csv")).expect("text");
    assert_eq!(table.lines().count(), 1 + shown.rows.len());
    assert_eq!(table.lines().next(), Some(&columns().join(",")[..]));
    let other = save(&folder.path().join("a.txt"), std::slice::from_ref(&shown)).map_err(|error| error.to_string());
    assert!(other.is_err_and(|text| text.contains(".svg, .png or .csv")));
    let nowhere =
        save(&folder.path().join("nowhere/a.svg"), std::slice::from_ref(&shown)).map_err(|error| error.to_string());
    assert!(nowhere.is_err_and(|text| text.contains("a.svg")), "it says which file");
}

#[test]
fn charts_without_rows_or_errors_are_drawn() {
    let zero = row(Surface::PnAen, LodKind::Uniform, 64.0, (1.0, 7, 0.0));
    let unknown = Row { probe: Probe { errors: None, max_error_px: None, ..zero.probe }, ..zero.clone() };
    for rows in [Vec::new(), vec![unknown], vec![zero.clone()], [some_rows(), vec![zero]].concat()] {
        let shown = [subject(Some("the exact surface"), rows.clone()), subject(None, rows)];
        let picture = bitmap(&shown).expect("it draws");
        assert_eq!(picture.width(), 960);
        let text = svg(&shown).expect("it draws");
        assert!(text.starts_with(&format!("<svg width=\"960\" height=\"{}\" ", picture.height())), "the same size");
        assert!(text.contains("Torus &lt;7&gt;") && text.contains("font-family=\"sans-serif\""), "text is text");
    }
}

#[test]
fn values_of_0_lie_at_the_bottom() {
    let axis = Axis::around([0.0, 0.01, 1.0].into_iter(), 1e-7);
    let places = [0.0, 0.01, 1.0].map(|value| axis.place(value));
    assert!(axis.start() < places[0] && places[0] < places[1] && places[1] < places[2], "{places:?}");
    assert_eq!(places.map(|place| axis.text(place)), ["0", "0.01", "1"]);
    let none = Axis::around([0.01, 1.0].into_iter(), 1e-7);
    assert!(none.start() > axis.start(), "no space for 0 without a value of 0");
    let ticks = none.ticks([none.start(), none.high]);
    assert!(!ticks.is_empty() && ticks.iter().all(|tick| (none.start()..=none.high).contains(&tick.place)));
}

#[test]
fn axes_of_small_ranges_have_ticks() {
    for (least, most) in [(25.0, 38.0), (0.2, 0.21), (3.0, 3.0)] {
        let axis = Axis::around([least, most].into_iter(), 0.0);
        let ticks = axis.ticks([axis.start(), axis.high]);
        assert!(ticks.iter().any(|tick| tick.named), "{least} to {most}");
        assert!(ticks.iter().all(|tick| tick.place.is_finite()));
    }
    let none = Axis::around(std::iter::empty(), 0.0);
    assert!(none.start() < none.high);
}
