//! Warnings about a mesh that was read or changed, in sentences for people.

use crate::mesh::rim::Rim;
use crate::mesh::{Heights, Mesh, Repairs};

/// Warnings about corners that were repaired. Normals that were made are none: files may leave them out on purpose.
pub fn repair_warnings(repairs: &Repairs) -> Vec<String> {
    let sentences = [
        (repairs.normals_replaced, "normals of no direction, replaced by ones that are smooth within 60 degrees"),
        (repairs.normals_rescaled, "normals whose length isn't 1, brought to it"),
        (repairs.denormals, "positions with coordinates too small for some devices (below 1.2e-38), set to 0"),
    ];
    let found = sentences.into_iter().filter(|(count, _)| *count > 0);
    found.map(|(count, sentence)| format!("{sentence}: {count}.")).collect()
}

/// Warnings about a rim along creases: that there is no crease, or that it is narrower than asked for in places.
pub fn rim_warnings(rim: &Rim) -> Vec<String> {
    let mut warnings = Vec::new();
    if rim.creases == 0 {
        warnings.push("no edge has split normals, so there is no crease for a rim.".to_owned());
    }
    if rim.narrowed > 0 {
        warnings.push(format!("edges and triangles too small for all of the rim's width: {}.", rim.narrowed));
    }
    warnings
}

/// A warning about triangles whose corners all have one texture coordinate: heights move each of them as a whole.
pub fn untextured_warning(heights: &Heights, mesh: &Mesh) -> Option<String> {
    let mut count = 0;
    for (material, _) in mesh.materials.iter().zip(&heights.of_material).filter(|(_, map)| map.is_some()) {
        let triangles = &mesh.triangles[material.triangles.start as usize..material.triangles.end as usize];
        let is_point = |triangle: &&[u32; 3]| {
            let [a, b, c] = triangle.map(|corner| mesh.corners[corner as usize].uv);
            a == b && b == c
        };
        count += triangles.iter().filter(is_point).count();
    }
    (count > 0).then(|| format!("triangles without texture coordinates, which heights move as a whole: {count}."))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{HeightMap, Shape};

    #[test]
    fn repairs_are_counted_in_sentences_but_normals_that_were_made_are_not() {
        assert!(repair_warnings(&Repairs { normals_made: 3, ..Repairs::default() }).is_empty());
        let all = Repairs { normals_made: 1, normals_replaced: 2, normals_rescaled: 3, denormals: 4 };
        let counts = repair_warnings(&all).iter().map(|warning| warning.chars().rev().nth(1)).collect::<Vec<_>>();
        assert_eq!(counts, [Some('2'), Some('3'), Some('4')]);
    }

    #[test]
    fn a_rim_without_creases_or_without_room_is_warned_of() {
        let of = |creases, narrowed| rim_warnings(&Rim { width: 0.1, creases, narrowed }).len();
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
