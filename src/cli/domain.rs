//! `pnaen domain`: prints the tessellator's domain points, and its triangles or lines.

use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::tessellate::Device;
use super::{AdapterOption, CliError, read_text, refuse};
use geometry::names::shown_path;
use geometry::tessellate::{
    DomainKind, HullFactors, IsolineFactors, Partitioning, QuadFactors, domain_plan, domain_point, domain_triangle,
    point_count, process, triangle_count,
};
use gpu::{DomainPass, DomainPattern, Gpu};
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
    let out = BufWriter::new(std::io::stdout().lock());
    let mut printer = Printer { out, is_numbered: args.input.is_some(), number: 0 };
    match args.kind {
        DomainKind::Tri if args.device == Some(Device::Cpu) => {
            args.sets()?.iter().try_for_each(|set| printer.print_triangles(&on_cpu(args.partitioning, set)))?;
        }
        DomainKind::Tri => {
            let sets = args.sets()?;
            let gpu = Gpu::chosen(&args.adapter.choice())?;
            let pass = DomainPass::default();
            for batch in sets.chunks(BATCH) {
                let patterns = pass.run(&gpu, args.partitioning, batch)?;
                patterns.iter().try_for_each(|pattern| printer.print_triangles(pattern))?;
            }
        }
        DomainKind::Quad => {
            for [e0, e1, e2, e3, u, v] in args.sets()? {
                let drawn = QuadFactors::new(args.partitioning, [e0, e1, e2, e3], [u, v]);
                let pattern = |own: QuadFactors| DomainPattern { points: own.points(), triangles: own.triangles() };
                printer.print_triangles(&drawn.map(pattern).unwrap_or_default())?;
            }
        }
        DomainKind::Isoline => {
            for [density, detail] in args.sets()? {
                let drawn = IsolineFactors::new(args.partitioning, density, detail);
                let (points, lines) = drawn.map(|own| (own.points(), own.lines())).unwrap_or_default();
                printer.print(&points, "line", &lines)?;
            }
        }
    }
    printer.out.flush().map_err(CliError::Output)
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

    /// Returns the set of `--factors`, or those of the file.
    fn sets<const N: usize>(&self) -> Result<Vec<[f32; N]>, CliError> {
        match (&self.input, &self.factors) {
            (Some(path), _) => self.read_sets(path),
            (None, list) => list.iter().map(|list| self.set(list).map_err(CliError::Usage)).collect(),
        }
    }

    /// Reads sets of factors from a file, one per line. Empty lines are skipped.
    fn read_sets<const N: usize>(&self, path: &Path) -> Result<Vec<[f32; N]>, CliError> {
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
            DomainKind::Tri => "expected four numbers, of three edges and inside: 3,2.5,inf,4, or in a file 3 2.5 inf 4",
            DomainKind::Quad => {
                "expected six numbers, of four edges and inside along u and v: 3,2.5,inf,4,2,2, or in a file 3 2.5 inf 4 2 2"
            }
            DomainKind::Isoline => {
                "expected two numbers, of isolines and of segments of each: 3,2.5, or in a file 3 2.5"
            }
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

/// Prints patterns, one after another.
struct Printer<W> {
    out: W,
    /// Whether every line begins with the number of the pattern.
    is_numbered: bool,
    /// The number of the next pattern.
    number: usize,
}

impl<W: Write> Printer<W> {
    /// Prints points, and what joins them, which has this name.
    fn print<const N: usize>(
        &mut self,
        points: &[[u32; 2]],
        name: &str,
        primitives: &[[u32; N]],
    ) -> Result<(), CliError> {
        let prefix = if self.is_numbered { format!("{},", self.number) } else { String::new() };
        self.number += 1;
        let mut write = |line: String| writeln!(self.out, "{prefix}{line}").map_err(CliError::Output);
        let mut numbered = points.iter().enumerate();
        numbered.try_for_each(|(index, [u, v])| write(format!("point,{index},{u},{v}")))?;
        let joined = |own: &[u32; N]| own.map(|point| point.to_string()).join(",");
        primitives.iter().try_for_each(|own| write(format!("{name},{}", joined(own))))
    }

    fn print_triangles(&mut self, pattern: &DomainPattern) -> Result<(), CliError> {
        self.print(&pattern.points, "triangle", &pattern.triangles)
    }
}

fn on_cpu(partitioning: Partitioning, &[e0, e1, e2, inside]: &[f32; 4]) -> DomainPattern {
    let factors = process(partitioning, [e0, e1, e2], inside);
    let plan = domain_plan(factors);
    DomainPattern {
        points: (0..point_count(factors)).map(|i| domain_point(&plan, i)).collect(),
        triangles: (0..triangle_count(factors)).map(|t| domain_triangle(&plan, t)).collect(),
    }
}

fn comma_list(text: &str) -> Result<FactorList, String> {
    numbers(text.split(',')).ok_or_else(|| "expected numbers separated by commas, such as 3,2.5,inf".into())
}

fn numbers<'a>(texts: impl Iterator<Item = &'a str>) -> Option<FactorList> {
    texts.map(|number| number.trim().parse().ok()).collect()
}
