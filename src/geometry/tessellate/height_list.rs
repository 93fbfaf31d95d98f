//! Reads the heights of a map, which are one list. Twin: `shaders/height_list.wgsl`.

use crate::mesh::HeightMap;

/// Returns where the px of a mip level are: the index of its first height in the map's list, and its width.
pub(super) fn level_place(map: &HeightMap, level: u32) -> [u32; 2] {
    let mut start = 0;
    for l in 0..level {
        start += (map.size[0] >> l).max(1) * (map.size[1] >> l).max(1);
    }
    [start, (map.size[0] >> level).max(1)]
}

/// Returns the height of the px in column `x` and row `y` of a level.
pub(super) fn fetch_height(map: &HeightMap, [start, width]: [u32; 2], [x, y]: [u32; 2]) -> f32 {
    map.heights[(start + y * width + x) as usize]
}
