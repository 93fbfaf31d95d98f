//! Holds the rows of a run to gates.

use std::collections::BTreeSet;

use super::{Method, Row, Tried};
use geometry::choice::Choice;
use geometry::numbers::{grouped, short};
use inspect::gates::{Gate, GateKind};

/// A gate that failed.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    pub kind: GateKind,
    /// The name of the subject where it is the worst.
    pub case: String,
    /// What was found there, in a sentence without its end.
    pub sentence: String,
    /// The tessellation in which it was found; none for what is found in the mesh itself.
    pub tried: Option<Tried>,
}

/// Whether the rows of a case have what a gate judges, for each of these methods.
pub fn are_judged(kind: GateKind, methods: &[Method], rows: &[Row]) -> bool {
    let has = |method: &Method| rows.iter().any(|row| row.method == method.name() && row.quantity.gate() == Some(kind));
    methods.iter().all(has)
}

/// The gates that rows fail, each with the worst of these rows.
pub fn failures(gates: &[Gate], rows: &[Row]) -> Vec<Failure> {
    gates.iter().filter_map(|gate| failure(gate, rows)).collect()
}

fn failure(Gate { kind, limit }: &Gate, rows: &[Row]) -> Option<Failure> {
    let fails = |row: &&Row| {
        row.quantity.gate() == Some(*kind) && limit.count().is_some_and(|limit| row.measured > limit as f64)
    };
    let worst = rows.iter().filter(fails).reduce(|a, b| if b.measured > a.measured { b } else { a })?;
    let failing = rows.iter().filter(fails).filter(|row| row.case == worst.case);
    let others = match failing.map(|row| row.method).collect::<BTreeSet<_>>().len() {
        1 => String::new(),
        several => format!("; {several} methods fail there"),
    };
    let Row { case, method, device, partitioning, measured, unit, .. } = worst;
    let number = if measured.fract() == 0.0 { grouped(*measured as u64) } else { short(*measured) };
    let sentence = format!(
        "{case} fails the gate {}: {method} has {number} {unit} with {partitioning} partitioning on {device}, {}{others}",
        kind.name(),
        limit.allowed(),
    );
    Some(Failure { kind: *kind, case: case.clone(), sentence, tried: worst.tried })
}

#[cfg(test)]
mod tests {
    use super::super::Quantity;
    use super::*;
    use geometry::tessellate::Surface;

    #[test]
    fn the_worst_row_of_a_gate_is_named() {
        let row = |case: &str, method, quantity: Quantity, measured| Row {
            case: case.into(),
            method,
            device: "cpu".into(),
            partitioning: "integer",
            measured,
            unit: quantity.unit(),
            promised: false,
            holds: measured <= quantity.limit(),
            quantity,
            tried: None,
        };
        let rows = [
            row("cube", "PN", Quantity::Points, 12.0),
            row("cube", "Phong", Quantity::Points, 3.0),
            row("cube", "PN", Quantity::Leaks, 4.0),
        ];
        assert!(are_judged(GateKind::Cracks, &[Method::Surface(Surface::Pn), Method::Surface(Surface::Phong)], &rows));
        assert!(
            !are_judged(GateKind::Leaks, &[Method::Surface(Surface::Pn), Method::Surface(Surface::Phong)], &rows),
            "Phong has no such row"
        );
        assert!(!are_judged(GateKind::Warnings, &[Method::Surface(Surface::Pn)], &rows), "no row has them");
        let gate = |text: &str| text.parse::<Gate>().expect("a gate");
        let found = failures(&[gate("cracks"), gate("leaks:4"), gate("folds"), gate("warnings")], &rows);
        let sentence =
            "cube fails the gate cracks: PN has 12 edge points that differ with integer partitioning on cpu, \
                        where 0 are allowed; 2 methods fail there"
                .to_owned();
        assert_eq!(found, [Failure { kind: GateKind::Cracks, case: "cube".into(), sentence, tried: None }]);
    }
}
