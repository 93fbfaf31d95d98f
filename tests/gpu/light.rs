//! The light's shaders against their twins on the CPU: the blurred cube map, lobes, and the tone curve.

use std::sync::OnceLock;

use bytemuck::{Pod, Zeroable};
use glam::{Mat3, Vec2, Vec3, Vec4, vec3};
use gpu::{bind_group, read_buffer};
use inspect::for_tests::environment::{environment_dfg, environment_sheen, level_of_roughness, long_reflection};
use inspect::for_tests::prefiltered::{irradiance_map, prefiltered};
use inspect::for_tests::reflectance::{
    AmbientLight, LookAt, coat_albedo, direct_reflection, dominant_direction, mean_roughness, reflect_ambient,
    sheen_direction, transmitted,
};
use inspect::for_tests::sunlit::{SunCase, sun_cases};
use inspect::for_tests::tone::tone_mapped;
use inspect::render::blur_levels::{ENVIRONMENT_LEVELS, roughness_of_level};
use inspect::render::cube_map::CubeMap;
use inspect::render::environment::{ENVIRONMENT, Environment, LightView};
use inspect::render::irradiance::light_parts;
use inspect::render::layout::srgb;
use inspect::render::studio::studio_light;
use inspect::settings::ToneCurve;
use load::panorama::Panorama;
use wgpu::util::DeviceExt;

use crate::engine;

/// One invocation a case.
const ENTRY: &str = "
struct Case {
    look: LookAt,
    normal: vec3<f32>,
    to_eye: vec3<f32>,
    to_light: vec3<f32>,
}

struct Found {
    ambient: vec3<f32>,
    transmission: f32,
    direct: vec3<f32>,
    shown: vec3<f32>,
    irradiance: vec3<f32>,
    radiance: vec3<f32>,
    dfg: vec2<f32>,
    sheen: f32,
    through: vec3<f32>,
}

@group(0) @binding(0) var<storage, read> cases: array<Case>;
@group(0) @binding(1) var<storage, read_write> results: array<Found>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&cases) {
        return;
    }
    let one = cases[id.x];
    var found: Found;
    found.ambient = ambient_reflection(one.look, one.normal, one.to_eye);
    found.transmission = coat_transmission(one.look, one.to_eye);
    found.direct = direct_reflection(one.look, one.normal, one.to_eye, one.to_light);
    found.shown = exposed(found.ambient);
    found.irradiance = environment_irradiance(one.normal);
    found.radiance = environment_radiance(one.normal, one.look.roughness);
    found.dfg = environment_dfg(dot(one.normal, one.to_eye), mean_roughness(one.look));
    found.sheen = environment_sheen(clamp(dot(one.normal, one.to_eye), 0.0, 1.0), one.look.sheen_roughness);
    found.through = transmitted_through(one.look, one.normal, one.to_eye);
    results[id.x] = found;
}
";

#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Case {
    look: LookAt,
    normal: Vec4,
    to_eye: Vec4,
    to_light: Vec4,
}

#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Found {
    ambient: Vec3,
    transmission: f32,
    direct: Vec4,
    shown: Vec4,
    irradiance: Vec4,
    radiance: Vec4,
    dfg: Vec2,
    sheen: f32,
    _pad: f32,
    through: Vec4,
}

/// Runs the shader over all cases under an environment, which is neither turned nor exposed.
fn run(environment: &Environment, cases: &[Case]) -> Vec<Found> {
    run_in(environment, &LightView::default(), cases)
}

/// The same, turned and shown like this.
fn run_in(environment: &Environment, view: &LightView, cases: &[Case]) -> Vec<Found> {
    let gpu = &engine().gpu;
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("light"),
        source: wgpu::ShaderSource::Wgsl((ENVIRONMENT.text() + ENTRY).into()),
    });
    let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("light"),
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let buffer = |contents: &[u8]| {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
    };
    let input = buffer(bytemuck::cast_slice(cases));
    let output = buffer(bytemuck::cast_slice(&vec![Found::zeroed(); cases.len()]));
    let layout = |index| pipeline.get_bind_group_layout(index);
    let buffers = [(0, input.as_entire_binding()), (1, output.as_entire_binding())];
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &bind_group(gpu, "light", &layout(0), buffers), &[]);
    let surroundings = view.surroundings(gpu);
    let light = environment.bound(16, &surroundings);
    pass.set_bind_group(1, &bind_group(gpu, "light", &layout(1), light), &[]);
    pass.dispatch_workgroups((cases.len() as u32).div_ceil(64), 1, 1);
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    let bytes = read_buffer(gpu, &output, 0, output.size()).expect("a readback");
    bytemuck::pod_collect_to_vec(&bytes)
}

/// Materials of all kinds, seen and lit from everywhere, the same in every run.
fn cases(count: usize) -> Vec<Case> {
    let mut random = fastrand::Rng::with_seed(7);
    let mut unit = move || random.f32();
    let mut direction = {
        let mut random = fastrand::Rng::with_seed(8);
        move || {
            let mut coordinate = || random.f32() * 2.0 - 1.0;
            vec3(coordinate(), coordinate(), coordinate()).try_normalize().unwrap_or(Vec3::X)
        }
    };
    let mut case = |index: usize| {
        let normal = direction();
        let beside = |other: Vec3| if other.dot(normal) < 0.0 { -other } else { other };
        let (to_eye, to_light) = (beside(direction()), direction());
        let look = LookAt {
            base_color: vec3(unit(), unit(), unit()),
            metallic: [0.0, 1.0, unit()][index % 3],
            specular_color: vec3(unit(), unit(), unit()),
            specular: unit(),
            coat_normal: (normal + 0.2 * direction()).normalize(),
            coat: [0.0, unit()][index % 2],
            roughness: [unit(), 1.0, 0.0][index % 7 % 3],
            coat_roughness: unit(),
            ior: 1.0 + unit(),
            occlusion: [1.0, unit()][index / 2 % 2],
            transmission: [0.0, unit()][index / 4 % 2],
            sheen_color: [Vec3::ZERO, vec3(unit(), unit(), unit())][index / 8 % 2],
            sheen_roughness: 0.1 + 0.9 * unit(),
            direction: normal.cross(direction()).try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector()),
            anisotropy: [0.0, unit()][index / 16 % 2],
            ..LookAt::default()
        };
        let sheen_albedo = environment_sheen(normal.dot(to_eye).clamp(0.0, 1.0), look.sheen_roughness);
        let look = LookAt { sheen_albedo, ..look };
        Case { look, normal: normal.extend(0.0), to_eye: to_eye.extend(0.0), to_light: to_light.extend(0.0) }
    };
    (0..count).map(&mut case).collect()
}

/// The studio as the CPU's twins make it.
struct Twin {
    filtered: &'static CubeMap,
    irradiance: &'static CubeMap,
    /// Turns a direction in object space into the light's own.
    turn: Mat3,
}

impl Twin {
    fn studio(rotation: f32) -> Self {
        static CUBES: OnceLock<[CubeMap; 2]> = OnceLock::new();
        let [filtered, irradiance] = CUBES.get_or_init(|| {
            let source = CubeMap::new(128, studio_light);
            [prefiltered(&source), irradiance_map(&light_parts(source.lights()), source.size)]
        });
        Self { filtered, irradiance, turn: Mat3::from_rotation_y(-rotation.to_radians()) }
    }

    fn radiance(&self, direction: Vec3, roughness: f32) -> Vec3 {
        self.filtered.sample(self.turn * direction, level_of_roughness(roughness))
    }

    fn ambient_light(&self, case: &Case) -> AmbientLight {
        let (normal, to_eye, look) = (case.normal.truncate(), case.to_eye.truncate(), &case.look);
        let reflected = |normal, roughness| self.radiance(dominant_direction(normal, to_eye, roughness), roughness);
        let is_long = look.anisotropy > 0.0;
        let facing = normal.dot(to_eye).clamp(0.0, 1.0);
        let coat_facing = look.coat_normal.dot(to_eye).clamp(0.0, 1.0);
        AmbientLight {
            diffuse: self.irradiance.sample(self.turn * normal, 0.0),
            reflected: match is_long {
                true => {
                    long_reflection(look, normal, to_eye, |direction, roughness| self.radiance(direction, roughness))
                }
                false => reflected(normal, look.roughness),
            },
            coat_reflected: reflected(look.coat_normal, look.coat_roughness),
            sheen: self.irradiance.sample(self.turn * sheen_direction(normal, to_eye), 0.0),
            dfg: environment_dfg(facing, mean_roughness(look)).into(),
            coat_dfg: environment_dfg(coat_facing, look.coat_roughness).into(),
            facing,
            coat_facing,
        }
    }
}

/// The largest component of a difference, relative where values are above 1.
fn off(a: Vec3, b: Vec3) -> f32 {
    ((a - b).abs() / b.abs().max(Vec3::ONE)).max_element()
}

/// Half floats have 11 bits, and texture units filter in 8: a level or a texel weighs up to 1/256 more or less. The largest
/// differences were 0.008 of the radiance, and 1e-6 of what no texture is needed for.
#[test]
fn shaders_light_as_their_twins_do() {
    let environment = Environment::studio(&engine().gpu).expect("a small environment");
    let view = LightView { brightness: 0.0, rotation: 40.0, exposure: -0.5, tone_curve: ToneCurve::Neutral };
    let twin = Twin::studio(view.rotation);
    let cases = cases(2000);
    let mut most = [0.0_f32; 9];
    for (case, found) in cases.iter().zip(run_in(&environment, &view, &cases)) {
        let [normal, to_eye, to_light] = [case.normal, case.to_eye, case.to_light].map(Vec4::truncate);
        let light = twin.ambient_light(case);
        let ambient = reflect_ambient(&case.look, &light);
        let direct = direct_reflection(&case.look, normal, to_eye, to_light);
        let shown = tone_mapped(found.ambient * view.exposure.exp2(), view.tone_curve);
        let offs = [
            off(found.ambient, ambient),
            (found.transmission - (1.0 - coat_albedo(&case.look, light.coat_dfg))).abs(),
            off(found.direct.truncate(), direct),
            off(found.shown.truncate(), shown),
            off(found.irradiance.truncate(), light.diffuse),
            off(found.radiance.truncate(), twin.radiance(normal, case.look.roughness)),
            (found.dfg - light.dfg).abs().max_element(),
            off(found.through.truncate(), transmitted(&case.look, light.dfg, light.coat_dfg)),
            off(Vec3::splat(found.sheen), Vec3::splat(case.look.sheen_albedo)),
        ];
        most = std::array::from_fn(|index| most[index].max(offs[index]));
    }
    println!("{most:?}");
    let allowed = [0.02, 0.004, 1e-3, 1e-5, 0.003, 0.02, 0.004, 0.004, 0.01];
    assert!(most.iter().zip(allowed).all(|(most, allowed)| *most <= allowed), "{most:?}");
}

/// White metal and white plastic, on the device: within 1 %.
#[test]
fn white_surfaces_cannot_be_seen_in_a_white_room() {
    let environment = Environment::uniform(&engine().gpu, [1.0; 3]).expect("a small environment");
    let white = |case: Case| {
        let look = LookAt { base_color: Vec3::ONE, specular_color: Vec3::ONE, occlusion: 1.0, ..case.look };
        let sheen_color = Vec3::splat(case.look.sheen_color.x);
        Case { look: LookAt { specular: 1.0, coat_normal: case.normal.truncate(), sheen_color, ..look }, ..case }
    };
    let cases: Vec<Case> = cases(1000).into_iter().map(white).collect();
    for (case, found) in cases.iter().zip(run(&environment, &cases)) {
        // What is seen through them is white, too.
        let seen = found.ambient + found.through.truncate();
        assert!(seen.distance(Vec3::ONE) < 0.01, "{case:?}: {seen}");
    }
}

/// Each level at its own texels' directions and between them.
#[test]
fn the_pass_blurs_as_its_twin_does() {
    let twin = Twin::studio(0.0);
    let environment = Environment::studio(&engine().gpu).expect("a small environment");
    let directions: Vec<Vec3> = CubeMap::new(16, |_| Vec3::ZERO).lights().map(|(direction, ..)| direction).collect();
    for level in 0..ENVIRONMENT_LEVELS {
        let roughness = roughness_of_level(level);
        let case = |&direction: &Vec3| {
            let direction = direction.extend(0.0);
            let look = LookAt { roughness, ..LookAt::default() };
            Case { look, normal: direction, to_eye: direction, to_light: direction }
        };
        let cases: Vec<Case> = directions.iter().map(case).collect();
        let offs = directions.iter().zip(run(&environment, &cases));
        let most =
            offs.map(|(&at, found)| off(found.radiance.truncate(), twin.radiance(at, roughness))).fold(0.0, f32::max);
        println!("level {level}: {most}");
        assert!(most < 0.02, "level {level}: {most}");
    }
}

#[test]
fn environments_are_the_same_every_time() {
    let cases = cases(500);
    let [once, again] = [(); 2].map(|()| {
        let environment = Environment::studio(&engine().gpu).expect("a small environment");
        run(&environment, &cases)
    });
    assert_eq!(bytemuck::cast_slice::<_, u8>(&once), bytemuck::cast_slice::<_, u8>(&again));
}

/// A panorama that is red on the right of its middle and green on the left, with the light turned by a quarter.
#[test]
fn panoramas_stand_the_right_way_round_and_turn_from_front_to_right() {
    let [red, green] = [vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0)];
    let panorama = Panorama::from_radiance([64, 32], |direction| if direction.x < 0.0 { green } else { red });
    let environment = Environment::from_panorama(&engine().gpu, panorama).expect("a small environment");
    let seen = |direction: Vec3, rotation: f32| {
        let [normal, to_eye, to_light] = [direction.extend(0.0); 3];
        let look = LookAt { roughness: 0.0, metallic: 1.0, ..LookAt::default() };
        let view = LightView { rotation, ..LightView::default() };
        let found = run_in(&environment, &view, &[Case { look, normal, to_eye, to_light }]);
        found[0].radiance.truncate()
    };
    assert!(seen(Vec3::X, 0.0).distance(red) < 0.01 && seen(Vec3::NEG_X, 0.0).distance(green) < 0.01);
    // What came from +X now comes from -Z.
    assert!(seen(Vec3::NEG_Z, 90.0).distance(red) < 0.01 && seen(Vec3::Z, 90.0).distance(green) < 0.01);
}

/// White and matte, with these normals, in a light that is exposed by this factor.
fn matte(environment: &Environment, exposure: f32, normals: &[Vec3]) -> Vec<Found> {
    let look = LookAt { roughness: 1.0, specular: 0.0, ..LookAt::default() };
    let case = |normal: &Vec3| {
        let [normal, to_eye, to_light] = [normal.extend(0.0); 3];
        Case { look, normal, to_eye, to_light }
    };
    let view = LightView { exposure: exposure.log2(), tone_curve: ToneCurve::None, ..LightView::default() };
    run_in(environment, &view, &normals.iter().map(case).collect::<Vec<_>>())
}

/// A small sun that gives half of all light, exposed so that the side that faces it has the byte 200: within 3 of 255 steps of the
/// sum over all pixels of the panorama.
#[test]
fn a_sun_lights_a_matte_surface_as_the_sum_over_all_pixels_says() {
    for SunCase { toward, panorama, normals, exact, exposure } in sun_cases() {
        let environment = Environment::from_panorama(&engine().gpu, panorama).expect("a small environment");
        for (found, exact) in matte(&environment, exposure, &normals).iter().zip(exact) {
            let found = found.shown.truncate().to_array().map(srgb);
            let exact = (exact.as_vec3() * exposure).to_array().map(srgb);
            let most = found.iter().zip(exact).map(|(found, exact)| found.abs_diff(exact)).max();
            assert!(most <= Some(3), "{toward}: {found:?}, not {exact:?}");
        }
    }
}

/// Half floats hold 65,504 at most.
#[test]
fn the_brightest_suns_are_finite() {
    for size in [[64, 32], [256, 128]] {
        let light = |direction: Vec3| Vec3::splat(if direction.y > 0.9 { 1e38 } else { 0.5 });
        let panorama = Panorama::from_radiance(size, light);
        let environment = Environment::from_panorama(&engine().gpu, panorama).expect("a small environment");
        let found = matte(&environment, 1.0, &[Vec3::Y, Vec3::NEG_Y]);
        let [up, down] = [0, 1].map(|index: usize| found[index].irradiance.truncate());
        assert!(up.is_finite() && up.min_element() > 60_000.0, "{size:?}: {up}");
        assert!(down.distance(Vec3::splat(0.5)) < 0.01, "{size:?}: {down}");
        assert!(found.iter().all(|found| found.radiance.is_finite()), "{size:?}: {found:?}");
    }
}

#[test]
fn without_a_tone_curve_exposure_is_a_factor() {
    let environment = Environment::uniform(&engine().gpu, [0.5; 3]).expect("a small environment");
    let view = LightView { exposure: 3.0, tone_curve: ToneCurve::None, ..LightView::default() };
    for found in run_in(&environment, &view, &cases(50)) {
        assert!(found.shown.truncate().distance(8.0 * found.ambient) < 1e-5);
    }
}
