//! Warnings about a mesh that was loaded or changed, as sentences.

use super::import::Import;
use super::notes::counted;
use geometry::mesh::crease_band::CreaseBand;
use geometry::mesh::{Heights, Mesh, Repairs};

/// Returns warnings about corners that were repaired. Normals that were missing don't cause one here, since files may
/// leave them out on purpose.
pub(super) fn repair_warnings(repairs: &Repairs, import: &Import) -> Vec<String> {
    let within = import.crease_angle;
    let replaced = format!("normals without a direction, replaced by ones that are smooth within {within} degrees");
    let sentences = [
        (repairs.normals_replaced, replaced.as_str()),
        (repairs.normals_rescaled, "normals whose length wasn't 1, scaled to it"),
        (repairs.denormals, "positions with coordinates too small for some devices (below 1.2e-38), set to 0"),
    ];
    counted(sentences.map(|(count, sentence)| (count as usize, sentence))).collect()
}

/// Returns warnings about a crease band: that the mesh has no crease, or that the band is narrower than requested in places.
pub fn crease_band_warnings(band: &CreaseBand) -> Vec<String> {
    let none = (band.creases == 0).then(|| "no edge has split normals, so no crease band was made.".to_owned());
    let narrowed = "edges and triangles too small for the full width of the crease band, which is narrower there";
    none.into_iter().chain(counted([(band.narrowed as usize, narrowed)])).collect()
}

/// Returns a warning about triangles whose corners all have the same texture coordinates: displacement moves such a
/// triangle as a whole.
pub(super) fn untextured_warning(heights: &Heights, mesh: &Mesh) -> Option<String> {
    let is_point = |triangle: &u32| {
        let [a, b, c] = mesh.triangles[*triangle as usize].map(|corner| mesh.corners[corner as usize].uv);
        a == b && b == c
    };
    let count = heights.ranges.iter().flat_map(|(range, _)| range.clone()).filter(is_point).count();
    (count > 0).then(|| format!("triangles without texture coordinates, which heights move as a whole: {count}."))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::{HeightMap, Shape};

    #[test]
    fn repairs_are_counted_in_sentences_but_normals_that_were_made_are_not() {
        assert!(repair_warnings(&Repairs { normals_made: 3, ..Repairs::default() }, &Import::default()).is_empty());
        let all = Repairs { normals_made: 1, normals_replaced: 2, normals_rescaled: 3, denormals: 4 };
        let counts = repair_warnings(&all, &Import::default())
            .iter()
            .map(|warning| warning.chars().rev().nth(1))
            .collect::<Vec<_>>();
        assert_eq!(counts, [Some('2'), Some('3'), Some('4')]);
    }

    #[test]
    fn crease_bands_without_creases_or_room_cause_warnings() {
        let of = |creases, narrowed| crease_band_warnings(&CreaseBand { width: 0.1, creases, narrowed }).len();
        assert_eq!([of(0, 0), of(5, 0), of(5, 7)], [1, 0, 1]);
    }

    #[test]
    fn triangles_without_texture_coordinates_are_counted() {
        let map = || HeightMap::new([1, 1], vec![0.5]);
        let [with, without] = [Shape::Torus, Shape::Icosphere].map(Shape::build);
        assert_eq!(untextured_warning(&Heights::everywhere(&with, map()), &with), None);
        let warning = untextured_warning(&Heights::everywhere(&without, map()), &without).expect("80 triangles");
        assert!(warning.ends_with("as a whole: 80."), "{warning}");
    }
}
