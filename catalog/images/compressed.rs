//! `sensor_msgs/CompressedImage`: the recording's own bytes, kept.

use crate::images::{ImageError, StoredImage, decode_grey, inspect};

/// Takes a JPEG or PNG as recorded and returns its bytes untouched, once it is known that they decode.
///
/// Decoding is most of the cost. A caller that decodes the image anyway should call [`inspect`], then [`decode_grey`], and keep the
/// bytes if both succeed: the checks are the same.
///
/// # Errors
/// Those of [`inspect`] and [`decode_grey`].
pub fn store_compressed(bytes: Vec<u8>) -> Result<StoredImage, ImageError> {
    let header = inspect(&bytes)?;
    decode_grey(&bytes, None)?;
    Ok(StoredImage { bytes, width: header.width, height: header.height, bayer: None })
}
