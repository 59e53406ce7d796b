//! OpenCV's own threads.

use std::sync::Once;

/// Switches OpenCV's own threads off, once: furrow parallelises over images.
pub(crate) fn single_threaded() {
    static ONCE: Once = Once::new();
    // A failure leaves OpenCV's threads on, which costs time and changes no result.
    ONCE.call_once(|| drop(opencv::core::set_num_threads(1)));
}
