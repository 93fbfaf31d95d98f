//! What the halves of a split picture show, in words, and these words in a picture.

use image::RgbaImage;

use super::legend::plate_of_lines;
use crate::engine::Loaded;
use crate::plot::ChartError;
use crate::settings::{Choice, Declaration, Settings, SplitSide, options};
use geometry::names::shown;

/// The colour of the divider.
const DIVIDER: image::Rgba<u8> = image::Rgba([190, 190, 190, 255]);

/// What is known of a half beside its settings.
#[derive(Clone, Debug, Default)]
pub struct HalfFacts {
    /// What the mesh is called, if the halves show different ones: see [`mesh_title`].
    pub mesh: Vec<String>,
    /// Its pose, if they have different ones.
    pub pose: Option<String>,
    /// The name of a shader in place of the surface.
    pub shader: Option<String>,
    /// The largest distance from the reference surface.
    pub largest: Option<String>,
    /// How many are emitted.
    pub triangles: Option<u64>,
    pub cracked_edges: Option<u64>,
}

/// The surface that a half shows, by name.
pub fn surface_title(settings: &Settings, half: SplitSide) -> &'static str {
    match half {
        SplitSide::Left => settings.left_surface().map_or("untessellated", |surface| surface.label()),
        SplitSide::Right => settings.tessellation.surface.label(),
    }
}

/// What the mesh of a half is called beside that of the other one: by its name and the weights that were chosen for its morph
/// targets, as far as these differ. The left one is the first of the meshes and of their names.
pub fn mesh_title(half: SplitSide, meshes: [&Loaded; 2], names: [String; 2]) -> Vec<String> {
    let [own, other] = [half as usize, 1 - half as usize].map(|of| &meshes[of].preparation.parts.morphs);
    let unlike = own.iter().filter(|(name, weight)| other.get(*name) != Some(*weight));
    let weights: Vec<_> = unlike.map(|(name, weight)| format!("{name} {weight}")).collect();
    let name = if names[0] == names[1] { "" } else { &names[half as usize] };
    let words = [name.to_owned(), shown(&weights.join(", "))];
    words.into_iter().filter(|text| !text.is_empty()).collect()
}

/// The title of a half: the mesh and the surface, what else differs between the halves, and what was counted.
pub fn half_title(settings: &Settings, half: SplitSide, facts: HalfFacts) -> String {
    let HalfFacts { mesh, pose, shader, largest, triangles, cracked_edges } = facts;
    let name = shader.unwrap_or_else(|| surface_title(settings, half).to_owned());
    let name = mesh.into_iter().chain(pose).chain([name]).collect::<Vec<_>>().join(", ");
    let first = largest.map_or_else(|| name.clone(), |largest| format!("{name}: {largest}"));
    let counts = [counted(triangles, "triangle"), counted(cracked_edges, "cracked edge")];
    let lines = [vec![first], differing(settings, half), counts.into_iter().flatten().collect()];
    lines.into_iter().filter(|line| !line.is_empty()).map(|line| line.join(", ")).collect::<Vec<_>>().join("\n")
}

/// What a half has otherwise than the other one, beside the surface.
fn differing(settings: &Settings, half: SplitSide) -> Vec<String> {
    let [left, right] = SplitSide::BOTH.map(|half| settings.half(half).unwrap_or(*settings));
    let own = if half == SplitSide::Left { &left } else { &right };
    let differs = |option: &&Declaration| {
        option.name != options::SURFACE.name
            && option.get(&left) != option.get(&right)
            && (option.no_effect)(own).is_none()
    };
    let compared = options::TESSELLATION.into_iter().filter(|_| settings.has_left_tessellation());
    compared.chain(options::LOOKS).filter(differs).map(|option| option.shown(own)).collect()
}

fn counted(count: Option<u64>, one: &str) -> Option<String> {
    count.map(|count| geometry::numbers::counted(count, one))
}

/// Draws the divider, if there is one, and the titles of both halves beside it or the middle.
///
/// # Errors
/// The font can't be used.
pub(super) fn draw_titles(picture: &mut RgbaImage, split: Option<f32>, titles: &[String; 2]) -> Result<(), ChartError> {
    let (width, height) = picture.dimensions();
    let at = (split.unwrap_or(0.5).clamp(0.0, 1.0) * width as f32).round() as u32;
    let columns = at.saturating_sub(1)..(at + 1).min(width);
    for x in columns.filter(|_| split.is_some()) {
        (0..height).for_each(|y| picture.put_pixel(x, y, DIVIDER));
    }
    for (half, title) in SplitSide::BOTH.into_iter().zip(titles) {
        let (plate, margin) = plate_of_lines(picture.dimensions(), &title.lines().collect::<Vec<_>>())?;
        let left = match half {
            SplitSide::Left => i64::from(at) - i64::from(plate.width() + margin),
            SplitSide::Right => i64::from(at + margin),
        };
        image::imageops::replace(picture, &plate, left, margin.into());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Preparation;
    use load::ShownParts;

    #[test]
    fn meshes_are_called_by_what_differs() {
        let weighed = |morphs: &[(&str, f32)]| {
            let morphs = morphs.iter().map(|(name, weight)| ((*name).to_owned(), *weight)).collect();
            let parts = ShownParts { morphs, ..ShownParts::default() };
            Loaded { preparation: Preparation { parts, ..Preparation::default() }, ..Loaded::default() }
        };
        let [left, right] = [weighed(&[("Blink", 1.0), ("Smile", 0.7)]), weighed(&[("Blink", 1.0), ("Frown", 0.5)])];
        let called = |names: [&str; 2]| {
            SplitSide::BOTH.map(|half| mesh_title(half, [&left, &right], names.map(str::to_owned)).join(", "))
        };
        assert_eq!(called(["a", "a"]), ["Smile 0.7", "Frown 0.5"]);
        assert_eq!(called(["a", "b"]), ["a, Smile 0.7", "b, Frown 0.5"]);
        let same = mesh_title(SplitSide::Left, [&left, &left], ["a", "a"].map(str::to_owned));
        assert!(same.is_empty(), "{same:?}");
    }
}
