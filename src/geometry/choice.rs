//! Enums whose values have names: what the command line, files, the window, documentation and shaders call them is declared once,
//! with the value.

/// What a value is called, and what it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Description {
    /// On the command line and in files: lower case, words joined by hyphens.
    pub name: &'static str,
    /// In the window.
    pub label: &'static str,
    /// Whole sentences for help and hover texts.
    pub text: &'static str,
}

impl Description {
    pub const fn new(name: &'static str, label: &'static str, text: &'static str) -> Self {
        Self { name, label, text }
    }

    /// Returns how HLSL spells the name of a partitioning, where that differs: `fractional_odd`, `fractional_even`.
    pub fn hlsl_name(&self) -> Option<String> {
        self.name.starts_with("fractional-").then(|| self.name.replace('-', "_"))
    }

    /// Whether a text is this name, or HLSL's spelling of it.
    pub fn is_named(&self, text: &str) -> bool {
        text == self.name || self.hlsl_name().is_some_and(|name| name == text)
    }
}

/// A value that is one of several, each with a name.
pub trait Choice: Copy + PartialEq + 'static {
    /// All values, in the order in which lists show them.
    const ALL: &'static [Self];

    fn description(self) -> Description;

    fn name(self) -> &'static str {
        self.description().name
    }

    fn label(self) -> &'static str {
        self.description().label
    }

    fn text(self) -> &'static str {
        self.description().text
    }

    /// The value of that name.
    fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|value| value.description().is_named(name))
    }
}

/// Declares an enum whose values have names: on the command line, in the window, and what each does. The texts are the values'
/// documentation, too. The order is that of lists.
#[macro_export]
macro_rules! choices {
    ($(#[$of_type:meta])* pub enum $type:ident {
        $($(#[$of_variant:meta])* $variant:ident => $name:literal, $label:literal, $text:literal;)+
    }) => {
        $(#[$of_type])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $type {
            $(#[doc = $text] $(#[$of_variant])* $variant),+
        }

        impl $type {
            /// All values, in the order in which lists show them.
            pub const ALL: [Self; [$(stringify!($variant)),+].len()] = [$(Self::$variant),+];
        }

        impl $crate::choice::Choice for $type {
            const ALL: &'static [Self] = &[$(Self::$variant),+];

            fn description(self) -> $crate::choice::Description {
                match self {
                    $(Self::$variant => $crate::choice::Description::new($name, $label, $text),)+
                }
            }
        }
    };
}
pub use choices;

/// Declares an enum each of whose values has a text, which the named function returns.
#[macro_export]
macro_rules! texts {
    ($(#[$of_type:meta])* pub enum $type:ident, $(#[$of_function:meta])* fn $function:ident {
        $($(#[$of_variant:meta])* $variant:ident => $text:expr,)+
    }) => {
        $(#[$of_type])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $type {
            $($(#[$of_variant])* $variant),+
        }

        impl $type {
            /// All values, in the order of their declaration.
            pub const ALL: [Self; [$(stringify!($variant)),+].len()] = [$(Self::$variant),+];

            $(#[$of_function])*
            pub const fn $function(self) -> &'static str {
                match self {
                    $(Self::$variant => $text,)+
                }
            }
        }
    };
}
pub use texts;

/// The descriptions of all values, in the order in which lists show them.
pub fn descriptions<T: Choice>() -> Vec<Description> {
    T::ALL.iter().map(|value| value.description()).collect()
}
