//! XXH64, the checksum of a frame's content.
//!
//! Source: Collet, "xxHash fast digest algorithm", section "XXH64 algorithm description".

const PRIMES: [u64; 5] =
    [0x9e37_79b1_85eb_ca87, 0xc2b2_ae3d_27d4_eb4f, 0x1656_67b1_9e37_79f9, 0x85eb_ca77_c2b2_ae63, 0x27d4_eb2f_1656_67c5];

/// The hash of bytes, with the seed 0.
pub(super) fn xxh64(bytes: &[u8]) -> u64 {
    let [p1, p2, p3, p4, p5] = PRIMES;
    let (stripes, rest) = bytes.as_chunks::<32>();
    let mut hash = if stripes.is_empty() { p5 } else { of_stripes(stripes) };
    hash = hash.wrapping_add(bytes.len() as u64);
    let (words, rest) = rest.as_chunks::<8>();
    for word in words {
        hash = step(hash ^ round(0, u64::from_le_bytes(*word)), 27, p1, p4);
    }
    let (halves, rest) = rest.as_chunks::<4>();
    for half in halves {
        hash = step(hash ^ u64::from(u32::from_le_bytes(*half)).wrapping_mul(p1), 23, p2, p3);
    }
    for byte in rest {
        hash = step(hash ^ u64::from(*byte).wrapping_mul(p5), 11, p1, 0);
    }
    hash = (hash ^ hash >> 33).wrapping_mul(p2);
    hash = (hash ^ hash >> 29).wrapping_mul(p3);
    hash ^ hash >> 32
}

/// What four lanes make of the stripes, of which each has a word for each lane.
fn of_stripes(stripes: &[[u8; 32]]) -> u64 {
    let [p1, p2, _, p4, _] = PRIMES;
    let mut lanes = [p1.wrapping_add(p2), p2, 0, p1.wrapping_neg()];
    for stripe in stripes {
        for (lane, word) in lanes.iter_mut().zip(stripe.as_chunks().0) {
            *lane = round(*lane, u64::from_le_bytes(*word));
        }
    }
    let sum = lanes.iter().zip([1, 7, 12, 18]).fold(0, |sum: u64, (lane, by)| sum.wrapping_add(lane.rotate_left(by)));
    lanes.iter().fold(sum, |hash, lane| step(hash ^ round(0, *lane), 0, p1, p4))
}

fn round(lane: u64, word: u64) -> u64 {
    step(lane.wrapping_add(word.wrapping_mul(PRIMES[1])), 31, PRIMES[0], 0)
}

fn step(hash: u64, by: u32, factor: u64, term: u64) -> u64 {
    hash.rotate_left(by).wrapping_mul(factor).wrapping_add(term)
}
