//! The vocabulary: cluster centres of descriptors. An image's words are the centres nearest to its descriptors.
//! Descriptors come in, word indices go out; nothing here knows images or places.
//!
//! - `words`: the [`Vocabulary`]; `dimensions`, `check` and `error`: what it is made of, and what can be wrong with it;
//! - `nearest`: the exact nearest word, after a `search` by `floats` or `integers` that leaves few words over;
//! - `kmeans`: training by k-means from a `sample`, with first words by `seeding`;
//! - `sequential`: training by radius.

mod check;
mod dimensions;
mod error;
mod floats;
mod integers;
mod kmeans;
mod nearest;
mod sample;
mod search;
mod seeding;
mod sequential;
mod words;

pub use dimensions::{DIMENSIONS, Descriptor};
pub use error::VocabularyError;
pub use kmeans::{KMeans, KMeansCheckpoint, KMeansProgress, TrainingRecord, train_kmeans};
pub use nearest::Nearest;
pub use sample::TrainingSample;
pub use sequential::train_sequential;
pub use words::Vocabulary;
