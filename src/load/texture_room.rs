//! How small a mesh's textures must be, so that all of them fit the memory that they may take.

use std::borrow::Cow;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

use super::images::{decode_halved, decoded_bytes, texture_size};
use super::memory_budget::Budget;
use geometry::mesh::mipmap::{MipFilter, level_count, level_size};
use geometry::mesh::{MemoryRefused, Texture, borrowing};
use geometry::progress::{Cancelled, Progress};

/// The greatest width and height of a texture that is shown, in px: every adapter has textures of that size (WebGPU, default limits).
pub(super) const MOST_SIDE: u32 = 8192;

/// The memory that textures may take, in bytes.
#[derive(Clone, Copy, Debug)]
struct TextureRoom {
    /// Decoded.
    host: u64,
    /// On the graphics card, with all mip levels.
    device: u64,
    /// What is in use already, or will be.
    used: u64,
}

/// How what is said of an image begins that can't be read.
pub(super) const LEFT_OUT: &str = "is left out";

/// How often a texture is halved, and why; the reason is empty if it isn't.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Scaling {
    halvings: u32,
    reason: String,
}

impl Scaling {
    /// What is said of a texture of a size in px after its name: that it is left out, if it can't be read, or to which size it is scaled
    /// down. None if it isn't.
    fn said(&self, [a, b]: [u32; 2], read: Result<[u32; 2], &String>) -> Option<String> {
        let Self { halvings, reason } = self;
        match read {
            Err(reason) => Some(format!("{LEFT_OUT}: {reason}.")),
            Ok([c, d]) => {
                (*halvings > 0).then(|| format!("is scaled down from {a} x {b} px to {c} x {d} px: {reason}."))
            }
        }
    }
}

/// An image that was read, unless it can't be; and what is said of it after its name, if anything.
#[derive(Clone, Debug, Default)]
pub(super) struct ReadImage {
    pub texture: Option<Arc<Texture>>,
    pub said: Option<String>,
}

/// Reads images, and scales the largest down until all fit. `bytes` returns an image's file and how its texels are averaged; `reserved`
/// is the memory that the rest of the load takes, in bytes.
pub(super) fn read_images<'b, I: Copy>(
    images: &[I],
    bytes: impl Fn(I) -> Result<(Cow<'b, [u8]>, MipFilter), String>,
    reserved: u64,
    budget: &Budget,
    progress: &Progress,
) -> Result<Vec<ReadImage>, Cancelled> {
    let size = |image: &I| borrowing(budget, || bytes(*image).ok().and_then(|(bytes, _)| texture_size(&bytes)));
    let sizes: Vec<_> = images.iter().map(|image| size(image).unwrap_or_default()).collect();
    let scalings = TextureRoom::new(budget, reserved).scalings(&sizes);
    let mut order: Vec<_> = (0..images.len()).collect();
    // What takes most memory while it is decoded comes first, while the others don't take any yet.
    order.sort_by_key(|i| Reverse(decoded_bytes(sizes[*i])));
    let mut read = vec![ReadImage::default(); images.len()];
    for i in order {
        progress.check()?;
        let decode = |(bytes, filter): (Cow<[u8]>, _)| decode_halved(&bytes, scalings[i].halvings, filter, budget);
        let texture = borrowing(budget, || bytes(images[i]).and_then(decode));
        let said = scalings[i].said(sizes[i], texture.as_ref().map(|texture| texture.size));
        read[i] = ReadImage { texture: texture.ok().map(Arc::new), said };
    }
    Ok(read)
}

impl TextureRoom {
    /// The room in a budget of which `reserved` bytes are left for the rest of the load. On the graphics card, textures may take as
    /// much as the whole load.
    fn new(budget: &Budget, reserved: u64) -> Self {
        let host = budget.left().saturating_sub(reserved);
        let device = budget.allowed();
        Self { host, device, used: device.saturating_sub(host) }
    }

    /// Halves the largest of these sizes, in px, until all textures fit, the first of several of one size first.
    fn scalings(&self, sizes: &[[u32; 2]]) -> Vec<Scaling> {
        let fits = |size, halvings| level_size(size, halvings).iter().all(|side| *side <= MOST_SIDE);
        let least = |size: &[u32; 2]| (0..u32::BITS).find(|halvings| fits(*size, *halvings)).unwrap_or(0);
        let mut halvings: Vec<u32> = sizes.iter().map(least).collect();
        let too_wide = halvings.clone();
        let [mut host, mut device] = [0_u64; 2];
        for (size, halvings) in sizes.iter().zip(&halvings) {
            host += decoded_bytes(level_size(*size, *halvings));
            device += device_bytes(level_size(*size, *halvings));
        }
        let reason = self.refused(host, device);
        let largest =
            |(index, size): (usize, &[u32; 2])| (pixels(level_size(*size, too_wide[index])), usize::MAX - index);
        let mut largest: BinaryHeap<_> = sizes.iter().enumerate().map(largest).collect();
        while host > self.host || device > self.device {
            let Some((_, inverse)) = largest.pop() else { break };
            let index = usize::MAX - inverse;
            let before = level_size(sizes[index], halvings[index]);
            let after = level_size(before, 1);
            if after == before {
                continue;
            }
            halvings[index] += 1;
            host = host - decoded_bytes(before) + decoded_bytes(after);
            device = device - device_bytes(before) + device_bytes(after);
            largest.push((pixels(after), inverse));
        }
        let scaling = |(halvings, too_wide): (u32, u32)| match (halvings, &reason) {
            (0, _) => Scaling::default(),
            (_, Some(reason)) if halvings > too_wide => Scaling { halvings, reason: reason.clone() },
            _ => Scaling { halvings, reason: format!("at most {MOST_SIDE} px a side are shown") },
        };
        halvings.into_iter().zip(too_wide).map(scaling).collect()
    }

    /// Why textures that take so many bytes don't fit, as a clause; none if they do.
    fn refused(&self, host: u64, device: u64) -> Option<String> {
        let allowed = self.device;
        if host > self.host {
            let refused = MemoryRefused { needed: self.used.saturating_add(host), allowed };
            return Some(format!("with all textures, the load {refused}"));
        }
        let refused = MemoryRefused { needed: device, allowed };
        (device > allowed).then(|| format!("on the graphics card, all textures with their mip levels {refused}"))
    }
}

fn pixels([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height)
}

/// The size of a texture with all its mip levels, in bytes.
fn device_bytes(size: [u32; 2]) -> u64 {
    (0..level_count(size)).map(|level| decoded_bytes(level_size(size, level))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn halvings(room: TextureRoom, sizes: &[[u32; 2]]) -> Vec<u32> {
        room.scalings(sizes).into_iter().map(|scaling| scaling.halvings).collect()
    }

    const MIB: u64 = 1 << 20;

    #[test]
    fn the_largest_are_halved_first() {
        let sizes = [[256, 256], [1024, 1024], [512, 512], [1024, 1024]];
        let room = |host, device| TextureRoom { host, device, used: 7 * MIB };
        assert_eq!(halvings(room(100 * MIB, 100 * MIB), &sizes), [0; 4]);
        // 9.25 MiB decoded, and a third more on the graphics card.
        assert_eq!(halvings(room(9 * MIB, 100 * MIB), &sizes), [0, 1, 0, 0]);
        assert_eq!(halvings(room(100 * MIB, 12 * MIB), &sizes), [0, 1, 0, 0]);
        assert_eq!(halvings(room(MIB, 100 * MIB), &sizes), [0, 2, 1, 2]);
        assert_eq!(halvings(room(0, 0), &[[1, 1], [3, 9]]), [0, 3]);
    }

    #[test]
    fn reasons_name_both_numbers() {
        let said =
            |host, device| TextureRoom { host, device, used: 7 * MIB }.scalings(&[[2048, 2048]]).remove(0).reason;
        let host = said(10 * MIB, 17 * MIB);
        assert!(host.contains("would take at least 23 MiB") && host.contains("only 17 MiB"), "{host}");
        let device = said(100 * MIB, 17 * MIB);
        assert!(device.contains("mip levels would take at least 22 MiB") && device.contains("only 17 MiB"), "{device}");
        assert_eq!(said(100 * MIB, 100 * MIB), "");
    }

    #[test]
    fn no_side_has_more_than_the_most() {
        let room = TextureRoom { host: u64::MAX, device: u64::MAX, used: 0 };
        let scalings = room.scalings(&[[16384, 3], [8192, 8192], [8193, 1], [16384, 16384]]);
        assert_eq!(scalings.iter().map(|scaling| scaling.halvings).collect::<Vec<_>>(), [1, 0, 1, 1]);
        assert_eq!(scalings[0].reason, "at most 8192 px a side are shown");
    }
}
