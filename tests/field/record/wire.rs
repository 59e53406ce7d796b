//! The two ways in which ROS lays out messages: ROS 1 (packed) and ROS 2 (CDR, little endian, aligned).

/// Which layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// ROS 1: packed, strings without a final zero.
    Ros1,
    /// CDR: values aligned to their size behind a head of four bytes, strings with a final zero.
    Cdr,
}

/// A message being laid out.
pub struct Wire {
    layout: Layout,
    bytes: Vec<u8>,
}

/// Length of the head of a CDR message.
const HEAD: usize = 4;

impl Wire {
    /// An empty message.
    pub fn new(layout: Layout) -> Wire {
        let bytes = if layout == Layout::Cdr { vec![0, 1, 0, 0] } else { Vec::new() };
        Wire { layout, bytes }
    }

    /// The layout.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// The bytes of the message.
    pub fn finish(self) -> Vec<u8> {
        self.bytes
    }

    fn align(&mut self, size: usize) {
        if self.layout == Layout::Cdr {
            while !(self.bytes.len() - HEAD).is_multiple_of(size) {
                self.bytes.push(0);
            }
        }
    }

    /// One byte.
    pub fn u8(&mut self, value: u8) {
        self.bytes.push(value);
    }

    /// Two bytes.
    pub fn u16(&mut self, value: u16) {
        self.align(2);
        self.bytes.extend(value.to_le_bytes());
    }

    /// Four bytes.
    pub fn u32(&mut self, value: u32) {
        self.align(4);
        self.bytes.extend(value.to_le_bytes());
    }

    /// A double.
    pub fn f64(&mut self, value: f64) {
        self.align(8);
        self.bytes.extend(value.to_le_bytes());
    }

    /// Doubles, their number known to the reader.
    pub fn f64s(&mut self, values: &[f64]) {
        values.iter().for_each(|&value| self.f64(value));
    }

    /// A text.
    pub fn string(&mut self, text: &str) {
        let zero = usize::from(self.layout == Layout::Cdr);
        self.u32((text.len() + zero) as u32);
        self.bytes.extend(text.as_bytes());
        self.bytes.extend(&[0][..zero]);
    }

    /// Bytes with their number before them.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.u32(bytes.len() as u32);
        self.bytes.extend(bytes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cdr_aligns_and_ros1_packs() {
        let lay = |layout| {
            let mut wire = Wire::new(layout);
            wire.string("ab");
            wire.u8(7);
            wire.f64(1.0);
            wire.finish()
        };
        let one = 1.0_f64.to_le_bytes();
        assert_eq!(lay(Layout::Ros1), [&[2, 0, 0, 0, b'a', b'b', 7], &one[..]].concat());
        assert_eq!(lay(Layout::Cdr), [&[0, 1, 0, 0, 3, 0, 0, 0, b'a', b'b', 0, 7], &one[..]].concat());
    }
}
