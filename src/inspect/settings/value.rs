//! The declaration of an option, and the values of options.

use std::fmt;

use serde::{Serialize, Serializer};

use super::{
    Choice, Description, FileLights, Lighting, Matcap, NormalMaps, NormalsAt, Overlay, Overlays, SectionAxis, Settings,
    SplitView, SurfaceUnit, ToneCurve,
};
use geometry::mesh::UpAxis;
use geometry::mesh::subdivision::FaceVarying;
use geometry::tessellate::{Clip, Convention, CurvatureKind, Displacement, Edges, Lod, Normals, Partitioning, Surface};
use load::import::Subdivide;
use load::{FileUnit, LengthUnit, NormalSource};

/// An option, declared once for the command line, saved settings and the window.
pub struct Declaration {
    /// On the command line, after `--`.
    pub name: &'static str,
    /// The row's name in the window.
    pub label: &'static str,
    /// What stands for the value in the command line's help, such as `PX`.
    pub placeholder: &'static str,
    /// What the option sets, in whole sentences.
    pub text: &'static str,
    pub kind: Kind,
    /// What the option is without a value; none if it always has one.
    pub unset: Option<Description>,
    /// The members of saved settings that hold it, if it isn't its own name with underscores: two for a pair, and none for what isn't
    /// saved.
    pub saved_as: Option<&'static [&'static str]>,
    /// Why the option has no effect under these settings, in a sentence; none if it has.
    pub no_effect: fn(&Settings) -> Option<&'static str>,
    /// Where settings have its value.
    pub access: Access,
}

/// Reads and writes a value in settings.
pub struct Access {
    pub get: fn(&Settings) -> Value,
    /// False, with settings unchanged, if the value isn't one of the option's.
    pub set: fn(&mut Settings, Value) -> bool,
}

/// What values an option takes.
pub enum Kind {
    /// One of several named values.
    Choice(fn() -> Vec<Description>),
    /// Any of several named values together.
    Several(fn() -> Vec<Description>),
    Number(Range),
    /// One of several named values, or a number. Where the window lists the names, `number` is one more entry; with it, the number
    /// has a row of its own, called `row`.
    NameOrNumber {
        names: fn() -> Vec<Description>,
        number: Description,
        row: &'static str,
        range: Range,
    },
    /// Two numbers, the first one smaller.
    Pair(Range),
    /// On or off.
    Switch,
    /// sRGB.
    Color,
    /// Values of some of these options.
    Options(fn() -> &'static [&'static Declaration]),
}

/// The numbers that an option takes, and how a slider shows them.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    pub least: f32,
    pub most: f32,
    /// After the number: `px`, `EV`, `°`, `m`, `r` for bounding radii, or `/r` for 1 / bounding radius; empty for a plain number.
    pub unit: &'static str,
    /// Decimals that a slider shows, at most.
    pub decimals: usize,
    pub is_logarithmic: bool,
}

/// A value of any option. As JSON it is null, a word, words, a number, numbers, or true or false; values of options are a word.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// The option has no value.
    Unset,
    Name(&'static str),
    Names(Vec<&'static str>),
    Number(f32),
    Pair([f32; 2]),
    Switch(bool),
    Color([u8; 3]),
    /// Options by their names.
    Options(#[serde(serialize_with = "in_a_word")] Vec<(&'static str, Value)>),
}

fn in_a_word<S: Serializer>(values: &[(&'static str, Value)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&Value::Options(values.to_vec()))
}

impl Declaration {
    pub fn get(&self, settings: &Settings) -> Value {
        (self.access.get)(settings)
    }

    /// False, with settings unchanged, if the value isn't one of the option's.
    pub fn set(&self, settings: &mut Settings, value: Value) -> bool {
        self.takes(&value) && (self.access.set)(settings, value)
    }

    fn takes(&self, value: &Value) -> bool {
        if *value == Value::Unset { self.unset.is_some() } else { self.kind.takes(value) }
    }

    /// Its label and its value as the window shows them, such as "Tolerance 0.25 px".
    pub fn shown(&self, settings: &Settings) -> String {
        let value = match self.get(settings) {
            Value::Name(name) => {
                let all = self.kind.descriptions();
                all.iter().find(|value| value.name == name).map_or(name, |value| value.label).to_owned()
            }
            Value::Unset => self.unset.map_or("", |unset| unset.label).to_owned(),
            Value::Names(names) if names.is_empty() => "none".to_owned(),
            value => value.to_string(),
        };
        let unit = self.range().map_or("", |range| range.unit);
        format!("{} {value} {unit}", self.label).trim_end().to_owned()
    }

    /// The members of saved settings that hold it.
    pub fn members(&self) -> Vec<String> {
        match self.saved_as {
            Some(members) => members.iter().map(|&name| name.to_owned()).collect(),
            None => vec![self.name.replace('-', "_")],
        }
    }

    /// The same members, each with its part of the value.
    pub fn written(&self, settings: &Settings) -> Vec<(String, Value)> {
        let values = match self.get(settings) {
            Value::Pair(pair) => pair.map(Value::Number).to_vec(),
            value => vec![value],
        };
        self.members().into_iter().zip(values).collect()
    }

    /// The default value of commands.
    pub fn default(&self) -> Value {
        self.get(&Settings::usual())
    }

    /// The range of its numbers; none if its values aren't numbers.
    pub fn range(&self) -> Option<&Range> {
        match &self.kind {
            Kind::Number(range) | Kind::Pair(range) | Kind::NameOrNumber { range, .. } => Some(range),
            _ => None,
        }
    }
}

impl Range {
    pub const fn new(least: f32, most: f32, unit: &'static str) -> Self {
        Self { least, most, unit, decimals: 2, is_logarithmic: false }
    }

    pub const fn decimals(self, decimals: usize) -> Self {
        Self { decimals, ..self }
    }

    pub const fn logarithmic(self) -> Self {
        Self { is_logarithmic: true, ..self }
    }

    pub fn contains(&self, number: f32) -> bool {
        (self.least..=self.most).contains(&number)
    }

    /// The unit in a word; empty for a plain number.
    fn unit_in_words(&self) -> &'static str {
        match self.unit {
            "" => "",
            "r" => " bounding radii",
            "EV" => " EV",
            "°" => " degrees",
            "m" => " metres",
            "/r" => " / bounding radius",
            _ => " px",
        }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {}{}", self.least, self.most, self.unit_in_words())
    }
}

impl Kind {
    /// The values that have names, in the order in which lists show them; empty for other kinds.
    pub fn descriptions(&self) -> Vec<Description> {
        match self {
            Self::Choice(all) | Self::Several(all) | Self::NameOrNumber { names: all, .. } => all(),
            _ => Vec::new(),
        }
    }

    /// Returns the name of the value that a text names. The text may spell it as HLSL does, with underscores.
    pub fn named(&self, text: &str) -> Option<&'static str> {
        self.descriptions().iter().find(|value| value.is_named(text)).map(|value| value.name)
    }

    fn takes(&self, value: &Value) -> bool {
        match (self, value) {
            (Self::Choice(_) | Self::NameOrNumber { .. }, Value::Name(name)) => self.named(name).is_some(),
            (Self::Several(_), Value::Names(names)) => names.iter().all(|name| self.named(name).is_some()),
            (Self::Number(range) | Self::NameOrNumber { range, .. }, Value::Number(number)) => range.contains(*number),
            (Self::Pair(range), Value::Pair([a, b])) => range.contains(*a) && range.contains(*b) && a < b,
            (Self::Switch, Value::Switch(_)) | (Self::Color, Value::Color(_)) => true,
            (Self::Options(all), Value::Options(values)) => values.iter().all(|(name, value)| {
                all().iter().find(|option| option.name == *name).is_some_and(|option| option.takes(value))
            }),
            _ => false,
        }
    }

    /// Reads a value as [`Value`] writes it.
    ///
    /// # Errors
    /// What was expected instead.
    pub fn parse(&self, text: &str) -> Result<Value, String> {
        let number = |text: &str| text.trim().parse::<f32>().ok();
        let value = match self {
            Self::Choice(_) => self.named(text).map(Value::Name),
            Self::Several(_) => text.split(',').map(|name| self.named(name)).collect::<Option<_>>().map(Value::Names),
            Self::Number(_) => text.parse().ok().map(Value::Number),
            Self::NameOrNumber { .. } => {
                self.named(text).map(Value::Name).or_else(|| text.parse().ok().map(Value::Number))
            }
            Self::Pair(_) => text.split_once(',').and_then(|(a, b)| Some(Value::Pair([number(a)?, number(b)?]))),
            Self::Switch => text.parse().ok().map(Value::Switch),
            Self::Color => color(text).map(Value::Color),
            Self::Options(all) => options(all(), text)?,
        };
        value.filter(|value| self.takes(value)).ok_or_else(|| self.expected())
    }

    fn expected(&self) -> String {
        let names = || self.descriptions().iter().map(|value| value.name).collect::<Vec<_>>().join(", ");
        match self {
            Self::Choice(_) | Self::Several(_) => format!("expected {}", names()),
            Self::Number(Range { least, most, .. }) => format!("expected a number from {least} to {most}"),
            Self::NameOrNumber { range, .. } => format!("expected {}, or a number: {range}", names()),
            Self::Pair(range) => {
                let Range { least, most, .. } = range;
                let unit = range.unit_in_words();
                format!("expected two numbers in{unit}, from {least} to {most} and the second one larger, such as 2,10")
            }
            Self::Switch => "expected true or false".into(),
            Self::Color => "expected six hexadecimal digits, such as 2b2e33".into(),
            Self::Options(all) => {
                let names: Vec<_> = all().iter().map(|option| option.name).collect();
                let (first, others) = (names[0], names[1..].join(", "));
                format!("expected a value of {first}, and perhaps of others: NAME=VALUE, where NAME is {others}")
            }
        }
    }
}

/// Reads values of options: `name=value` after a comma each. The first may be without the name of the first option. A value that has
/// a comma goes on after it. An empty one unsets the option, or is a list of no names.
///
/// # Errors
/// What was expected instead of a value. None if no option has such a name.
fn options(all: &[&'static Declaration], text: &str) -> Result<Option<Value>, String> {
    let mut given: Vec<(&str, String)> = Vec::new();
    for item in text.split(',') {
        match (item.split_once('='), given.last_mut()) {
            (Some((name, value)), _) => given.push((name.trim(), value.to_owned())),
            (None, None) if item.is_empty() => return Ok(None),
            (None, None) => given.push((all[0].name, item.to_owned())),
            (None, Some((_, value))) => *value = format!("{value},{item}"),
        }
    }
    let mut values = Vec::new();
    for (name, value) in given {
        let Some(option) = all.iter().find(|option| option.name == name) else { return Ok(None) };
        let value = match option.kind {
            _ if value.is_empty() && option.unset.is_some() => Value::Unset,
            Kind::Several(_) if value.is_empty() => Value::Names(Vec::new()),
            _ => option.kind.parse(&value).map_err(|expected| format!("{expected} as {name}"))?,
        };
        values.push((option.name, value));
    }
    Ok(Some(Value::Options(values)))
}

/// An sRGB colour as RRGGBB, with or without a number sign.
fn color(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    let is_color = digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit());
    let [_, r, g, b] = u32::from_str_radix(digits, 16).ok().filter(|_| is_color)?.to_be_bytes();
    Some([r, g, b])
}

/// Writes the value as the command line takes it.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unset => Ok(()),
            Self::Name(name) => f.write_str(name),
            Self::Names(names) => f.write_str(&names.join(",")),
            Self::Number(number) => write!(f, "{number}"),
            Self::Pair([a, b]) => write!(f, "{a},{b}"),
            Self::Switch(is_on) => write!(f, "{is_on}"),
            Self::Color([r, g, b]) => write!(f, "{r:02x}{g:02x}{b:02x}"),
            Self::Options(values) => {
                let all: Vec<_> = values.iter().map(|(name, value)| format!("{name}={value}")).collect();
                f.write_str(&all.join(","))
            }
        }
    }
}

/// A field of settings that holds an option's value.
pub(super) trait Field: Sized {
    fn value(&self) -> Value;
    /// None if the value is of another kind.
    fn from_value(value: Value) -> Option<Self>;

    /// False, with the field unchanged, if the value is of another kind.
    fn put(&mut self, value: Value) -> bool {
        let own = Self::from_value(value);
        let is_taken = own.is_some();
        own.into_iter().for_each(|own| *self = own);
        is_taken
    }
}

/// Fields that hold the name of a value.
macro_rules! named_fields {
    ($($type:ty),+ $(,)?) => {
        $(impl Field for $type {
            fn value(&self) -> Value {
                Value::Name(self.name())
            }

            fn from_value(value: Value) -> Option<Self> {
                if let Value::Name(name) = value { Self::named(name) } else { None }
            }
        })+
    };
}

named_fields! {
    Clip, Convention, CurvatureKind, Displacement, Edges, FaceVarying, FileLights, Lighting, Lod, Matcap, NormalMaps,
    NormalSource, Normals, NormalsAt, Partitioning, SectionAxis, SplitView, Subdivide, Surface, SurfaceUnit, ToneCurve, UpAxis,
}

impl Field for FileUnit {
    fn value(&self) -> Value {
        match self {
            Self::Named(unit) => Value::Name(unit.name()),
            Self::Metres(metres) => Value::Number(*metres),
        }
    }

    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Name(name) => LengthUnit::named(name).map(Self::Named),
            Value::Number(metres) => Self::from_metres(metres),
            _ => None,
        }
    }
}

impl<T: Field> Field for Option<T> {
    fn value(&self) -> Value {
        self.as_ref().map_or(Value::Unset, Field::value)
    }

    fn from_value(value: Value) -> Option<Self> {
        if value == Value::Unset { Some(None) } else { T::from_value(value).map(Some) }
    }
}

/// Fields that hold a value as it is.
macro_rules! plain_fields {
    ($($type:ty: $kind:ident),+ $(,)?) => {
        $(impl Field for $type {
            fn value(&self) -> Value {
                Value::$kind(*self)
            }

            fn from_value(value: Value) -> Option<Self> {
                if let Value::$kind(own) = value { Some(own) } else { None }
            }
        })+
    };
}

plain_fields! { f32: Number, bool: Switch, [u8; 3]: Color }

/// The names of the overlays that are on. Two that colour the surface are refused.
impl Field for Overlays {
    fn value(&self) -> Value {
        Value::Names(self.on().map(Choice::name).collect())
    }

    fn from_value(value: Value) -> Option<Self> {
        let Value::Names(names) = value else { return None };
        let overlays: Option<Vec<_>> = names.into_iter().map(Overlay::named).collect();
        Self::new(&overlays?)
    }
}
