//! What a matrix says of contrasts: which contenders are set against which.

use super::Selection;
use serde::Deserialize;
use toml::Spanned;

/// The words that stand for another contender, whatever it is called.
pub const WORDS: [&str; 3] = ["parent", "mimicked", "placebo"];

/// One contender set against another, or each of several.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContrastSpec {
    /// What is asked about: the name of a collective, the label of an experience, or `each` and a selection as in
    /// `"each 10:00 generated"`.
    pub of: Spanned<String>,
    /// What it should beat: the same, or `parent`, `mimicked` or `placebo`.
    pub over: Spanned<String>,
}

/// A side of a contrast.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Side {
    /// Each experience that a selection takes.
    Each(Selection),
    /// What is called so.
    Name(String),
    /// The recorded experiences that the other side was generated from.
    Parent,
    /// The recorded experiences at the slot that the other side mimics.
    Mimicked,
    /// The collective of placebos beside the other side.
    Placebo,
}

impl Side {
    /// Reads `of`.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn of(text: &str) -> Result<Self, String> {
        match text.strip_prefix("each ") {
            Some(selection) => Selection::parse(selection).map(Self::Each),
            None if text.trim().is_empty() => {
                Err("a contrast names nothing: expected a collective, an experience or \"each …\"".to_owned())
            }
            None if WORDS.contains(&text) => {
                Err(format!("of = \"{text}\" says of what: put it into over, and what is asked about into of"))
            }
            None => Ok(Self::Name(text.to_owned())),
        }
    }

    /// Reads `over`.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn over(text: &str) -> Result<Self, String> {
        match text {
            "parent" => Ok(Self::Parent),
            "mimicked" => Ok(Self::Mimicked),
            "placebo" => Ok(Self::Placebo),
            _ => Self::of(text),
        }
    }
}
