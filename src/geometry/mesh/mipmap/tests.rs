use super::*;

/// An image of noise, always the same. Its alpha is that of leaves: mostly 0 or 255.
pub(crate) fn noise(size: [u32; 2]) -> Texture {
    let mut random = fastrand::Rng::with_seed(u64::from(size[0]) << 32 | u64::from(size[1]));
    let alpha = |random: &mut fastrand::Rng| match random.u8(..4) {
        0 => 255,
        1 => random.u8(..),
        _ => 0,
    };
    let texel = |_| [random.u8(..), random.u8(..), random.u8(..), alpha(&mut random)];
    Texture { size, rgba: (0..size[0] * size[1]).flat_map(texel).collect() }
}

fn of(size: [u32; 2], texels: &[[u8; 4]]) -> Texture {
    Texture { size, rgba: texels.concat() }
}

const FILTERS: [MipFilter; 4] = [MipFilter::Colors, MipFilter::AlphaWeighted, MipFilter::Numbers, MipFilter::Normals];

#[test]
fn every_texel_counts_as_much_as_any_other() {
    for source in 1..200 {
        let mut counted = vec![0.0; source as usize];
        let targets = (source / 2).max(1);
        for target in 0..targets {
            let Taps { first, weights } = Taps::new(target, source);
            for (k, weight) in weights.into_iter().enumerate().filter(|(_, weight)| *weight > 0.0) {
                counted[first as usize + k] += weight;
            }
            let expected = if source == 1 { 1 } else { [2, source][source as usize % 2] };
            assert_eq!(weights.iter().sum::<f32>(), expected as f32, "of {source}");
        }
        assert!(counted.iter().all(|count| *count == counted[0]), "of {source}: {counted:?}");
    }
}

#[test]
fn one_colour_stays_as_it_is() {
    for byte in 0..=255 {
        for filter in FILTERS {
            // Normals other than unit vectors change.
            let own = if filter == MipFilter::Normals { [128, 128, 255, byte] } else { [byte, 255 - byte, 7, byte] };
            for made in mip_levels(&of([5, 3], &[own; 15]), filter, None) {
                assert!(made.rgba.chunks(4).all(|texel| texel == own), "{filter:?} {own:?}: {:?}", made.rgba);
            }
        }
    }
}

#[test]
fn colours_are_averaged_in_linear_light_and_numbers_are_not() {
    let half = of([2, 2], &[[0, 0, 0, 255], [255; 4], [255; 4], [0, 0, 0, 255]]);
    assert_eq!(halved(&half, MipFilter::Colors).rgba, [188, 188, 188, 255]);
    assert_eq!(halved(&half, MipFilter::Numbers).rgba, [128, 128, 128, 255]);
}

#[test]
fn what_is_transparent_adds_no_fringe() {
    let leaf = of([2, 1], &[[40, 200, 60, 255], [0, 0, 0, 0]]);
    assert_eq!(halved(&leaf, MipFilter::AlphaWeighted).rgba, [40, 200, 60, 128]);
    let nothing = of([2, 1], &[[40, 200, 60, 0]; 2]);
    assert_eq!(halved(&nothing, MipFilter::AlphaWeighted).rgba, [40, 200, 60, 0]);
}

#[test]
fn normals_stay_unit_vectors() {
    // Tilted by 45 degrees to both sides, and away from each other.
    let tilted = of([2, 1], &[[218, 128, 218, 255], [38, 128, 218, 255]]);
    assert_eq!(halved(&tilted, MipFilter::Normals).rgba, [128, 128, 255, 255]);
    // Two that are opposite leave no direction; bytes have no exact 0, so these add up to nothing.
    let opposite = of([2, 1], &[[255, 100, 20, 255], [0, 155, 235, 255]]);
    assert_eq!(halved(&opposite, MipFilter::Normals).rgba, [128, 128, 255, 255]);
}

#[test]
fn levels_of_odd_sizes_keep_the_average() {
    let source = noise([37, 21]);
    let mean = |texture: &Texture| {
        let sum: f64 = texture.rgba.iter().step_by(4).map(|byte| f64::from(*byte)).sum();
        sum / f64::from(texture.size[0] * texture.size[1])
    };
    let levels = mip_levels(&source, MipFilter::Numbers, None);
    assert_eq!(levels.iter().map(|level| level.size).collect::<Vec<_>>(), [[18, 10], [9, 5], [4, 2], [2, 1], [1, 1]]);
    // Each level is rounded to bytes.
    for level in levels {
        assert!((mean(&level) - mean(&source)).abs() < 1.0, "{:?}: {} of {}", level.size, mean(&level), mean(&source));
    }
}

#[test]
fn rows_that_come_one_by_one_make_the_same_image() {
    for size in [[8, 8], [7, 5], [1, 9], [6, 1], [1, 1], [33, 64]] {
        for filter in FILTERS {
            let source = noise(size);
            let mut halver = RowHalver::new(size, filter);
            let rows = source.rgba.chunks(4 * size[0] as usize).filter_map(|row| halver.push(row.to_vec()));
            assert_eq!(rows.collect::<Vec<_>>().concat(), halved(&source, filter).rgba, "{size:?} {filter:?}");
        }
    }
}

#[test]
fn as_much_of_a_mask_passes_on_every_level() {
    for (size, least) in [([64, 64], 128), ([61, 45], 30), ([32, 32], 255)] {
        let source = noise(size);
        let all = covered(&source, least);
        for (level, made) in (1..).zip(mip_levels(&source, MipFilter::AlphaWeighted, Some(least))) {
            let (found, wanted) = (covered(&made, least), u64::from(wanted_texels(all, size, level)));
            // Several texels may have one alpha, and then pass together.
            let texels = u64::from(made.size[0] * made.size[1]);
            assert!(
                found.abs_diff(wanted) <= 1 + texels / 40,
                "{size:?} level {level}: {found}, not {wanted} of {texels}"
            );
        }
    }
    // Without that, thin parts vanish: a tenth of the texels are covered.
    let lines = of([10, 10], &(0..100).map(|i| [0, 0, 0, if i % 10 == 3 { 255 } else { 0 }]).collect::<Vec<_>>());
    let plain = mip_levels(&lines, MipFilter::AlphaWeighted, None);
    let kept = mip_levels(&lines, MipFilter::AlphaWeighted, Some(200));
    assert_eq!([covered(&plain[0], 200), covered(&kept[0], 200)], [0, 5]);
}

#[test]
fn a_mask_that_nothing_or_all_passes_stays_so() {
    for alpha in [0, 255] {
        let source = of([9, 4], &[[1, 2, 3, alpha]; 36]);
        for made in mip_levels(&source, MipFilter::AlphaWeighted, Some(128)) {
            assert_eq!(covered(&made, 128), if alpha == 0 { 0 } else { u64::from(made.size[0] * made.size[1]) });
        }
    }
}
