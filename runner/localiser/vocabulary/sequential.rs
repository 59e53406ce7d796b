//! openFABMAP's way to a vocabulary, for comparison.

use super::check::check_finite;
use super::dimensions::Descriptor;
use super::error::VocabularyError;
use super::kmeans;
use super::nearest::PackedWords;
use super::words::Vocabulary;

/// Descriptors compared at once with the centres that exist before them.
const BATCH: usize = 1024;

/// Modified sequential clustering, as openFABMAP does it: a descriptor farther than `radius` (Euclidean; 0.4 to 0.45 is
/// usual for SURF) from every centre becomes a centre; then each descriptor goes to its nearest centre, and the means
/// are the words. The number of words follows from the data, and the order of the descriptors matters. Errors:
/// [`VocabularyError::NoDescriptors`], [`VocabularyError::NotFinite`], [`VocabularyError::BadRadius`].
pub fn train_sequential(descriptors: &[Descriptor], radius: f64) -> Result<Vocabulary, VocabularyError> {
    if !(radius > 0.0 && radius.is_finite()) {
        return Err(VocabularyError::BadRadius { radius });
    }
    check_finite("descriptor", descriptors)?;
    let (first, _) = descriptors.split_first().ok_or(VocabularyError::NoDescriptors)?;
    let mut centres = vec![*first];
    let mut packed = PackedWords::new(&centres);
    for batch in descriptors.chunks(BATCH) {
        let known = packed.nearest(batch);
        let far = batch.iter().zip(&known).filter(|(_, nearest)| nearest.squared_distance > radius * radius);
        let before = centres.len();
        for (descriptor, _) in far {
            if centres[before..].iter().all(|centre| squared_distance(centre, descriptor) > radius * radius) {
                centres.push(*descriptor);
                packed.push(descriptor);
            }
        }
    }
    let means = kmeans::means(descriptors, &packed.nearest(descriptors), &centres);
    Ok(Vocabulary::from_words(&means))
}

fn squared_distance(a: &Descriptor, b: &Descriptor) -> f64 {
    a.iter().zip(b).map(|(&a, &b)| (f64::from(a) - f64::from(b)).powi(2)).sum()
}
