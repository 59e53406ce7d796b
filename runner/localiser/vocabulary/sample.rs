//! What a vocabulary is trained on: a bounded, seeded sample of descriptors that come image by image.

use super::check::check_finite;
use super::dimensions::Descriptor;
use super::error::VocabularyError;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use std::collections::HashSet;

/// Different descriptors per word that are kept: training takes time with the square of the words, and no longer for
/// more images.
const DESCRIPTORS_PER_WORD: usize = 128;

/// A uniform sample of all different descriptors offered so far, of at most 128 per word (196 MB for 6000 words).
/// Descriptors that repeat exactly, as those of a robot that stands still, count once; of each only 8 bytes are
/// remembered.
#[derive(Debug, Clone)]
pub struct TrainingSample {
    words: usize,
    seed: u64,
    offered: usize,
    /// Fingerprints of the descriptors offered.
    known: HashSet<u64>,
    kept: Vec<Descriptor>,
    random: ChaCha12Rng,
}

impl TrainingSample {
    /// An empty sample for a vocabulary of `words` words. Error: [`VocabularyError::NoWords`].
    pub fn new(words: usize, seed: u64) -> Result<Self, VocabularyError> {
        if words == 0 {
            return Err(VocabularyError::NoWords);
        }
        let random = ChaCha12Rng::seed_from_u64(seed);
        Ok(Self { words, seed, offered: 0, known: HashSet::new(), kept: Vec::new(), random })
    }

    /// Offers the descriptors of an image; the order of all offers matters. Each different one is kept with the same
    /// chance (reservoir sampling, Vitter 1985, algorithm R). Error: [`VocabularyError::NotFinite`], counted over all
    /// offers; nothing is then taken.
    pub fn offer(&mut self, descriptors: &[Descriptor]) -> Result<(), VocabularyError> {
        check_finite("descriptor", descriptors).map_err(|error| error.counted_from(self.offered))?;
        self.offered += descriptors.len();
        let most = self.words.saturating_mul(DESCRIPTORS_PER_WORD);
        for descriptor in descriptors {
            if !self.known.insert(fingerprint(descriptor)) {
                continue;
            }
            if self.kept.len() < most {
                self.kept.push(*descriptor);
            } else if let Some(kept) = self.kept.get_mut(self.random.random_range(0..self.known.len())) {
                *kept = *descriptor;
            }
        }
        Ok(())
    }

    /// Words to be trained.
    pub fn words(&self) -> usize {
        self.words
    }

    /// The seed.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Descriptors offered, repeated ones included.
    pub fn offered(&self) -> usize {
        self.offered
    }

    /// Descriptors in the sample.
    pub fn kept(&self) -> usize {
        self.kept.len()
    }

    /// The sample, all different, at least as many as words, and the generator as it stands. Errors:
    /// [`VocabularyError::NoDescriptors`], [`VocabularyError::TooFewDescriptors`].
    pub(super) fn into_kept(self) -> Result<(Vec<Descriptor>, ChaCha12Rng), VocabularyError> {
        if self.offered == 0 {
            return Err(VocabularyError::NoDescriptors);
        }
        if self.kept.len() < self.words {
            return Err(VocabularyError::TooFewDescriptors { words: self.words, distinct: self.kept.len() });
        }
        Ok((self.kept, self.random))
    }
}

/// 64 bits of a descriptor's numbers, the same on every machine. Among four million different descriptors two share
/// them with a chance of one in two million; one of the two is then lost to the sample, which does no harm.
fn fingerprint(descriptor: &Descriptor) -> u64 {
    let mix = |hash: u64, word: u64| {
        let product = u128::from(hash ^ word) * 0x9e37_79b9_7f4a_7c15_u128;
        (product >> 64) as u64 ^ (product as u64).rotate_left(17)
    };
    // Adding 0.0 makes both zeros the same bits.
    descriptor.iter().fold(0x243f_6a88_85a3_08d3, |hash, value| mix(hash, u64::from((value + 0.0).to_bits())))
}
