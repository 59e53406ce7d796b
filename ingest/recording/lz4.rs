//! lz4 frames, unpacked by the C library itself: its readers of streams, and those in Rust, copy every byte once more
//! and allocate anew for every chunk.

use lz4::liblz4::{
    LZ4F_VERSION, LZ4F_createDecompressionContext, LZ4F_decompress, LZ4F_freeDecompressionContext,
    LZ4F_resetDecompressionContext, LZ4FDecompressOptions, LZ4FDecompressionContext, check_error,
};
use std::io;

/// Unpacks frames, one after another, with a context that it keeps.
#[derive(Default)]
pub(crate) struct Lz4(Option<LZ4FDecompressionContext>);

impl Lz4 {
    /// Fills `room` from its start with what the frame in `packed` holds, as far as both go: how many bytes that are.
    /// The checksums that the frame has are checked; what stands behind it is passed over.
    pub(crate) fn decompress(&mut self, packed: &[u8], room: &mut [u8]) -> io::Result<usize> {
        let context = self.fresh_context()?;
        // All that was unpacked stays where it is, so that later blocks may refer to it.
        let options = LZ4FDecompressOptions { stable_dst: 1, reserved: [0; 3] };
        let (mut taken, mut filled) = (0, 0);
        loop {
            let (from, to) = (&packed[taken..], &mut room[filled..]);
            let (mut from_bytes, mut to_bytes) = (from.len(), to.len());
            // SAFETY: the context lives as long as `self`; both slices live during the call and are as long as said;
            // `filled` bytes before `to` are left alone until the frame ends, as `stable_dst` promises.
            let more = check_error(unsafe {
                LZ4F_decompress(context, to.as_mut_ptr(), &mut to_bytes, from.as_ptr(), &mut from_bytes, &options)
            })?;
            (taken, filled) = (taken + from_bytes, filled + to_bytes);
            if more == 0 || (from_bytes, to_bytes) == (0, 0) {
                return Ok(filled);
            }
        }
    }

    /// The context, before a frame.
    fn fresh_context(&mut self) -> io::Result<LZ4FDecompressionContext> {
        if let Some(context) = self.0 {
            // SAFETY: it was created below and not freed.
            unsafe { LZ4F_resetDecompressionContext(context) };
            return Ok(context);
        }
        let mut context = LZ4FDecompressionContext(std::ptr::null_mut());
        // SAFETY: it is written to by the call alone.
        check_error(unsafe { LZ4F_createDecompressionContext(&mut context, LZ4F_VERSION) })?;
        Ok(*self.0.insert(context))
    }
}

impl Drop for Lz4 {
    fn drop(&mut self) {
        if let Some(context) = self.0 {
            // SAFETY: it was created by the library and is used by nobody else.
            unsafe { LZ4F_freeDecompressionContext(context) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Lz4;
    use lz4_flex::frame::{BlockMode, BlockSize, FrameEncoder, FrameInfo};
    use std::io::Write;

    /// Bytes that repeat themselves at distances of up to a window and more.
    fn data(len: usize) -> Vec<u8> {
        (0..len).map(|i| (i * i / 7919 % 251) as u8 ^ (i % 70_001 % 13) as u8).collect()
    }

    fn packed(data: &[u8], mode: BlockMode, checksums: bool) -> Vec<u8> {
        let frame = FrameInfo::new().block_mode(mode).block_size(BlockSize::Max64KB);
        let frame = frame.block_checksums(checksums).content_checksum(checksums);
        let mut encoder = FrameEncoder::with_frame_info(frame, Vec::new());
        encoder.write_all(data).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn frames_of_another_packer_come_out_whole_one_after_another() {
        let mut lz4 = Lz4::default();
        for len in [0, 1, 65_535, 65_536, 300_000] {
            for (mode, checksums) in [(BlockMode::Independent, false), (BlockMode::Linked, true)] {
                let (data, mut room) = (data(len), vec![0xaa; len + 1]);
                assert_eq!(lz4.decompress(&packed(&data, mode, checksums), &mut room).unwrap(), len);
                assert!(room[..len] == data, "{len} bytes, {mode:?}");
            }
        }
    }

    #[test]
    fn cut_and_damaged_frames_give_less_or_an_error_and_leave_the_next_one_whole() {
        let (mut lz4, data) = (Lz4::default(), data(200_000));
        let sound = packed(&data, BlockMode::Linked, true);
        let mut room = vec![0; data.len() + 1];
        for at in (0..sound.len()).step_by(997) {
            let cut = lz4.decompress(&sound[..at], &mut room);
            assert!(cut.is_err() || cut.is_ok_and(|len| len <= data.len() && room[..len] == data[..len]));
            let mut flipped = sound.clone();
            flipped[at] ^= 0x10;
            assert!(lz4.decompress(&flipped, &mut room).is_err(), "a flip at {at} of {}", sound.len());
            assert_eq!(lz4.decompress(&sound, &mut room).unwrap(), data.len());
            assert!(room[..data.len()] == data);
        }
        assert_eq!(lz4.decompress(&sound, &mut room[..1000]).unwrap(), 1000, "no more than there is room for");
    }
}
