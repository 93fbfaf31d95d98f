//! Exported shaders that displace under LOD by the view: a shader of its own, or the first pass, finds the mip level at each point.

use documents::assert_part_of_page;
use geometry::mesh::{Mesh, Shape, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{
    Clip, Convention, Displacement, Edges, FACTOR_VALUE, HullFactors, Inputs, Lod, LodView, Normals, Partitioning,
    PatchFactors, Surface, Tessellated, Tessellation, Vertex, tessellate, tessellate_given,
};
use glam::Vec2;
use inspect::render::Camera;
use inspect::shader_files::{Language, ShaderFile, shader_files};

use crate::engine;
use crate::exported::vulkan;
use crate::exported_displaced::{Passes, assert_all_agree, assert_displaced_agrees, assert_near, shifted};
use crate::vulkan::agreement::{Agreement, shared_points};
use crate::vulkan::exported::{
    DISPLACEMENTS, LANGUAGES, Subject, VIEWPORT, lods_by_view, rows_by_view, table_by_view, wavy,
};
use crate::vulkan::stages::CapturedCorner;

/// A tessellation whose edges have factors of about 2 to 6, so that neighbours read clearly different levels.
fn usual(lod: Lod) -> Tessellation {
    Tessellation {
        lod,
        displacement: Displacement::On,
        factor: 9.0,
        pixels: 30.0,
        near: 2.0,
        far: 6.0,
        height_scale: 0.2,
        midlevel: 0.3,
        ..Tessellation::default()
    }
}

#[test]
fn every_surface_displaced_by_the_view_agrees_and_the_page_says_so() {
    let mut subject = Subject::new(engine(), &vulkan(), wavy(Shape::CubeSplit.build())).expect("a small mesh");
    let rows = rows_by_view(&mut subject).expect("shaders that run");
    for row in &rows {
        let what = format!("{:?} {:?} {:?}", row.lod, row.displacement, row.language);
        assert_agrees(&row.agreement, row.displacement != Displacement::On, &what);
    }
    assert_eq!(rows.len(), lods_by_view().count() * DISPLACEMENTS.len() * LANGUAGES.len());
    assert_part_of_page("docs/results/shaders.md", "table of agreement by the view", &table_by_view(&rows));
    for (surface, lod) in Surface::ALL.into_iter().zip(lods_by_view().cycle()) {
        for language in LANGUAGES {
            let own = Tessellation { surface, ..usual(lod) };
            let agreement = subject.agreement(language, &own, &|weights| weights).expect("shaders that run");
            assert_agrees(&agreement, surface.tears(), &format!("{surface:?} {lod:?} {language:?}"));
        }
    }
}

/// Same factors, same triangles and positions, and the same bits on shared edges unless these tear.
fn assert_agrees(own: &Agreement, tears: bool, what: &str) {
    assert_displaced_agrees(own, what);
    assert!(own.factors <= 1e-6, "{what}: {own:?}");
    assert!(own.shared > 50, "{what}: {own:?}");
    assert_eq!(own.torn > 0, tears, "{what}: {own:?}");
}

#[test]
fn partitionings_conventions_normals_and_edges_agree_by_the_view_too() {
    let partitionings = [Partitioning::Integer, Partitioning::Pow2, Partitioning::FractionalEven];
    let mut tried: Vec<_> = lods_by_view()
        .cycle()
        .zip(partitionings)
        .map(|(lod, partitioning)| Tessellation { partitioning, ..usual(lod) })
        .collect();
    for (lod, convention) in lods_by_view().cycle().zip([Convention::AmdPn, Convention::EdgeOrder, Convention::Rotated])
    {
        tried.push(Tessellation { convention, ..usual(lod) });
    }
    for (lod, normals) in lods_by_view().cycle().zip([Normals::Quadratic, Normals::Surface]) {
        tried.push(Tessellation { normals, ..usual(lod) });
    }
    tried.push(Tessellation { edges: Edges::AsPublished, ..usual(Lod::Distance) });
    assert_all_agree(&tried);
}

/// The exported GLSL with a piece of a file replaced.
fn changed(own: &Tessellation, name: &str, piece: &str, other: &str) -> Vec<ShaderFile> {
    let mut files = shader_files(Language::Glsl, own, "a test").expect("GLSL");
    let file = files.iter_mut().find(|file| file.name == name).expect("the file");
    assert_eq!(file.text.matches(piece).count(), 1, "{piece}");
    file.text = file.text.replace(piece, other);
    files
}

#[test]
fn levels_of_a_patchs_own_edges_would_tear() {
    let mut subject = Subject::new(engine(), &vulkan(), wavy(Shape::CubeSplit.build())).expect("a small mesh");
    for lod in lods_by_view() {
        // A corner's sides are the one that begins there and the one before.
        let own_edges = "relief.corner_levels = min(side_levels, side_levels.zxy);";
        let files = changed(&usual(lod), "patch.tese", "relief.corner_levels = corner_levels;", own_edges);
        let agreement = subject.agreement_of(&files, Language::Glsl, &usual(lod), &|weights| weights);
        let agreement = agreement.expect("shaders that run");
        assert!(agreement.torn > 0 && agreement.position_ulps > 1000.0, "{lod:?}: {agreement:?}");
    }
}

/// A view with the right half of a mesh out of it.
fn partly_seen(mesh: &Mesh) -> LodView {
    let mut camera = Camera::framing(&mesh.bounds(), VIEWPORT);
    camera.pan(Vec2::new(300.0, 0.0), VIEWPORT);
    camera.lod_view(VIEWPORT, &mesh.bounds())
}

#[test]
fn patches_that_clipping_leaves_out_count_at_points() {
    // Whole numbers of segments, so that points lie at the same places although factors differ in their last bits.
    let partitioning = Partitioning::Integer;
    let mesh = shifted(Shape::Torus, 0.37);
    let view = partly_seen(&mesh);
    let mut subject = Subject::new(engine(), &vulkan(), mesh).expect("a small mesh");
    subject.view = view;
    let weights = |weights| weights;
    let by_frustum = lods_by_view().map(|lod| (lod, Clip::Frustum));
    for (lod, clip) in by_frustum.chain([(Lod::EdgeLength, Clip::Paper)]) {
        let whole = Tessellation { partitioning, ..usual(lod) };
        let own = Tessellation { clip, ..whole };
        let all = subject.agreement(Language::Glsl, &whole, &weights).expect("shaders that run");
        for language in LANGUAGES {
            let agreement = subject.agreement(language, &own, &weights).expect("shaders that run");
            let what = format!("{own:?} {language:?}");
            assert_displaced_agrees(&agreement, &what);
            assert_eq!(agreement.torn, 0, "{what}: {agreement:?}");
            assert!(agreement.triangles < all.triangles, "{what}: nothing was left out");
        }
        // A shader that didn't count them would read other heights at the border of what is drawn.
        let start = "    uint first = PATCH_INDICES * patch_index;\n";
        let skip = "    bool is_out = true;
    for (uint k = 0u; k < 3u; k++) {
        vec4 clip = constants.view.clip_from_object * vec4(position_at(first + k), 1.0);
        is_out = is_out && clip.x > clip.w;
    }
    if (is_out) {
        return;
    }
";
        let files = changed(&own, "levels.comp", start, &format!("{start}{skip}"));
        let broken = subject.agreement_of(&files, Language::Glsl, &own, &weights).expect("shaders that run");
        assert!(broken.position_ulps > 100.0, "{own:?}: {broken:?}");
    }
}

/// The factors that the tessellator worked with, as a hull shader would write them.
fn written(factors: &[PatchFactors]) -> Vec<HullFactors> {
    let number = |word: u32| (word & FACTOR_VALUE) as f32 / 65536.0;
    let of = |own: &PatchFactors| HullFactors { edges: own.outside.map(number), inside: number(own.inside) };
    factors.iter().map(of).collect()
}

/// What passes emitted, as if it were captured: patches and domain points are those of the CPU's vertices.
fn captured(vertices: &[[f32; 8]], triangles: &[[u32; 3]], cpu: &[Vertex]) -> Vec<[CapturedCorner; 3]> {
    let corner = |at: u32| {
        let ([x, y, z, a, b, c, s, t], other) = (vertices[at as usize], cpu[at as usize]);
        let [u, v] = other.domain().map(|weight| weight as f32 / 65536.0);
        CapturedCorner {
            position: [x, y, z, 1.0],
            normal: [a, b, c, 0.0],
            uv: [s, t, 0.0, 0.0],
            place: [u, v, 1.0 - u - v, other.patch() as f32],
            factors: [0.0; 4],
        }
    };
    triangles.iter().map(|triangle| triangle.map(corner)).collect()
}

/// Runs the passes on a mesh that is seen like this, and holds what they emit to the CPU. Returns the CPU's.
fn assert_passes_agree(mesh: &Mesh, own: &Tessellation, view: LodView) -> Tessellated {
    let topology = Topology::build(mesh, &Progress::new()).expect("not cancelled");
    let files = shader_files(Language::Wgsl, own, "a test").expect("WGSL of any pattern");
    let passes = Passes::new(mesh, &topology, own, view);
    let (vertices, triangles) = passes.run(&files[0].text);
    let inputs = Inputs::new(own, view);
    let is_fractional = matches!(own.partitioning, Partitioning::FractionalOdd | Partitioning::FractionalEven);
    // Factors differ in their last bits, which moves points only if factors needn't be whole numbers.
    let cpu = match is_fractional {
        true => tessellate_given(mesh, &topology, &inputs, &written(&passes.factors())),
        false => tessellate(mesh, &topology, &inputs, None),
    };
    let what = format!("{own:?}");
    assert!(triangles == cpu.triangles && !triangles.is_empty(), "{what}: triangles");
    assert_near(&vertices, &cpu.vertices, mesh.bounds().radius(), &what);
    let patches = 0..topology.patches.len() as u32;
    let corners: Vec<_> = patches.map(|patch| topology.patch_positions(patch).map(|point| point.to_array())).collect();
    let (shared, torn) = shared_points(&captured(&vertices, &triangles, &cpu.vertices), &corners, &|weights| weights);
    assert!(shared > 50, "{what}: {shared} points on shared edges");
    assert_eq!(torn > 0, own.displacement != Displacement::On, "{what}: {torn} of {shared} points have other bits");
    cpu
}

#[test]
fn exported_compute_passes_displace_by_the_view_as_the_cpu_does() {
    let mesh = wavy(Shape::CubeSplit.build());
    let view = Camera::framing(&mesh.bounds(), VIEWPORT).lod_view(VIEWPORT, &mesh.bounds());
    // Subtriangulation has a factor for the whole mesh.
    let partitionings = Partitioning::ALL.into_iter().filter(|own| *own != Partitioning::Subtriangulation);
    for ((turn, partitioning), lod) in partitionings.enumerate().zip(lods_by_view().cycle()) {
        let displacement = DISPLACEMENTS[turn % 3];
        let normals = [Normals::Linear, Normals::Surface][turn % 2];
        let own = Tessellation { partitioning, normals, ..usual(lod) };
        assert_passes_agree(&mesh, &own, view);
        assert_passes_agree(&mesh, &Tessellation { displacement, ..own }, view);
    }
}

#[test]
fn patches_that_clipping_leaves_out_count_in_compute_passes() {
    let mesh = shifted(Shape::Torus, 0.37);
    let view = partly_seen(&mesh);
    for lod in lods_by_view() {
        let whole = Tessellation { partitioning: Partitioning::Integer, ..usual(lod) };
        let all = assert_passes_agree(&mesh, &whole, view);
        let seen = assert_passes_agree(&mesh, &Tessellation { clip: Clip::Frustum, ..whole }, view);
        assert!(seen.triangles.len() < all.triangles.len(), "{lod:?}: nothing was left out");
    }
}
