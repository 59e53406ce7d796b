//! An image as it was recorded, and what is stored of it.

use furrow_catalog::Views;
use furrow_catalog::images::encoding::{is_deep_encoding, mosaic_of_encoding};
use furrow_catalog::images::{
    BayerPattern, Depth, ImageError, LookupTable, LoosePixels, RawImage, RawPixels, SeenPixels, Side, decode_colour,
    decode_grey, inspect,
};
use furrow_model::GreyImage;
use std::sync::Arc;

/// An image as it was recorded.
#[derive(Debug, Clone)]
pub(crate) enum Picture {
    /// An image file: JPEG, PNG, PGM or PPM.
    Compressed(Vec<u8>),
    /// An image file whose message says that it holds a mosaic.
    Mosaic(BayerPattern, Vec<u8>),
    /// An image file that a table undistorts before it is stored; where it is a mosaic, its colours are resolved first.
    Distorted { bytes: Vec<u8>, bayer: Option<BayerPattern>, table: Arc<LookupTable> },
    /// Raw pixels.
    Raw { width: usize, height: usize, step: usize, encoding: String, big_endian: bool, data: Vec<u8> },
    /// A message of which only the header can be decoded, and what is wrong with the rest.
    Broken(String),
}

impl Picture {
    /// The bytes that are stored, and the rectified grey view. The image is decoded once. 16-bit pixels are scaled by
    /// the recording's `depth`.
    pub(crate) fn encode_and_rectify(
        self,
        side: Side,
        views: &Views,
        depth: Depth,
    ) -> Result<(Vec<u8>, GreyImage), ImageError> {
        let store = |image: &RawImage<'_>| {
            let pixels = RawPixels::of_depth(image, depth)?;
            Ok((pixels.store()?.bytes, views.grey_of_pixels(side, &pixels)?))
        };
        if let Self::Raw { .. } = self {
            check_mosaic(self.bayer_pattern(), views.bayer(side))?;
        }
        match self {
            Self::Compressed(bytes) | Self::Mosaic(_, bytes) => match LoosePixels::of_file(&bytes)? {
                Some(loose) => store(&loose.as_raw()),
                None => views.grey(side, &bytes).map(|view| (bytes, view)),
            },
            Self::Raw { width, height, step, encoding, big_endian, data } => {
                store(&RawImage { width, height, step, encoding: &encoding, big_endian, data: &data })
            }
            Self::Distorted { bytes, bayer, table } => {
                let image = table.apply(&decode_colour(&bytes, bayer)?)?;
                let (width, height) = (image.width, image.height);
                store(&RawImage {
                    width,
                    height,
                    step: 3 * width,
                    encoding: "rgb8",
                    big_endian: false,
                    data: &image.rgb,
                })
            }
            Self::Broken(fault) => Err(ImageError::Message { fault }),
        }
    }

    /// Decodes the image for nothing but to see whether it can be.
    pub(crate) fn check(&self) -> Result<(), ImageError> {
        match self {
            Self::Compressed(bytes) | Self::Mosaic(_, bytes) => match LoosePixels::of_file(bytes)? {
                Some(_) => Ok(()),
                None => decode_grey(bytes, None).map(|_| ()),
            },
            Self::Distorted { bytes, bayer, .. } => decode_colour(bytes, *bayer).map(|_| ()),
            Self::Raw { .. } => self.as_raw().map_or(Ok(()), |image| RawPixels::of(&image).map(|_| ())),
            Self::Broken(fault) => Err(ImageError::Message { fault: fault.clone() }),
        }
    }

    /// Columns and rows.
    pub(crate) fn size(&self) -> Result<(u32, u32), ImageError> {
        match self {
            Self::Compressed(bytes) | Self::Mosaic(_, bytes) | Self::Distorted { bytes, .. } => {
                LoosePixels::size_of_file(bytes)
            }
            Self::Raw { width, height, .. } => Ok((*width as u32, *height as u32)),
            Self::Broken(fault) => Err(ImageError::Message { fault: fault.clone() }),
        }
    }

    /// The Bayer pattern of its pixels; `None` where they are no mosaic. A file of several channels is none, whatever
    /// its message says: its publisher resolved the colours.
    pub(crate) fn bayer_pattern(&self) -> Option<BayerPattern> {
        match self {
            Self::Raw { encoding, .. } => mosaic_of_encoding(encoding),
            Self::Mosaic(pattern, bytes) => match inspect(bytes) {
                Ok(header) => (!header.colour).then_some(*pattern),
                Err(_) => LoosePixels::of_file(bytes).ok().flatten().filter(LoosePixels::is_grey).map(|_| *pattern),
            },
            Self::Compressed(_) | Self::Distorted { .. } | Self::Broken(_) => None,
        }
    }

    /// Whether it has 16-bit pixels, of which a camera may use only some.
    pub(crate) fn is_deep(&self) -> bool {
        match self {
            Self::Compressed(bytes) | Self::Mosaic(_, bytes) => {
                LoosePixels::of_file(bytes).is_ok_and(|loose| loose.is_some_and(|loose| loose.is_deep()))
            }
            Self::Raw { encoding, .. } => is_deep_encoding(encoding),
            Self::Distorted { .. } | Self::Broken(_) => false,
        }
    }

    /// Adds its 16-bit pixels, if it has such, to those seen of its recording.
    pub(crate) fn show(&self, seen: &mut SeenPixels) {
        match self {
            Self::Compressed(bytes) | Self::Mosaic(_, bytes) => {
                if let Ok(Some(loose)) = LoosePixels::of_file(bytes) {
                    seen.add_image(&loose.as_raw());
                }
            }
            Self::Raw { .. } => {
                if let Some(image) = self.as_raw() {
                    seen.add_image(&image);
                }
            }
            Self::Distorted { .. } | Self::Broken(_) => {}
        }
    }

    fn as_raw(&self) -> Option<RawImage<'_>> {
        match *self {
            Self::Raw { width, height, step, ref encoding, big_endian, ref data } => {
                Some(RawImage { width, height, step, encoding, big_endian, data })
            }
            _ => None,
        }
    }
}

/// Refuses a raw image whose mosaic is not the recording's: its colours would be resolved wrongly.
fn check_mosaic(found: Option<BayerPattern>, expected: Option<BayerPattern>) -> Result<(), ImageError> {
    if found == expected {
        return Ok(());
    }
    let name = |pattern: Option<BayerPattern>| {
        pattern.map_or("none".to_owned(), |pattern| format!("{pattern:?}").to_lowercase())
    };
    Err(ImageError::OtherMosaic { found: name(found), expected: name(expected) })
}
