//! The Chow-Liu tree: which word's presence tells most about which other's (Chow and Liu 1968), learned from images of
//! other places.
//! Presences come in, a tree goes out; nothing here knows descriptors or places.

mod cooccurrence;
mod smoothing;
mod spanning;

use crate::presence::Presence;
use cooccurrence::Cooccurrence;
use smoothing::{NEVER_SEEN, smoothed};

/// What can be wrong with a tree or its training images.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ChowLiuError {
    /// No images to learn from.
    #[error("training a Chow-Liu tree: no images came; give the codebook's images, from a route that is not mapped")]
    NoImages,
    /// A tree over no words.
    #[error("training or reading a Chow-Liu tree: the vocabulary has no words, expected at least 1")]
    NoWords,
    /// An image holds a word that the vocabulary lacks.
    #[error(
        "training a Chow-Liu tree: image {image} shows word {word} of a vocabulary of {words}; use one vocabulary for all images"
    )]
    WordOutOfRange {
        /// The image's index.
        image: usize,
        /// The word.
        word: u32,
        /// Words in the vocabulary.
        words: usize,
    },
    /// The information threshold is not a number of nats.
    #[error("training a Chow-Liu tree: the information threshold is {0} nats, expected a number of at least 0")]
    BadThreshold(f64),
    /// Columns of unequal length.
    #[error("reading a Chow-Liu tree: its columns have {0:?} rows, expected equally many")]
    Ragged([usize; 4]),
    /// A probability outside (0, 1).
    #[error(
        "reading a Chow-Liu tree: word {word} has the probability {value}, expected a number between 0 and 1, both excluded"
    )]
    BadProbability {
        /// The word.
        word: usize,
        /// The number.
        value: f64,
    },
    /// A parent that is no word, or a circle of parents.
    #[error(
        "reading a Chow-Liu tree: the parents of word {word} lead to no root; the table is damaged, train it again"
    )]
    NoRoot {
        /// The word.
        word: usize,
    },
}

/// A tree (or, above an information threshold, a forest) over the words, directed from its roots. A root is its own
/// parent, and both its conditional probabilities are its frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct ChowLiuTree {
    parent: Vec<u32>,
    p_present: Vec<f64>,
    p_present_given_parent_present: Vec<f64>,
    p_present_given_parent_absent: Vec<f64>,
}

impl ChowLiuTree {
    /// From its columns, one row per word: the parent's index, P(present), P(present | parent present), P(present |
    /// parent absent). Errors: [`ChowLiuError::NoWords`], [`ChowLiuError::Ragged`], [`ChowLiuError::BadProbability`],
    /// [`ChowLiuError::NoRoot`].
    pub fn from_columns(
        parent: Vec<u32>,
        p_present: Vec<f64>,
        p_present_given_parent_present: Vec<f64>,
        p_present_given_parent_absent: Vec<f64>,
    ) -> Result<Self, ChowLiuError> {
        let tree = Self { parent, p_present, p_present_given_parent_present, p_present_given_parent_absent };
        let probabilities =
            [&tree.p_present, &tree.p_present_given_parent_present, &tree.p_present_given_parent_absent];
        let [a, b, c] = probabilities.map(Vec::len);
        if tree.parent.is_empty() {
            return Err(ChowLiuError::NoWords);
        }
        if [a, b, c] != [tree.parent.len(); 3] {
            return Err(ChowLiuError::Ragged([tree.parent.len(), a, b, c]));
        }
        for column in probabilities {
            if let Some((word, &value)) = column.iter().enumerate().find(|(_, p)| !(**p > 0.0 && **p < 1.0)) {
                return Err(ChowLiuError::BadProbability { word, value });
            }
        }
        match spanning::first_without_root(&tree.parent) {
            Some(word) => Err(ChowLiuError::NoRoot { word }),
            None => Ok(tree),
        }
    }

    /// Number of words.
    pub fn words(&self) -> usize {
        self.parent.len()
    }

    /// Each word's parent; a root's is the root itself.
    pub fn parent(&self) -> &[u32] {
        &self.parent
    }

    /// P(word present), for each word.
    pub fn p_present(&self) -> &[f64] {
        &self.p_present
    }

    /// P(word present | its parent present), for each word.
    pub fn p_present_given_parent_present(&self) -> &[f64] {
        &self.p_present_given_parent_present
    }

    /// P(word present | its parent absent), for each word.
    pub fn p_present_given_parent_absent(&self) -> &[f64] {
        &self.p_present_given_parent_absent
    }

    /// The roots by rising index: one where the information threshold was 0.
    pub fn roots(&self) -> Vec<u32> {
        (0..).zip(&self.parent).filter(|(word, parent)| word == *parent).map(|(word, _)| word).collect()
    }
}

/// Learns the tree from the presences of `images`, over a vocabulary of `words` words.
///
/// The tree is the spanning tree of greatest total information, by openFABMAP's score in nats: the mutual information
/// with smoothed marginals and raw joints. Pairs below `information_threshold_nats` (openFABMAP's default is 0.0005; 0
/// keeps all) are no edges, so the result may be a forest. Each tree's root is the lower end of its strongest edge.
/// Equal scores go to the lower indices. Memory: the presences as bits, and one row of scores. Errors:
/// [`ChowLiuError::NoImages`], [`ChowLiuError::NoWords`], [`ChowLiuError::WordOutOfRange`],
/// [`ChowLiuError::BadThreshold`].
pub fn train(images: &[Presence], words: usize, information_threshold_nats: f64) -> Result<ChowLiuTree, ChowLiuError> {
    check(images, words, information_threshold_nats)?;
    let cooccurrence = Cooccurrence::new(images, words);
    let edges = spanning::strongest_forest(&cooccurrence, information_threshold_nats);
    let parent = spanning::direct(&edges, words);
    Ok(with_probabilities(parent, &cooccurrence))
}

fn check(images: &[Presence], words: usize, information_threshold_nats: f64) -> Result<(), ChowLiuError> {
    if words == 0 {
        return Err(ChowLiuError::NoWords);
    }
    if images.is_empty() {
        return Err(ChowLiuError::NoImages);
    }
    if information_threshold_nats.is_nan() || information_threshold_nats < 0.0 {
        return Err(ChowLiuError::BadThreshold(information_threshold_nats));
    }
    for (image, presence) in images.iter().enumerate() {
        if let Some(word) = presence.beyond(words) {
            return Err(ChowLiuError::WordOutOfRange { image, word, words });
        }
    }
    Ok(())
}

fn with_probabilities(parent: Vec<u32>, cooccurrence: &Cooccurrence) -> ChowLiuTree {
    let images = cooccurrence.images();
    let conditional = |count, total| if total == 0 { NEVER_SEEN } else { smoothed(count, total) };
    let (mut p_present, mut given_present, mut given_absent) = (Vec::new(), Vec::new(), Vec::new());
    for (word, &parent) in parent.iter().enumerate() {
        let (own, parents) = (cooccurrence.count(word), cooccurrence.count(parent as usize));
        let p = smoothed(own, images);
        p_present.push(p);
        if word == parent as usize {
            given_present.push(p);
            given_absent.push(p);
        } else {
            let both = cooccurrence.both(word, parent as usize);
            given_present.push(conditional(both, parents));
            given_absent.push(conditional(own - both, images - parents));
        }
    }
    ChowLiuTree {
        parent,
        p_present,
        p_present_given_parent_present: given_present,
        p_present_given_parent_absent: given_absent,
    }
}
