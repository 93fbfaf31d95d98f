//! Measures how many pictures a second the window shows while its camera turns: `cargo bench --bench orbit`. Arguments after `--`
//! are mesh files that are measured too; `seconds=N` is how long each mesh is turned (5).
//!
//! The window is driven as a person does, with a drag of 4 points a frame. It is painted into a texture that nothing reads back, and each
//! frame waits until the one before it is painted, as a window does that has two frames in flight. Each mesh is measured with its
//! opening settings, first with previews in place of pictures that would be late, and then with full pictures alone. Before the
//! first drag the window rests for two seconds, as it does while somebody looks at a mesh that was opened. A picture counts once, when
//! the window shows it for the first time. Last, the window is painted while nothing but the pointer moves: that is the time which no
//! preview can go below. The bench reports its results, and no result makes it fail.

#[path = "../window/driver.rs"]
mod driver;

use std::path::PathBuf;
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui::{Event, Modifiers, PointerButton, Pos2};
use egui_kittest::kittest::Queryable;
use egui_kittest::wgpu::{create_render_state, default_wgpu_setup};
use egui_kittest::{Harness, TestRenderer};
use egui_wgpu::{RenderState, RendererOptions, ScreenDescriptor};
use geometry::mesh::shapes::Shape;
use load::files::Limits;
use load::source::Source;
use pnaen::app::App;

use driver::settle;

/// Width and height of the window, in points.
const SIZE: [f32; 2] = [1280.0, 720.0];
/// How long the window rests before the first drag.
const REST: Duration = Duration::from_secs(2);
/// How far the pointer moves from frame to frame, in points.
const STEP: f32 = 4.0;

/// What a window showed while its camera turned.
struct Shown {
    /// Pictures for each second, previews included.
    rate: f64,
    /// The time between two frames of the window in ms: the median, and the 95th percentile.
    frame_ms: [f64; 2],
}

/// Paints the window as the program does, without reading its picture back: the renderer of `egui_kittest` takes as long for that as
/// for the painting.
struct Painter {
    state: RenderState,
    screen: Option<wgpu::Texture>,
    /// What was submitted for the last frame.
    last: Option<wgpu::SubmissionIndex>,
}

impl Painter {
    fn new() -> Self {
        // As the program paints: without the slower filtering that makes pictures of tests predictable.
        let state = create_render_state(default_wgpu_setup(), RendererOptions::default());
        Self { state, screen: None, last: None }
    }

    /// Returns the texture that stands for the window, in px.
    fn screen(&mut self, size: [u32; 2]) -> wgpu::TextureView {
        let texture = self.screen.get_or_insert_with(|| {
            self.state.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("window"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: self.state.target_format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        });
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }
}

impl TestRenderer for Painter {
    fn setup_eframe(&self, context: &mut eframe::CreationContext<'_>, frame: &mut eframe::Frame) {
        context.wgpu_render_state = Some(self.state.clone());
        frame.wgpu_render_state = Some(self.state.clone());
    }

    fn handle_delta(&mut self, delta: &mut egui::TexturesDelta) {
        let mut renderer = self.state.renderer.write();
        for (id, images) in delta.set.drain() {
            for image in images {
                renderer.update_texture(&self.state.device, &self.state.queue, id, &image);
            }
        }
        for id in delta.free.drain() {
            renderer.free_texture(&id);
        }
    }

    /// Paints the window. Returns a picture without meaning.
    fn render(&mut self, context: &egui::Context, output: &egui::FullOutput) -> Result<image::RgbaImage, String> {
        let pixels_per_point = context.pixels_per_point();
        let size = context.content_rect().size() * pixels_per_point;
        let size_in_pixels = [size.x.round() as u32, size.y.round() as u32];
        let screen = ScreenDescriptor { pixels_per_point, size_in_pixels };
        let primitives = context.tessellate(output.shapes.clone(), pixels_per_point);
        let view = self.screen(size_in_pixels);
        let RenderState { device, queue, renderer, .. } = &self.state;
        let mut renderer = renderer.write();
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut commands = renderer.update_buffers(device, queue, &mut encoder, &primitives, &screen);
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                resolve_target: None,
                ops: wgpu::Operations::default(),
                depth_slice: None,
            })],
            ..Default::default()
        });
        renderer.render(&mut pass.forget_lifetime(), &primitives, &screen);
        commands.push(encoder.finish());
        let submitted = queue.submit(commands);
        if let Some(submission_index) = self.last.replace(submitted) {
            let waiting = wgpu::PollType::Wait { submission_index: Some(submission_index), timeout: None };
            device.poll(waiting).map_err(|error| error.to_string())?;
        }
        Ok(image::RgbaImage::new(1, 1))
    }
}

fn window(source: &Source) -> Harness<'static, App> {
    let source = Some(source.clone());
    let mut harness = Harness::builder().with_size(SIZE).renderer(Painter::new()).build_eframe(move |context| {
        App::new(context, source, Limits::default()).expect("the bench needs a graphics adapter")
    });
    settle(&mut harness);
    harness
}

fn pointer(harness: &mut Harness<App>, at: Pos2, pressed: Option<bool>) {
    harness.event(Event::PointerMoved(at));
    if let Some(pressed) = pressed {
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        harness.event(Event::PointerButton { pos: at, button, pressed, modifiers });
    }
}

/// Shows frames for some time without any input.
fn rest(harness: &mut Harness<App>, time: Duration) {
    let start = Instant::now();
    while start.elapsed() < time {
        harness.step();
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Turns the camera for some time.
fn turn(harness: &mut Harness<App>, time: Duration) -> Shown {
    let viewport = harness.get_by_role_and_label(Role::Image, "Viewport").rect();
    let at = |frame: u32| viewport.center() + egui::vec2(STEP * (frame % 50) as f32, 0.0);
    pointer(harness, at(0), Some(true));
    harness.step();
    let seen = |harness: &Harness<App>| harness.state().pictures() + harness.state().previews();
    let (before, start) = (seen(harness), Instant::now());
    let mut frames = Vec::new();
    while start.elapsed() < time {
        let frame = Instant::now();
        pointer(harness, at(frames.len() as u32), None);
        harness.step();
        let _ = harness.render();
        frames.push(frame.elapsed().as_secs_f64() * 1e3);
    }
    let rate = (seen(harness) - before) as f64 / start.elapsed().as_secs_f64();
    pointer(harness, at(0), Some(false));
    settle(harness);
    frames.sort_by(f64::total_cmp);
    let percentile = |part: f64| frames.get((part * frames.len() as f64) as usize).copied().unwrap_or(f64::NAN);
    Shown { rate, frame_ms: [percentile(0.5), percentile(0.95)] }
}

/// Moves the pointer over the settings, which draws no picture. Returns how long a frame of the window takes in ms: the median.
fn painting_ms(harness: &mut Harness<App>) -> f64 {
    let mut frames: Vec<f64> = (0..40)
        .map(|frame| {
            pointer(harness, Pos2::new(40.0 + 4.0 * (frame % 20) as f32, 300.0), None);
            let start = Instant::now();
            harness.step();
            let _ = harness.render();
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    frames.sort_by(f64::total_cmp);
    frames[frames.len() / 2]
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    let seconds = arguments.iter().find_map(|argument| argument.strip_prefix("seconds=")?.parse().ok()).unwrap_or(5.0);
    let files =
        arguments.iter().filter(|argument| !argument.contains('=')).map(|path| Source::File(PathBuf::from(path)));
    let meshes = [Source::Vase, Source::Shape(Shape::Torus)].into_iter().chain(files);
    println!("Window of {} x {} points, {seconds} s each\n", SIZE[0], SIZE[1]);
    println!(
        "| mesh | triangles | full pictures a second | frame, ms (median, 95 %) | with previews | frame, ms | window \
         alone, ms |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for source in meshes {
        let mut harness = window(&source);
        let time = Duration::from_secs_f64(seconds);
        rest(&mut harness, REST);
        let previewed = turn(&mut harness, time);
        harness.state_mut().switch_previews();
        let full = turn(&mut harness, time);
        let painting = painting_ms(&mut harness);
        let triangles = harness.state().totals().map_or(0, |(_, triangles)| triangles);
        let ms = |shown: &Shown| format!("{:.1}, {:.1}", shown.frame_ms[0], shown.frame_ms[1]);
        println!(
            "| {} | {triangles} | {:.1} | {} | {:.1} | {} | {painting:.1} |",
            source.title(),
            full.rate,
            ms(&full),
            previewed.rate,
            ms(&previewed)
        );
    }
}
