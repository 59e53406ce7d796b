//! Why no stereo pair was found among a recording's topics.

use std::fmt::Write;

/// A recording whose stereo pair is missing or ambiguous.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TopicError {
    /// No topic has images.
    #[error("looking for images: no topic has them; topics: {}; {advice}", list_names(topics))]
    NoImages {
        /// The topics there are, with their types.
        topics: Vec<String>,
        /// What to do.
        advice: &'static str,
    },
    /// There is nothing to pair.
    #[error(
        "looking for a stereo pair: no two image topics differ only in left/right or a camera's number; image topics: \
         {}{}; name them with --left TOPIC --right TOPIC{}",
        list_names(images),
        hidden_names(hidden),
        pair_advice(images, hidden)
    )]
    NoPair {
        /// The image topics there are.
        images: Vec<String>,
        /// Those among them that seem to show depth or the like.
        hidden: Vec<String>,
    },
    /// Several pairs are as good as each other.
    #[error(
        "looking for a stereo pair: several are possible: {}; choose with --left TOPIC --right TOPIC",
        pairs.join(", ")
    )]
    Several {
        /// The pairs, as `left and right`.
        pairs: Vec<String>,
    },
    /// A topic that was named is not there.
    #[error(
        "looking for topic {wanted}: it is no image topic of the recording; image topics: {}; name them with \
         --left TOPIC --right TOPIC",
        list_names(images)
    )]
    Missing {
        /// What was named.
        wanted: String,
        /// The image topics there are.
        images: Vec<String>,
    },
    /// One topic for both sides.
    #[error(
        "left and right are the same topic, {topic}: name two; image topics: {}; if both eyes lie side by side in it, \
         split its images first, as into the folders left and right",
        list_names(images)
    )]
    Same {
        /// The topic.
        topic: String,
        /// The image topics there are.
        images: Vec<String>,
    },
    /// One side raw, the other compressed.
    #[error(
        "pairing {left} with {right}: one is raw, the other compressed; give two alike with --left TOPIC --right TOPIC"
    )]
    Unlike {
        /// The left topic.
        left: String,
        /// The right topic.
        right: String,
    },
}

fn list_names(names: &[String]) -> String {
    const SHOWN: usize = 40;
    let mut list = if names.is_empty() { "none".to_owned() } else { names[..names.len().min(SHOWN)].join(", ") };
    if names.len() > SHOWN {
        let _ = write!(list, " and {} more", names.len() - SHOWN);
    }
    list
}

fn hidden_names(hidden: &[String]) -> String {
    if hidden.is_empty() { String::new() } else { format!(" (by name not a camera's: {})", list_names(hidden)) }
}

fn pair_advice(images: &[String], hidden: &[String]) -> &'static str {
    match (images, hidden.is_empty()) {
        ([_], true) => {
            "; this is the only one: if both eyes lie side by side in it, split its images first, as into the folders \
             left and right; if the other camera is in another file, give both files"
        }
        _ => "",
    }
}
