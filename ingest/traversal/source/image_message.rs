//! Image messages as pictures.

use crate::message::{CompressedImage, Header, Image, MessageError};
use crate::recording::{Encoding, RawMessage};
use crate::traversal::picture::Picture;
use furrow_catalog::images::BayerPattern;
use furrow_catalog::images::encoding::mosaic_of_encoding;

/// In a damaged message, a stamp further than an hour from when it was received is taken for damaged, too.
const CREDIBLE_NS: u64 = 3600 * 1_000_000_000;

/// An image message's header stamp and picture. Of a message that can be decoded only in part, the stamp is kept: so
/// that its partner is known to lack it.
///
/// # Errors
/// A message without a stamp that can be read.
pub(super) fn image_of(message: RawMessage<'_>, compressed: bool) -> Result<(i64, Picture), MessageError> {
    let (encoding, bytes) = (message.topic.encoding, message.bytes);
    let decoded = if compressed { compressed_image(encoding, bytes) } else { raw_image(encoding, bytes) };
    decoded.or_else(|error| match Header::decode(encoding, bytes) {
        Ok(header) if header.stamp_ns.abs_diff(message.receive_ns) < CREDIBLE_NS => {
            Ok((header.stamp_ns, Picture::Broken(error.to_string())))
        }
        _ => Err(error),
    })
}

fn compressed_image(encoding: Encoding, bytes: &[u8]) -> Result<(i64, Picture), MessageError> {
    let image = CompressedImage::decode(encoding, bytes)?;
    let data = image.data.to_vec();
    let picture = match mosaic_of_format(image.format) {
        Some(pattern) => Picture::Mosaic(pattern, data),
        None => Picture::Compressed(data),
    };
    Ok((image.header.stamp_ns, picture))
}

/// The mosaic that a `format` such as `bayer_rggb8; png compressed ` speaks of: the encoding of the raw image stands
/// before the semicolon, and behind `compressed` that of the file, where it is another.
fn mosaic_of_format(format: &str) -> Option<BayerPattern> {
    let (raw, file) = format.split_once(';').unwrap_or((format, ""));
    let stored = file.split_once("compressed").map_or("", |(_, stored)| stored.trim());
    let raw = raw.trim();
    if stored.is_empty() || stored == raw { mosaic_of_encoding(raw) } else { mosaic_of_encoding(stored) }
}

fn raw_image(encoding: Encoding, bytes: &[u8]) -> Result<(i64, Picture), MessageError> {
    let image = Image::decode(encoding, bytes)?;
    let picture = Picture::Raw {
        width: image.width as usize,
        height: image.height as usize,
        step: image.step as usize,
        encoding: image.encoding.to_owned(),
        big_endian: image.is_bigendian,
        data: image.data.to_vec(),
    };
    Ok((image.header.stamp_ns, picture))
}

#[cfg(test)]
mod tests {
    use super::mosaic_of_format;
    use furrow_catalog::images::BayerPattern;

    #[test]
    fn a_format_names_the_mosaic_that_its_file_holds() {
        let rggb = Some(BayerPattern::Rggb);
        for (format, expected) in [
            ("bayer_rggb8; png compressed ", rggb),
            ("bayer_rggb8; jpeg compressed ", rggb),
            ("bayer_rggb16;png compressed", rggb),
            ("bayer_rggb8", rggb),
            ("bayer_rggb8; jpeg compressed bayer_rggb8", rggb),
            ("bayer_gbrg8; png compressed ", Some(BayerPattern::Gbrg)),
            ("bayer_rggb8; jpeg compressed bgr8", None),
            ("bayer_rggb8; jpeg compressed mono8", None),
            ("rgb8; jpeg compressed bgr8", None),
            ("jpeg", None),
            ("", None),
            (";", None),
        ] {
            assert_eq!(mosaic_of_format(format), expected, "{format}");
        }
    }
}
