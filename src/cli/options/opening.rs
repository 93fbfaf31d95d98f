//! How the window takes the mesh that it opens first.

use clap::{Arg, ArgMatches, Args, Error};

use super::PartOptions;
use super::declared::{Declared, Group, arg, given};
use inspect::engine::Preparation;
use inspect::settings::{Declaration, Settings, Value, options};
use load::{Import, ShownParts};

/// How the window takes the mesh that it opens first. What isn't given is as the window was left, or as it was chosen for the file.
#[derive(Clone, Debug, Default, Args)]
#[command(
    mut_arg("hide_part", |arg| arg.requires("file")),
    mut_arg("show_part", |arg| arg.requires("file")),
    mut_arg("part", |arg| arg.requires("file")),
    mut_arg("morph", |arg| arg.requires("file"))
)]
pub struct OpeningOptions {
    #[command(flatten)]
    import: Declared<GivenImport>,
    #[command(flatten)]
    pub parts: PartOptions,
}

/// The names of those of [`options::IMPORT`] that were given, with their values.
#[derive(Clone, Debug, Default)]
struct GivenImport(Vec<(&'static str, Value)>);

impl OpeningOptions {
    /// Whether none was given.
    pub fn is_empty(&self) -> bool {
        self.import.0.0.is_empty() && self.parts.shown() == ShownParts::default()
    }

    /// Changes what the given options are about.
    pub fn change(&self, preparation: &mut Preparation) {
        preparation.import = self.import(preparation.import);
        preparation.parts = self.parts.shown();
    }

    /// How the geometry of a file is taken, which is `usual` without options.
    pub fn import(&self, usual: Import) -> Import {
        let mut settings = Settings { import: usual, ..Settings::default() };
        for (name, value) in &self.import.0.0 {
            let declared = options::IMPORT.into_iter().filter(|own| own.name == *name);
            declared.for_each(|own| _ = own.set(&mut settings, value.clone()));
        }
        settings.import
    }
}

impl Group for GivenImport {
    const ALL: &'static [&'static [&'static Declaration]] = &[&options::IMPORT];

    fn arg(declaration: &'static Declaration) -> Arg {
        arg(declaration)
    }

    fn take(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        let value = |declaration: &'static Declaration| Some((declaration.name, given(declaration, matches)?));
        self.0 = options::IMPORT.into_iter().filter_map(value).collect();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::cli::Cli;
    use geometry::mesh::UpAxis;
    use geometry::mesh::subdivision::FaceVarying;
    use load::import::Subdivide;
    use load::{FileUnit, LengthUnit, NormalSource};

    fn options(arguments: &[&str]) -> OpeningOptions {
        Cli::try_parse_from(["pnaen"].iter().chain(arguments)).expect("options of the window").opening
    }

    #[test]
    fn only_what_is_given_changes_how_a_file_is_taken() {
        let usual = Import {
            normals: NormalSource::Made,
            crease_angle: 30.0,
            up: Some(UpAxis::X),
            unit: Some(FileUnit::Named(LengthUnit::Inch)),
            show_hidden: true,
            subdivide: Subdivide::Loop,
            levels: Some(3.0),
            subdivide_uvs: Some(FaceVarying::Corners),
        };
        assert!(options(&["a.obj"]).is_empty());
        assert_eq!(options(&["a.obj"]).import(usual), usual);
        let some = options(&["a.obj", "--up", "z", "--crease-angle", "0"]);
        assert_eq!(some.import(usual), Import { crease_angle: 0.0, up: Some(UpAxis::Z), ..usual });
        let others = options(&["a.obj", "--mesh-normals=file", "--unit=mm", "--hide-part", "a", "--hide-part=b"]);
        let mut preparation = Preparation { import: usual, ..Preparation::default() };
        others.change(&mut preparation);
        let expected =
            Import { normals: NormalSource::File, unit: Some(FileUnit::Named(LengthUnit::Millimetre)), ..usual };
        assert_eq!(options(&["a.obj", "--unit=0.0254"]).import(usual).unit, Some(FileUnit::Metres(0.0254)));
        assert_eq!(
            (preparation.import, &preparation.parts.hidden[..]),
            (expected, &["a".to_owned(), "b".to_owned()][..])
        );
    }

    #[test]
    fn parts_need_a_file_and_commands_have_options_of_their_own() {
        assert!(Cli::try_parse_from(["pnaen", "--hide-part", "a"]).is_err());
        assert!(Cli::try_parse_from(["pnaen", "--morph", "a=1"]).is_err());
        assert_eq!(options(&["a.obj", "--morph", "a=1", "--morph=b=2"]).parts.shown().morphs.len(), 2);
        assert!(Cli::try_parse_from(["pnaen", "--up", "z", "info", "a.obj"]).is_err());
        for unit in ["parsec", "0", "-1", "nan", "inf", "1e300", "1e-40", "0.0254 m", ""] {
            assert!(Cli::try_parse_from(["pnaen", "a.obj", "--unit", unit]).is_err(), "{unit}");
        }
    }
}
