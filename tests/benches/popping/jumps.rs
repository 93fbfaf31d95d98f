//! What changes between two successive frames because factors do.

use geometry::tessellate::factors::{row_base, triangle_count};

use crate::frame::{Emitted, Frame};
use crate::histogram::Histogram;
use crate::places::{Place, Places};
use crate::view::View;

/// The largest cosine of the angle at which the limit surface is nearly edge-on: it is then less than 5.7 degrees from it.
const EDGE_ON: f64 = 0.1;

/// What changed between successive frames, added up.
#[derive(Clone, Default)]
pub(crate) struct Jumps {
    /// The number of frames that were compared with the frame before, and their triangles.
    pub frames: u64,
    pub triangles: u64,
    /// In px.
    pub silhouette: f64,
    /// In px, at the places of patches whose pattern changed.
    pub surface: Histogram,
    /// Of `surface`, those in patches whose base changed.
    pub surface_of_bases: Histogram,
    /// In degrees, at the same places as `surface`.
    pub normals: Histogram,
    /// The largest distances on screen between what is emitted and the limit surface, in px: of this frame, and of the frame
    /// before under this frame's camera. Only patches whose pattern changed are looked at.
    pub error: f64,
    pub error_before: f64,
    /// Patches with a place in view that faces the eye, added up over frames.
    pub patches: u64,
    /// Of `patches`, those whose pattern changed.
    pub patterns: u64,
    /// Of `patterns`, those with the largest factor in one of the frames. Their places aren't compared, since LOD by error may not
    /// keep the tolerance there.
    pub capped: u64,
    /// Of `patterns`, those whose rows have another base, with more than one triangle in both frames.
    pub bases: u64,
    /// Of `bases`, those that have no fewer triangles than before.
    pub flips: u64,
    /// Of `bases`, those whose edges have the same numbers of segments as before.
    pub beside_same_edges: u64,
}

impl Jumps {
    pub(crate) fn merge(&mut self, other: &Self) {
        self.frames += other.frames;
        self.triangles += other.triangles;
        self.silhouette = self.silhouette.max(other.silhouette);
        self.surface.merge(&other.surface);
        self.surface_of_bases.merge(&other.surface_of_bases);
        self.normals.merge(&other.normals);
        self.error = self.error.max(other.error);
        self.error_before = self.error_before.max(other.error_before);
        self.patches += other.patches;
        self.patterns += other.patterns;
        self.capped += other.capped;
        self.bases += other.bases;
        self.flips += other.flips;
        self.beside_same_edges += other.beside_same_edges;
    }

    /// Compares a frame with the frame before it, as the camera of the former sees both.
    pub(crate) fn compare(&mut self, [before, now]: [&Frame; 2], places: &Places, [view_before, view]: [&View; 2]) {
        self.frames += 1;
        self.triangles += now.triangles() as u64;
        for patch in (0..now.patches()).filter(|&patch| !places.is_flat(patch)) {
            let is_in_view = |place: &Place| view.shows(place) && view_before.shows(place);
            let facing = |place: &Place| is_in_view(place).then(|| view.facing(place));
            let facing: Vec<Option<f64>> = places.of_patch(patch).iter().map(facing).collect();
            let is_wanted = |facing: &Option<f64>| facing.is_some_and(|cosine| cosine > -EDGE_ON);
            if !facing.iter().any(is_wanted) {
                continue;
            }
            let is_seen = facing.iter().flatten().any(|&cosine| cosine > 0.0);
            self.patches += u64::from(is_seen);
            if now.has_same_pattern(before, patch) {
                continue;
            }
            let has_other_base = self.count_changes(before, now, patch, is_seen);
            if before.is_capped(patch) || now.is_capped(patch) {
                self.capped += u64::from(is_seen);
                continue;
            }
            let emitted = before.at_places(patch).into_iter().zip(now.at_places(patch));
            for ((place, facing), emitted) in places.of_patch(patch).iter().zip(&facing).zip(emitted) {
                if let Some(cosine) = facing.filter(|_| is_wanted(facing)) {
                    let (Some(old), Some(new)) = emitted else { panic!("a pattern has a hole") };
                    self.compare_place(place, cosine, [old, new], view, has_other_base);
                }
            }
        }
    }

    /// Counts what changed of a patch with another pattern. Returns whether its base changed.
    fn count_changes(&mut self, before: &Frame, now: &Frame, patch: usize, is_seen: bool) -> bool {
        let [old, new] = [before, now].map(|frame| frame.factors(patch));
        let [triangles_before, triangles] = [old, new].map(triangle_count);
        let has_other_base = row_base(old) != row_base(new) && triangles_before > 1 && triangles > 1;
        if is_seen {
            self.patterns += 1;
            self.bases += u64::from(has_other_base);
            self.flips += u64::from(has_other_base && triangles >= triangles_before);
            self.beside_same_edges += u64::from(has_other_base && old.outside == new.outside);
        }
        has_other_base
    }

    fn compare_place(
        &mut self,
        place: &Place,
        cosine: f64,
        [old, new]: [Emitted; 2],
        view: &View,
        has_other_base: bool,
    ) {
        let points = [old.position, new.position, place.position].map(|p| view.on_screen(p));
        let [Some(from), Some(to), Some(limit)] = points else { return };
        if cosine.abs() < EDGE_ON {
            self.silhouette = self.silhouette.max((to - from).dot(view.across_silhouette(place)).abs());
        }
        if cosine <= 0.0 {
            return;
        }
        let px = from.distance(to);
        self.surface.add(px);
        if has_other_base {
            self.surface_of_bases.add(px);
        }
        self.normals.add(old.normal.angle_between(new.normal).to_degrees());
        self.error = self.error.max(to.distance(limit));
        self.error_before = self.error_before.max(from.distance(limit));
    }
}
