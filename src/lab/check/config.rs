//! The configuration of a check: a TOML file with gates, options of `render`, cameras, and sections for some of the files.

use std::ops::Range;
use std::path::Path;

use strsim::levenshtein;
use toml::de::{DeTable, DeValue};

use super::pattern::Pattern;
use geometry::names::{shown, shown_path};
use inspect::gates::Gate;
use inspect::shot::ShotError;
use inspect::shot::files::{file_error, read_text};
use load::files::file_reason;

/// The most bytes that a configuration may have.
const MOST_BYTES: u64 = 1 << 20;

/// The keys that a configuration may have outside of its sections.
const SECTION_KEYS: [&str; 5] = ["fail-on", "options", "cameras", "files", "golden"];

/// A configuration.
#[derive(Clone, Debug, Default)]
pub struct Config {
    /// Its path, for messages.
    path: String,
    base: Section,
    /// The folder of golden pictures.
    pub golden: Option<String>,
    files: Vec<Files>,
}

/// A section for some of the files.
#[derive(Clone, Debug)]
struct Files {
    pattern: Pattern,
    line: usize,
    section: Section,
}

/// What a configuration says about some assets.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// None if it says nothing about gates.
    pub gates: Option<Vec<Gate>>,
    pub options: Vec<OptionValue>,
    /// Named views, each with options of the camera. Empty if it says nothing about them.
    pub cameras: Vec<(String, Vec<OptionValue>)>,
}

/// A value of an option of `render`.
#[derive(Clone, Debug, PartialEq)]
pub struct OptionValue {
    /// The option's name on the command line, without `--`.
    pub name: String,
    /// What follows it on the command line, once for each time that it is given. None for a switch that is on.
    pub values: Vec<Option<String>>,
    pub line: usize,
}

impl Config {
    /// Reads a configuration.
    ///
    /// # Errors
    /// The file can't be read, is no TOML, or has an unknown key or a value of the wrong type.
    pub fn read(path: &Path, options: &[String], camera: &[&str]) -> Result<Self, ShotError> {
        let unreadable = |reason: String| file_error(path, "read", &reason);
        let about = std::fs::metadata(path).map_err(|error| unreadable(file_reason(&error)))?;
        if !about.is_file() {
            return Err(unreadable("it is no file; name a TOML file".to_owned()));
        }
        if about.len() > MOST_BYTES {
            return Err(unreadable(format!("it has {} bytes, and at most {MOST_BYTES} are read", about.len())));
        }
        Self::parse(&shown_path(path), &read_text(path)?, options, camera)
    }

    /// Reads a configuration from its text. `path` names it in messages.
    fn parse(path: &str, text: &str, options: &[String], camera: &[&str]) -> Result<Self, ShotError> {
        let reader = Reader { path, text, options, camera };
        let table = DeTable::parse(text).map_err(|error| {
            let at = error.span().unwrap_or_default();
            reader.error(at, &format!("this is no TOML: {}", error.message()))
        })?;
        let mut config = Self { path: path.to_owned(), ..Self::default() };
        for (key, value) in table.get_ref().iter() {
            match key.get_ref().as_ref() {
                "files" => config.files = reader.files(value)?,
                "golden" => config.golden = Some(reader.text(value)?),
                name if reader.take(name, value, &mut config.base)? => {}
                name => return Err(reader.unknown(key.span(), name, &SECTION_KEYS)),
            }
        }
        Ok(config)
    }

    /// What holds for the asset at a path below the configuration's folder, with `/` between folders: what the sections say whose
    /// patterns match it, the last one of them first.
    pub fn section(&self, path: &str) -> Section {
        let mut all = self.base.clone();
        for Files { section: own, .. } in self.files.iter().filter(|files| files.pattern.matches(path)) {
            all.gates = own.gates.clone().or(all.gates);
            for option in &own.options {
                all.options.retain(|other| other.name != option.name);
                all.options.push(option.clone());
            }
            if !own.cameras.is_empty() {
                all.cameras.clone_from(&own.cameras);
            }
        }
        all
    }

    /// A sentence without its end for each section that holds for none of these paths.
    pub fn unmatched(&self, paths: &[String]) -> Vec<String> {
        let matches = |files: &&Files| paths.iter().any(|path| files.pattern.matches(path));
        let unmatched = self.files.iter().filter(|files| !matches(files));
        let said = |Files { pattern, line, .. }: &Files| {
            format!("{}, line {line}: no asset matches the path {}", self.path, shown(pattern.text()))
        };
        unmatched.map(said).collect()
    }

    /// All options, whichever assets they hold for.
    pub fn options(&self) -> impl Iterator<Item = &OptionValue> {
        let sections = std::iter::once(&self.base).chain(self.files.iter().map(|files| &files.section));
        sections.flat_map(|own| own.options.iter().chain(own.cameras.iter().flat_map(|(_, camera)| camera)))
    }

    /// The error of an option that its command doesn't take.
    pub fn wrong(&self, option: &OptionValue, reason: &str) -> ShotError {
        ShotError::Line { path: self.path.clone(), line: option.line, reason: reason.to_owned() }
    }

    /// The error of options that can't be together.
    pub fn clash(&self, reason: &str) -> ShotError {
        ShotError::Clash { path: self.path.clone(), reason: reason.to_owned() }
    }
}

/// A value with its place in the text.
type Value<'a> = toml::Spanned<DeValue<'a>>;

struct Reader<'a> {
    path: &'a str,
    text: &'a str,
    /// The options that a configuration may have, and those of them that a named view may have.
    options: &'a [String],
    camera: &'a [&'a str],
}

impl Reader<'_> {
    fn line(&self, at: Range<usize>) -> usize {
        1 + self.text.bytes().take(at.start).filter(|byte| *byte == b'\n').count()
    }

    fn error(&self, at: Range<usize>, reason: &str) -> ShotError {
        ShotError::Line { path: self.path.to_owned(), line: self.line(at), reason: reason.to_owned() }
    }

    fn unknown(&self, at: Range<usize>, name: &str, known: &[&str]) -> ShotError {
        let nearest = known.iter().min_by_key(|other| levenshtein(name, other));
        let meant = nearest.filter(|other| levenshtein(name, other) <= 1 + name.chars().count() / 3);
        let meant = meant.map(|other| format!("; did you mean {other}?")).unwrap_or_default();
        self.error(at, &format!("there is no key {}{meant}", shown(name)))
    }

    /// Takes a key that every section may have. False if it is none of these.
    fn take(&self, name: &str, value: &Value, section: &mut Section) -> Result<bool, ShotError> {
        match name {
            "fail-on" => section.gates = Some(self.gates(value)?),
            "options" => {
                let all: Vec<&str> = self.options.iter().map(String::as_str).collect();
                section.options = self.options(value, &all)?;
            }
            "cameras" => {
                let mut cameras: Vec<_> = self.table(value, "named cameras, such as [cameras.front]")?.iter().collect();
                // A table is in the order of its names; views stay in the order in which they were written.
                cameras.sort_by_key(|(key, _)| key.span().start);
                for (key, camera) in cameras {
                    if key.get_ref().is_empty() {
                        return Err(self.error(key.span(), "a camera needs a name, such as [cameras.front]"));
                    }
                    self.table(
                        camera,
                        "a table of camera options, such as [cameras.front] with camera = [0, 10] below it",
                    )?;
                    let options = self.options(camera, self.camera)?;
                    section.cameras.push((key.get_ref().to_string(), options));
                }
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn files(&self, value: &Value) -> Result<Vec<Files>, ShotError> {
        let expected = "expected sections that begin with [[files]]";
        let Some(sections) = value.get_ref().as_array() else { return Err(self.error(value.span(), expected)) };
        let mut files = Vec::new();
        for section in sections.iter() {
            let (mut path, mut own) = (None, Section::default());
            for (key, value) in self.table(section, "a section that begins with [[files]]")? {
                match key.get_ref().as_ref() {
                    "path" => {
                        let pattern = Pattern::parse(&self.text(value)?).map_err(|error| {
                            self.error(value.span(), &format!("this is no pattern of paths: {error}"))
                        })?;
                        path = Some((pattern, self.line(key.span())));
                    }
                    name if self.take(name, value, &mut own)? => {}
                    name => return Err(self.unknown(key.span(), name, &["path", "fail-on", "options", "cameras"])),
                }
            }
            let without =
                || self.error(section.span(), "a section of [[files]] needs a path, such as path = \"props/*.glb\"");
            let (pattern, line) = path.ok_or_else(without)?;
            files.push(Files { pattern, line, section: own });
        }
        Ok(files)
    }

    fn table<'a, 'b>(&self, value: &'a Value<'b>, expected: &str) -> Result<&'a DeTable<'b>, ShotError> {
        value.get_ref().as_table().ok_or_else(|| self.error(value.span(), &format!("expected {expected}")))
    }

    fn text(&self, value: &Value) -> Result<String, ShotError> {
        let text = value.get_ref().as_str().map(str::to_owned);
        text.ok_or_else(|| self.error(value.span(), "expected a text in quotation marks"))
    }

    fn gates(&self, value: &Value) -> Result<Vec<Gate>, ShotError> {
        let expected = "expected a list of gates, such as [\"cracks\", \"triangles:100000\"]";
        let all = value.get_ref().as_array().ok_or_else(|| self.error(value.span(), expected))?;
        let gate = |value: &Value| {
            let text = value.get_ref().as_str().ok_or_else(|| self.error(value.span(), expected))?;
            text.parse().map_err(|reason: String| self.error(value.span(), &format!("{}: {reason}", shown(text))))
        };
        all.iter().map(gate).collect()
    }

    fn options(&self, value: &Value, known: &[&str]) -> Result<Vec<OptionValue>, ShotError> {
        let mut options = Vec::new();
        for (key, value) in self.table(value, "options of `pnaen render`, such as tolerance = 0.5")? {
            let name = key.get_ref().as_ref();
            if SECTION_KEYS.contains(&name) {
                let misplaced =
                    format!("{name} isn't an option; write it above the line in brackets that it stands under");
                return Err(self.error(key.span(), &misplaced));
            }
            if !known.contains(&name) {
                return Err(self.unknown(key.span(), name, known));
            }
            let (values, line) = (self.values(value)?, self.line(key.span()));
            options.push(OptionValue { name: name.to_owned(), values, line });
        }
        Ok(options)
    }

    /// What follows an option on the command line. Numbers of a list belong together, and texts of a list are given one by one.
    fn values(&self, value: &Value) -> Result<Vec<Option<String>>, ShotError> {
        match value.get_ref() {
            DeValue::Boolean(true) => Ok(vec![None]),
            DeValue::Boolean(false) => Ok(Vec::new()),
            DeValue::Array(all) if all.iter().all(|item| item.get_ref().is_str()) => {
                all.iter().map(|item| self.text(item).map(Some)).collect()
            }
            DeValue::Array(all) => {
                let numbers: Result<Vec<_>, _> = all.iter().map(|item| self.scalar(item)).collect();
                Ok(vec![Some(numbers?.join(","))])
            }
            _ => Ok(vec![Some(self.scalar(value)?)]),
        }
    }

    fn scalar(&self, value: &Value) -> Result<String, ShotError> {
        match value.get_ref() {
            DeValue::String(text) => Ok(text.to_string()),
            DeValue::Integer(number) => Ok(number.as_str().to_owned()),
            DeValue::Float(number) => Ok(number.as_str().to_owned()),
            _ => {
                Err(self.error(value.span(), "expected a number, a text, true or false, or a list of numbers or texts"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Config, ShotError> {
        let all = ["tolerance", "lod", "camera", "overlay", "cull-back-faces", "hide-part"].map(str::to_owned);
        Config::parse("pnaen.toml", text, &all, &["camera"])
    }

    #[test]
    fn sections_of_matching_files_come_last() {
        let text = "fail-on = [\"cracks\"]\n[options]\nlod = \"error\"\ntolerance = 0.5\ncull-back-faces = true\n\
                    [cameras.front]\ncamera = [0, 10]\n[[files]]\npath = \"props/*.glb\"\nfail-on = [\"triangles:10\"]\n\
                    [files.options]\ntolerance = 2\ncull-back-faces = false\nhide-part = [\"a\", \"b\"]\n";
        let config = read(text).expect("a configuration");
        let value = |section: &Section, name: &str| {
            section.options.iter().find(|option| option.name == name).map(|option| option.values.clone())
        };
        let text = |text: &str| Some(text.to_owned());
        let usual = config.section("a.glb");
        assert_eq!(usual.gates, Some(vec!["cracks".parse().expect("a gate")]));
        assert_eq!(value(&usual, "tolerance"), Some(vec![text("0.5")]));
        assert_eq!(value(&usual, "cull-back-faces"), Some(vec![None]));
        assert_eq!((usual.cameras[0].0.as_str(), &usual.cameras[0].1[0].values), ("front", &vec![text("0,10")]));
        let prop = config.section("props/a.glb");
        assert_eq!(prop.gates, Some(vec!["triangles:10".parse().expect("a gate")]));
        assert_eq!(value(&prop, "tolerance"), Some(vec![text("2")]));
        assert_eq!(value(&prop, "cull-back-faces"), Some(vec![]));
        assert_eq!(value(&prop, "hide-part"), Some(vec![text("a"), text("b")]));
        assert_eq!((value(&prop, "lod"), &prop.cameras), (Some(vec![text("error")]), &usual.cameras));
        let views =
            read("[cameras.b]\ncamera = 1\n[cameras.a]\ncamera = 2\n").expect("a configuration").section("a.glb");
        assert_eq!(views.cameras.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["b", "a"]);
        let unmatched = config.unmatched(&["a.glb".to_owned(), "props/a.obj".to_owned()]);
        assert_eq!(unmatched, ["pnaen.toml, line 9: no asset matches the path props/*.glb"]);
        assert!(config.unmatched(&["a.glb".to_owned(), "props/a.glb".to_owned()]).is_empty());
        let all: Vec<&str> = config.options().map(|option| option.name.as_str()).collect();
        let files = ["cull-back-faces", "hide-part", "tolerance"];
        assert_eq!((all.len(), all.iter().filter(|name| files.contains(name)).count()), (7, 5));
    }

    #[test]
    fn what_is_wrong_has_its_line_and_the_nearest_name() {
        for (text, line, words) in [
            ("fail-on = [\"cracks\"]\nfail-onn = []", 2, "there is no key fail-onn; did you mean fail-on?"),
            ("[options]\n\ntolerence = 1", 3, "there is no key tolerence; did you mean tolerance?"),
            ("[options]\nxyzzyplugh = 1", 2, "there is no key xyzzyplugh"),
            ("[cameras.front]\nlod = \"error\"", 2, "there is no key lod"),
            ("[cameras.\"\"]\ncamera = [0, 0]", 1, "a camera needs a name"),
            ("[options]\nlod = \"error\"\nfail-on = [\"cracks\"]", 3, "fail-on isn't an option; write it above"),
            ("fail-on = \"cracks\"", 1, "expected a list of gates"),
            ("fail-on = [\n\"cracks\",\n\"crack\"]", 3, "crack: expected one of cracks"),
            ("options = 3", 1, "expected options"),
            ("[options]\ntolerance = 1979-05-27", 2, "expected a number"),
            ("[cameras]\nfront = [0, 10]", 2, "such as [cameras.front] with camera = [0, 10]"),
            ("[[files]]\nfail-on = []", 1, "needs a path"),
            ("[[files]]\npath = 3", 2, "expected a text"),
            ("[[files]]\npath = \"a[z-a].glb\"", 2, "this is no pattern of paths"),
            ("files = 3", 1, "[[files]]"),
            ("[options]\ntolerance = \n", 2, "this is no TOML"),
            ("include = \"other.toml\"", 1, "there is no key include"),
        ] {
            let said = read(text).expect_err(text).to_string();
            assert!(said.starts_with(&format!("pnaen.toml, line {line}: ")), "{text:?}: {said}");
            assert!(said.contains(words), "{text:?}: {said}");
        }
        assert!(!read("[options]\nxyzzyplugh = 1").expect_err("unknown").to_string().contains("did you mean"));
        let deep = format!("a = {}{}", "[".repeat(100_000), "]".repeat(100_000));
        assert!(read(&deep).is_err());
    }
}
