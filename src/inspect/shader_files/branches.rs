//! Leaves out the branches that the choices of an export never take.
//!
//! The shaders are written so that every condition on a choice is an `if` of its own line, which compares a constant or an
//! argument with the name of a value. A condition of another form stays, and is decided where the shader runs.

/// What is known of conditions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known<'a> {
    /// Names that conditions compare, each with the name of its value.
    pub values: &'a [(&'a str, &'a str)],
    /// Conditions that never hold.
    pub false_conditions: &'a [&'a str],
}

/// Returns a function's lines without the branches that are never taken.
pub(super) fn without_dead_branches(lines: &[String], known: &Known) -> Vec<String> {
    let mut kept = Vec::new();
    let mut at = 0;
    while at < lines.len() {
        let line = &lines[at];
        let holds = condition(line).and_then(|condition| decided(condition, known));
        let Some((holds, block)) = holds.and_then(|holds| Some((holds, Block::at(lines, at)?))) else {
            kept.push(line.clone());
            at += 1;
            continue;
        };
        let taken = if holds { &lines[at + 1..block.then_end] } else { block.otherwise(lines) };
        let taken: Vec<_> = taken.iter().map(|line| line.strip_prefix("    ").unwrap_or(line).to_owned()).collect();
        let taken = without_dead_branches(&taken, known);
        let returns =
            taken.last().is_some_and(|last| indent(last) == indent(line) && last.trim().starts_with("return"));
        kept.extend(taken);
        at = block.end;
        if returns {
            // Nothing after it in the same block is reached.
            at += lines[at..].iter().take_while(|after| after.is_empty() || indent(after) >= indent(line)).count();
        }
    }
    kept
}

/// Returns the condition of a line `if ... {`.
fn condition(line: &str) -> Option<&str> {
    line.trim_start().strip_prefix("if ")?.strip_suffix(" {")
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// The lines of an `if`, by their numbers.
struct Block {
    /// The line that closes what is done if the condition holds.
    then_end: usize,
    /// The line after the whole.
    end: usize,
}

impl Block {
    /// Returns the block whose `if` is in line `at`; `None` if it has an `else if`.
    fn at(lines: &[String], at: usize) -> Option<Self> {
        let own = indent(&lines[at]);
        let closes = |from: usize| {
            (from..lines.len()).find(|&i| indent(&lines[i]) == own && lines[i].trim_start().starts_with('}'))
        };
        let then_end = closes(at + 1)?;
        match lines[then_end].trim() {
            "}" => Some(Self { then_end, end: then_end + 1 }),
            "} else {" => Some(Self { then_end, end: closes(then_end + 1)? + 1 }),
            _ => None,
        }
    }

    /// The lines of the `else`.
    fn otherwise<'a>(&self, lines: &'a [String]) -> &'a [String] {
        let has_else = self.end > self.then_end + 1;
        if has_else { &lines[self.then_end + 1..self.end - 1] } else { &[] }
    }
}

/// Returns whether a condition holds: comparisons that are all joined by `||`, or all by `&&`. `None` if that isn't known.
fn decided(condition: &str, known: &Known) -> Option<bool> {
    let is_all = condition.contains(" && ");
    if is_all && condition.contains(" || ") {
        return None;
    }
    let parts = condition.split(if is_all { " && " } else { " || " });
    let compared: Vec<_> = parts.map(|part| comparison(part, known)).collect();
    // One that is false decides an `&&`, one that is true an `||`.
    if compared.contains(&Some(!is_all)) {
        return Some(!is_all);
    }
    compared.iter().all(Option::is_some).then_some(is_all)
}

/// Returns whether `name == VALUE`, or `name != VALUE`, holds. Names of values that differ are different values.
fn comparison(part: &str, known: &Known) -> Option<bool> {
    if known.false_conditions.contains(&part) {
        return Some(false);
    }
    let equal = part.split_once(" == ").map(|sides| (sides, true));
    let ((name, value), wants_equal) = equal.or_else(|| part.split_once(" != ").map(|sides| (sides, false)))?;
    let (_, own) = known.values.iter().find(|(known, _)| *known == name)?;
    // Something else than a value's name, such as another argument, isn't compared here.
    let is_value = value.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
    is_value.then_some((*own == value) == wants_equal)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pruned(text: &str) -> String {
        let lines: Vec<_> = text.lines().map(str::to_owned).collect();
        let known = Known { values: &[("surface", "PN"), ("clip", "OFF")], false_conditions: &["has_rows(x)"] };
        without_dead_branches(&lines, &known).join("\n")
    }

    #[test]
    fn a_branch_that_is_never_taken_is_left_out() {
        assert_eq!(
            pruned("fn f() {\n    if surface == FLAT {\n        a();\n    }\n    b();\n}"),
            "fn f() {\n    b();\n}"
        );
        assert_eq!(
            pruned(
                "fn f() {\n    if surface == FLAT || surface == BENT {\n        a();\n    } else {\n        c();\n    }\n    b();\n}"
            ),
            "fn f() {\n    c();\n    b();\n}"
        );
    }

    #[test]
    fn what_follows_a_return_is_left_out() {
        assert_eq!(
            pruned(
                "fn f() {\n    if surface == PN {\n        return a();\n    }\n    if x {\n        b();\n    }\n    return c();\n}"
            ),
            "fn f() {\n    return a();\n}"
        );
        assert_eq!(
            pruned(
                "fn f() {\n    if x {\n        if clip != ON {\n            return a();\n        }\n        b();\n    }\n    c();\n}"
            ),
            "fn f() {\n    if x {\n        return a();\n    }\n    c();\n}"
        );
    }

    #[test]
    fn what_isnt_known_stays() {
        for text in [
            "fn f() {\n    if surface == other {\n        a();\n    }\n}",
            "fn f() {\n    if lod == ERROR {\n        a();\n    }\n}",
            "fn f() {\n    if surface == PN && x {\n        a();\n    }\n}",
            "fn f() {\n    if surface == FLAT {\n        a();\n    } else if x {\n        b();\n    }\n}",
        ] {
            assert_eq!(pruned(text), text);
        }
        assert_eq!(pruned("fn f() {\n    if has_rows(x) {\n        a();\n    }\n}"), "fn f() {\n}");
        assert_eq!(pruned("fn f() {\n    if surface == FLAT && x {\n        a();\n    }\n}"), "fn f() {\n}");
    }
}
