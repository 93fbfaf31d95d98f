//! Which settings of the chart are measured when, and whether it is out of date.

use crate::app::App;
use crate::app::jobs::chart_job::{ChartBasis, Charted};
use geometry::tessellate::Tessellation;
use inspect::settings::Settings;
use lab::chart::{Plan, Row, Setting, Subject, coarse_first, whole};
use load::Source;

/// How long settings that aren't in the chart must stay unchanged before they are measured as well, in s.
const STILL: f64 = 0.4;

impl App {
    pub(in crate::app) fn toggle_chart(&mut self) {
        self.panels.chart.is_open = !self.panels.chart.is_open;
        if !self.panels.chart.is_open {
            self.close_chart();
        }
    }

    pub fn chart_rows(&self) -> &[Row] {
        self.panels.chart.charted.as_ref().map_or(&[], |charted| &charted.subject.rows)
    }

    /// What a chart that is measured now would be about.
    fn chart_of(&self) -> Option<ChartBasis> {
        let document = self.document.as_ref()?;
        let size = self.viewport.picture.target.as_ref()?.0.size;
        Some(ChartBasis {
            document: document.generation,
            moment: self.moment(),
            reference_shape: self.yardstick().0,
            camera: self.viewport.camera,
            size,
            base: base(&self.settings),
        })
    }

    /// Why the chart is out of date; none if it isn't.
    pub(in crate::app) fn chart_outdated(&self) -> Option<&'static str> {
        let (of, now) = (self.panels.chart.charted.as_ref()?.of, self.chart_of()?);
        let respects = [
            (of.document != now.document, "another mesh is shown"),
            (of.moment != now.moment, "another pose is shown"),
            (of.reference_shape != now.reference_shape, "another reference surface is chosen"),
            ((of.camera, of.size) != (now.camera, now.size), "the view has changed"),
            (of.base != now.base, "other settings have changed"),
        ];
        respects.into_iter().find_map(|(differs, why)| differs.then_some(why))
    }

    /// Starts to measure the settings that the chart lacks. Measures all anew if it lacks none, or is out of date.
    pub(in crate::app) fn measure_chart(&mut self, context: &egui::Context) {
        let Some(of) = self.chart_of() else { return };
        let Some(title) = self.source().map(Source::title) else { return };
        let (_, reference_shape, words) = self.yardstick();
        let all = self.chart_settings();
        let is_known =
            |setting: &Setting| self.panels.chart.charted.as_ref().is_some_and(|charted| charted.has(setting));
        let missing: Vec<_> = all.iter().filter(|setting| !is_known(setting)).copied().collect();
        let starts_over =
            missing.is_empty() || self.panels.chart.charted.as_ref().is_none_or(|charted| charted.of != of);
        if starts_over {
            let (adapter, size) = (self.engine.gpu.info.name.clone(), of.size);
            let (diagonal, reference_shape) = reference_shape.map(|compared| (compared.diagonal(), words)).unzip();
            let subject = Subject { title, reference_shape, adapter, size, rows: Vec::new() };
            let charted = Charted { of, subject, left_out: Vec::new(), diagonal, current: None };
            self.panels.chart.charted = Some(charted);
        }
        let mut settings = if starts_over { all } else { missing };
        // The window's own setting comes first.
        let own = Setting::new(&self.settings);
        settings.sort_by_key(|setting| Some(*setting) != own);
        let is_listed = settings.first().is_some_and(|first| Some(*first) == own);
        let current = self.unknown_current().filter(|_| !is_listed);
        self.start_charting(context, of, current, settings);
    }

    pub(in crate::app) fn chart_settings(&self) -> Vec<Setting> {
        let plan = Plan { normals: vec![self.settings.tessellation.normals], ..self.panels.chart.plan.clone() };
        coarse_first(plan.settings())
    }

    /// The window's settings, if they aren't measured yet.
    fn unknown_current(&self) -> Option<Settings> {
        // The chart measures surfaces of ours.
        if self.uses_surface_shader() {
            return None;
        }
        let (charted, current) = (self.panels.chart.charted.as_ref()?, whole(&self.settings));
        let listed = Setting::new(&current).is_some_and(|own| charted.has(&own));
        let known = charted.current.is_some_and(|(known, _)| known == current);
        (!listed && !known).then_some(current)
    }

    /// Starts to measure the window's own settings once they stay unchanged.
    pub(in crate::app) fn measure_current(&mut self, context: &egui::Context) {
        let is_idle = self.panels.chart.is_open && self.charting().is_none() && !self.is_busy() && !self.is_playing();
        let of = self.panels.chart.charted.as_ref().map(|charted| charted.of).filter(|_| is_idle);
        let wanted = of.filter(|of| Some(*of) == self.chart_of()).and_then(|of| Some((of, self.unknown_current()?)));
        let Some((of, current)) = wanted else {
            self.panels.chart.still = None;
            return;
        };
        let now = context.input(|input| input.time);
        let since = self.panels.chart.still.filter(|(known, _)| *known == current).map_or(now, |(_, since)| since);
        self.panels.chart.still = Some((current, since));
        if now - since < STILL {
            context.request_repaint_after(std::time::Duration::from_secs_f64(STILL - (now - since)));
            return;
        }
        self.start_charting(context, of, Some(current), Vec::new());
    }
}

/// The settings without those that the chart varies, which are set to their defaults.
fn base(settings: &Settings) -> Settings {
    let (mut base, usual) = (whole(settings), Tessellation::default());
    let own = &mut base.tessellation;
    (own.surface, own.normals, own.partitioning) = (usual.surface, usual.normals, usual.partitioning);
    (own.lod, own.factor, own.pixels, own.tolerance) = (usual.lod, usual.factor, usual.pixels, usual.tolerance);
    (own.near, own.far) = (usual.near, usual.far);
    base
}
