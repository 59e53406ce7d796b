//! A place in a message's bytes. ROS1 packs values in little endian. CDR (OMG CORBA 3.3 part 2, section 9.3; XCDR1 of
//! OMG DDS-XTypes) aligns each primitive to its size, counted from behind the four-byte encapsulation header that names
//! the byte order.

use crate::recording::Encoding;

/// Bytes that are not the message they should be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MessageError {
    /// A field reaches past the end.
    #[error(
        "decoding {message}: field {field} at byte {at}: expected {wanted} bytes, found {left} to the end: the message \
         is cut short or of another type"
    )]
    Short {
        /// The message's type.
        message: &'static str,
        /// The field.
        field: &'static str,
        /// Where it begins.
        at: usize,
        /// How long it says it is.
        wanted: usize,
        /// What is left.
        left: usize,
    },
    /// A text that is not UTF-8.
    #[error(
        "decoding {message}: field {field} at byte {at}: expected UTF-8 text: the message is damaged or of another type"
    )]
    NotText {
        /// The message's type.
        message: &'static str,
        /// The field.
        field: &'static str,
        /// Where it begins.
        at: usize,
    },
    /// An encoding that is not read.
    #[error(
        "decoding {message}: expected ROS1 bytes or plain CDR (encapsulation 0000 or 0001), found {found}; record with \
         rosbag or with rosbag2's default serialisation"
    )]
    Encoding {
        /// The message's type.
        message: &'static str,
        /// What it is.
        found: String,
    },
    /// A value that has no meaning here.
    #[error("decoding {message}: field {field}: expected {expected}, found {found}")]
    Value {
        /// The message's type.
        message: &'static str,
        /// The field.
        field: &'static str,
        /// What it holds.
        found: String,
        /// What it may hold.
        expected: &'static str,
    },
}

/// A place in a message.
pub(crate) struct Cursor<'a> {
    message: &'static str,
    bytes: &'a [u8],
    at: usize,
    /// Where alignment counts from; `None` where nothing is aligned.
    origin: Option<usize>,
    big_endian: bool,
}

macro_rules! number {
    ($name:ident, $type:ty) => {
        #[doc = concat!("The next `", stringify!($type), "`.")]
        pub(crate) fn $name(&mut self, field: &'static str) -> Result<$type, MessageError> {
            let bytes = self.aligned(field)?;
            Ok(if self.big_endian { <$type>::from_be_bytes(bytes) } else { <$type>::from_le_bytes(bytes) })
        }
    };
}

impl<'a> Cursor<'a> {
    /// The start of a `message` in `bytes`.
    pub(crate) fn new(message: &'static str, encoding: Encoding, bytes: &'a [u8]) -> Result<Self, MessageError> {
        let plain = Self { message, bytes, at: 0, origin: None, big_endian: false };
        let wrong_encoding = |found: String| Err(MessageError::Encoding { message, found });
        match (encoding, bytes) {
            (Encoding::Ros1, _) => Ok(plain),
            (Encoding::Cdr, [0, kind @ (0 | 1), _, _, ..]) => {
                Ok(Self { at: 4, origin: Some(4), big_endian: *kind == 0, ..plain })
            }
            (Encoding::Cdr, [first, second, ..]) => {
                wrong_encoding(format!("CDR with encapsulation {first:02x}{second:02x}"))
            }
            (Encoding::Cdr, _) => wrong_encoding(format!("{} bytes", bytes.len())),
            (Encoding::Unknown, _) => wrong_encoding("another encoding".to_owned()),
        }
    }

    /// The next `count` bytes.
    pub(crate) fn bytes(&mut self, count: usize, field: &'static str) -> Result<&'a [u8], MessageError> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let taken = rest.get(..count).ok_or(MessageError::Short {
            message: self.message,
            field,
            at: self.at,
            wanted: count,
            left: rest.len(),
        })?;
        self.at += count;
        Ok(taken)
    }

    fn aligned<const N: usize>(&mut self, field: &'static str) -> Result<[u8; N], MessageError> {
        if let Some(origin) = self.origin {
            let padding = (self.at - origin).wrapping_neg() % N;
            self.bytes(padding, field)?;
        }
        let mut value = [0; N];
        value.copy_from_slice(self.bytes(N, field)?);
        Ok(value)
    }

    number!(u8, u8);
    number!(i8, i8);
    number!(u16, u16);
    number!(u32, u32);
    number!(i32, i32);
    number!(f64, f64);

    /// The next `N` doubles.
    pub(crate) fn f64s<const N: usize>(&mut self, field: &'static str) -> Result<[f64; N], MessageError> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.f64(field)?;
        }
        Ok(values)
    }

    /// A sequence of doubles: a count, then the values.
    pub(crate) fn f64_list(&mut self, field: &'static str) -> Result<Vec<f64>, MessageError> {
        let count = self.u32(field)? as usize;
        // Grows with the values that are there, so that a wild count allocates nothing.
        let mut values = Vec::new();
        for _ in 0..count {
            values.push(self.f64(field)?);
        }
        Ok(values)
    }

    /// A sequence of bytes: a count, then the bytes, left in place.
    pub(crate) fn byte_list(&mut self, field: &'static str) -> Result<&'a [u8], MessageError> {
        let count = self.u32(field)? as usize;
        self.bytes(count, field)
    }

    /// A text: its length and bytes. CDR counts and writes a closing NUL.
    pub(crate) fn text(&mut self, field: &'static str) -> Result<&'a str, MessageError> {
        let bytes = self.byte_list(field)?;
        let at = self.at - bytes.len();
        let bytes = if self.origin.is_some() { bytes.strip_suffix(&[0]).unwrap_or(bytes) } else { bytes };
        std::str::from_utf8(bytes).map_err(|_| MessageError::NotText { message: self.message, field, at })
    }
}
