//! Comparisons that show both values and the case where they fail.

/// Compares two values; shows both, and the case they belong to, where the comparison fails.
#[doc(hidden)]
#[macro_export]
macro_rules! ordered {
    ($a:expr, $order:tt, $b:expr, $($case:tt)+) => {
        match (&$a, &$b) {
            (a, b) => assert!(
                *a $order *b,
                "{}: {} is {a:?}, and not {} {b:?}",
                format_args!($($case)+),
                stringify!($a),
                stringify!($order)
            ),
        }
    };
}

/// Fails unless the first value is at most the second.
#[macro_export]
macro_rules! at_most {
    ($a:expr, $b:expr) => { $crate::ordered!($a, <=, $b, "") };
    ($a:expr, $b:expr, $($case:tt)+) => { $crate::ordered!($a, <=, $b, $($case)+) };
}

/// Fails unless the first value is at least the second.
#[macro_export]
macro_rules! at_least {
    ($a:expr, $b:expr) => { $crate::ordered!($a, >=, $b, "") };
    ($a:expr, $b:expr, $($case:tt)+) => { $crate::ordered!($a, >=, $b, $($case)+) };
}

/// Fails unless the first value is below the second.
#[macro_export]
macro_rules! below {
    ($a:expr, $b:expr) => { $crate::ordered!($a, <, $b, "") };
    ($a:expr, $b:expr, $($case:tt)+) => { $crate::ordered!($a, <, $b, $($case)+) };
}

/// Fails unless the first value is above the second.
#[macro_export]
macro_rules! above {
    ($a:expr, $b:expr) => { $crate::ordered!($a, >, $b, "") };
    ($a:expr, $b:expr, $($case:tt)+) => { $crate::ordered!($a, >, $b, $($case)+) };
}
