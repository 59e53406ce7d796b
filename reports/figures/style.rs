//! How experiences are told apart where each has a line.

use super::arrange::{Column, Kind, Setting};
use crate::chart::elements::{Key, Line};
use crate::chart::palette::{Tone, Tones};
use crate::chart::shape::CROSS;

const DASHES: [&str; 3] = ["9 3 2 3", "2 3", "12 4"];

/// How an experience's line looks.
pub(super) struct Style {
    pub tone: Tone,
    pub dash: &'static str,
    pub mark: usize,
    pub filled: bool,
    /// The column, and the legend's switch.
    pub series: usize,
}

impl Style {
    pub fn of(column: &Column, index: usize, setting: &Setting<'_>, tones: &Tones) -> Self {
        let before = setting.columns[..index].iter().filter(|other| other.kind == column.kind);
        match column.kind {
            Kind::Recorded => Self {
                tone: tones.of(column.slot),
                dash: "",
                mark: tones.mark(column.slot),
                filled: true,
                series: index,
            },
            Kind::Named => Self {
                tone: tones.of(column.slot),
                dash: "5 4",
                mark: tones.mark(column.slot),
                filled: false,
                series: index,
            },
            Kind::Collective => {
                let nth = before.count();
                let (dash, mark) = (DASHES[nth % DASHES.len()], (3 + nth) % CROSS);
                Self { tone: Tone::ink(), dash, mark, filled: true, series: index }
            }
        }
    }

    /// The line of a column, with its title and data.
    pub fn line(&self, column: &Column, d: String, title: &str, data: Vec<(&'static str, String)>) -> Line {
        let width = if column.collective { 2.6 } else { 2.0 };
        let (tone, title, series) = (self.tone.clone(), title.to_owned(), Some(self.series));
        Line { d, tone, dash: self.dash, width, title, series, data }
    }

    /// Its entry in the legend.
    pub fn key(&self, label: &str) -> Key {
        Key::new(label, self.tone.clone(), Some(self.dash), Some(self.mark), self.filled).switching(self.series)
    }
}
