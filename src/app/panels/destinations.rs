//! Where a click on a finding leads: its worst place, from which one steps to the next and to the previous one.

use crate::app::App;
use crate::app::sections::Section;
use geometry::casts::to_u32;
use geometry::mesh::TJunction;
use inspect::gates::{EdgeSpot, GateKind, Place, Spot};
use inspect::measure::FoldedPatch;
use inspect::render::Leak;
use inspect::settings::{Overlay, SplitSide};
use load::{Import, NormalSource};

/// Where a click on a finding leads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::app) enum Destination {
    /// The overlay of cracks, and the edge with the widest gap.
    Cracks,
    /// The overlay of cracks, and the edge at the largest leak.
    Leaks,
    /// The overlay of folds, and the patch whose folds have the largest area.
    Folds,
    TJunctions,
    /// The overlays of a gate of the mesh, and the worst place that it found.
    Mesh(GateKind),
    /// The edge with the most points whose normals differ.
    ShadingSeams,
    /// The edge whose sides were given the most different factors.
    GivenFactors,
    Sizes,
    Factors,
    /// Another crease angle where the file has no normals: flat triangles, or smooth ones again.
    CreaseAngle(f32),
    /// Normals that are made anew in place of those of the file.
    MadeNormals,
    /// The section that counts what isn't drawn.
    Patches,
    Warnings,
}

/// The finding that was followed last, and which of its places is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::app) struct ShownFinding {
    pub leads: Destination,
    /// From 0 on; the worst one is the first.
    pub place: usize,
    pub count: usize,
}

/// Which place of a finding is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::app) enum Step {
    Worst,
    Next,
    /// The one before the worst is the last one.
    Previous,
}

/// A place that a finding has.
#[derive(Clone, Copy)]
enum FoundPlace {
    Edge(u32),
    Leak(Leak),
    Fold(FoldedPatch),
    Junction(TJunction),
    Gate(GateKind),
}

impl App {
    /// Goes on to another place of the finding that is shown, or else to the first finding's worst place.
    pub(in crate::app) fn step_through_finding(&mut self, step: Step) {
        let shown = self.document.as_ref().and_then(|document| document.shown_finding).map(|finding| finding.leads);
        let first = || self.destinations().into_iter().find(|&leads| !self.places(leads).is_empty());
        if let Some(leads) = shown.or_else(first) {
            self.follow(leads, step);
        }
    }

    pub(in crate::app) fn follow(&mut self, leads: Destination, step: Step) {
        self.turn_on(leads);
        let places = self.places(leads);
        let Some(document) = self.document.as_mut().filter(|_| !places.is_empty()) else { return };
        let count = places.len();
        let before = document.shown_finding.filter(|finding| finding.leads == leads).map(|finding| finding.place);
        let place = match (step, before) {
            (Step::Worst, _) | (Step::Next, None) => 0,
            (Step::Next, Some(place)) => (place + 1) % count,
            (Step::Previous, place) => (place.unwrap_or(0) + count - 1) % count,
        };
        document.shown_finding = Some(ShownFinding { leads, place, count });
        match places[place] {
            FoundPlace::Edge(edge) => self.select_edge(edge),
            FoundPlace::Leak(leak) => self.show_leak(&leak),
            FoundPlace::Fold(folded) => self.show_fold(&folded),
            FoundPlace::Junction(junction) => self.show_junction(&junction),
            FoundPlace::Gate(gate) => self.show_found(gate),
        }
    }

    /// The places of a finding, the worst one first.
    fn places(&self, leads: Destination) -> Vec<FoundPlace> {
        let results = self.results();
        let cracks = results.map(|results| &results.found.cracks);
        let checks = self.document.as_ref().map(|document| &document.checks);
        match leads {
            Destination::Cracks => {
                // The widest in px is the worst, and the others follow by their gaps.
                let widest = results.and_then(|results| results.widest_crack).map(|(edge, _)| edge);
                let cracked = cracks.map_or(&[][..], |cracks| cracks.cracked()).iter().map(|cracked| cracked.edge);
                widest.into_iter().chain(cracked.filter(|&edge| Some(edge) != widest)).map(FoundPlace::Edge).collect()
            }
            Destination::Leaks => self.leaks().unwrap_or_default().iter().copied().map(FoundPlace::Leak).collect(),
            Destination::Folds => {
                let folded = results.map_or(&[][..], |results| &results.found.folded);
                folded.iter().copied().map(FoundPlace::Fold).collect()
            }
            Destination::TJunctions => {
                let junctions = checks.and_then(|checks| checks.t_junctions()).unwrap_or_default();
                junctions.iter().copied().map(FoundPlace::Junction).collect()
            }
            Destination::Mesh(gate) => vec![FoundPlace::Gate(gate)],
            Destination::ShadingSeams => {
                let mut seams: Vec<_> = cracks.into_iter().flat_map(|cracks| cracks.shading_seams()).collect();
                seams.sort_by_key(|seam| std::cmp::Reverse(seam.different_normals));
                seams.into_iter().map(|seam| FoundPlace::Edge(seam.edge)).collect()
            }
            Destination::GivenFactors => {
                let edges = self.agreement().map_or(&[][..], |agreement| &agreement.edges);
                edges.iter().map(|edge| FoundPlace::Edge(edge.edge)).collect()
            }
            Destination::Sizes
            | Destination::Factors
            | Destination::CreaseAngle(_)
            | Destination::MadeNormals
            | Destination::Patches
            | Destination::Warnings => Vec::new(),
        }
    }

    /// Turns on what shows a finding: its overlay, its colours, its section or its window.
    fn turn_on(&mut self, leads: Destination) {
        use Destination::{Cracks, Folds, Leaks, TJunctions};
        let (overlays, open) = (&mut self.settings.overlays, &mut self.panels.open);
        if matches!(leads, Cracks | Leaks | Folds | TJunctions) {
            open.set(Section::Cracks, true);
        }
        match leads {
            Cracks => overlays.cracks = true,
            Folds => overlays.folds = true,
            TJunctions => overlays.t_junctions = true,
            Destination::Mesh(gate) => gate.overlays().iter().for_each(|overlay| overlays.turn_on(*overlay)),
            Leaks | Destination::ShadingSeams => {}
            Destination::GivenFactors => {
                let section = if self.uses_lod_shader() { Section::LodShader } else { Section::Factors };
                self.panels.open.set(section, true);
            }
            Destination::Sizes => overlays.turn_on(Overlay::TriangleSize),
            Destination::Factors => overlays.turn_on(Overlay::Factors),
            Destination::CreaseAngle(angle) => self.settings.import.crease_angle = angle,
            Destination::MadeNormals => {
                let import = &mut self.settings.import;
                import.normals = NormalSource::Made;
                if import.crease_angle == 0.0 {
                    import.crease_angle = Import::default().crease_angle;
                }
            }
            Destination::Patches => open.set(Section::Patches, true),
            Destination::Warnings => self.dialogs.shows_warnings = true,
        }
    }

    /// Selects the edge or the triangle that is the worst of what a gate of the mesh found, and shows it.
    fn show_found(&mut self, gate: GateKind) {
        let Some(document) = &self.document else { return };
        let found = document.checks.found().iter().find(|judgement| judgement.kind == gate);
        let Some(Place { triangles, spot, .. }) = found.and_then(|judgement| judgement.place.clone()) else { return };
        if let Spot::Edge(EdgeSpot { ends, .. }) = spot {
            let topology = &document.loaded.topology;
            let at = |point: u32| topology.points[point as usize];
            let edge = topology.edges.iter().position(|edge| topology.edge_points(edge).map(at) == ends);
            edge.into_iter().for_each(|edge| self.select_edge(to_u32(edge)));
        } else {
            self.select_triangle(triangles.first().copied());
            self.show_place(SplitSide::Right, &spot, self.selected_patch());
        }
    }
}
