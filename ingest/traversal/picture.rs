//! An image as it was recorded, and what is stored of it.

use furrow_catalog::Views;
use furrow_catalog::images::{BayerPattern, ImageError, RawImage, RawPixels, Side, inspect};
use furrow_model::GreyImage;

/// An image as it was recorded.
pub(crate) enum Picture {
    /// A JPEG or PNG file.
    Compressed(Vec<u8>),
    /// Raw pixels.
    Raw { width: usize, height: usize, step: usize, encoding: String, big_endian: bool, data: Vec<u8> },
}

impl Picture {
    /// The bytes that are stored, and the rectified grey view. The image is decoded once.
    pub(crate) fn encode_and_rectify(self, side: Side, views: &Views) -> Result<(Vec<u8>, GreyImage), ImageError> {
        match self {
            Self::Compressed(bytes) => views.grey(side, &bytes).map(|view| (bytes, view)),
            Self::Raw { width, height, step, encoding, big_endian, data } => {
                let image = RawImage { width, height, step, encoding: &encoding, big_endian, data: &data };
                let pixels = RawPixels::of(&image)?;
                Ok((pixels.store()?.bytes, views.grey_of_pixels(side, &pixels)?))
            }
        }
    }

    /// Columns and rows.
    pub(crate) fn size(&self) -> Result<(u32, u32), ImageError> {
        match self {
            Self::Compressed(bytes) => inspect(bytes).map(|header| (header.width as u32, header.height as u32)),
            Self::Raw { width, height, .. } => Ok((*width as u32, *height as u32)),
        }
    }

    /// The Bayer pattern of raw pixels; `None` where they are no mosaic.
    pub(crate) fn bayer_pattern(&self) -> Option<BayerPattern> {
        let Self::Raw { encoding, .. } = self else { return None };
        match encoding.as_str() {
            "bayer_rggb8" => Some(BayerPattern::Rggb),
            "bayer_bggr8" => Some(BayerPattern::Bggr),
            "bayer_gbrg8" => Some(BayerPattern::Gbrg),
            "bayer_grbg8" => Some(BayerPattern::Grbg),
            _ => None,
        }
    }
}
