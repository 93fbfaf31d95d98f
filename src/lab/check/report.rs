//! What a check found, and its reports as text and as JSON.

use std::fmt::Write;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use geometry::choice::texts;
use geometry::numbers::{counted, grouped};
use inspect::gates::{GateKind, Judgement, Place};
use inspect::settings::Choice;
use inspect::shot::Numbers;

/// What a check found.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// In the order in which they were named, and those of a folder in the order of their paths.
    pub assets: Vec<Asset>,
    /// How many assets were left out because the check was interrupted.
    pub left_out: usize,
}

/// What was found about an asset.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Asset {
    pub path: String,
    /// Whether what was found is that of an earlier run, since nothing has changed.
    #[serde(skip_deserializing)]
    pub unchanged: bool,
    /// How long this run took to check it, in s: 0 if it is unchanged.
    #[serde(skip)]
    pub seconds: f64,
    /// Why it couldn't be checked, in a sentence.
    pub error: Option<String>,
    /// Warnings of loading it.
    pub warnings: Vec<String>,
    pub views: Vec<View>,
}

/// What was found about an asset from one camera.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct View {
    /// The name in the configuration; empty for the only view.
    pub name: String,
    pub numbers: Numbers,
    pub gates: Vec<GateResult>,
    /// A PNG file in base64, if pictures were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub picture: Option<String>,
}

/// How a gate judged.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GateResult {
    pub name: String,
    /// The largest number that passes: a count, or a length as text.
    pub limit: Value,
    /// A count, or a length as two numbers; null if nothing could be found out, and then the gate failed.
    pub found: Value,
    pub passed: bool,
    /// What was found, and where if it failed, in a sentence without its end.
    pub text: String,
    /// The worst place of a gate that failed: the mesh's triangles that it lies on; `at`, in object units, null for a place of
    /// a picture; and `px`, from the picture's top left. Null if there is none.
    #[serde(rename = "where")]
    pub place: Value,
    /// A picture of the place, a PNG file in base64.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evidence: Option<String>,
    /// How long this run took to judge it, in s: 0 if the asset is unchanged.
    #[serde(skip)]
    pub seconds: f64,
}

/// What is judged beside the gates, and what passing it means.
pub const GOLDEN: [&str; 2] = ["golden", "The view is the same as its golden picture."];
pub(super) const OPENS: [&str; 2] = ["opens", "The asset can be opened and measured."];

texts! {
    /// The result of an asset.
    pub enum Status, fn name {
        Passed => "passed",
        /// A gate failed.
        Failed => "failed",
        /// It couldn't be checked.
        Broken => "broken",
    }
}

impl GateResult {
    /// What a judgement says, with a picture of its place, and how long it took in s.
    pub fn new(judgement: &Judgement, evidence: Option<String>, seconds: f64) -> Self {
        let place = |Place { triangles, spot, .. }: &Place| {
            let (at, px) = (spot.at().map(|at| at.to_array()), spot.px().map(|px| px.to_array()));
            json!({ "triangles": triangles, "at": at, "px": px })
        };
        Self {
            name: judgement.gate.to_owned(),
            limit: json!(judgement.limit),
            found: json!(judgement.found),
            passed: judgement.passed,
            text: if judgement.passed { judgement.text.clone() } else { judgement.sentence() },
            place: judgement.place.as_ref().map_or(Value::Null, place),
            evidence,
            seconds,
        }
    }
}

impl Asset {
    pub fn status(&self) -> Status {
        match self.error {
            Some(_) => Status::Broken,
            None if self.gates().all(|(_, gate)| gate.passed) => Status::Passed,
            None => Status::Failed,
        }
    }

    /// The gates of all views, each with the name of its view.
    pub fn gates(&self) -> impl Iterator<Item = (&str, &GateResult)> {
        self.views.iter().flat_map(|view| view.gates.iter().map(|gate| (view.name.as_str(), gate)))
    }
}

/// The name of a gate, with that of its view where there are several and it is about the view.
pub(super) fn gate_title(view: &str, gate: &str) -> String {
    let is_of_mesh = GateKind::ALL.iter().any(|kind| kind.name() == gate && kind.is_of_mesh());
    if view.is_empty() || is_of_mesh { gate.to_owned() } else { format!("{gate} ({view})") }
}

impl Report {
    pub fn count(&self, status: Status) -> usize {
        self.assets.iter().filter(|asset| asset.status() == status).count()
    }

    /// Whether every asset was checked and passed.
    pub fn passed(&self) -> bool {
        self.count(Status::Passed) == self.assets.len()
    }

    /// How many assets passed, failed and couldn't be checked, on one line.
    pub fn summary(&self) -> String {
        let number = |count: usize| grouped(count as u64);
        let all = counted(self.assets.len() as u64, "asset");
        let counts = Status::ALL.map(|status| format!("{} {}", number(self.count(status)), status.name()));
        let mut text = format!("{all}: {}", counts.join(", "));
        let unchanged = self.assets.iter().filter(|asset| asset.unchanged).count();
        for (count, words) in
            [(unchanged, "unchanged and not measured again"), (self.left_out, "left out because of the interruption")]
        {
            if count > 0 {
                let _ = write!(text, "; {} {words}", number(count));
            }
        }
        text
    }

    /// A line for each asset, with a line below it for each gate that failed, and the summary.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for asset in &self.assets {
            let note = if asset.unchanged { " (unchanged)" } else { "" };
            let _ = writeln!(text, "{:<7} {}{note}", asset.status().name(), asset.path);
            if let Some(error) = &asset.error {
                let _ = writeln!(text, "        {error}");
            }
            for (view, gate) in asset.gates().filter(|(_, gate)| !gate.passed) {
                let _ = writeln!(text, "        {}: {}", gate_title(view, &gate.name), gate.text);
            }
        }
        text + &self.summary() + "\n"
    }

    /// The report as JSON.
    pub fn json(&self) -> Value {
        json!({
            "pnaen": env!("CARGO_PKG_VERSION"),
            "passed": self.count(Status::Passed),
            "failed": self.count(Status::Failed),
            "broken": self.count(Status::Broken),
            "left_out": self.left_out,
            "assets": self.assets.iter().map(asset_json).collect::<Vec<_>>(),
        })
    }
}

/// An asset as JSON, without its pictures.
fn asset_json(asset: &Asset) -> Value {
    let mut plain = asset.clone();
    for view in &mut plain.views {
        view.picture = None;
        view.gates.iter_mut().for_each(|gate| gate.evidence = None);
    }
    let mut json = json!(plain);
    json["status"] = asset.status().name().into();
    json
}

/// A report with an asset of each kind.
#[cfg(test)]
pub(super) fn sample() -> Report {
    let gate = |name: &str, found: Option<u64>, text: &str| GateResult {
        name: name.into(),
        found: json!(found),
        passed: found == Some(0),
        text: text.into(),
        ..GateResult::default()
    };
    let failed = GateResult {
        place: json!({ "triangles": [3, 7], "at": [0.5, 0.0, 1.0], "px": null }),
        evidence: Some("ZXZpZGVuY2U=".into()),
        ..gate("cracks", Some(12), "12 edges are cracked, where 0 are allowed")
    };
    let view =
        |name: &str, gates| View { name: name.into(), gates, picture: Some("cGljdHVyZQ==".into()), ..View::default() };
    let asset = |path: &str, views| Asset { path: path.into(), views, ..Asset::default() };
    let good =
        Asset { unchanged: true, ..asset("a b/good.glb", vec![view("", vec![gate("cracks", Some(0), "none")])]) };
    let torn = asset(
        "torn<&\">.glb",
        vec![
            view("front", vec![failed, gate("leaks", None, "the mesh is open")]),
            view("back", vec![gate("cracks", Some(0), "none")]),
        ],
    );
    let broken = Asset { error: Some("broken.obj can't be read".into()), ..asset("broken.obj", Vec::new()) };
    Report { assets: vec![good, torn, broken], left_out: 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_as_text_names_what_failed() {
        let expected = "passed  a b/good.glb (unchanged)\nfailed  torn<&\">.glb\n        cracks (front): 12 edges are cracked, where \
                        0 are allowed\n        leaks (front): the mesh is open\nbroken  broken.obj\n        broken.obj \
                        can't be read\n3 assets: 1 passed, 1 failed, 1 broken; 1 unchanged and not measured again\n";
        assert_eq!(sample().text(), expected);
        assert!(!sample().passed());
        let interrupted = Report { left_out: 2, ..Report::default() };
        assert_eq!(
            interrupted.summary(),
            "0 assets: 0 passed, 0 failed, 0 broken; 2 left out because of the interruption"
        );
    }

    #[test]
    fn a_gate_of_the_mesh_is_of_no_view() {
        assert_eq!(gate_title("front", "cracks"), "cracks (front)");
        assert_eq!(gate_title("", "cracks"), "cracks");
        assert_eq!(gate_title("front", "t-junctions"), "t-junctions");
    }

    #[test]
    fn a_report_as_json_has_every_gate_and_no_picture() {
        let json = sample().json();
        assert!(["passed", "failed", "broken"].into_iter().all(|key| json[key] == 1), "{json}");
        assert_eq!(json.pointer("/assets/1/views/0/gates/0/where/triangles"), Some(&serde_json::json!([3, 7])));
        assert_eq!(json.pointer("/assets/0/unchanged"), Some(&true.into()));
        assert!(!json.to_string().contains("cGljdHVyZQ"));
    }

    #[test]
    fn what_a_cache_keeps_comes_back() {
        for asset in sample().assets {
            let text = serde_json::to_string(&asset).expect("JSON");
            let back: Asset = serde_json::from_str(&text).expect("an asset");
            assert_eq!(back, Asset { unchanged: false, ..asset });
        }
    }
}
