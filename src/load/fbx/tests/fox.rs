//! Temporary: against glTF.
use crate::files::Limits;
use crate::load::mesh_file::load;
use crate::mesh::{Moment, Topology};
use crate::progress::Progress;
use crate::tessellate::deform;
use std::path::Path;

#[test]
fn morph_shapes() {
    let bytes = std::fs::read("/work/shared/meshes/MorphStressTest.fbx").unwrap();
    let budget = crate::load::memory_budget::Budget::new(bytes.len(), &Limits::default());
    let scene = super::super::parse::scene(&bytes, &budget, &Progress::new()).unwrap();
    println!(
        "memory {} temp {} of file {}",
        scene.metadata.result_memory_used,
        scene.metadata.temp_memory_used,
        bytes.len()
    );
    for s in &scene.blend_shapes {
        let f = |g: fn(f64, f64) -> f64| {
            [0, 1, 2].map(|k| s.position_offsets.iter().map(|v| [v.x, v.y, v.z][k]).fold(0.0, g))
        };
        println!(
            "{} {} {:?} {:?} normals {}",
            s.element.name.as_ref(),
            s.num_offsets,
            f(f64::min),
            f(f64::max),
            s.normal_offsets.iter().filter(|n| n.x != 0.0 || n.y != 0.0 || n.z != 0.0).count()
        );
    }
    let bytes = std::fs::read("/work/shared/meshes/Fox.fbx").unwrap();
    let scene = super::super::parse::scene(&bytes, &budget, &Progress::new()).unwrap();
    println!(
        "fox memory {} temp {} of file {}",
        scene.metadata.result_memory_used,
        scene.metadata.temp_memory_used,
        bytes.len()
    );
}

#[test]
fn fox_compare() {
    for (a, b) in [("Fox.fbx", "Fox.glb"), ("MorphStressTest.fbx", "MorphStressTest.gltf")] {
        let [f, g] = [a, b]
            .map(|n| load(&Path::new("/work/shared/meshes").join(n), &Limits::default(), &Progress::new()).unwrap());
        println!(
            "{a}: {} {} tris; corners {} {}; {:?} | {:?}",
            f.triangles.len(),
            g.triangles.len(),
            f.corners.len(),
            g.corners.len(),
            f.warnings,
            g.warnings
        );
        for m in f.materials.iter().chain(&g.materials) {
            println!(
                "  material {} {:?} tex {:?} metal {} rough {} {:?}",
                m.name,
                m.base_color,
                m.texture.as_ref().map(|t| t.size),
                m.look.metallic,
                m.look.roughness,
                m.look.alpha
            );
        }
        let size = |m: &crate::mesh::Mesh| {
            let b = m.bounds();
            (b.center(), b.radius())
        };
        println!("  bounds {:?} {:?}", size(&f.mesh), size(&g.mesh));
        let (rf, rg) = (f.rig.as_ref(), g.rig.as_ref());
        let (Some(rf), Some(rg)) = (rf, rg) else {
            println!("  no rig {} {}", rf.is_some(), rg.is_some());
            continue;
        };
        println!(
            "  clips {:?} | {:?}",
            rf.clips.iter().map(|c| (c.name.clone(), c.duration)).collect::<Vec<_>>(),
            rg.clips.iter().map(|c| (c.name.clone(), c.duration)).collect::<Vec<_>>()
        );
        let [tf, tg] = [&f, &g].map(|m| Topology::build(&m.mesh, &Progress::new()).unwrap());
        let radius = size(&g.mesh).1;
        for (i, clip) in rg.clips.iter().enumerate() {
            let Some(j) = rf.clips.iter().position(|c| c.name.contains(&clip.name)) else {
                println!("  no clip {}", clip.name);
                continue;
            };
            for t in 0..=7 {
                let time = (clip.duration * 24.0 * f64::from(t) / 7.0).floor() / 24.0;
                let (pf, _) = deform(&f.mesh, &tf, &rf.pose(Moment { clip: j, time }));
                let (pg, _) = deform(&g.mesh, &tg, &rg.pose(Moment { clip: i, time }));
                let cloud = |m: &crate::mesh::Mesh| {
                    m.triangles.as_flattened().iter().map(|&c| m.corners[c as usize].position).collect::<Vec<_>>()
                };
                let (cf, cg) = (cloud(&pf), cloud(&pg));
                // nearest distance each way
                let one = |a: &[glam::Vec3], b: &[glam::Vec3]| {
                    a.iter().map(|p| b.iter().map(|q| p.distance(*q)).fold(f32::MAX, f32::min)).fold(0.0, f32::max)
                };
                let scale = std::env::var("FBX_SCALE").ok().and_then(|s| s.parse::<f32>().ok()).unwrap_or(1.0);
                let cf: Vec<_> = cf.iter().map(|p| *p * scale).collect();
                let ordered = cf.iter().zip(&cg).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
                println!(
                    "  {} t={time:.3} nearest {:.2e} {:.2e} ordered {:.2e} (relative to radius)",
                    clip.name,
                    one(&cf, &cg) / radius,
                    one(&cg, &cf) / radius,
                    ordered / radius
                );
            }
        }
    }
}
