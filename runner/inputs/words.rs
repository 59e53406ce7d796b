//! A codebook, and the words that images show.

use furrow_localiser::{Codebook, Presence};
use furrow_model::{CodebookId, ObjectId};

/// A codebook ready for use.
pub(crate) struct ReadyCodebook {
    pub id: CodebookId,
    pub codebook: Codebook,
}

/// The words of a list of images, and the object that holds them.
pub(crate) struct Words {
    pub table: ObjectId,
    pub presences: Vec<Presence>,
}

/// The stored words of a live traversal and of an experience.
pub(crate) struct WordTables {
    pub codebook: CodebookId,
    /// The table of the live traversal, and its images.
    pub live: (ObjectId, usize),
    /// The table of the experience, and its images.
    pub map: (ObjectId, usize),
}
