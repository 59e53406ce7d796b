//! Optimal-transport flow, the built-in generator (Monge-Kantorovich transport of Gaussians, Pitié and Kokaram 2007):
//! per cell, the colours of one time of day are carried onto those of another.
//!
//! The map of a pixel is affine in its log-opponent colour with coefficients that vary slowly over the image, so what a
//! descriptor sees, which ignores such maps, is kept; and since z moves along the transport's straight way, no z is a
//! jump.

use crate::bands::BANDS;
use crate::cells::CELLS;
use crate::moments::{CellSums, Moments};
use crate::sensor::Noise;
use crate::shadow::{CellShade, Shades};
use crate::transport::Transport;
use crate::{GenerateError, shadow};
use serde::{Deserialize, Serialize};

/// How strongly the optional stages work; 0 is off.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Strengths {
    /// The camera's noise moves towards the target's.
    pub sensor: f64,
    /// The contrast between light and shadow moves towards the target's.
    pub shadow: f64,
    /// Surfaces brighten and darken as they face the target's sun or turn away from it. Not written where it is off:
    /// what was trained and remembered without it keeps its name.
    #[serde(skip_serializing_if = "is_off")]
    pub relight: f64,
}

fn is_off(strength: &f64) -> bool {
    *strength == 0.0
}

/// A trained flow: plain data, so that its bytes name it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Otf {
    /// The cells' maps, row by row ([`CELLS`]).
    pub cells: Vec<CellMap>,
    /// The camera's noise in both domains.
    pub noise: Noise,
    /// Light and shadow in both domains, as many as cells.
    pub shades: Vec<CellShade>,
    /// The optional stages.
    pub strengths: Strengths,
}

/// The map of one cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CellMap {
    /// Mean of (base, o1, o2) in the source domain.
    pub source: [f64; 3],
    /// The same in the target domain.
    pub target: [f64; 3],
    /// Carries the colours around the one mean onto those around the other.
    pub transport: Transport,
    /// Logarithms of the bands' gains at z = 1.
    pub log_gains: [f64; BANDS],
}

/// How much of a cell's covariance is its own, how much the whole image's, and how much is added to its diagonal.
const OWN: f64 = 0.7;
const GLOBAL: f64 = 0.3;
const RIDGE: f64 = 0.02;
/// Added to the bands' energies, and how far their ratio may go.
const BAND_FLOOR: f64 = 1e-4;
const GAIN: [f64; 2] = [0.5, 2.0];
/// A cell with less than this share of the image's weight counts as one without pixels: it follows the whole image.
const LEAST_SHARE: f64 = 1e-4;

impl Otf {
    /// The flow from one domain to another.
    ///
    /// # Errors
    /// [`GenerateError::NoPixels`] where a domain has none, [`GenerateError::Parameter`] for strengths that are not
    /// numbers from 0 to 4.
    pub fn train(source: &Moments, target: &Moments, strengths: Strengths) -> Result<Self, GenerateError> {
        for (what, found) in [
            ("strength of the sensor stage", strengths.sensor),
            ("strength of the shadow stage", strengths.shadow),
            ("strength of the relight stage", strengths.relight),
        ] {
            if !(0.0..=4.0).contains(&found) {
                return Err(GenerateError::Parameter { what, found, expected: "0 (off) to 4" });
            }
        }
        let (source_domain, target_domain) = (Domain::of(source, "source")?, Domain::of(target, "target")?);
        let cell = |i: usize| {
            let (a, b) = (source_domain.cell(i), target_domain.cell(i));
            let gain =
                |k: usize| ((b.energy[k] + BAND_FLOOR) / (a.energy[k] + BAND_FLOOR)).sqrt().clamp(GAIN[0], GAIN[1]);
            CellMap {
                source: a.mean,
                target: b.mean,
                transport: Transport::between(&a.covariance, &b.covariance),
                log_gains: std::array::from_fn(|k| libm::log(gain(k))),
            }
        };
        Ok(Self {
            cells: (0..CELLS).map(cell).collect(),
            noise: Noise::between(&source.noise, &target.noise),
            shades: shadow::changes(&Shades::fit(&source.shades), &Shades::fit(&target.shades)),
            strengths,
        })
    }

    /// Whether the numbers are those of a model: what [`Otf::train`] gives always is.
    ///
    /// # Errors
    /// [`GenerateError::Damaged`] naming what is not.
    pub fn check(&self) -> Result<(), GenerateError> {
        let damaged = |what: String| Err(GenerateError::Damaged(what));
        if self.cells.len() != CELLS || self.shades.len() != CELLS {
            return damaged(format!("it has {} cells and {} shades, not {CELLS}", self.cells.len(), self.shades.len()));
        }
        let numbers = self.cells.iter().flat_map(|cell| {
            let transport = cell.transport.stretch.into_iter().chain(cell.transport.axes.into_iter().flatten());
            cell.source.into_iter().chain(cell.target).chain(cell.log_gains).chain(transport)
        });
        let shades = self.shades.iter().flat_map(CellShade::numbers);
        let Strengths { sensor, shadow, relight } = self.strengths;
        let others = [self.noise.source, self.noise.target, sensor, shadow, relight];
        if numbers.chain(shades).chain(others).any(|number| !number.is_finite()) {
            return damaged("it has numbers that are not finite".to_owned());
        }
        Ok(())
    }
}

/// A domain's Gaussians.
struct Domain<'a> {
    moments: &'a Moments,
    global: Gaussian,
    weight: f64,
}

struct Gaussian {
    mean: [f64; 3],
    covariance: [[f64; 3]; 3],
    energy: [f64; BANDS],
}

impl Gaussian {
    fn of(sums: &CellSums) -> Option<Self> {
        Some(Self { mean: sums.mean()?, covariance: sums.covariance()?, energy: sums.band_energy()? })
    }
}

impl<'a> Domain<'a> {
    fn of(moments: &'a Moments, domain: &'static str) -> Result<Self, GenerateError> {
        let sums = moments.global();
        let global = Gaussian::of(&sums).ok_or(GenerateError::NoPixels { domain })?;
        Ok(Self { moments, global, weight: sums.weight })
    }

    /// A cell's Gaussian, its covariance drawn towards the whole image's.
    fn cell(&self, i: usize) -> Gaussian {
        let sums = self.moments.cells.get(i).filter(|sums| sums.weight > LEAST_SHARE * self.weight);
        let own = sums.and_then(Gaussian::of);
        let own = own.as_ref().unwrap_or(&self.global);
        let drawn = |i: usize, j: usize| {
            let ridge = if i == j { RIDGE } else { 0.0 };
            OWN * own.covariance[i][j] + GLOBAL * self.global.covariance[i][j] + ridge
        };
        let covariance = std::array::from_fn(|i| std::array::from_fn(|j| drawn(i, j)));
        Gaussian { mean: own.mean, covariance, energy: own.energy }
    }
}
