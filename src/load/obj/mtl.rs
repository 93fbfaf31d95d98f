//! Reads MTL, the material files of OBJ: the colours and textures of materials.
//!
//! The crate `tobj` isn't used. It drops a whole file because of one statement that it can't read, and takes the
//! options of `map_Kd` for a part of the file name.

use std::collections::BTreeMap;

use crate::text_lines::{Lines, first_word, numbers_or_nan, parsed, words};
use geometry::mesh::HeightAmount;
use geometry::mesh::mipmap::MipFilter;

/// A material in a material file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct MtlMaterial {
    pub name: Vec<u8>,
    /// Kd: the diffuse colour, linear.
    pub color: [f32; 3],
    /// Ke: the colour that is emitted, linear.
    pub emissive: [f32; 3],
    /// d: how opaque it is, 0 to 1.
    pub alpha: f32,
    /// Tr: how transparent it is, 0 to 1, in files that don't say how opaque it is.
    pub transparency: f32,
    /// Pr: perceptual roughness, 0 to 1.
    pub roughness: Option<f32>,
    /// Pm: 0 for dielectrics, 1 for metals.
    pub metallic: Option<f32>,
    pub textures: BTreeMap<MtlMap, MtlTexture>,
}

/// What a texture is for. The first one that a material has says where all are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum MtlMap {
    /// map_Kd: the diffuse texture.
    BaseColor,
    /// map_Ke: what multiplies the colour that is emitted.
    Emissive,
    /// norm: normals in tangent space.
    Normal,
    /// map_Bump or bump: heights, or normals in tangent space. Blender, for one, writes normal maps so.
    Bump,
    /// map_d: how opaque it is.
    Opacity,
    /// map_Pr: what multiplies the roughness.
    Roughness,
    /// map_Pm: what multiplies how much of a metal it is.
    Metalness,
    /// disp or map_disp: heights that displace the surface.
    Displacement,
}

impl MtlMap {
    /// How the image is halved.
    pub(super) fn filter(self) -> MipFilter {
        match self {
            Self::BaseColor | Self::Emissive => MipFilter::Colors,
            Self::Normal | Self::Bump => MipFilter::Normals,
            Self::Opacity | Self::Roughness | Self::Metalness | Self::Displacement => MipFilter::Numbers,
        }
    }
}

/// The statements of maps.
const MAP_STATEMENTS: [(&[u8], MtlMap); 12] = [
    (b"map_Kd", MtlMap::BaseColor),
    (b"map_Ke", MtlMap::Emissive),
    (b"norm", MtlMap::Normal),
    (b"map_Bump", MtlMap::Bump),
    (b"map_bump", MtlMap::Bump),
    (b"bump", MtlMap::Bump),
    (b"map_d", MtlMap::Opacity),
    (b"map_Pr", MtlMap::Roughness),
    (b"map_Pm", MtlMap::Metalness),
    (b"disp", MtlMap::Displacement),
    (b"map_disp", MtlMap::Displacement),
    (b"map_Disp", MtlMap::Displacement),
];

impl MtlMaterial {
    /// A white material.
    pub(super) fn named(name: &[u8]) -> Self {
        Self { name: name.to_vec(), color: [1.0; 3], alpha: 1.0, ..Self::default() }
    }

    /// Its maps that count: heights don't beside normals.
    pub(super) fn maps(&self) -> impl Iterator<Item = (MtlMap, &MtlTexture)> {
        let has_normals = self.textures.contains_key(&MtlMap::Normal);
        let counts = move |map: &MtlMap| *map != MtlMap::Bump || !has_normals;
        self.textures.iter().filter(move |(map, _)| counts(map)).map(|(map, texture)| (*map, texture))
    }

    /// What the numbers of a map are multiplied by.
    pub(super) fn factor(&self, map: MtlMap, texture: &MtlTexture) -> f32 {
        match map {
            MtlMap::Normal | MtlMap::Bump => texture.strength,
            MtlMap::Roughness => self.roughness.unwrap_or(1.0),
            MtlMap::Metalness => self.metallic.unwrap_or(1.0),
            MtlMap::BaseColor | MtlMap::Emissive | MtlMap::Opacity | MtlMap::Displacement => 1.0,
        }
    }
}

/// A texture, and the options before its name.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct MtlTexture {
    pub file: String,
    /// -s and -o: texture coordinates are multiplied by the first, and the second is added.
    pub scale: [f32; 2],
    pub offset: [f32; 2],
    /// -clamp on: there is no image beyond its border.
    pub is_clamped: bool,
    /// -bm: what the slopes of a normal map are multiplied by.
    pub strength: f32,
    /// -mm: how far heights move the surface, which is what is added to them and before that what they are multiplied by.
    pub amount: Option<HeightAmount>,
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
        word => {
            if let Some((_, map)) = MAP_STATEMENTS.iter().find(|(statement, _)| *statement == word) {
                material.textures.insert(*map, texture(rest));
            }
        }
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
    let mut found = MtlTexture { scale: [1.0; 2], strength: 1.0, ..MtlTexture::default() };
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
            b"-mm" => found.amount = HeightAmount::from_factor(place[1], place[0]),
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
    words(text).nth(word).is_some_and(|word| parsed::<f32>(word).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_and_textures_are_read_and_the_rest_is_not() {
        let text = "# made by hand\r\nKd 1 0 0\r\nnewmtl old wood\r\nNs x\r\nKd 0.5 .25 2\r\nmap_Kd -s 2 3 1 -clamp on \
                    a b.png\r\nPr 0.25\r\nPm 7\r\nd -halo 0.5\r\nTr 0.5\r\nKe 2\r\nmap_Ke -o 0.5 glow.png\r\nnorm -bm 2.5 n.png\r\nmap_bump b.png\r\nmap_d d.png\r\nmap_Pr r.png\r\nmap_Pm m.png\r\nmap_disp -mm -0.5 2 h.png\r\nnewmtl plain\r\n\tKd \
                    spectral a.rfl\r\nKd 0.5\r\nd\r\n";
        let place = |file: &str| MtlTexture { file: file.to_owned(), ..texture(b"") };
        let amount = Some(HeightAmount { scale: 2.0, midlevel: 0.25 });
        let wood = MtlMaterial {
            color: [0.5, 0.25, 1.0],
            emissive: [2.0; 3],
            alpha: 0.5,
            transparency: 0.5,
            roughness: Some(0.25),
            metallic: Some(1.0),
            textures: BTreeMap::from([
                (MtlMap::BaseColor, MtlTexture { scale: [2.0, 3.0], is_clamped: true, ..place("a b.png") }),
                (MtlMap::Emissive, MtlTexture { offset: [0.5, 0.0], ..place("glow.png") }),
                (MtlMap::Normal, MtlTexture { strength: 2.5, ..place("n.png") }),
                (MtlMap::Bump, place("b.png")),
                (MtlMap::Opacity, place("d.png")),
                (MtlMap::Roughness, place("r.png")),
                (MtlMap::Metalness, place("m.png")),
                (MtlMap::Displacement, MtlTexture { amount, ..place("h.png") }),
            ]),
            ..MtlMaterial::named(b"old wood")
        };
        let plain = MtlMaterial { color: [0.5; 3], ..MtlMaterial::named(b"plain") };
        assert_eq!(read(text.as_bytes()), Ok((vec![wood, plain], 2)));
        assert_eq!(texture(b"-o 1 2.png"), MtlTexture { offset: [1.0, 0.0], ..place("2.png") });
        let whole = HeightAmount::from_factor(1.0, 0.0);
        assert_eq!(texture(b"-mm 0 1 -bm 2 -t 1 x"), MtlTexture { strength: 2.0, amount: whole, ..place("x") });
        for bad in ["-mm 1 0 x", "-mm a b x", "-mm 0 inf x"] {
            assert_eq!(texture(bad.as_bytes()), place("x"), "{bad}");
        }
        assert_eq!(texture(b"-bm x y"), place("y"));
        assert_eq!(texture(b"-s"), place(""));
    }
}
