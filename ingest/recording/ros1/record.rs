//! Records: header length, header, data length, data, all little endian. A header is a list of fields `length
//! name=value`.

/// What a record is, by its `op` field.
pub(super) mod op {
    pub(crate) const MESSAGE: u8 = 2;
    pub(crate) const BAG_HEADER: u8 = 3;
    pub(crate) const INDEX: u8 = 4;
    pub(crate) const CHUNK: u8 = 5;
    pub(crate) const CHUNK_INFO: u8 = 6;
    pub(crate) const CONNECTION: u8 = 7;
}

/// The fields of a header or of a connection's data.
pub(super) struct Fields<'a>(pub(super) &'a [u8]);

impl<'a> Fields<'a> {
    /// The fields in `bytes`; `None` where their lengths do not add up or one lacks its `=`.
    pub(super) fn new(bytes: &'a [u8]) -> Option<Self> {
        let mut rest = bytes;
        while !rest.is_empty() {
            let (field, after) = counted(rest)?;
            field.contains(&b'=').then_some(())?;
            rest = after;
        }
        Some(Self(bytes))
    }

    /// The value of the field `name`.
    pub(super) fn get(&self, name: &str) -> Option<&'a [u8]> {
        let mut rest = self.0;
        while let Some((field, after)) = counted(rest) {
            let value = field.strip_prefix(name.as_bytes()).and_then(|value| value.strip_prefix(b"="));
            if value.is_some() {
                return value;
            }
            rest = after;
        }
        None
    }

    /// A one-byte field.
    pub(super) fn u8(&self, name: &str) -> Option<u8> {
        let [value] = self.array(name)?;
        Some(value)
    }

    /// A four-byte field.
    pub(super) fn u32(&self, name: &str) -> Option<u32> {
        self.array(name).map(u32::from_le_bytes)
    }

    /// An eight-byte field.
    pub(super) fn u64(&self, name: &str) -> Option<u64> {
        self.array(name).map(u64::from_le_bytes)
    }

    /// A time in nanoseconds: seconds, nanoseconds.
    pub(super) fn time_ns(&self, name: &str) -> Option<i64> {
        let both = self.u64(name)?;
        Some((both & 0xffff_ffff) as i64 * 1_000_000_000 + (both >> 32) as i64)
    }

    /// A text field.
    pub(super) fn text(&self, name: &str) -> Option<&'a str> {
        self.get(name).and_then(|value| std::str::from_utf8(value).ok())
    }

    fn array<const N: usize>(&self, name: &str) -> Option<[u8; N]> {
        self.get(name)?.try_into().ok()
    }
}

/// A length and as many bytes, split off the front.
pub(super) fn counted(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (len, rest) = bytes.split_first_chunk::<4>()?;
    rest.split_at_checked(u32::from_le_bytes(*len) as usize)
}

/// A connection: what a publisher said about a topic.
#[derive(Debug, Clone)]
pub(super) struct Connection {
    pub(super) id: u32,
    pub(super) topic: String,
    pub(super) type_name: String,
}

impl Connection {
    /// The connection of a record; `None` where a field is missing.
    pub(super) fn read(header: &Fields<'_>, data: &[u8]) -> Option<Self> {
        let data = Fields::new(data)?;
        let (id, topic) = (header.u32("conn")?, header.text("topic")?.to_owned());
        Some(Self { id, topic, type_name: data.text("type")?.to_owned() })
    }
}
