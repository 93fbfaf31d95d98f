//! The texts of `--height`: which images displace the materials.

use std::ffi::OsString;
use std::path::Path;

use super::{HeightSource, NamedImage};
use geometry::mesh::HeightAmount;
use geometry::tessellate::Tessellation;

/// What is said of a text that names no image of a material or a part.
const FORM: &str = "write NAME=IMAGE or NAME=IMAGE,scale=S,midlevel=H with a material's or a part's name and numbers of at most \
                    1e9, or ./ in front of a path with an equals sign";

impl HeightSource {
    /// Reads `material`, `file`, `NAME=IMAGE,scale=S,midlevel=H` with the name of a material or a part, or the path of an image. A
    /// path with an equals sign in it is absolute, or begins with a point.
    ///
    /// # Errors
    /// A clause that says what to write.
    pub fn parse(text: OsString) -> Result<Self, &'static str> {
        match text.to_str().filter(|text| !text.starts_with('.') && !Path::new(text).is_absolute()) {
            Some("material") => Ok(Self::Materials),
            Some("file") => Ok(Self::Model),
            Some(text) if text.contains('=') => Ok(Self::Each(vec![NamedImage::parse(text).ok_or(FORM)?])),
            _ => Ok(Self::File(text.into())),
        }
    }

    /// Returns the texts that [`Self::parse`] reads it from, each the value of one option.
    pub fn texts(&self) -> Vec<String> {
        match self {
            Self::Materials => vec!["material".to_owned()],
            Self::Model => vec!["file".to_owned()],
            Self::File(path) if path.is_absolute() => vec![path.display().to_string()],
            Self::File(path) => vec![format!("./{}", path.display())],
            Self::Each(images) => images.iter().map(NamedImage::text).collect(),
        }
    }

    /// Returns the source that several options name; none without any. Only images of single materials and parts can be several.
    pub fn joined(all: &[Self]) -> Option<Self> {
        let images = |own: &Self| if let Self::Each(images) = own { images.clone() } else { Vec::new() };
        let images: Vec<_> = all.iter().flat_map(images).collect();
        if images.is_empty() { all.first().cloned() } else { Some(Self::Each(images)) }
    }
}

impl NamedImage {
    fn parse(text: &str) -> Option<Self> {
        let (part, mut path) = text.split_once('=').filter(|(part, _)| !part.is_empty())?;
        // An image alone has no numbers of its own.
        if [",scale", ",midlevel"].iter().any(|option| part.ends_with(option)) {
            return None;
        }
        let mut numbers = [None; 2];
        while let Some((before, option)) = path.rsplit_once(',') {
            let number = |name| option.strip_prefix(name);
            let Some((k, number)) = number("scale=").map(|x| (0, x)).or(number("midlevel=").map(|x| (1, x))) else {
                break;
            };
            numbers[k] = Some(number.parse().ok()?);
            path = before;
        }
        let amount = match numbers {
            [None, None] => None,
            [scale, midlevel] => Some(HeightAmount::new(scale?, midlevel.unwrap_or(Tessellation::default().midlevel))?),
        };
        (!path.is_empty()).then(|| Self { part: part.to_owned(), path: path.into(), amount })
    }

    fn text(&self) -> String {
        let Self { part, path, amount } = self;
        let amount = amount.map(|own| format!(",scale={},midlevel={}", own.scale, own.midlevel)).unwrap_or_default();
        format!("{part}={}{amount}", path.display())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(part: &str, path: &str, amount: Option<(f32, f32)>) -> HeightSource {
        let amount = amount.map(|(scale, midlevel)| HeightAmount { scale, midlevel });
        HeightSource::Each(vec![NamedImage { part: part.to_owned(), path: path.into(), amount }])
    }

    #[test]
    fn texts_name_sources() {
        let cases = [
            ("material", HeightSource::Materials),
            ("file", HeightSource::Model),
            ("./file", HeightSource::File("./file".into())),
            ("a,b.png", HeightSource::File("a,b.png".into())),
            ("./a=b.png", HeightSource::File("./a=b.png".into())),
            ("wall=b.png", image("wall", "b.png", None)),
            ("material:wall=b.png", image("material:wall", "b.png", None)),
            ("Car/Wheel/.=b.png,scale=1", image("Car/Wheel/.", "b.png", Some((1.0, 0.5)))),
            ("old wall=a=b,c.png,scale=-2", image("old wall", "a=b,c.png", Some((-2.0, 0.5)))),
            ("wall=b.png,midlevel=0.25,scale=1e-3", image("wall", "b.png", Some((0.001, 0.25)))),
        ];
        for (text, expected) in cases {
            assert_eq!(HeightSource::parse(text.into()), Ok(expected.clone()), "{text}");
            let texts = expected.texts();
            let is_file = matches!(expected, HeightSource::File(_));
            assert!(is_file || HeightSource::parse((&texts[0]).into()) == Ok(expected), "{texts:?}");
        }
        let bad = [
            "=a.png",
            "wall=",
            "wall=,scale=1",
            "wall=a.png,scale=x",
            "wall=a.png,scale=inf",
            "wall=a.png,midlevel=0",
            "a.png,scale=1",
        ];
        assert!(bad.iter().all(|text| HeightSource::parse(text.into()).is_err()));
        for path in ["file", "a=b.png", "-x.png"] {
            let texts = HeightSource::File(path.into()).texts();
            assert_eq!(HeightSource::parse((&texts[0]).into()), Ok(HeightSource::File(format!("./{path}").into())));
        }
    }

    #[test]
    fn images_of_materials_are_joined() {
        let [a, b] = ["a", "b"].map(|name| image(name, "c.png", None));
        assert_eq!(HeightSource::joined(&[]), None);
        assert_eq!(HeightSource::joined(&[HeightSource::Model]), Some(HeightSource::Model));
        let joined = HeightSource::joined(&[a, b]).expect("two images");
        assert_eq!(joined.texts(), ["a=c.png", "b=c.png"]);
        assert_eq!(joined.files(), [Path::new("c.png"); 2]);
    }
}
