//! What a run starts from: traversals, contenders, what is to be made, the codebook's images, descriptor files, and the
//! keys of all that. Reads the store; knows no plan and no stage.

pub(crate) mod answers;
pub mod codebook;
pub mod contender;
pub(crate) mod descriptors;
pub(crate) mod key;
pub mod making;
pub(crate) mod recogniser;
pub(crate) mod sampling;
pub(crate) mod table;
pub mod traversals;
pub(crate) mod words;
pub mod zone;
