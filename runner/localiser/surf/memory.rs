//! Large buffers that go from one image to the next: fresh pages from the system cost more than the sums that are
//! written into them.

use std::ops::{Deref, DerefMut};
use std::sync::{Mutex, PoisonError};

/// Buffers that no image uses now.
static SPARE: Mutex<Vec<Vec<i32>>> = Mutex::new(Vec::new());
/// Buffers of one image: its pixels and the sums of four octaves.
const PER_IMAGE: usize = 5;

/// Numbers of an image, the memory of which is used again. What they hold at first is arbitrary: whoever asks for them
/// reads only what he has written.
pub(super) struct Numbers(Vec<i32>);

impl Numbers {
    /// `length` numbers.
    pub fn new(length: usize) -> Self {
        let mut spare = SPARE.lock().unwrap_or_else(PoisonError::into_inner);
        let fitting = (0..spare.len()).filter(|&i| spare[i].len() >= length).min_by_key(|&i| spare[i].len());
        let mut numbers = fitting.map(|i| spare.swap_remove(i)).unwrap_or_default();
        drop(spare);
        numbers.resize(length, 0);
        Self(numbers)
    }
}

impl Drop for Numbers {
    fn drop(&mut self) {
        let mut spare = SPARE.lock().unwrap_or_else(PoisonError::into_inner);
        if spare.len() >= PER_IMAGE * rayon::current_num_threads() {
            // The images may have become smaller: the oldest buffers make room.
            spare.remove(0);
        }
        spare.push(std::mem::take(&mut self.0));
    }
}

impl Deref for Numbers {
    type Target = [i32];

    fn deref(&self) -> &[i32] {
        &self.0
    }
}

impl DerefMut for Numbers {
    fn deref_mut(&mut self) -> &mut [i32] {
        &mut self.0
    }
}
