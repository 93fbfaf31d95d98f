//! Reads MTL, the material files of OBJ: the colours and textures of materials.
//!
//! The crate `tobj` isn't used. It drops a whole file because of one statement that it can't read, and takes the
//! options of `map_Kd` for a part of the file name.

use crate::text_lines::{Lines, first_word, number, numbers_or_nan, words};

/// A material in a material file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MtlMaterial {
    pub name: Vec<u8>,
    /// Kd: the diffuse colour, linear.
    pub color: [f32; 3],
    /// map_Kd: the diffuse texture.
    pub texture: Option<MtlTexture>,
    /// Ke: the colour that is emitted, linear.
    pub emissive: [f32; 3],
    /// map_Ke: the texture that multiplies it.
    pub emissive_texture: Option<MtlTexture>,
    /// d: how opaque it is, 0 to 1.
    pub alpha: f32,
    /// Tr: how transparent it is, 0 to 1, in files that don't say how opaque it is.
    pub transparency: f32,
    /// Pr: perceptual roughness, 0 to 1.
    pub roughness: Option<f32>,
    /// Pm: 0 for dielectrics, 1 for metals.
    pub metallic: Option<f32>,
    /// map_d: how opaque it is.
    pub opacity_texture: Option<MtlTexture>,
    /// map_Pr: the texture that multiplies the roughness.
    pub roughness_texture: Option<MtlTexture>,
    /// map_Pm: the texture that multiplies how much of a metal it is.
    pub metallic_texture: Option<MtlTexture>,
    /// norm: normals in tangent space.
    pub normal_texture: Option<MtlTexture>,
    /// map_Bump or bump: heights, or normals in tangent space.
    pub bump_texture: Option<MtlTexture>,
}

impl MtlMaterial {
    /// A white material.
    pub(super) fn named(name: &[u8]) -> Self {
        Self {
            name: name.to_vec(),
            color: [1.0; 3],
            texture: None,
            emissive: [0.0; 3],
            emissive_texture: None,
            alpha: 1.0,
            transparency: 0.0,
            roughness: None,
            metallic: None,
            opacity_texture: None,
            roughness_texture: None,
            metallic_texture: None,
            normal_texture: None,
            bump_texture: None,
        }
    }
}

/// A texture, and the options before its name.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MtlTexture {
    pub file: String,
    /// -s and -o: texture coordinates are multiplied by the first, and the second is added.
    pub scale: [f32; 2],
    pub offset: [f32; 2],
    /// -clamp on: there is no image beyond its border.
    pub is_clamped: bool,
    /// -bm: what the slopes of a normal map are multiplied by.
    pub strength: f32,
}

/// Reads the materials of a file. Also returns how many statements that are understood have numbers that can't be read.
///
/// # Errors
/// A clause that says what is wrong with the whole file.
pub(super) fn read(bytes: &[u8]) -> Result<(Vec<MtlMaterial>, usize), String> {
    let (mut materials, mut bad) = (Vec::<MtlMaterial>::new(), 0);
    let mut lines = Lines::new(bytes);
    while let Some(line) = lines.next().map_err(|fault| fault.to_string())? {
        let (word, rest) = first_word(line.text);
        if word == b"newmtl" {
            materials.push(MtlMaterial::named(rest));
        }
        let Some(material) = materials.last_mut() else { continue };
        bad += usize::from(take(material, word, rest).is_none());
    }
    Ok((materials, bad))
}

/// Reads a statement; none if its numbers can't be read.
fn take(material: &mut MtlMaterial, word: &[u8], rest: &[u8]) -> Option<()> {
    match word {
        b"Kd" => material.color = color(rest)?.map(|x| x.clamp(0.0, 1.0)),
        b"Ke" => material.emissive = color(rest)?.map(|x| x.max(0.0)),
        b"d" => material.alpha = part(rest.strip_prefix(b"-halo").unwrap_or(rest))?,
        b"Tr" => material.transparency = part(rest)?,
        b"Pr" => material.roughness = Some(part(rest)?),
        b"Pm" => material.metallic = Some(part(rest)?),
        b"map_Kd" => material.texture = Some(texture(rest)),
        b"map_Ke" => material.emissive_texture = Some(texture(rest)),
        b"map_d" => material.opacity_texture = Some(texture(rest)),
        b"map_Pr" => material.roughness_texture = Some(texture(rest)),
        b"map_Pm" => material.metallic_texture = Some(texture(rest)),
        b"norm" => material.normal_texture = Some(texture(rest)),
        b"map_Bump" | b"map_bump" | b"bump" => material.bump_texture = Some(texture(rest)),
        _ => {}
    }
    Some(())
}

/// Parses a colour: red, green and blue, or one number for all three.
fn color(text: &[u8]) -> Option<[f32; 3]> {
    let color = match words(text).nth(1) {
        Some(_) => numbers_or_nan(text),
        None => [numbers_or_nan::<1>(text)[0]; 3],
    };
    color.iter().all(|channel| channel.is_finite()).then_some(color)
}

/// Parses a number from 0 to 1.
fn part(text: &[u8]) -> Option<f32> {
    let [number] = numbers_or_nan(text);
    number.is_finite().then_some(number.clamp(0.0, 1.0))
}

/// Parses a file name after options. Options about anything but its place are ignored.
fn texture(mut text: &[u8]) -> MtlTexture {
    let mut found =
        MtlTexture { file: String::new(), scale: [1.0; 2], offset: [0.0; 2], is_clamped: false, strength: 1.0 };
    loop {
        let (word, mut rest) = first_word(text);
        let count = match word {
            b"-blendu" | b"-blendv" | b"-cc" | b"-clamp" | b"-imfchan" | b"-bm" | b"-boost" | b"-texres" | b"-type" => {
                1
            }
            b"-mm" => 2,
            b"-o" | b"-s" | b"-t" => (0..3).take_while(|&i| is_number(rest, i)).count(),
            _ => {
                found.file = String::from_utf8_lossy(text).into_owned();
                return found;
            }
        };
        let place = numbers_or_nan::<2>(rest);
        match word {
            b"-clamp" => found.is_clamped = first_word(rest).0 == b"on",
            b"-bm" => found.strength = Some(place[0]).filter(|strength| strength.is_finite()).unwrap_or(1.0),
            b"-s" => replace(&mut found.scale, place, count),
            b"-o" => replace(&mut found.offset, place, count),
            _ => {}
        }
        for _ in 0..count {
            rest = first_word(rest).1;
        }
        text = rest;
    }
}

/// Replaces the numbers that an option has. The others stay.
fn replace(kept: &mut [f32; 2], given: [f32; 2], count: usize) {
    for (kept, given) in kept.iter_mut().zip(given).take(count).filter(|(_, given)| given.is_finite()) {
        *kept = given;
    }
}

fn is_number(text: &[u8], word: usize) -> bool {
    words(text).nth(word).is_some_and(|word| number(word).is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_and_textures_are_read_and_the_rest_is_not() {
        let text = "# made by hand\r\nKd 1 0 0\r\nnewmtl old wood\r\nNs x\r\nKd 0.5 .25 2\r\nmap_Kd -s 2 3 1 -clamp on \
                    a b.png\r\nPr 0.25\r\nPm 7\r\nd -halo 0.5\r\nTr 0.5\r\nKe 2\r\nmap_Ke -o 0.5 glow.png\r\nnorm -bm 2.5 n.png\r\nmap_bump b.png\r\nmap_d d.png\r\nmap_Pr r.png\r\nmap_Pm m.png\r\nnewmtl plain\r\n\tKd \
                    spectral a.rfl\r\nKd 0.5\r\nd\r\n";
        let place = |file: &str| MtlTexture { file: file.to_owned(), ..texture(b"") };
        let wood = MtlMaterial {
            color: [0.5, 0.25, 1.0],
            texture: Some(MtlTexture { scale: [2.0, 3.0], is_clamped: true, ..place("a b.png") }),
            emissive: [2.0; 3],
            emissive_texture: Some(MtlTexture { offset: [0.5, 0.0], ..place("glow.png") }),
            alpha: 0.5,
            transparency: 0.5,
            roughness: Some(0.25),
            metallic: Some(1.0),
            normal_texture: Some(MtlTexture { strength: 2.5, ..place("n.png") }),
            opacity_texture: Some(place("d.png")),
            roughness_texture: Some(place("r.png")),
            metallic_texture: Some(place("m.png")),
            bump_texture: Some(place("b.png")),
            ..MtlMaterial::named(b"old wood")
        };
        let plain = MtlMaterial { color: [0.5; 3], ..MtlMaterial::named(b"plain") };
        assert_eq!(read(text.as_bytes()), Ok((vec![wood, plain], 2)));
        assert_eq!(texture(b"-o 1 2.png"), MtlTexture { offset: [1.0, 0.0], ..place("2.png") });
        assert_eq!(texture(b"-mm 0 1 -bm 2 -t 1 x"), MtlTexture { strength: 2.0, ..place("x") });
        assert_eq!(texture(b"-bm x y"), place("y"));
        assert_eq!(texture(b"-s"), place(""));
    }
}
