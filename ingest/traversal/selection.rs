//! Which of a recording's frames an ingest takes.

use std::fmt;
use std::str::FromStr;

/// Which of a recording's pairs, counted from 0 in the recording's order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameSelection {
    /// Every pair.
    All,
    /// 0, 2, 4 …
    Even,
    /// 1, 3, 5 …
    Odd,
    /// From the first number to before the second.
    Range(u32, u32),
}

impl FrameSelection {
    /// Whether pair number `index` is wanted.
    pub fn contains(self, index: u32) -> bool {
        match self {
            Self::All => true,
            Self::Even => index.is_multiple_of(2),
            Self::Odd => !index.is_multiple_of(2),
            Self::Range(from, to) => (from..to).contains(&index),
        }
    }

    /// Whether any pair from number `from` to before `to` is wanted.
    pub(crate) fn touches(self, from: u32, to: u32) -> bool {
        match self {
            Self::Range(first, end) => first < to && from < end,
            _ => (from..to).take(2).any(|index| self.contains(index)),
        }
    }
}

impl fmt::Display for FrameSelection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => f.write_str("all"),
            Self::Even => f.write_str("even"),
            Self::Odd => f.write_str("odd"),
            Self::Range(from, to) => write!(f, "{from}..{to}"),
        }
    }
}

impl FromStr for FrameSelection {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let range = || {
            let (from, to) = text.split_once("..")?;
            let (from, to) = (from.parse().ok()?, to.parse().ok()?);
            (from < to).then_some(Self::Range(from, to))
        };
        match text {
            "all" => Ok(Self::All),
            "even" => Ok(Self::Even),
            "odd" => Ok(Self::Odd),
            _ => {
                range().ok_or_else(|| format!("'{text}' selects no frames: expected all, even, odd or A..B with A < B"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn selections_read_back_and_choose() {
        for (text, chosen) in
            [("all", vec![0, 1, 2, 3]), ("even", vec![0, 2]), ("odd", vec![1, 3]), ("1..3", vec![1, 2])]
        {
            let selection: FrameSelection = text.parse().unwrap();
            assert_eq!(selection.to_string(), text);
            assert_eq!((0..4).filter(|i| selection.contains(*i)).collect::<Vec<_>>(), chosen);
        }
        for text in ["", "3..1", "2..2", "-1..2", "none"] {
            assert!(text.parse::<FrameSelection>().is_err(), "{text}");
        }
    }
}
