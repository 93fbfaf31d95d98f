//! Settings at random, for tests.

use clap::ValueEnum;
use proptest::prelude::*;

use super::{DeviationUnit, FACTOR_RANGE, Overlay, Overlays, Settings};
use crate::tessellate::{Clip, Convention, Edges, Lod, Normals, Partitioning, Surface};

fn any<T: ValueEnum + Clone + std::fmt::Debug + 'static>() -> impl Strategy<Value = T> {
    proptest::sample::select(T::value_variants())
}

prop_compose! {
    fn chosen()(
        surface in any::<Surface>(),
        normals in any::<Normals>(),
        edges in any::<Edges>(),
        partitioning in proptest::sample::select(&Partitioning::ALL[..]),
        lod in any::<Lod>(),
        clip in any::<Clip>(),
        convention in any::<Convention>(),
        deviation_in in any::<DeviationUnit>(),
        split_surface in proptest::option::of(any::<Surface>()),
        cull_back_faces in proptest::bool::ANY,
    ) -> Settings {
        let settings = Settings { surface, normals, edges, partitioning, lod, clip, convention, ..Settings::opening() };
        Settings { deviation_in, split_surface, cull_back_faces, ..settings }
    }
}

prop_compose! {
    pub fn settings()(
        chosen in chosen(),
        alpha in 0.0f32..=1.0,
        factor in FACTOR_RANGE,
        pixels in 1.0f32..=256.0,
        tolerance in 0.01f32..=100.0,
        near in 0.1f32..=100.0,
        beyond in 0.1f32..=800.0,
        height_scale in -1.0f32..=1.0,
        midlevel in 0.0f32..=1.0,
        split in proptest::option::of(0.0f32..=1.0),
        background in proptest::array::uniform3(0u8..),
        overlays in proptest::collection::vec(any::<Overlay>(), 0..6),
    ) -> Settings {
        let overlays = Overlays::of(&overlays).unwrap_or_default();
        let settings = Settings { alpha, factor, pixels, tolerance, near, far: near + beyond, ..chosen };
        Settings { height_scale, midlevel, split, background, overlays, ..settings }
    }
}
