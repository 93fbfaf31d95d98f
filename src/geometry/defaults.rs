//! Structs that say behind each field what it is by default.

/// Declares a struct and its default: every field is followed by its value.
#[macro_export]
macro_rules! with_defaults {
    ($(#[$of_type:meta])* $seen:vis struct $type:ident {
        $($(#[$of_field:meta])* $shown:vis $field:ident: $kind:ty = $value:expr,)+
    }) => {
        $(#[$of_type])*
        $seen struct $type {
            $($(#[$of_field])* $shown $field: $kind),+
        }

        impl Default for $type {
            fn default() -> Self {
                Self { $($field: $value),+ }
            }
        }
    };
}
pub use with_defaults;
