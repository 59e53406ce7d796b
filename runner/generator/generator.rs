//! All generators behind one name.

use crate::chance::seed_of;
use crate::flow::{Planes, flow};
use crate::invariant::Invariant;
use crate::otf::Otf;
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

/// Memory of one worker, used again from image to image.
#[derive(Debug, Default)]
pub struct Workspace {
    planes: Planes,
}

impl Workspace {
    /// An image in log-opponent colours and scales.
    pub(crate) fn planes_of(&mut self, image: &ColourImage) -> Result<&mut Planes, GenerateError> {
        check(image)?;
        self.planes.fill(image);
        Ok(&mut self.planes)
    }
}

fn check(image: &ColourImage) -> Result<(), GenerateError> {
    let (width, height, values) = (image.width, image.height, image.rgb.len());
    if values == 0 || width.checked_mul(height).and_then(|pixels| pixels.checked_mul(3)) != Some(values) {
        return Err(GenerateError::Size { width, height, values });
    }
    Ok(())
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

    /// The generator of a name that needs no training: `identity`, `invariant`, `gamma:0.8`, `noise:3`, `blur:0.8`; `None` for other names.
    ///
    /// # Errors
    /// [`GenerateError::Parameter`] for numbers that make no sense.
    pub fn named(name: &str) -> Option<Result<Self, GenerateError>> {
        let (kind, number) = name.split_once(':').map_or((name, None), |(kind, number)| (kind, Some(number)));
        let parameter = |make: fn(f64) -> Self, default: f64, range: std::ops::RangeInclusive<f64>, what, expected| {
            let found = number.map_or(default, |number| number.parse().unwrap_or(f64::NAN));
            Some(if range.contains(&found) {
                Ok(make(found))
            } else {
                Err(GenerateError::Parameter { what, found, expected })
            })
        };
        match kind {
            "identity" if number.is_none() => Some(Ok(Self::Identity)),
            "invariant" if number.is_none() => Some(Ok(Self::Invariant(Invariant::default()))),
            "gamma" => parameter(Self::Gamma, 0.8, 0.1..=10.0, "the exponent of gamma", "0.1 to 10, as in gamma:0.8"),
            "noise" => {
                parameter(Self::Noise, 3.0, 0.0..=64.0, "the deviation of noise", "0 to 64 grey levels, as in noise:3")
            }
            "blur" => parameter(Self::Blur, 0.8, 0.0..=32.0, "the width of blur", "0 to 32 pixels, as in blur:0.8"),
            _ => None,
        }
    }

    /// The name of a generator that needs no training, as [`Generator::named`] reads it; `otf` for a trained one.
    pub fn name(&self) -> String {
        match self {
            Self::Gamma(number) | Self::Noise(number) | Self::Blur(number) => format!("{}:{number}", self.kind()),
            _ => self.kind().to_owned(),
        }
    }

    /// Whether it knows nothing of any hour.
    pub fn is_placebo(&self) -> bool {
        !matches!(self, Self::Otf(_) | Self::Invariant(_))
    }

    /// Whether it relights images, and so needs the shading of each.
    pub fn relights(&self) -> bool {
        matches!(self, Self::Otf(otf) if otf.strengths.relight > 0.0)
    }

    /// `image` moved by `z`; 0 gives the image itself to within a grey level. Chance depends on `seed` and nothing else.
    ///
    /// # Errors
    /// [`GenerateError::Domainness`] for z outside [`DOMAINNESS`], [`GenerateError::Size`] where the pixels do not fill the image,
    /// [`GenerateError::NoShading`] of a generator that relights.
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
        check(image)?;
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
