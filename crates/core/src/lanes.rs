//! Four numbers at once. The compiler makes vector instructions of them where the processor has some; each lane is rounded as a
//! single number would be, so that results are the same on every processor.
//!
//! Comparisons give masks, which select among numbers.

use core::array::from_fn;
use core::ops::{Add, AddAssign, BitAnd, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// What is so of which of four numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mask([bool; 4]);

impl Mask {
    pub(crate) const ALL: Self = Self([true; 4]);

    #[inline(always)]
    pub(crate) fn any(self) -> bool {
        let [a, b, c, d] = self.0;
        a | b | c | d
    }

    /// By lane the first number where it is so, and else the second.
    #[inline(always)]
    pub(crate) fn select<L: Lanes>(self, so: L, otherwise: L) -> L {
        L::selected(self, so, otherwise)
    }
}

impl BitAnd for Mask {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(from_fn(|lane| self.0[lane] & other.0[lane]))
    }
}

/// What masks select.
pub(crate) trait Lanes {
    /// See [`Mask::select`].
    fn selected(mask: Mask, so: Self, otherwise: Self) -> Self;
}

/// Implements an operator lane by lane, also with a single number on either side.
macro_rules! operator {
    ($lanes:ident, $real:ty, $operator:ident, $function:ident) => {
        impl $operator for $lanes {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(from_fn(|lane| self.0[lane].$function(other.0[lane])))
            }
        }

        impl $operator<$real> for $lanes {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: $real) -> Self {
                self.$function(Self::splat(other))
            }
        }

        impl $operator<$lanes> for $real {
            type Output = $lanes;
            #[inline(always)]
            fn $function(self, other: $lanes) -> $lanes {
                $lanes::splat(self).$function(other)
            }
        }
    };
}

macro_rules! comparison {
    ($function:ident, $operator:tt) => {
        #[inline(always)]
        pub(crate) fn $function(self, other: Self) -> Mask {
            Mask(from_fn(|lane| self.0[lane] $operator other.0[lane]))
        }
    };
}

macro_rules! assignment {
    ($lanes:ident, $operator:ident, $function:ident, $by:ident) => {
        impl $operator for $lanes {
            #[inline(always)]
            fn $function(&mut self, other: Self) {
                *self = self.$by(other);
            }
        }
    };
}

macro_rules! lanes {
    ($(#[$about:meta])* $lanes:ident, $real:ty) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        #[repr(align(16))]
        pub(crate) struct $lanes([$real; 4]);

        #[allow(dead_code, reason = "each of the two kinds needs other parts")]
        impl $lanes {
            pub(crate) const ZERO: Self = Self::splat(0.0);
            pub(crate) const ONE: Self = Self::splat(1.0);

            #[inline(always)]
            pub(crate) const fn new(lanes: [$real; 4]) -> Self {
                Self(lanes)
            }

            #[inline(always)]
            pub(crate) const fn splat(number: $real) -> Self {
                Self([number; 4])
            }

            #[inline(always)]
            pub(crate) const fn to_array(self) -> [$real; 4] {
                self.0
            }

            #[inline(always)]
            pub(crate) fn abs(self) -> Self {
                Self(self.0.map(<$real>::abs))
            }

            #[inline(always)]
            pub(crate) fn sqrt(self) -> Self {
                Self(self.0.map(<$real>::sqrt))
            }

            /// The greater of each two; the other's where one is NaN.
            #[inline(always)]
            pub(crate) fn fast_max(self, other: Self) -> Self {
                Self(from_fn(|lane| {
                    let (a, b) = (self.0[lane], other.0[lane]);
                    if a > b { a } else { b }
                }))
            }

            /// The smaller of each two; the other's where one is NaN.
            #[inline(always)]
            pub(crate) fn fast_min(self, other: Self) -> Self {
                Self(from_fn(|lane| {
                    let (a, b) = (self.0[lane], other.0[lane]);
                    if a < b { a } else { b }
                }))
            }

            comparison!(simd_gt, >);
            comparison!(simd_ge, >=);
            comparison!(simd_lt, <);
            comparison!(simd_le, <=);

            /// The sum of the lanes.
            #[inline(always)]
            pub(crate) fn sum(self) -> $real {
                let [a, b, c, d] = self.0;
                (a + b) + (c + d)
            }
        }

        impl Lanes for $lanes {
            #[inline(always)]
            fn selected(mask: Mask, so: Self, otherwise: Self) -> Self {
                Self(from_fn(|lane| {
                    if mask.0[lane] {
                        so.0[lane]
                    } else {
                        otherwise.0[lane]
                    }
                }))
            }
        }

        impl From<[$real; 4]> for $lanes {
            #[inline(always)]
            fn from(lanes: [$real; 4]) -> Self {
                Self(lanes)
            }
        }

        impl Neg for $lanes {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self(self.0.map(|lane| -lane))
            }
        }

        operator!($lanes, $real, Add, add);
        operator!($lanes, $real, Sub, sub);
        operator!($lanes, $real, Mul, mul);
        operator!($lanes, $real, Div, div);
        assignment!($lanes, AddAssign, add_assign, add);
        assignment!($lanes, SubAssign, sub_assign, sub);
        assignment!($lanes, MulAssign, mul_assign, mul);
    };
}

lanes!(
    /// Four numbers in double precision.
    F64x4,
    f64
);
lanes!(
    /// Four numbers in single precision.
    F32x4,
    f32
);
