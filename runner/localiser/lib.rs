//! Localisation by appearance: which place of an experience does a live image show, or none of them? No file, socket or
//! clock is touched here, and equal input gives equal bits on any number of threads.
//!
//! A tour, in the order an image passes through:
//! - [`mod@surf`]: keypoints and their descriptors;
//! - [`vocabulary`]: descriptors become words, the nearest cluster centres;
//! - [`presence`]: an image is the set of words it shows;
//! - [`chow_liu`]: the tree of words that occur together, learned on other ground;
//! - [`codebook`]: vocabulary, tree and sample images, trained together;
//! - [`fabmap`]: FAB-MAP 2.0: the likelihood of each place and of a new one;
//! - [`seqslam`], [`external`]: other recognisers: sequences of small images, descriptors that another program
//!   computed;
//! - [`ranking`]: what all recognisers answer; they are registered in `runner/stages/matching/registry.rs`;
//! - [`verification`]: calibrates the threshold: how many inliers two different places may share;
//! - [`hub`]: the control hub: compares an answer's inliers with the threshold, so that here a place is good or not,
//!   and keeps the best of many localisers.

pub mod chow_liu;
pub mod codebook;
pub mod external;
pub mod fabmap;
pub mod hub;
pub mod presence;
pub mod ranking;
pub mod seqslam;
pub mod surf;
pub mod verification;
pub mod vocabulary;

pub use chow_liu::ChowLiuTree;
pub use codebook::Codebook;
pub use fabmap::FabMap;
pub use hub::Hub;
pub use presence::Presence;
pub use vocabulary::Vocabulary;
