//! Arithmetic on the numbers of eight triples.

use crate::motion::reprojection::NEAR_M;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Triples at a time: two registers of AVX2, so that one computes while the other waits.
pub(in crate::motion) const LANES: usize = 8;

/// One number of each triple.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lanes(pub [f64; LANES]);

pub(super) const ZERO: Lanes = Lanes::all(0.0);

impl Lanes {
    /// The same number in all lanes.
    pub const fn all(value: f64) -> Self {
        Self([value; LANES])
    }

    /// `operation` on the numbers of each lane.
    #[inline(always)]
    fn zip_with(self, other: Self, operation: impl Fn(f64, f64) -> f64) -> Self {
        let mut out = self;
        for (value, other) in out.0.iter_mut().zip(other.0) {
            *value = operation(*value, other);
        }
        out
    }

    /// These numbers, but `other` in lanes whose `depth_m` is below [`NEAR_M`].
    #[inline(always)]
    pub fn unless_near(self, depth_m: Self, other: f64) -> Self {
        self.zip_with(depth_m, |value, depth_m| if depth_m < NEAR_M { other } else { value })
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.zip_with(self, |value, _| value.sqrt())
    }
}

impl Add for Lanes {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip_with(other, |a, b| a + b)
    }
}

impl Sub for Lanes {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip_with(other, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip_with(other, |a, b| a * b)
    }
}

impl Div for Lanes {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip_with(other, |a, b| a / b)
    }
}

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.zip_with(self, |value, _| -value)
    }
}
