use super::*;
use crate::engine::Engine;
use crate::render::textures::first_level;
use geometry::mesh::Texture;
use geometry::mesh::mipmap::{covered, mip_levels};
use gpu::read_texture;

fn engine() -> &'static Engine {
    static ENGINE: std::sync::LazyLock<Engine> =
        std::sync::LazyLock::new(|| Engine::headless().expect("these tests need a graphics adapter: run ./setup.sh"));
    &ENGINE
}

/// An image of noise, always the same. Its alpha is that of leaves: mostly 0 or 255.
fn noise(size: [u32; 2]) -> Texture {
    let mut random = fastrand::Rng::with_seed(u64::from(size[0]) << 32 | u64::from(size[1]));
    let alpha = |random: &mut fastrand::Rng| match random.u8(..4) {
        0 => 255,
        1 => random.u8(..),
        _ => 0,
    };
    let texel = |_| [random.u8(..), random.u8(..), random.u8(..), alpha(&mut random)];
    Texture { size, rgba: (0..size[0] * size[1]).flat_map(texel).collect() }
}

/// The levels of an image that the passes make, but the first.
fn made(source: &Texture, filter: MipFilter, least: Option<u32>) -> Vec<Texture> {
    let gpu = &engine().gpu;
    let image = first_level(gpu, source, wgpu::TextureUsages::COPY_SRC);
    let first = image.create_view(&wgpu::TextureViewDescriptor {
        format: Some(wgpu::TextureFormat::Rgba8Unorm),
        mip_level_count: Some(1),
        ..Default::default()
    });
    let test = least.map(|least| AlphaTest { least, covered: covered(source, least) });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    Mipmaps::new().fill(gpu, &mut encoder, &image, &first, filter, test).expect("a small image");
    gpu.queue.submit([encoder.finish()]);
    (1..level_count(source.size)).map(|level| read_level(gpu, &image, level)).collect()
}

fn read_level(gpu: &Gpu, image: &wgpu::Texture, level: u32) -> Texture {
    let size = level_size([image.width(), image.height()], level);
    let blank = Texture { size, rgba: vec![0; 4 * (size[0] * size[1]) as usize] };
    let alone = first_level(gpu, &blank, wgpu::TextureUsages::COPY_SRC);
    let from = wgpu::TexelCopyTextureInfo { mip_level: level, ..image.as_image_copy() };
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let extent = wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 };
    encoder.copy_texture_to_texture(from, alone.as_image_copy(), extent);
    gpu.queue.submit([encoder.finish()]);
    Texture { size, rgba: read_texture(gpu, &alone).expect("a readback") }
}

/// The largest difference of a byte of two lists of levels.
fn difference(a: &[Texture], b: &[Texture]) -> u8 {
    assert_eq!(
        a.iter().map(|level| level.size).collect::<Vec<_>>(),
        b.iter().map(|level| level.size).collect::<Vec<_>>()
    );
    let bytes = |levels: &[Texture]| levels.iter().flat_map(|level| level.rgba.clone()).collect::<Vec<_>>();
    bytes(a).into_iter().zip(bytes(b)).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
}

const FILTERS: [MipFilter; 4] = [MipFilter::Colors, MipFilter::AlphaWeighted, MipFilter::Numbers, MipFilter::Normals];

/// A device may divide and take square roots with an error of a few ULP, so that a number half-way between two bytes may become
/// either of them.
const MOST: u8 = 1;

#[test]
fn the_passes_make_what_the_cpu_makes() {
    for size in [[64, 64], [61, 45], [1, 7], [300, 3], [2, 2], [129, 128]] {
        let source = noise(size);
        for filter in FILTERS {
            let worst = difference(&made(&source, filter, None), &mip_levels(&source, filter, None));
            assert!(worst <= MOST, "{size:?} {filter:?}: {worst} steps");
        }
        for least in [1, 128, 250] {
            let expected = mip_levels(&source, MipFilter::AlphaWeighted, Some(least));
            let worst = difference(&made(&source, MipFilter::AlphaWeighted, Some(least)), &expected);
            assert!(worst <= MOST, "{size:?} from {least}: {worst} steps");
        }
    }
}

#[test]
fn the_passes_make_the_same_every_time() {
    let source = noise([117, 64]);
    for filter in FILTERS {
        let [first, second] = [(); 2].map(|()| made(&source, filter, Some(100)));
        assert_eq!(difference(&first, &second), 0, "{filter:?}");
    }
}

#[test]
fn an_image_of_one_texel_needs_no_pass() {
    assert!(made(&noise([1, 1]), MipFilter::Colors, Some(128)).is_empty());
}

#[test]
fn the_default_limits_of_webgpu_hold_the_levels_of_the_largest_image() {
    let limits = wgpu::Limits::default();
    let side = limits.max_texture_dimension_2d;
    assert!(level_bytes([side; 2]) <= limits.max_storage_buffer_binding_size);
    assert!(level_bytes([side, 1]) < 8 << 20);
}
