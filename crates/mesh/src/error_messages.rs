//! One way to write what errors say.

/// Implements [`Display`](core::fmt::Display) and [`Error`](core::error::Error) for an enum from a message for each variant. Variants
/// listed after `from` wrap an error: they say what it says, and are made of it by [`From`].
#[doc(hidden)]
#[macro_export]
macro_rules! error_messages {
    (
        $name:ident { $($variant:pat => ($($message:tt)+),)* }
        $(from { $($wrapping:ident($wrapped:ty)),+ })?
    ) => {
        impl core::fmt::Display for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                match self {
                    $($variant => write!(f, $($message)+),)*
                    $($(Self::$wrapping(error) => core::fmt::Display::fmt(error, f),)+)?
                }
            }
        }

        impl core::error::Error for $name {}

        $($(
            impl From<$wrapped> for $name {
                fn from(error: $wrapped) -> Self {
                    Self::$wrapping(error)
                }
            }
        )+)?
    };
}
