//! The report as SARIF 2.1.0 (OASIS, 2020), which code hosts show beside the files: a rule for each gate, and a result for each
//! gate that failed.

use std::path::Path;

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use serde_json::{Value, json};

use super::report::{Asset, GOLDEN, OPENS, Report, gate_title};
use inspect::gates::GateKind;
use inspect::settings::Choice;

/// Writes the report.
pub fn sarif(report: &Report) -> Value {
    let rule = |name: &str, text: &str| json!({ "id": name, "shortDescription": { "text": text } });
    let gates = GateKind::ALL.map(|kind| rule(kind.name(), kind.text()));
    let others = [GOLDEN, OPENS].map(|[name, text]| rule(name, text));
    let rules: Vec<Value> = gates.into_iter().chain(others).collect();
    let results: Vec<Value> = report.assets.iter().flat_map(results).collect();
    json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": { "name": "pnaen", "version": env!("CARGO_PKG_VERSION"), "rules": rules } },
            "invocations": [{ "executionSuccessful": report.left_out == 0 }],
            "results": results,
        }],
    })
}

fn results(asset: &Asset) -> Vec<Value> {
    let result = |rule: &str, view: &str, message: String, properties: Value| {
        // GitHub takes no result without a line, though assets have none.
        let place = json!({ "artifactLocation": { "uri": uri(&asset.path) }, "region": { "startLine": 1 } });
        json!({
            "ruleId": rule,
            "level": "error",
            "message": { "text": message },
            "locations": [{ "physicalLocation": place }],
            "partialFingerprints": { "primaryLocationLineHash": fingerprint([&asset.path, rule, view]) },
            "properties": properties,
        })
    };
    let broken = asset.error.iter().map(|error| result(OPENS[0], "", error.clone(), json!({})));
    let failed = asset.gates().filter(|(_, gate)| !gate.passed).map(|(view, gate)| {
        let message = format!("{}: {}", gate_title(view, &gate.name), gate.text);
        let properties = json!({ "view": view, "limit": gate.limit, "found": gate.found, "where": gate.place });
        result(&gate.name, view, message, properties)
    });
    broken.chain(failed).collect()
}

/// What a result keeps from run to run, however much is found: asset, gate and view. Without it, GitHub takes results of a gate in
/// two views for one.
fn fingerprint(parts: [&str; 3]) -> String {
    blake3::hash(parts.join("\n").as_bytes()).to_hex()[..32].to_owned()
}

/// The characters that are written as bytes in a path.
const OTHERS: &AsciiSet = &NON_ALPHANUMERIC.remove(b'/').remove(b'-').remove(b'.').remove(b'_').remove(b'~');

/// A path as a URI reference (RFC 3986): relative paths stay relative, and other characters than the unreserved ones are bytes in
/// hexadecimal digits.
fn uri(path: &str) -> String {
    let start = match (Path::new(path).is_absolute(), path.starts_with(['/', '\\'])) {
        (true, true) => "file://",
        // Drives of Windows.
        (true, false) => "file:///",
        (false, _) => "",
    };
    let path = path.strip_prefix("./").unwrap_or(path);
    let path = if cfg!(windows) { path.replace('\\', "/") } else { path.to_owned() };
    format!("{start}{}", utf8_percent_encode(&path, OTHERS))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::report::sample;

    #[test]
    fn failed_gates_and_broken_assets_are_results() {
        let sarif = sarif(&sample());
        let run = &sarif["runs"][0];
        let ids: Vec<_> =
            run["tool"]["driver"]["rules"].as_array().expect("rules").iter().map(|rule| &rule["id"]).collect();
        let results = run["results"].as_array().expect("results");
        assert_eq!(results.len(), 3);
        for result in results {
            assert!(ids.contains(&&result["ruleId"]), "{result}");
            assert!(result["message"]["text"].as_str().is_some_and(|text| !text.is_empty()));
        }
        let places: Vec<_> = results
            .iter()
            .map(|result| result.pointer("/locations/0/physicalLocation/artifactLocation/uri").and_then(Value::as_str))
            .collect();
        assert_eq!(places, [Some("torn%3C%26%22%3E.glb"), Some("torn%3C%26%22%3E.glb"), Some("broken.obj")]);
        assert_eq!(results[0].pointer("/properties/where/at"), Some(&json!([0.5, 0.0, 1.0])));
        assert_eq!(results[0].pointer("/locations/0/physicalLocation/region/startLine"), Some(&json!(1)));
        let marks = results.iter().map(|result| &result["partialFingerprints"]["primaryLocationLineHash"]);
        let marks: Vec<_> = marks.map(|mark| mark.as_str().expect("a text")).collect();
        assert!(marks[0] != marks[1] && marks[1] != marks[2] && marks.iter().all(|mark| mark.len() == 32), "{marks:?}");
    }
}
