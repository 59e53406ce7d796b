//! All generators behind one name.

use crate::chance::seed_of;
use crate::flow::flow;
use crate::invariant::Invariant;
use crate::otf::Otf;
use crate::planes::{Workspace, check_size};
use crate::relight::Shading;
use crate::{DOMAINNESS, GenerateError, placebo, sensor};
use furrow_model::ColourImage;
use serde::{Deserialize, Serialize};

/// A generator that runs here. Plain data: its JSON is the model that a store names by its bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Generator {
    /// Optimal-transport flow between two trained domains.
    Otf(Box<Otf>),
    /// The illumination-invariant image.
    Invariant(Invariant),
    /// Placebo: the image itself.
    Identity,
    /// Placebo: grey levels to the power of this, above 0.
    Gamma(f64),
    /// Placebo: noise of this deviation in grey levels.
    Noise(f64),
    /// Placebo: a blur of this deviation in pixels of an image 640 wide.
    Blur(f64),
}

/// What chance depends on beside the pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Seed {
    /// The user's.
    pub seed: u64,
    /// The image's header stamp.
    pub stamp_ns: i64,
}

impl Generator {
    /// The kind's name: `otf`, `invariant`, `identity`, `gamma`, `noise` or `blur`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Otf(_) => "otf",
            Self::Invariant(_) => "invariant",
            Self::Identity => "identity",
            Self::Gamma(_) => "gamma",
            Self::Noise(_) => "noise",
            Self::Blur(_) => "blur",
        }
    }

    /// The name of a generator that needs no training, as [`Generator::named`] reads it; `otf` for a trained one.
    pub fn name(&self) -> String {
        match self {
            Self::Gamma(number) | Self::Noise(number) | Self::Blur(number) => format!("{}:{number}", self.kind()),
            _ => self.kind().to_owned(),
        }
    }

    /// Whether it relights images, and so needs the shading of each.
    pub fn relights(&self) -> bool {
        matches!(self, Self::Otf(otf) if otf.strengths.relight > 0.0)
    }

    /// `image` moved by `z`; 0 gives the image itself to within a grey level. Chance depends on `seed` and nothing
    /// else.
    ///
    /// # Errors
    /// [`GenerateError::Domainness`] for z outside [`DOMAINNESS`], [`GenerateError::Size`] where the pixels do not fill
    /// the image, [`GenerateError::NoShading`] of a generator that relights.
    pub fn apply(
        &self,
        image: &ColourImage,
        z: f64,
        seed: Seed,
        workspace: &mut Workspace,
    ) -> Result<ColourImage, GenerateError> {
        self.apply_lit(image, z, seed, None, workspace)
    }

    /// As [`Generator::apply`], with what relights this image; generators that do not relight leave it alone.
    ///
    /// # Errors
    /// As [`Generator::apply`].
    pub fn apply_lit(
        &self,
        image: &ColourImage,
        z: f64,
        seed: Seed,
        shading: Option<&Shading>,
        workspace: &mut Workspace,
    ) -> Result<ColourImage, GenerateError> {
        if !(DOMAINNESS[0]..=DOMAINNESS[1]).contains(&z) {
            return Err(GenerateError::Domainness { found: z });
        }
        check_size(image)?;
        let seed = seed_of(seed.seed, seed.stamp_ns as u64);
        let rgb = match self {
            Self::Otf(otf) => {
                otf.check()?;
                let shading = match (self.relights(), shading) {
                    (false, _) => None,
                    (true, Some(shading)) => Some(shading),
                    (true, None) => return Err(GenerateError::NoShading),
                };
                let mut rgb = flow(otf, image, z, shading, workspace.planes_of(image)?);
                let added = otf.noise.added(z * otf.strengths.sensor);
                if added > 0.0 {
                    sensor::add_noise(&mut rgb, added, seed);
                }
                rgb
            }
            Self::Invariant(invariant) => invariant.apply(image, z),
            Self::Identity => image.rgb.clone(),
            Self::Gamma(exponent) => placebo::gamma(image, libm::pow(*exponent, z)),
            Self::Noise(deviation) => placebo::noise(image, z.max(0.0) * deviation, seed),
            Self::Blur(sigma) => placebo::blur(image, z.max(0.0) * sigma),
        };
        Ok(ColourImage { width: image.width, height: image.height, rgb })
    }
}
