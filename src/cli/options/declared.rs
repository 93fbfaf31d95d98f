//! Command line options made from the declarations of settings.

use std::ffi::OsStr;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser, ValueParser};
use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command, Error, FromArgMatches};

use geometry::defaults::with_defaults;
use geometry::tessellate::{Displacement, Lod, Tessellation};
use inspect::settings::{Choice, Declaration, Description, Kind, Lighting, Settings, Value, descriptions, options};
use load::Import;

/// Options that are made from declarations.
pub trait Group: Clone + Default {
    const ALL: &'static [&'static [&'static Declaration]];

    fn arg(declaration: &'static Declaration) -> Arg {
        with_default(arg(declaration), declaration)
    }

    /// Takes what was given on the command line.
    fn take(&mut self, matches: &ArgMatches) -> Result<(), Error>;
}

/// The values of a group's options.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Declared<T>(pub T);

/// How a mesh is tessellated.
pub(crate) type TessellationOptions = Declared<GivenTessellation>;

/// How a picture is drawn: settings with the usual tessellation.
pub(crate) type PictureOptions = Declared<Settings>;

/// How the geometry of a file is taken.
pub(crate) type ImportOptions = Declared<Import>;

with_defaults! {
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct GivenTessellation {
        pub tessellation: Tessellation = Settings::usual().tessellation,
        /// Given on the command line; without it, displacement depends on whether there are heights.
        pub displacement: Option<Displacement> = None,
    }
}

const WITHOUT_DISPLACEMENT: &str =
    "By default on with --height, else off. Without --height it takes the file's height images, or else base colours";
/// Arguments that say factors: a factor, and a file or a shader of factors.
const WITHOUT_LOD: [&str; 3] = ["factor", "given", "lod_shader"];
const USUAL_LOD: &str = "With --factor it is uniform, unless this option says otherwise";
const USUAL_PARTITIONING: &str = "By default rows under LOD by error, else fractional-odd";

impl<T: Group> clap::Args for Declared<T> {
    fn augment_args(command: Command) -> Command {
        command.args(T::ALL.iter().copied().flatten().map(|declaration| T::arg(declaration)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<T: Group> FromArgMatches for Declared<T> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let mut own = Self::default();
        own.update_from_arg_matches(matches)?;
        Ok(own)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        self.0.take(matches)
    }
}

impl Group for GivenTessellation {
    const ALL: &'static [&'static [&'static Declaration]] = &[&options::TESSELLATION];

    fn arg(declaration: &'static Declaration) -> Arg {
        let own = arg(declaration);
        let more = |text: &str| format!("{} {text}", declaration.text);
        match declaration.name {
            name if name == options::DISPLACEMENT.name => own.help(more(WITHOUT_DISPLACEMENT)),
            name if name == options::PARTITIONING.name => own.help(more(USUAL_PARTITIONING)),
            name if name == options::LOD.name => with_default(own, declaration).help(more(USUAL_LOD)),
            _ => with_default(own, declaration),
        }
    }

    fn take(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        let mut settings = Settings::from(self.tessellation);
        take(&options::TESSELLATION, matches, &mut settings)?;
        self.tessellation = settings.tessellation;
        let is_given = |id: &str| {
            matches.try_contains_id(id).is_ok_and(|is_known| is_known)
                && matches.value_source(id) == Some(ValueSource::CommandLine)
        };
        let own = &mut self.tessellation;
        if !is_given(options::LOD.name) && (own.partitioning.has_one_factor() || WITHOUT_LOD.into_iter().any(is_given))
        {
            own.lod = Lod::Uniform;
        }
        if !is_given(options::PARTITIONING.name) {
            own.partitioning = own.lod.usual_partitioning();
        }
        if matches.contains_id(options::DISPLACEMENT.name) {
            self.displacement = Some(self.tessellation.displacement);
        }
        Ok(())
    }
}

impl Group for Settings {
    const ALL: &'static [&'static [&'static Declaration]] = &[&options::LOOKS, &options::PICTURE];

    fn arg(declaration: &'static Declaration) -> Arg {
        let arg = with_default(arg(declaration), declaration);
        if matches!(declaration.kind, Kind::Options(_)) { arg.requires(options::SPLIT.name) } else { arg }
    }

    fn take(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        // The left half differs from the right one by what is said.
        let mut right = GivenTessellation::default();
        right.take(matches)?;
        let has_heights = matches.try_contains_id("height").is_ok_and(|has_heights| has_heights);
        right.tessellation.displacement = right.displacement.unwrap_or(Displacement::usual(has_heights));
        let mut own = self.with(right.tessellation);
        take(&options::LOOKS, matches, &mut own)?;
        let is_given = matches.value_source(options::LIGHTING.name) == Some(ValueSource::CommandLine);
        if !is_given && matches.try_contains_id("environment").is_ok_and(|has_file| has_file) {
            own.lighting = Lighting::Environment;
        }
        take(&options::PICTURE, matches, &mut own)?;
        *self = own.with(self.tessellation);
        Ok(())
    }
}

impl Group for Import {
    const ALL: &'static [&'static [&'static Declaration]] = &[&options::IMPORT];

    fn take(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        let mut settings = Settings { import: *self, ..Settings::default() };
        take(&options::IMPORT, matches, &mut settings)?;
        *self = settings.import;
        Ok(())
    }
}

/// An option of the command line. Help texts have no period at their end.
pub(super) fn arg(declaration: &'static Declaration) -> Arg {
    let arg = Arg::new(declaration.name).long(declaration.name).help(help(declaration));
    if matches!(declaration.kind, Kind::Switch) {
        return arg.action(ArgAction::SetTrue);
    }
    let takes_negative = declaration.range().is_some_and(|range| range.least < 0.0)
        || declaration.kind.descriptions().iter().any(|value| value.name.starts_with('-'));
    let arg =
        arg.value_name(declaration.placeholder).allow_hyphen_values(takes_negative).value_parser(parser(declaration));
    if matches!(declaration.kind, Kind::Several(_)) { arg.action(ArgAction::Append).value_delimiter(',') } else { arg }
}

fn with_default(arg: Arg, declaration: &Declaration) -> Arg {
    match (&declaration.kind, declaration.default()) {
        (Kind::Several(_) | Kind::Switch, _) | (_, Value::Unset) => arg,
        (_, default) => arg.default_value(default.to_string()),
    }
}

/// The text, and the numbers that the option takes.
fn help(declaration: &Declaration) -> String {
    let text = declaration.text.trim_end_matches('.');
    declaration.range().map_or_else(|| text.to_owned(), |range| format!("{text} [{range}]"))
}

fn parser(declaration: &'static Declaration) -> ValueParser {
    match &declaration.kind {
        Kind::Choice(all) | Kind::Several(all) => {
            let value = |name: String| declaration.kind.named(&name).map_or(Value::Unset, Value::Name);
            let names: Vec<_> = all().into_iter().map(possible).collect();
            ValueParser::new(Listed { parser: PossibleValuesParser::new(names.clone()).map(value), names })
        }
        kind @ Kind::NameOrNumber { .. } => {
            let names = kind.descriptions().into_iter().map(possible).collect();
            ValueParser::new(Listed { parser: move |text: &str| kind.parse(text), names })
        }
        kind => ValueParser::new(move |text: &str| kind.parse(text)),
    }
}

/// Reads a value as `parser` does, without the blanks around it, which people write after the commas of a list.
#[derive(Clone)]
pub(crate) struct Listed<P> {
    pub parser: P,
    /// What help texts list, though there may be more values than they.
    pub names: Vec<PossibleValue>,
}

impl<P: TypedValueParser> TypedValueParser for Listed<P> {
    type Value = P::Value;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<P::Value, Error> {
        self.parser.parse_ref(command, arg, value.to_str().map_or(value, |text| OsStr::new(text.trim())))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.names.iter().cloned()))
    }
}

fn possible(description: Description) -> PossibleValue {
    PossibleValue::new(description.name).help(description.text.trim_end_matches('.')).aliases(description.hlsl_name())
}

/// Puts what was given on the command line into settings.
fn take(all: &[&Declaration], matches: &ArgMatches, settings: &mut Settings) -> Result<(), Error> {
    for declaration in all {
        let Some(value) = given(declaration, matches) else { continue };
        if !declaration.set(settings, value.clone()) {
            // Only a list of overlays is refused as a whole: values that are wrong by themselves never come here.
            let name = declaration.name;
            let message =
                format!("--{name} can't be {value}: each of these colours the whole surface, so choose one\n");
            return Err(Error::raw(ErrorKind::ValueValidation, message));
        }
    }
    Ok(())
}

/// Returns the value of an option, if it has one.
pub(super) fn given(declaration: &Declaration, matches: &ArgMatches) -> Option<Value> {
    let name = declaration.name;
    let given = || matches.get_many::<Value>(name).into_iter().flatten().cloned();
    match declaration.kind {
        Kind::Switch => matches.get_flag(name).then_some(Value::Switch(true)),
        Kind::Several(_) => Some(Value::Names(given().filter_map(|value| name_of(&value)).collect())),
        _ => given().next_back(),
    }
}

fn name_of(value: &Value) -> Option<&'static str> {
    if let Value::Name(name) = value { Some(name) } else { None }
}

/// Reads one of several named values.
pub(crate) fn choice<T: Choice + Send + Sync>() -> impl TypedValueParser<Value = T> {
    named(descriptions::<T>().into_iter().map(possible), T::named)
}

/// Reads one of several names, each of which `find` has a value for.
pub(crate) fn named<T: Clone + Send + Sync + 'static>(
    names: impl IntoIterator<Item = PossibleValue>,
    find: impl Fn(&str) -> Option<T> + Clone + Send + Sync + 'static,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(names).try_map(move |name| find(&name).ok_or("no such value"))
}

/// Reads a number of an option's range.
pub(crate) fn number_of(declaration: &'static Declaration) -> impl TypedValueParser<Value = f32> {
    move |text: &str| match declaration.kind.parse(text)? {
        Value::Number(number) => Ok(number),
        _ => Err(String::from("expected a number")),
    }
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory, Parser};

    use super::*;
    use crate::cli::{Cli, Command as Run};

    #[test]
    fn the_help_of_render_has_every_option_with_its_text_values_range_and_default() {
        let mut cli = Cli::command();
        let render = cli.find_subcommand_mut("render").expect("it is a command");
        let help = render.render_long_help().to_string();
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        let help = words(&help);
        for option in options::all() {
            let name = option.name;
            assert!(
                help.contains(&words(&format!("--{name} {}", if option.placeholder.is_empty() { "" } else { "<" })))
            );
            assert!(help.contains(option.text.trim_end_matches('.')), "{name}");
            assert!(option.range().is_none_or(|range| help.contains(&format!("[{range}]"))), "{name}");
            for Description { name, text, .. } in option.kind.descriptions() {
                assert!(help.contains(&format!("- {name}: {}", text.trim_end_matches('.'))), "{name}");
            }
            let default = option.default();
            let has_default = !matches!(default, Value::Unset | Value::Switch(_) | Value::Names(_));
            // What the default of these is depends on others.
            if has_default && ![options::DISPLACEMENT.name, options::PARTITIONING.name].contains(&name) {
                assert!(help.contains(&format!("[default: {default}]")), "{name}");
            }
        }
    }

    fn read(arguments: &[String]) -> Result<Settings, Error> {
        let usual = ["pnaen", "render", "a.glb", "-o", "a.png"].map(String::from);
        match Cli::try_parse_from(usual.iter().chain(arguments))?.command {
            Some(Run::Render(args)) => Ok(Settings {
                import: args.shot.surface.weld.import.0,
                ..args.shot.picture.0.with(args.shot.surface.tessellation.0.tessellation)
            }),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn what_gives_factors_stands_for_uniform_lod_and_each_lod_has_its_partitioning() {
        use Lod::{EdgeLength, Error, Uniform};
        use geometry::tessellate::Partitioning::{FractionalOdd, Integer, Rows, Subtriangulation};
        for (arguments, lod, partitioning) in [
            ("", Error, Rows),
            ("--factor=8", Uniform, FractionalOdd),
            ("--factor=8 --lod=error", Error, Rows),
            ("--lod=uniform", Uniform, FractionalOdd),
            ("--lod=edge-length", EdgeLength, FractionalOdd),
            ("--lod=uniform --partitioning=rows", Uniform, Rows),
            ("--partitioning=integer", Error, Integer),
            ("--partitioning=subtriangulation", Uniform, Subtriangulation),
            ("--factors=a.csv", Uniform, FractionalOdd),
            ("--lod-shader=a.wgsl", Uniform, FractionalOdd),
        ] {
            let words: Vec<_> = arguments.split_whitespace().map(String::from).collect();
            let own = read(&words).expect("valid options").tessellation;
            assert_eq!((own.lod, own.partitioning), (lod, partitioning), "{arguments}");
        }
    }

    #[test]
    fn every_option_is_read_from_the_command_line() {
        assert_eq!(read(&[]).expect("nothing is given"), Settings::usual());
        for option in options::all() {
            let value = match &option.kind {
                Kind::Choice(all) => all().last().map_or(Value::Unset, |value| Value::Name(value.name)),
                Kind::Several(all) => Value::Names(all()[..2].iter().map(|value| value.name).collect()),
                Kind::Number(range) | Kind::NameOrNumber { range, .. } => Value::Number(range.least),
                Kind::Pair(range) => Value::Pair([range.least, range.most]),
                Kind::Switch => Value::Switch(true),
                Kind::Color => Value::Color([1, 2, 3]),
                Kind::Options(all) if all()[0].name == options::SURFACE.name => {
                    Value::Options(vec![(all()[0].name, Value::Name("flat"))])
                }
                Kind::Options(all) => Value::Options(vec![(all()[0].name, Value::Names(vec!["clay", "wireframe"]))]),
            };
            // A factor stands for uniform LOD.
            let mut expected =
                if option.name == options::FACTOR.name { Settings::default() } else { Settings::usual() };
            let mut arguments = Vec::new();
            if matches!(option.kind, Kind::Options(_)) {
                assert!(read(&[format!("--{}={value}", option.name)]).is_err(), "it needs a split");
                arguments.push("--split=0.5".to_owned());
                expected.split = Some(0.5);
            }
            arguments.push(match value {
                Value::Switch(_) => format!("--{}", option.name),
                _ => format!("--{}={value}", option.name),
            });
            assert!(option.set(&mut expected, value));
            if option.name == options::LOD.name {
                expected = expected.under(expected.tessellation.lod);
            }
            assert_eq!(read(&arguments).expect("a value of the option"), expected, "{arguments:?}");
            assert!(read(&[format!("--{}=odd", option.name)]).is_err(), "{}", option.name);
        }
        let clash = read(&["--overlay=factors,barycentric".to_owned()]).expect_err("both colour the surface");
        assert_eq!((clash.kind(), clash.exit_code()), (ErrorKind::ValueValidation, 2));
    }
}
