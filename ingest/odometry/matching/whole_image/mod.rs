//! Mutually best matches for windows that cover a good part of the image. Only distances are kept while all pairs are
//! compared, sixteen at a time with AVX2. The partner is looked up for the few points that pass the ratio test.

#[cfg(target_arch = "x86_64")]
mod distinct;
mod matches;
#[cfg(target_arch = "x86_64")]
mod sixteen;

pub(crate) use matches::match_whole_image;
