//! `pnaen domain`: prints the tessellator's domain points and triangles.

use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::tessellate::Device;
use super::{AdapterOption, CliError, read_text};
use geometry::names::shown_path;
use geometry::tessellate::{
    HullFactors, Partitioning, domain_plan, domain_point, domain_triangle, point_count, process, triangle_count,
};
use gpu::{DomainPass, DomainPattern, Gpu};
use inspect::shot::ShotError;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// How factors become segments; subtriangulation takes four equal factors. pow2 gives what integer gives: hull shaders round factors
    /// to powers of two before the tessellator gets them
    #[arg(long, value_name = "P", value_parser = super::options::choice::<Partitioning>())]
    pub partitioning: Partitioning,
    /// Factors of the edges where u, v and w are 0, and the inside factor; nan, inf, 0 and negative numbers are allowed
    #[arg(
        long,
        value_name = "E0,E1,E2,INSIDE",
        allow_hyphen_values = true,
        value_parser = comma_set,
        required_unless_present = "input",
        conflicts_with = "input"
    )]
    pub factors: Option<FactorSet>,
    /// File with a set of four factors per line, separated by spaces (- for standard input)
    #[arg(long, value_name = "FILE")]
    pub input: Option<PathBuf>,
    /// Where to compute; the CPU needs no graphics driver
    #[arg(long, value_enum, default_value_t = Device::Gpu)]
    pub device: Device,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

/// Three edge factors and the inside factor.
pub(super) type FactorSet = [f32; 4];

/// How many sets the GPU computes at once.
const BATCH: usize = 256;

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    args.adapter.check(args.device == Device::Cpu)?;
    let (sets, numbered) = match (&args.input, args.factors) {
        (Some(path), _) => (read_sets(path, args.partitioning)?, true),
        (None, Some(set)) if !is_taken(args.partitioning, set) => return Err(CliError::Usage(NOT_EQUAL)),
        (None, set) => (set.into_iter().collect(), false),
    };
    let mut out = BufWriter::new(std::io::stdout().lock());
    let mut number = 0;
    let mut write = |pattern: &DomainPattern| {
        let prefix = if numbered { format!("{number},") } else { String::new() };
        number += 1;
        write_pattern(&mut out, &prefix, pattern).map_err(CliError::Output)
    };
    match args.device {
        Device::Cpu => sets.iter().try_for_each(|set| write(&on_cpu(args.partitioning, set)))?,
        Device::Gpu => {
            let gpu = Gpu::chosen(&args.adapter.choice())?;
            let pass = DomainPass::default();
            for batch in sets.chunks(BATCH) {
                pass.run(&gpu, args.partitioning, batch)?.iter().try_for_each(&mut write)?;
            }
        }
    }
    out.flush().map_err(CliError::Output)
}

/// Why a set is refused.
const NOT_EQUAL: &str = "subtriangulation cuts all edges into the same number of segments: expected four equal factors";

/// Whether a partitioning takes a set: subtriangulation needs four equal factors.
fn is_taken(partitioning: Partitioning, [e0, e1, e2, inside]: FactorSet) -> bool {
    !partitioning.has_one_factor() || HullFactors { edges: [e0, e1, e2], inside }.is_uniform()
}

fn on_cpu(partitioning: Partitioning, &[e0, e1, e2, inside]: &FactorSet) -> DomainPattern {
    let factors = process(partitioning, [e0, e1, e2], inside);
    let plan = domain_plan(factors);
    DomainPattern {
        points: (0..point_count(factors)).map(|i| domain_point(&plan, i)).collect(),
        triangles: (0..triangle_count(factors)).map(|t| domain_triangle(&plan, t)).collect(),
    }
}

fn write_pattern(out: &mut impl Write, prefix: &str, pattern: &DomainPattern) -> std::io::Result<()> {
    let mut points = pattern.points.iter().enumerate();
    points.try_for_each(|(index, [u, v])| writeln!(out, "{prefix}point,{index},{u},{v}"))?;
    pattern.triangles.iter().try_for_each(|[a, b, c]| writeln!(out, "{prefix}triangle,{a},{b},{c}"))
}

fn comma_set(text: &str) -> Result<FactorSet, String> {
    factor_set(text.split(',')).ok_or_else(|| "expected four numbers, such as 3,2.5,inf,4".into())
}

fn factor_set<'a>(numbers: impl Iterator<Item = &'a str>) -> Option<FactorSet> {
    let numbers: Option<Vec<f32>> = numbers.map(|number| number.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

/// Reads sets of factors from a file, one per line. Empty lines are skipped.
fn read_sets(path: &Path, partitioning: Partitioning) -> Result<Vec<FactorSet>, CliError> {
    let text = read_text(path)?;
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let set = |(index, line): (usize, &str)| {
        let at_line = |reason: &str| ShotError::Line { path: shown_path(path), line: index + 1, reason: reason.into() };
        let set = factor_set(line.split_whitespace())
            .ok_or_else(|| at_line("expected four numbers separated by spaces, such as 3 2.5 inf 4"))?;
        if is_taken(partitioning, set) { Ok(set) } else { Err(at_line(NOT_EQUAL)) }
    };
    Ok(lines.map(set).collect::<Result<_, _>>()?)
}
