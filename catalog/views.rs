//! Rectified views of stored images: what odometry, features and pages look at.

use crate::images::{
    BayerPattern, CalibrationError, ColourImage, ImageError, RawPixels, Rectifier, Side, SingleCamera, decode_colour,
    decode_grey,
};
use crate::records::{self, Cameras, ViewsRecord};
use crate::{CatalogError, Objects};
use furrow_model::{CameraCalibration, GreyImage, ObjectId, StereoRig};

/// A stored image that gives no view.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// The object.
    #[error(transparent)]
    Catalog(#[from] CatalogError),
    /// The calibration.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// The image.
    #[error("image {image}: {source}")]
    Image {
        /// Which.
        image: ObjectId,
        /// Why.
        source: ImageError,
    },
}

/// Makes rectified views. May be shared between threads.
pub struct Views {
    record: ViewsRecord,
    rig: StereoRig,
    lens: Lens,
}

/// How pixels move.
enum Lens {
    Pair(Box<Rectifier>),
    Single(Box<SingleCamera>),
}

impl Views {
    /// For images of these cameras.
    ///
    /// # Errors
    /// Calibrations that give no rectified images.
    pub fn new(record: ViewsRecord) -> Result<Self, CalibrationError> {
        match &record.calibration {
            Cameras::Pair(pair) => {
                let rectifier = Rectifier::from_record(pair)?;
                let record = ViewsRecord { calibration: Cameras::Pair(Box::new(rectifier.record().clone())), ..record };
                Ok(Self { record, rig: rectifier.rig(), lens: Lens::Pair(Box::new(rectifier)) })
            }
            Cameras::Single(single) => {
                let single = single.clone();
                Ok(Self { record, rig: single.rig()?, lens: Lens::Single(single) })
            }
        }
    }

    /// From the stored record.
    ///
    /// # Errors
    /// Where the record cannot be read or gives no rectified pair.
    pub fn load(objects: &Objects, id: ObjectId) -> Result<Self, ViewError> {
        Ok(Self::new(records::read(objects, id)?)?)
    }

    /// The record, its rectified size filled in.
    pub fn record(&self) -> &ViewsRecord {
        &self.record
    }

    /// The rig that views show the world through.
    pub fn rig(&self) -> StereoRig {
        self.rig
    }

    /// A rectified grey view of stored bytes.
    ///
    /// # Errors
    /// Bytes that do not decode, or of another size than the calibration's.
    pub fn grey(&self, side: Side, bytes: &[u8]) -> Result<GreyImage, ImageError> {
        self.rectified_grey(side, decode_grey(bytes, self.bayer(side))?)
    }

    /// The rectified grey view of pixels that are about to be stored, as [`Views::grey`] will show the stored file.
    ///
    /// # Errors
    /// Pixels of another size than the calibration's.
    pub fn grey_of_pixels(&self, side: Side, pixels: &RawPixels<'_>) -> Result<GreyImage, ImageError> {
        self.rectified_grey(side, pixels.grey(self.bayer(side))?)
    }

    /// A rectified colour view of stored bytes.
    ///
    /// # Errors
    /// As [`Views::grey`].
    pub fn colour(&self, side: Side, bytes: &[u8]) -> Result<ColourImage, ImageError> {
        let image = decode_colour(bytes, self.bayer(side))?;
        match &self.lens {
            Lens::Pair(rectifier) => rectifier.rectify_colour(side, &image),
            Lens::Single(single) => single.check_size(side, image.width, image.height).map(|()| image),
        }
    }

    /// The stored pixel (x, y) that the rectified pixel (u, v) shows; `None` where the lens sees no such ray.
    pub fn source_of(&self, side: Side, [u_px, v_px]: [f64; 2]) -> Option<[f64; 2]> {
        match &self.lens {
            Lens::Pair(rectifier) => rectifier.source_of(side, u_px, v_px),
            Lens::Single(_) => Some([u_px, v_px]),
        }
    }

    /// The left camera as it was recorded; K, D and R are those of the stored image. Whether that is rectified already
    /// comes with it.
    pub fn left_camera(&self) -> (&CameraCalibration, bool) {
        match &self.record.calibration {
            Cameras::Pair(pair) => (&pair.left, pair.stream_is_rectified),
            Cameras::Single(single) => (&single.camera, true),
        }
    }

    fn rectified_grey(&self, side: Side, image: GreyImage) -> Result<GreyImage, ImageError> {
        match &self.lens {
            Lens::Pair(rectifier) => rectifier.rectify_grey(side, image),
            Lens::Single(single) => single.check_size(side, image.width, image.height).map(|()| image),
        }
    }

    /// A rectified grey view of a stored image.
    ///
    /// # Errors
    /// As [`Objects::read`] and [`Views::grey`].
    pub fn grey_of(&self, objects: &Objects, side: Side, image: ObjectId) -> Result<GreyImage, ViewError> {
        self.grey(side, &objects.read(image)?).map_err(|source| ViewError::Image { image, source })
    }

    /// A rectified colour view of a stored image.
    ///
    /// # Errors
    /// As [`Objects::read`] and [`Views::colour`].
    pub fn colour_of(&self, objects: &Objects, side: Side, image: ObjectId) -> Result<ColourImage, ViewError> {
        self.colour(side, &objects.read(image)?).map_err(|source| ViewError::Image { image, source })
    }

    /// The mosaic of a side's stored images; `None` where they are none.
    pub fn bayer(&self, side: Side) -> Option<BayerPattern> {
        match side {
            Side::Left => self.record.left_bayer,
            Side::Right => self.record.right_bayer,
        }
    }
}
