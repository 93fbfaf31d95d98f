//! Decompresses Zstandard to a length that is known beforehand: what would be longer is refused, so that data can't ask for more memory
//! than its file says. Checksums are verified, and dictionaries aren't supported.

/// The most memory that decompressing takes beside the result, in bytes: literals of a block, and tables.
pub(super) const WORKING_BYTES: u64 = 1 << 19;

/// Decompresses data to `length` bytes.
///
/// # Errors
/// The end of a clause that begins with the data.
pub(super) fn decompress(bytes: &[u8], length: usize) -> Result<Vec<u8>, String> {
    let mut result = vec![0; length];
    let written = zstd::bulk::decompress_to_buffer(bytes, &mut result)
        .map_err(|error| format!("can't be decompressed to {length} bytes: {error}"))?;
    if written < length {
        return Err(format!("decompresses to {written} bytes, but its file says {length}"));
    }
    Ok(result)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame of these blocks, each with its kind and size, without the size of the whole.
    fn frame(blocks: &[(u32, u32, &[u8])]) -> Vec<u8> {
        let mut bytes = vec![0x28, 0xb5, 0x2f, 0xfd, 0, 0x58];
        for (i, (kind, size, data)) in blocks.iter().enumerate() {
            let last = u32::from(i + 1 == blocks.len());
            bytes.extend(&(size << 3 | kind << 1 | last).to_le_bytes()[..3]);
            bytes.extend(*data);
        }
        bytes
    }

    /// 64 lines `row 0: 0 0 0`, `row 1: 1 1 1` and so on, compressed at level 19, with a checksum.
    const ROWS: &[u8] = include_bytes!("rows.zst");

    fn rows() -> Vec<u8> {
        (0..64).flat_map(|i| format!("row {i}: {} {} {}\n", i * i, i * 7 % 64, i * 13 % 64).into_bytes()).collect()
    }

    fn refused(bytes: &[u8], length: usize) -> String {
        decompress(bytes, length).expect_err("it is wrong")
    }

    #[test]
    fn blocks_of_all_kinds_become_what_they_were() {
        let both = frame(&[(0, 3, b"abc"), (1, 5, b"x")]);
        assert_eq!(decompress(&both, 8), Ok(b"abcxxxxx".to_vec()));
        assert_eq!(decompress(ROWS, rows().len()), Ok(rows()));
    }

    #[test]
    fn lengths_that_lie_are_refused() {
        // Four bytes that become 128 KiB, a thousand times.
        let bomb = frame(&vec![(1, 128 << 10, &b"x"[..]); 1000]);
        assert_eq!(decompress(&bomb, 128_000 << 10).map(|bytes| bytes.len()), Ok(128_000 << 10));
        assert!(refused(&bomb, 1 << 20).starts_with("can't be decompressed to 1048576 bytes: "));
        assert!(refused(ROWS, rows().len() - 1).starts_with("can't be decompressed to "));
        let length = rows().len();
        let said = format!("decompresses to {length} bytes, but its file says {}", length + 1);
        assert_eq!(refused(ROWS, length + 1), said);
        let dictionary = [0x28, 0xb5, 0x2f, 0xfd, 1, 0x58, 7, 1, 0, 0];
        for bytes in [&frame(&[(3, 0, b"")])[..], b"nothing like it", &dictionary] {
            assert!(refused(bytes, 0).starts_with("can't be decompressed to 0 bytes: "));
        }
    }

    #[test]
    fn data_that_is_cut_or_changed_gives_an_error_or_the_same_bytes() {
        let whole = rows();
        for end in 0..ROWS.len() {
            assert!(decompress(&ROWS[..end], whole.len()).is_err(), "{end}");
        }
        let mut passed = 0;
        for bit in 0..8 * ROWS.len() {
            let mut bytes = ROWS.to_vec();
            bytes[bit / 8] ^= 1 << (bit % 8);
            if let Ok(bytes) = decompress(&bytes, whole.len()) {
                assert!(bytes == whole, "bit {bit}");
                passed += 1;
            }
        }
        // The window's size doesn't matter, say, and neither does the length of a code that nothing uses.
        assert!(passed < ROWS.len() / 10, "{passed} of {} bits", 8 * ROWS.len());
    }

    #[test]
    fn checksums_are_verified() {
        for (text, checksum) in [("", 0x51d8_e999_u32), ("abc", 0xad77_0999)] {
            let mut bytes = frame(&[(0, text.len() as u32, text.as_bytes())]);
            bytes[4] |= 4;
            bytes.extend(checksum.to_le_bytes());
            assert_eq!(decompress(&bytes, text.len()), Ok(text.as_bytes().to_vec()), "{text}");
            let last = bytes.len() - 1;
            bytes[last] ^= 0x80;
            assert!(refused(&bytes, text.len()).contains("checksum"), "{text}");
        }
    }
}
