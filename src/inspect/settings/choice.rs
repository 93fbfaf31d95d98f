//! Values with names: how the command line, saved settings and the window call the values of an option.

pub(crate) use geometry::choice::choices;
pub use geometry::choice::{Choice, Description, descriptions};

#[cfg(test)]
mod tests {
    use geometry::mesh::UpAxis;
    use geometry::mesh::subdivision::FaceVarying;
    use load::{LengthUnit, NormalSource};

    use super::super::{Colors, Lighting, NormalsAt, Overlay, SurfaceUnit, ToneCurve};
    use geometry::tessellate::{
        Clip, Convention, CurvatureKind, Displacement, Edges, Lod, Normals, Partitioning, Surface,
    };

    use super::*;

    fn check<T: Choice + std::fmt::Debug>() {
        for (index, value) in T::ALL.iter().copied().enumerate() {
            let Description { name, label, text } = value.description();
            assert!(!T::ALL[..index].contains(&value), "{value:?} is listed twice");
            assert_eq!(T::named(name), Some(value), "{value:?}");
            let hlsl = value.description().hlsl_name();
            assert!(hlsl.is_none_or(|hlsl| T::named(&hlsl) == Some(value)), "{value:?}");
            assert!(T::ALL[..index].iter().all(|other| other.label() != label), "{label} is there twice");
            assert!(text.ends_with('.') && text.len() > 10, "{value:?}: {text}");
            assert_eq!(label.trim(), label);
        }
        assert_eq!(T::named("odd"), None);
        assert_eq!(T::named(""), None);
    }

    #[test]
    fn every_value_is_found_by_its_name_and_has_a_text() {
        check::<Surface>();
        check::<Normals>();
        check::<Edges>();
        check::<Partitioning>();
        check::<Lod>();
        check::<Clip>();
        check::<Convention>();
        check::<Displacement>();
        check::<SurfaceUnit>();
        check::<CurvatureKind>();
        check::<NormalsAt>();
        check::<Lighting>();
        check::<ToneCurve>();
        check::<Overlay>();
        check::<Colors>();
        check::<NormalSource>();
        check::<UpAxis>();
        check::<FaceVarying>();
        check::<LengthUnit>();
    }
}
