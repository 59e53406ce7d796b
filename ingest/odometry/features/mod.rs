//! Features of one image: filters, non-maximum suppression, descriptors, and the indices that matching searches.
//! Nothing here knows a second image: it may use only `params`.

#[cfg(target_arch = "x86_64")]
mod blocks;
mod descriptor;
mod detection;
mod filter_rows;
mod filters;
mod frame;
mod index;
mod non_maximum;
mod whole_image;

#[cfg(target_arch = "x86_64")]
pub(crate) use blocks::{Blocks, LANES, REGISTER, SUMMED};
pub use frame::FrameFeatures;
#[cfg(test)]
pub(crate) use index::bin_order;
pub(crate) use index::{Index, Window};
pub(crate) use whole_image::WholeImage;
