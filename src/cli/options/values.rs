//! Parsers of the values of options.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use std::str::FromStr;

use clap::builder::{OsStringValueParser, PathBufValueParser, TypedValueParser};
use glam::Vec3;

use geometry::mesh::PartStyle;
use inspect::export::ending;
use inspect::render::camera::FIELDS_OF_VIEW;
use load::format::Format;
use load::{HeightSource, Source};

/// Parses the path of a picture. Refuses standard output, and endings of files that are no PNG files.
pub(crate) fn picture() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(picture_path)
}

fn picture_path(path: PathBuf) -> Result<PathBuf, String> {
    if path.as_os_str() == "-" {
        return Err("pictures aren't written to standard output: name a .png file".to_owned());
    }
    let ending = ending(&path);
    let is_mesh = Format::from_name(&path).is_some();
    let is_image = ["jpg", "jpeg", "webp", "bmp", "gif", "tif", "tiff", "svg", "hdr", "exr"].contains(&&*ending);
    let is_text = ["csv", "tsv", "json", "toml", "txt", "md", "html", "xml", "wgsl"].contains(&&*ending);
    if is_mesh || is_image || is_text {
        return Err(format!("pictures are PNG files, not .{ending}: name it .png"));
    }
    Ok(path)
}

/// The same, or that of a report on a picture.
pub(crate) fn picture_or_page() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| if ending(&path) == "html" { Ok(path) } else { picture_path(path) })
}

/// Parses the path of a file to write, whose ending, one of these, gives its format. `wanted` says which there are.
pub(crate) fn ending_in(
    endings: &'static [&'static str],
    wanted: &'static str,
) -> impl TypedValueParser<Value = PathBuf> {
    let is_one = move |path: &PathBuf| endings.contains(&ending(path).as_str());
    PathBufValueParser::new().try_map(move |path| Some(path).filter(is_one).ok_or(wanted))
}

/// Parses the name of a part, and what it has in place of what is set for all.
pub(crate) fn part_style(text: &str) -> Result<(String, PartStyle), String> {
    let expected = "expected NAME:KEY=VALUE,.., such as door:surface=flat,detail=2,normals=made,crease=30";
    let (name, style) = text.rsplit_once(':').ok_or(expected)?;
    Ok((name.to_owned(), style.parse()?))
}

/// Parses a width and height in px.
pub(crate) fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse().ok().filter(|side| (1..=16384).contains(side));
    // With a comma as a list of numbers in a configuration gives it.
    let sides = text.split_once(['x', 'X', ',']).and_then(|(w, h)| Some([side(w)?, side(h)?]));
    sides.ok_or_else(|| "expected WIDTHxHEIGHT in px, each from 1 to 16384, such as 1280x720".into())
}

/// The direction and distance of the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraOption {
    /// Degrees.
    pub azimuth: f32,
    pub elevation: f32,
    /// Bounding radii.
    pub distance: Option<f32>,
}

impl FromStr for CameraOption {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match numbers(text).as_deref() {
            Some(&[azimuth, elevation]) => Ok(Self { azimuth, elevation, distance: None }),
            Some(&[azimuth, elevation, distance]) if distance > 0.0 => {
                Ok(Self { azimuth, elevation, distance: Some(distance) })
            }
            _ => Err("expected AZIMUTH,ELEVATION in degrees and perhaps a DISTANCE above 0 in bounding radii, such as 30,20,2.5".into()),
        }
    }
}

/// Parses the name of a morph target, which may have equals signs, and its weight.
pub(crate) fn morph(text: &str) -> Result<(String, f32), String> {
    let (name, weight) = text.rsplit_once('=').unwrap_or_default();
    let weight = number(weight, |weight: &f32| weight.is_finite(), "NAME=WEIGHT, such as Smile=0.7")?;
    Ok((name.to_owned(), weight))
}

/// Parses a vertical field of view in degrees.
pub(crate) fn field_of_view(text: &str) -> Result<f32, String> {
    number(text, |angle| FIELDS_OF_VIEW.contains(angle), &in_range("degrees", &FIELDS_OF_VIEW))
}

/// Parses a number that is good.
fn number<T: FromStr>(text: &str, is_good: impl Fn(&T) -> bool, expected: &str) -> Result<T, String> {
    text.trim().parse().ok().filter(is_good).ok_or_else(|| format!("expected {expected}"))
}

fn in_range<T: Display>(what: &str, range: &RangeInclusive<T>) -> String {
    format!("{what} from {} to {}", range.start(), range.end())
}

/// Parses an angle in degrees.
pub(crate) fn angle(text: &str) -> Result<f32, String> {
    number(text, |angle: &f32| angle.is_finite(), "a number of degrees")
}

/// Parses a time that is finite and not negative.
pub(crate) fn seconds(text: &str) -> Result<f64, String> {
    number(text, |time: &f64| time.is_finite() && *time >= 0.0, "a number of seconds, 0 or more")
}

/// Parses a position in object units.
pub(super) fn position(text: &str) -> Result<Vec3, String> {
    let place = numbers(text).and_then(|numbers| <[f32; 3]>::try_from(numbers).ok());
    place.map(Vec3::from).ok_or_else(|| "expected X,Y,Z in object units, such as 0,1.5,0".into())
}

/// Parses a mesh's source, whose path may be in any encoding.
pub(crate) fn source() -> impl TypedValueParser<Value = Source> {
    OsStringValueParser::new().try_map(Source::try_from)
}

/// Parses a source of height images, whose path may be in any encoding.
pub(crate) fn heights() -> impl TypedValueParser<Value = HeightSource> {
    OsStringValueParser::new().try_map(HeightSource::parse)
}

/// Parses a number of bytes, with a unit or without.
pub(super) fn bytes(text: &str) -> Result<u64, String> {
    let (number, unit) = text.split_at(text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len()));
    let unit = match unit.trim().to_lowercase().as_str() {
        "" | "b" => Some(1),
        "kib" => Some(1_u64 << 10),
        "mib" => Some(1 << 20),
        "gib" => Some(1 << 30),
        _ => None,
    };
    let bytes = unit.zip(number.parse().ok()).and_then(|(unit, number): (u64, u64)| unit.checked_mul(number));
    let expected = "expected a whole number of bytes above 0, or of KiB, MiB or GiB, such as 500MiB";
    bytes.filter(|bytes| *bytes > 0).ok_or_else(|| expected.into())
}

/// Parses a whole number of a range.
pub(crate) fn whole<T>(range: RangeInclusive<T>) -> impl Fn(&str) -> Result<T, String> + Clone
where
    T: Copy + FromStr + PartialOrd + Display,
{
    move |text: &str| number(text, |number| range.contains(number), &in_range("a whole number", &range))
}

/// Parses a whole number that is at least this one.
pub(crate) fn whole_from<T>(least: T) -> impl Fn(&str) -> Result<T, String> + Clone
where
    T: Copy + FromStr + PartialOrd + Display,
{
    move |text: &str| number(text, |number| *number >= least, &format!("a whole number, {least} or more"))
}

/// Parses a number of a range.
pub(crate) fn within(range: RangeInclusive<f32>) -> impl Fn(&str) -> Result<f32, String> + Clone {
    move |text: &str| number(text, |number| range.contains(number), &in_range("a number", &range))
}

/// Reads finite numbers between commas.
fn numbers(text: &str) -> Option<Vec<f32>> {
    text.split(',').map(|number| number.trim().parse().ok().filter(|x: &f32| x.is_finite())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use load::files::Limits;

    #[test]
    fn pictures_have_no_name_of_another_format() {
        for good in ["a.png", "A.PNG", "picture", "shot.v2", "{}.png", "views", "a.glb.png"] {
            assert_eq!(picture_path(good.into()), Ok(good.into()));
        }
        for bad in ["-", "a.jpg", "theirs.obj", "model.GLB", "numbers.json", "theirs.csv", "pnaen.toml"] {
            assert!(picture_path(bad.into()).is_err(), "{bad}");
        }
    }

    #[test]
    fn whole_numbers_say_what_they_take() {
        let jobs = whole(1..=256_u16);
        assert_eq!((jobs("256"), jobs("0")), (Ok(256), Err("expected a whole number from 1 to 256".to_owned())));
        assert_eq!(whole_from(1_u64)("x"), Err("expected a whole number, 1 or more".to_owned()));
        assert!(["", "-1", "1.5", "99999999999"].into_iter().all(|bad| whole_from(0_u32)(bad).is_err()));
    }

    #[test]
    fn morph_targets_have_a_name_and_a_weight() {
        for (text, name, weight) in [("Smile=0.7", "Smile", 0.7), ("a = b=-1", "a = b", -1.0), ("=2", "", 2.0)] {
            assert_eq!(morph(text), Ok((name.to_owned(), weight)));
        }
        for bad in ["", "Smile", "Smile=", "Smile=x", "Smile=nan", "Smile=inf", "0.7"] {
            assert!(morph(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn sizes_and_cameras_are_read_or_refused() {
        assert_eq!(["640x480", "640,480"].map(size), [const { Ok([640, 480]) }; 2]);
        for bad in ["640", "0x10", "640x", "-1x5", "99999x5"] {
            assert!(size(bad).is_err(), "{bad}");
        }
        let camera = CameraOption { azimuth: -10.0, elevation: 5.5, distance: Some(2.0) };
        assert_eq!("-10, 5.5,2".parse(), Ok(camera));
        for bad in ["1", "1,2,0", "1,2,3,4", "nan,0", "a,b"] {
            assert!(bad.parse::<CameraOption>().is_err(), "{bad}");
        }
        assert_eq!(["1", "2KiB", "3 mib", "2GiB"].map(bytes), [1, 2 << 10, 3 << 20, 2 << 30].map(Ok));
        assert_eq!(bytes("2GiB"), Ok(Limits::default().file), "the default of --max-size");
        assert_eq!(bytes("512MiB"), Ok(Limits::default().memory), "the default of --max-memory");
        for bad in ["", "0", "0GiB", "-1", "1.5GiB", "GiB", "1GB", "1e9", "99999999999GiB", "+1"] {
            assert!(bytes(bad).is_err(), "{bad}");
        }
        let weld = within(0.0..=0.1);
        assert!(weld("0").is_ok() && weld("1e-7") == Ok(1e-7) && weld("0.1").is_ok());
        assert!(weld("0.11").is_err() && weld("-1e-7").is_err() && weld("nan").is_err() && weld("").is_err());
    }
}
