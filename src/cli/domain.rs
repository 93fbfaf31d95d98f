//! `pnaen domain`: prints or draws the tessellator's domain points, and its triangles or lines.

mod diagram;

use std::io::{BufWriter, Write};
use std::path::PathBuf;

use super::tessellate::Device;
use super::{AdapterOption, CliError, options, read_text, refuse, write_text};
use geometry::names::shown_path;
use geometry::tessellate::{DomainKind, HullFactors, IsolineFactors, Partitioning, QuadFactors, process};
use gpu::{DomainPass, Gpu};
use inspect::settings::Choice;
use inspect::shot::ShotError;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// What is tessellated
    #[arg(long, value_name = "KIND", value_parser = super::options::choice::<DomainKind>(), default_value = DomainKind::Tri.name())]
    pub kind: DomainKind,
    /// How factors become segments; subtriangulation takes four equal factors. pow2 gives what integer gives: hull shaders round factors
    /// to powers of two before the tessellator gets them
    #[arg(long, value_name = "P", value_parser = super::options::choice::<Partitioning>())]
    pub partitioning: Partitioning,
    /// Factors of the edges where u, v and w are 0, and the inside factor; nan, inf, 0 and negative numbers are allowed. Of a
    /// quad those of the edges where u is 0, v is 0, u is 1 and v is 1, and inside along u and v; of isolines their number and
    /// the segments of each
    #[arg(
        long,
        value_name = "E0,E1,E2,INSIDE",
        allow_hyphen_values = true,
        value_parser = comma_list,
        required_unless_present = "input",
        conflicts_with = "input"
    )]
    pub factors: Option<FactorList>,
    /// File with a set of factors per line, separated by spaces (- for standard input)
    #[arg(long, value_name = "FILE")]
    pub input: Option<PathBuf>,
    /// Picture of the pattern to write instead of numbers, an SVG file
    #[arg(short, long, value_name = "OUT.svg", value_parser = options::ending_in(&["svg"], "diagrams are SVG files: name it .svg"), conflicts_with = "input")]
    pub output: Option<PathBuf>,
    /// Where to compute: triangles by default on the GPU, quads and isolines on the CPU, which needs no graphics driver
    #[arg(long, value_enum)]
    pub device: Option<Device>,
    #[command(flatten)]
    pub adapter: AdapterOption,
}

/// Factors in the order of the option. clap takes a field that is written as a `Vec` for an option to repeat.
pub(super) type FactorList = Vec<f32>;

/// How many sets the GPU computes at once.
const BATCH: usize = 256;

pub(super) fn run(args: &Args) -> Result<(), CliError> {
    args.check()?;
    let mut shown = Output { args, out: BufWriter::new(std::io::stdout().lock()), number: 0 };
    match args.kind {
        DomainKind::Tri if args.device == Some(Device::Cpu) => {
            for [e0, e1, e2, inside] in args.sets()? {
                let factors = process(args.partitioning, [e0, e1, e2], inside);
                shown.add(&factors.points(), &factors.triangles())?;
            }
        }
        DomainKind::Tri => {
            let sets = args.sets()?;
            let gpu = Gpu::chosen(&args.adapter.choice())?;
            let pass = DomainPass::default();
            for batch in sets.chunks(BATCH) {
                let mut patterns = pass.run(&gpu, args.partitioning, batch)?.into_iter();
                patterns.try_for_each(|own| shown.add(&own.points, &own.triangles))?;
            }
        }
        DomainKind::Quad => {
            for [e0, e1, e2, e3, u, v] in args.sets()? {
                let drawn = QuadFactors::new(args.partitioning, [e0, e1, e2, e3], [u, v]);
                let (points, triangles) = drawn.map(|own| (own.points(), own.triangles())).unwrap_or_default();
                shown.add(&points, &triangles)?;
            }
        }
        DomainKind::Isoline => {
            for [density, detail] in args.sets()? {
                let drawn = IsolineFactors::new(args.partitioning, density, detail);
                let (points, lines) = drawn.map(|own| (own.points(), own.lines())).unwrap_or_default();
                shown.add(&points, &lines)?;
            }
        }
    }
    shown.out.flush().map_err(CliError::Output)
}

impl Args {
    fn check(&self) -> Result<(), CliError> {
        let is_tri = self.kind == DomainKind::Tri;
        refuse(
            !is_tri && !Partitioning::DIRECT3D.contains(&self.partitioning),
            "quads and isolines have Direct3D's partitionings: choose integer, pow2, fractional-odd or fractional-even",
        )?;
        refuse(
            !is_tri && (self.device == Some(Device::Gpu) || self.adapter.adapter.is_some()),
            "quads and isolines are computed on the CPU: leave out --device gpu and --adapter",
        )?;
        self.adapter.check(self.device == Some(Device::Cpu))
    }

    /// Returns the set of `--factors`, or those of the file, one per line. Empty lines are skipped.
    fn sets<const N: usize>(&self) -> Result<Vec<[f32; N]>, CliError> {
        let Some(path) = &self.input else {
            return self.factors.iter().map(|list| self.set(list).map_err(CliError::Usage)).collect();
        };
        let text = read_text(path)?;
        let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let set = |(index, line): (usize, &str)| {
            let list = numbers(line.split_whitespace()).unwrap_or_default();
            let at_line = |why: &str| ShotError::Line { path: shown_path(path), line: index + 1, reason: why.into() };
            self.set(&list).map_err(at_line)
        };
        Ok(lines.map(set).collect::<Result<_, _>>()?)
    }

    /// Returns a set of as many factors as the kind of patch has, or says why these are none.
    fn set<const N: usize>(&self, list: &[f32]) -> Result<[f32; N], &'static str> {
        let set = list.try_into().map_err(|_| match self.kind {
            DomainKind::Tri => "expected four numbers, of edges and inside: 3,2.5,inf,4, or in a file 3 2.5 inf 4",
            DomainKind::Quad => "expected six numbers, of edges and inside: 3,2,inf,4,2,2, or in a file 3 2 inf 4 2 2",
            DomainKind::Isoline => "expected two numbers, of isolines and their segments: 3,2.5, or in a file 3 2.5",
        })?;
        match *list {
            [e0, e1, e2, inside]
                if self.partitioning.has_one_factor() && !HullFactors { edges: [e0, e1, e2], inside }.is_uniform() =>
            {
                Err("subtriangulation cuts all edges into the same number of segments: expected four equal factors")
            }
            _ => Ok(set),
        }
    }
}

/// Prints patterns, one after another, or draws the only one.
struct Output<'a, W> {
    args: &'a Args,
    out: W,
    /// The number of the next pattern.
    number: usize,
}

impl<W: Write> Output<'_, W> {
    /// Shows points, and what joins them: lines or triangles.
    fn add<const N: usize>(&mut self, points: &[[u32; 2]], primitives: &[[u32; N]]) -> Result<(), CliError> {
        if let (Some(path), Some(factors)) = (&self.args.output, &self.args.factors) {
            return Ok(write_text(path, &diagram::svg(self.args.kind, factors, points, primitives))?);
        }
        // In a list every line begins with the number of its pattern.
        let prefix = self.args.input.as_ref().map_or_else(String::new, |_| format!("{},", self.number));
        self.number += 1;
        let name = if N == 2 { "line" } else { "triangle" };
        let mut write = |line: String| writeln!(self.out, "{prefix}{line}").map_err(CliError::Output);
        let mut numbered = points.iter().enumerate();
        numbered.try_for_each(|(index, [u, v])| write(format!("point,{index},{u},{v}")))?;
        let joined = |own: &[u32; N]| own.map(|point| point.to_string()).join(",");
        primitives.iter().try_for_each(|own| write(format!("{name},{}", joined(own))))
    }
}

fn comma_list(text: &str) -> Result<FactorList, String> {
    numbers(text.split(',')).ok_or_else(|| "expected numbers separated by commas, such as 3,2.5,inf".into())
}

fn numbers<'a>(texts: impl Iterator<Item = &'a str>) -> Option<FactorList> {
    texts.map(|number| number.trim().parse().ok()).collect()
}
