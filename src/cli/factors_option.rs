//! The option `--factors`: factors from a file in place of LOD's, and a report on where they disagree.

use std::path::PathBuf;

use super::options::LOD_OPTIONS;
use super::{CliError, note};
use geometry::mesh::{Mesh, Topology};
use geometry::tessellate::{HullFactors, Tessellation};
use inspect::measure::Agreement;
use inspect::shot::{FactorsFile, read_factors, said};

#[derive(Clone, Debug, Default, clap::Args)]
pub struct FactorsOption {
    /// Tessellate with the factors of a file in place of those that LOD computes (- for standard input): CSV with the header
    /// patch,e0,e1,e2,inside (under rows patch,e0,e1,e2,base,width,flipped) and a line for each triangle, as the factors
    /// command or another engine writes it. Standard error lists edges whose two sides have different factors, and names the convention under which all sides agree
    #[arg(long = "factors", value_name = "CSV", conflicts_with_all = LOD_OPTIONS)]
    pub given: Option<PathBuf>,
}

/// Factors from a file, checked against the mesh: one for each patch, and what was found about them.
type Given = (Vec<HullFactors>, FactorsFile);

impl FactorsOption {
    /// Reads the file, if one was named, and reports on standard error where its factors disagree.
    pub fn read(
        &self,
        mesh: &Mesh,
        topology: &Topology,
        tessellation: &Tessellation,
    ) -> Result<Option<Given>, CliError> {
        let convention = tessellation.convention;
        let Some(path) = &self.given else { return Ok(None) };
        let factors = read_factors(path, mesh, topology, tessellation.partitioning)?;
        let agreement = Agreement::new(topology, &factors, convention);
        said(topology, &agreement, convention).iter().for_each(|line| note(line));
        let about = FactorsFile::new(path, topology, &agreement, convention);
        Ok(Some((factors, about)))
    }
}
