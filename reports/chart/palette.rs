//! Colours ordered by hour, from night's indigo to evening's orange.
//!
//! Lightness grows along the light page's ramp up to the last stop and along the whole dark page's one; each was
//! checked with Machado's simulations of protanopia, deuteranopia and tritanopia. Colour never stands alone: shapes,
//! dashes and labels say the same.

use super::shape::CROSS as SHAPES;
use furrow_model::TimeSlot;
use serde::Serialize;
use std::collections::BTreeSet;

const LIGHT: [[u8; 3]; 6] = [
    [0x1c, 0x0f, 0x5c],
    [0x1f, 0x4a, 0x9c],
    [0x12, 0x7a, 0x8f],
    [0x4f, 0x8f, 0x4a],
    [0xa8, 0x90, 0x0f],
    [0xd9, 0x7b, 0x4f],
];
const DARK: [[u8; 3]; 6] = [
    [0x6f, 0x68, 0xd8],
    [0x5b, 0x92, 0xec],
    [0x4f, 0xb9, 0xb0],
    [0x9f, 0xc2, 0x5a],
    [0xec, 0xcb, 0x5c],
    [0xff, 0xe3, 0xd0],
];

/// A colour: a class that the page's style sheet colours by theme, and the light theme's value for a figure that stands
/// alone.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Tone {
    pub class: String,
    pub light: String,
    pub dark: String,
}

impl Tone {
    fn fixed(class: &str, light: &str, dark: &str) -> Self {
        Self { class: class.to_owned(), light: light.to_owned(), dark: dark.to_owned() }
    }

    /// The text's colour: collectives.
    pub fn ink() -> Self {
        Self::fixed("tone-ink", "#1b1f24", "#e9ecf0")
    }

    /// Counts, and what is neither right nor wrong.
    pub fn plain() -> Self {
        Self::fixed("tone-plain", "#1f4a9c", "#5b92ec")
    }

    /// Known to be wrong.
    pub fn wrong() -> Self {
        Self::fixed("tone-wrong", "#b3123f", "#ff7a90")
    }

    /// What no ground truth judges; the style sheet has its dark value.
    pub fn soft() -> Self {
        Self::fixed("tone-soft", "#8a929c", "")
    }

    /// The line below a lane's dots; the style sheet has its dark value.
    pub fn rail() -> Self {
        Self::fixed("rail", "#d3d8de", "")
    }
}

/// The tone and mark of each slot on a page.
pub(crate) struct Tones {
    slots: Vec<TimeSlot>,
}

impl Tones {
    pub fn new(slots: BTreeSet<TimeSlot>) -> Self {
        Self { slots: slots.into_iter().collect() }
    }

    fn index(&self, slot: TimeSlot) -> usize {
        self.slots.binary_search(&slot).unwrap_or(0)
    }

    pub fn of(&self, slot: TimeSlot) -> Tone {
        let index = self.index(slot);
        let along = if self.slots.len() > 1 { index as f64 / (self.slots.len() - 1) as f64 } else { 0.2 };
        Tone { class: format!("tone-{index}"), light: at(&LIGHT, along), dark: at(&DARK, along) }
    }

    /// Which mark the slot is drawn with; neighbours in time differ.
    pub fn mark(&self, slot: TimeSlot) -> usize {
        self.index(slot) % SHAPES
    }

    /// Every tone, for the style sheet.
    pub fn all(&self) -> Vec<Tone> {
        let fixed = [Tone::ink(), Tone::plain(), Tone::wrong()];
        self.slots.iter().map(|slot| self.of(*slot)).chain(fixed).collect()
    }
}

fn at(ramp: &[[u8; 3]; 6], along: f64) -> String {
    let place = along * (ramp.len() - 1) as f64;
    let low = (place as usize).min(ramp.len() - 2);
    let part = place - low as f64;
    let mixed = |i: usize| (f64::from(ramp[low][i]) * (1.0 - part) + f64::from(ramp[low + 1][i]) * part).round() as u8;
    format!("#{:02x}{:02x}{:02x}", mixed(0), mixed(1), mixed(2))
}
