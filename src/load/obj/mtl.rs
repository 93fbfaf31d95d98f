//! Reads MTL, the material files of OBJ: the colours and colour textures of materials.
//!
//! The crate `tobj` isn't used. It drops a whole file because of one statement that it can't read, and takes the
//! options of `map_Kd` for a part of the file name.

use crate::load::text_lines::{Lines, first_word, number, numbers};

/// A material in a material file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MtlMaterial {
    pub name: Vec<u8>,
    /// Kd: the diffuse colour, linear.
    pub color: [f32; 3],
    /// map_Kd: the file name of the diffuse texture.
    pub texture: Option<String>,
}

/// Reads the materials of a file. Also returns how many statements about colours can't be read.
///
/// # Errors
/// A clause that says what is wrong with the whole file.
pub(super) fn read(bytes: &[u8]) -> Result<(Vec<MtlMaterial>, usize), String> {
    let (mut materials, mut bad) = (Vec::<MtlMaterial>::new(), 0);
    let mut lines = Lines::new(bytes);
    while let Some(line) = lines.next().map_err(|fault| fault.to_string())? {
        let (word, rest) = first_word(line.text);
        if word == b"newmtl" {
            materials.push(MtlMaterial { name: rest.to_vec(), color: [1.0; 3], texture: None });
        }
        let Some(material) = materials.last_mut() else { continue };
        match word {
            b"Kd" => match numbers::<3>("Kd", rest) {
                Ok(color) if color.iter().all(|x| x.is_finite()) => material.color = color.map(|x| x.clamp(0.0, 1.0)),
                _ => bad += 1,
            },
            b"map_Kd" => material.texture = Some(String::from_utf8_lossy(without_options(rest)).into_owned()),
            _ => {}
        }
    }
    Ok((materials, bad))
}

/// Returns the file name after options such as `-clamp on` or `-s 1 1 1`, which are ignored.
fn without_options(mut text: &[u8]) -> &[u8] {
    loop {
        let (word, mut rest) = first_word(text);
        let words = match word {
            b"-blendu" | b"-blendv" | b"-cc" | b"-clamp" | b"-imfchan" | b"-bm" | b"-boost" | b"-texres" | b"-type" => {
                1
            }
            b"-mm" => 2,
            b"-o" | b"-s" | b"-t" => (0..3).take_while(|&i| is_number(rest, i)).count(),
            _ => return text,
        };
        for _ in 0..words {
            rest = first_word(rest).1;
        }
        text = rest;
    }
}

fn is_number(text: &[u8], word: usize) -> bool {
    crate::load::text_lines::words(text).nth(word).is_some_and(|word| number(word).is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_and_textures_are_read_and_the_rest_is_not() {
        let text = "# made by hand\r\nKd 1 0 0\r\nnewmtl old wood\r\nNs x\r\nKd 0.5 .25 2\r\nmap_Kd -s 1 1 1 -clamp on \
                    a b.png\r\nnewmtl plain\r\n\tKd spectral a.rfl\r\n";
        let described = |name: &[u8], color, texture: Option<&str>| MtlMaterial {
            name: name.to_vec(),
            color,
            texture: texture.map(str::to_owned),
        };
        let expected =
            vec![described(b"old wood", [0.5, 0.25, 1.0], Some("a b.png")), described(b"plain", [1.0; 3], None)];
        assert_eq!(read(text.as_bytes()), Ok((expected, 1)));
        assert_eq!(without_options(b"-o 1 2.png"), b"2.png");
        assert_eq!(without_options(b"-mm 0 1 -bm 2 -t 1 x"), b"x");
        assert_eq!(without_options(b"-s"), b"");
    }
}
