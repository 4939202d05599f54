//! What errors say: a line of text for each variant.

/// Implements `core::fmt::Display` and `core::error::Error` for an error without a source.
///
/// `error_text!(Name { pattern => "text", .. })`: patterns of `Self`, whose names the text may hold in
/// braces; values for its empty braces stand in parentheses behind it.
macro_rules! error_text {
    ($name:ident { $($variant:pat => $text:literal $(($($value:expr),+))?),+ $(,)? }) => {
        impl core::fmt::Display for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                match self {
                    $($variant => write!(f, $text $(, $($value),+)?),)+
                }
            }
        }

        impl core::error::Error for $name {}
    };
}
