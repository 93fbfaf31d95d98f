//! Computes how much memory it takes to decode a JPEG image in addition to its pixels: a progressive image keeps all
//! coefficients until its last scan.

use std::io::{self, Read, Seek, SeekFrom};

/// Returns the size of a progressive image's coefficients, in bytes. They have 16 bits each and are stored in blocks of
/// 8 x 8, in whole units (MCUs) of blocks of every component (ITU-T T.81, A.1 and A.2). Returns 0 for a sequential
/// image, whose units are decoded one after another; and none if the segments before the first scan aren't in the
/// expected order, in which case a decoder may find something else. Afterwards the file is at its start.
///
/// # Errors
/// The errors of reading.
pub(super) fn coefficient_bytes(file: &mut (impl Read + Seek)) -> io::Result<Option<u64>> {
    file.seek(SeekFrom::Start(0))?;
    let frame = frame(file).or_else(|error| match error.kind() {
        io::ErrorKind::UnexpectedEof => Ok(None),
        _ => Err(error),
    })?;
    file.seek(SeekFrom::Start(0))?;
    Ok(frame.map(|frame| if frame.is_progressive { bytes(frame.size, &frame.samplings) } else { 0 }))
}

/// Returns the greatest size of the coefficients of any image of `size` px.
pub(super) fn most_coefficient_bytes(size: [u32; 2]) -> u64 {
    bytes(size, &[[1, 1]; 4])
}

/// The frame header of a JPEG image.
struct JpegFrame {
    is_progressive: bool,
    /// Width and height in px.
    size: [u32; 2],
    /// The sampling factors of each component, horizontal and vertical.
    samplings: Vec<[u8; 2]>,
}

/// Reads the frame header of a JPEG image; returns none if the segments aren't those of one.
fn frame(file: &mut impl Read) -> io::Result<Option<JpegFrame>> {
    if bytes_of::<2>(file)? != [0xff, 0xd8] {
        return Ok(None);
    }
    let mut found = None;
    loop {
        let [0xff, marker] = bytes_of(file)? else { return Ok(None) };
        // Markers without a length, and the end marker, don't come before a scan.
        if matches!(marker, 0x00 | 0x01 | 0xd0..=0xd9 | 0xff) {
            return Ok(None);
        }
        let Some(length) = u64::from(u16::from_be_bytes(bytes_of(file)?)).checked_sub(2) else { return Ok(None) };
        let mut segment = file.by_ref().take(length);
        match marker {
            0xc0..=0xc2 => {
                let [_, h0, h1, w0, w1, count] = bytes_of(&mut segment)?;
                let components = (0..count).map(|_| bytes_of(&mut segment));
                let samplings = components.map(|own| own.map(|[_, factors, _]| [factors >> 4, factors & 15]));
                let samplings = samplings.collect::<io::Result<_>>()?;
                let size = [[w0, w1], [h0, h1]].map(|side| u16::from_be_bytes(side).into());
                found = Some(JpegFrame { is_progressive: marker == 0xc2, size, samplings });
            }
            0xda => return Ok(found),
            _ => {}
        }
        io::copy(&mut segment, &mut io::sink())?;
    }
}

fn bytes_of<const N: usize>(file: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}

fn bytes(size: [u32; 2], samplings: &[[u8; 2]]) -> u64 {
    let most = |axis: usize| samplings.iter().map(|own| u64::from(own[axis])).max().unwrap_or(0).max(1);
    let units = [0, 1].map(|axis| u64::from(size[axis]).div_ceil(8 * most(axis)));
    let blocks: u64 = samplings.iter().map(|&[across, down]| u64::from(across) * u64::from(down)).sum();
    units[0] * units[1] * blocks * 64 * 2
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// A header: an application segment, then a frame of 100 x 50 px in three components, the first of which has
    /// sampling factors of 2.
    fn header(frame: u8) -> Vec<u8> {
        let mut bytes = vec![0xff, 0xd8, 0xff, 0xe0, 0, 4, 7, 7, 0xff, frame, 0, 17, 8, 0, 50, 0, 100, 3];
        bytes.extend([1, 0x22, 0, 2, 0x11, 1, 3, 0x11, 1, 0xff, 0xda, 0, 2]);
        bytes
    }

    fn of(bytes: Vec<u8>) -> Option<u64> {
        coefficient_bytes(&mut Cursor::new(bytes)).expect("in memory")
    }

    #[test]
    fn progressive_images_keep_whole_units_of_every_component() {
        // 7 x 4 units of 16 x 16 px, with six blocks each.
        assert_eq!(of(header(0xc2)), Some(7 * 4 * 6 * 128));
        assert_eq!(of(header(0xc0)), Some(0));
    }

    #[test]
    fn unknown_segments_give_no_answer() {
        let mut odd = header(0xc0);
        odd.insert(8, 0);
        assert_eq!(of(odd), None, "a byte between segments");
        assert_eq!(of(header(0xc0)[..20].to_vec()), None, "cut short");
        assert_eq!(of(Vec::new()), None);
        assert_eq!(of(vec![0xff, 0xd8, 0xff, 0xda, 0, 2]), None, "no frame before the scan");
        assert_eq!(most_coefficient_bytes([100, 50]), 13 * 7 * 4 * 128);
    }
}
