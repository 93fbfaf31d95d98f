//! The report as JUnit XML, which build servers show as test results: a suite for each asset, and a case for each gate.

use std::io;

use quick_xml::events::{BytesDecl, BytesText, Event};
use quick_xml::writer::{ElementWriter, Writer};

use super::report::{Asset, OPENS, Report, Status, gate_title};
use geometry::names::on_one_line;

/// Writes the report.
pub fn junit(report: &Report) -> io::Result<String> {
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let cases: usize = report.assets.iter().map(|asset| 1 + asset.gates().count()).sum();
    let failed: usize = report.assets.iter().map(failures).sum();
    let counts = [cases, failed, report.count(Status::Broken)];
    let time = report.assets.iter().map(|asset| asset.seconds).sum();
    let suites = suite_element(&mut writer, "testsuites", "pnaen check", counts, time);
    suites.write_inner_content(|writer| report.assets.iter().try_for_each(|asset| suite(writer, asset)))?;
    let mut text = String::from_utf8(writer.into_inner()).map_err(io::Error::other)?;
    text.push('\n');
    Ok(text)
}

type Out = Writer<Vec<u8>>;
type Element<'a> = ElementWriter<'a, Vec<u8>>;

fn suite(writer: &mut Out, asset: &Asset) -> io::Result<()> {
    let path = on_one_line(&asset.path);
    let counts = [1 + asset.gates().count(), failures(asset), usize::from(asset.error.is_some())];
    let suite = suite_element(writer, "testsuite", &path, counts, asset.seconds);
    suite.write_inner_content(|writer| {
        let judging: f64 = asset.gates().map(|(_, gate)| gate.seconds).sum();
        let opened = asset.error.as_ref().map(|error| ("error", error.as_str()));
        case(writer, &path, OPENS[0], asset.seconds - judging, opened)?;
        for (view, gate) in asset.gates() {
            let outcome = (!gate.passed).then_some(("failure", gate.text.as_str()));
            case(writer, &path, &gate_title(view, &gate.name), gate.seconds, outcome)?;
        }
        if asset.unchanged {
            writer.create_element("system-out").write_text_content(BytesText::new("unchanged: not measured again"))?;
        }
        Ok(())
    })?;
    Ok(())
}

/// An element with numbers of tests, failures and errors, and a time in s.
fn suite_element<'a>(writer: &'a mut Out, kind: &'a str, name: &str, counts: [usize; 3], time: f64) -> Element<'a> {
    let [tests, failures, errors] = counts.map(|count| count.to_string());
    let (time, attributes) = (seconds(time), [("tests", tests), ("failures", failures), ("errors", errors)]);
    let element = writer.create_element(kind).with_attribute(("name", name));
    let element = element.with_attributes(attributes.iter().map(|(name, count)| (*name, count.as_str())));
    element.with_attribute(("time", time.as_str()))
}

/// How many gates failed.
fn failures(asset: &Asset) -> usize {
    asset.gates().filter(|(_, gate)| !gate.passed).count()
}

/// A time in s, as JUnit has it.
fn seconds(time: f64) -> String {
    format!("{:.3}", time.max(0.0))
}

/// A case, how long it took in s, and what it ended with unless it passed: an element and its message.
fn case(writer: &mut Out, path: &str, name: &str, time: f64, outcome: Option<(&str, &str)>) -> io::Result<()> {
    let (name, time) = (on_one_line(name), seconds(time));
    let attributes = [("classname", path), ("name", name.as_str()), ("time", time.as_str())];
    let case = writer.create_element("testcase").with_attributes(attributes);
    match outcome {
        None => case.write_empty()?,
        Some((element, message)) => case.write_inner_content(|writer| {
            let message = on_one_line(message);
            let outcome = writer.create_element(element).with_attribute(("message", message.as_str()));
            // Some build servers show the attribute, and others the text.
            outcome.write_text_content(BytesText::new(&message))?;
            Ok(())
        })?,
    };
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::report::sample;

    #[test]
    fn suites_and_cases_have_times_that_add_up() {
        let mut report = sample();
        report.assets[1].seconds = 1.5;
        report.assets[1].views[0].gates[0].seconds = 0.25;
        report.assets[2].seconds = 0.0126;
        let text = junit(&report).expect("XML");
        for line in [
            "<testsuites name=\"pnaen check\" tests=\"7\" failures=\"2\" errors=\"1\" time=\"1.513\">",
            "failures=\"0\" errors=\"1\" time=\"0.013\">",
            "name=\"cracks (front)\" time=\"0.250\">",
            "name=\"opens\" time=\"1.250\"/>",
            "name=\"cracks (back)\" time=\"0.000\"/>",
        ] {
            assert!(text.contains(line), "{line} isn't in {text}");
        }
        assert_eq!(text.matches(" time=\"").count(), 1 + 3 + 7, "{text}");
    }

    #[test]
    fn each_gate_is_a_case_and_texts_are_escaped() {
        let text = junit(&sample()).expect("XML");
        let mut reader = quick_xml::Reader::from_str(&text);
        let mut elements = Vec::new();
        loop {
            match reader.read_event().expect("well formed") {
                Event::Eof => break,
                Event::Start(start) | Event::Empty(start) => {
                    elements.push(String::from_utf8_lossy(start.name().as_ref()).into_owned());
                }
                _ => {}
            }
        }
        let count = |name: &str| elements.iter().filter(|element| *element == name).count();
        let found = ["testsuite", "testcase", "failure", "error", "system-out"].map(count);
        assert_eq!(found, [3, 7, 2, 1, 1], "a gate that can't be judged fails: {text}");
        assert!(text.contains("torn&lt;&amp;&quot;&gt;.glb"), "{text}");
        assert!(text.contains("tests=\"7\" failures=\"2\" errors=\"1\""), "{text}");
        assert!(text.contains("name=\"cracks (front)\""), "{text}");
        let said = "12 edges are cracked, where 0 are allowed";
        assert!(text.contains(&format!("<failure message=\"{said}\">{said}</failure>")), "{text}");
    }
}
