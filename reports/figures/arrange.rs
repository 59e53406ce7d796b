//! Outcomes into the grid that figures draw: live traversals down, experiences across, one grid per setting.

use crate::chart::palette::Tones;
use crate::error::ReportError;
use crate::input::CellInput;
use crate::wording::{self, listed};
use furrow_model::{Outcome, TimeSlot, TraversalId};
use std::collections::BTreeSet;

/// What a cell localised against.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    /// A recorded experience, named by its slot.
    Recorded,
    /// One experience under another name, such as a generated one at the slot that it stands for.
    Named,
    /// Several at once.
    Collective,
}

/// An experience or collective. Columns are in order: single experiences by hour, recorded before named, then
/// collectives by name.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Column {
    pub collective: bool,
    pub slot: TimeSlot,
    pub kind: Kind,
    pub label: String,
}

impl Column {
    fn of(outcome: &Outcome) -> Self {
        let slot = outcome.members.first().map_or(outcome.live, |member| member.slot);
        let kind = match outcome.members.len() {
            0 | 1 if outcome.experience == slot.to_string() => Kind::Recorded,
            0 | 1 => Kind::Named,
            _ => Kind::Collective,
        };
        Self { collective: kind == Kind::Collective, slot, kind, label: wording::shown(&outcome.experience) }
    }
}

/// One live traversal and its cells, one place per column.
pub(crate) struct Row<'a> {
    pub slot: TimeSlot,
    pub label: String,
    pub cells: Vec<Option<&'a CellInput>>,
}

/// Cells that differ in nothing but live traversal and experience.
pub(crate) struct Setting<'a> {
    /// What tells it from the other settings; empty where there is one only.
    pub title: String,
    pub columns: Vec<Column>,
    pub rows: Vec<Row<'a>>,
    /// Whether the page has so many cells that its figures must be drawn with fewer words.
    pub crowded: bool,
}

impl<'a> Setting<'a> {
    /// All its cells, row by row.
    pub fn cells(&self) -> impl Iterator<Item = &'a CellInput> + '_ {
        self.rows.iter().flat_map(|row| row.cells.iter().flatten().copied())
    }

    /// All its cells with their live traversal and experience, row by row.
    pub fn places(&self) -> impl Iterator<Item = (&Row<'a>, &Column, &'a CellInput)> + '_ {
        self.rows.iter().flat_map(|row| {
            let columns = self.columns.iter().zip(&row.cells);
            columns.filter_map(move |(column, cell)| cell.map(|cell| (row, column, cell)))
        })
    }

    /// The distinct values of something its outcomes have, in order.
    pub fn distinct<T: Ord>(&self, value: impl Fn(&Outcome) -> T) -> BTreeSet<T> {
        self.cells().map(|cell| value(&cell.outcome)).collect()
    }

    /// Its thresholds of inliers, as a caption lists them.
    pub fn thresholds(&self) -> String {
        listed(self.distinct(|outcome| outcome.threshold_inliers).iter().map(u32::to_string))
    }

    /// What its distances come from, as a caption lists it.
    pub fn distance_sources(&self) -> String {
        listed(self.distinct(|outcome| wording::shown(&outcome.evaluation.distance_source)))
    }

    /// The ground truths that judge its cells, as a caption lists them; none where nothing does.
    pub fn truths(&self) -> Option<String> {
        let truth = |outcome: &Outcome| Some(wording::shown(&outcome.evaluation.ground_truth.as_ref()?.source));
        let truths = self.distinct(truth);
        let known = listed(truths.into_iter().flatten());
        (!known.is_empty()).then_some(known)
    }
}

/// The colours of the slots of all live traversals and experiences.
pub(crate) fn tones(settings: &[Setting<'_>]) -> Tones {
    let rows = settings.iter().flat_map(|setting| setting.rows.iter().map(|row| row.slot));
    let columns = settings.iter().flat_map(|setting| setting.columns.iter().map(|column| column.slot));
    Tones::new(rows.chain(columns).collect())
}

/// Cells that a page draws in full; more are drawn so that a thousand take at most 10 MB.
const CELLS_IN_FULL: usize = 150;

type Place = (TimeSlot, TraversalId, String);
type Factor = (&'static str, fn(&Outcome) -> String);

/// What else may set two cells of the same live traversal and experience apart, in the order in which titles name it.
const FACTORS: [Factor; 6] = [
    ("place recogniser", |outcome| wording::shown(&outcome.method)),
    ("vocabulary", |outcome| format!("{} words", outcome.codebook_words)),
    ("codebook", |outcome| outcome.codebook.map_or("none".to_owned(), |codebook| codebook.short())),
    ("threshold", |outcome| format!("{} inliers", outcome.threshold_inliers)),
    ("keyframes", |outcome| format!("{} m, {} rad", outcome.keyframes.distance_m, outcome.keyframes.yaw_rad)),
    ("experience versions", |outcome| {
        outcome.members.iter().map(|member| member.id.short()).collect::<Vec<_>>().join(" + ")
    }),
];

fn place(outcome: &Outcome) -> Place {
    (outcome.live, outcome.live_traversal, outcome.experience.clone())
}

/// Splits cells into as few settings as keep every place of every grid to one cell.
pub(crate) fn arrange(cells: &[CellInput]) -> Result<Vec<Setting<'_>>, ReportError> {
    let mut keys = BTreeSet::new();
    if let Some(twice) = cells.iter().find(|cell| !keys.insert(cell.outcome.key)) {
        return Err(ReportError::TwiceGiven(twice.outcome.key));
    }
    let factors = dividing_factors(cells);
    let titles = |cell: &CellInput| -> Vec<String> { factors.iter().map(|factor| factor.1(&cell.outcome)).collect() };
    let mut order: Vec<Vec<String>> = Vec::new();
    for cell in cells {
        let title = titles(cell);
        if !order.contains(&title) {
            order.push(title);
        }
    }
    let setting = |title: Vec<String>| {
        let own: Vec<&CellInput> = cells.iter().filter(|cell| titles(cell) == title).collect();
        let named = factors.iter().zip(&title).map(|(factor, value)| format!("{}: {value}", factor.0));
        grid(named.collect::<Vec<_>>().join("; "), &own, cells.len() > CELLS_IN_FULL)
    };
    Ok(order.into_iter().map(setting).collect())
}

fn dividing_factors(cells: &[CellInput]) -> Vec<Factor> {
    let places = |factors: &[Factor]| {
        let titled = |cell: &CellInput| factors.iter().map(|factor| factor.1(&cell.outcome)).collect::<Vec<_>>();
        cells.iter().map(|cell| (place(&cell.outcome), titled(cell))).collect::<BTreeSet<_>>().len()
    };
    let mut factors: Vec<Factor> = Vec::new();
    for factor in FACTORS {
        // A factor that follows from those before, as a codebook's words follow from the codebook, divides nothing
        // more.
        let more = [factors.as_slice(), &[factor]].concat();
        if places(&more) > places(&factors) {
            factors = more;
        }
    }
    factors
}

fn grid<'a>(title: String, cells: &[&'a CellInput], crowded: bool) -> Setting<'a> {
    let columns: Vec<Column> =
        cells.iter().map(|cell| Column::of(&cell.outcome)).collect::<BTreeSet<_>>().into_iter().collect();
    let lives: BTreeSet<(TimeSlot, TraversalId)> =
        cells.iter().map(|cell| (cell.outcome.live, cell.outcome.live_traversal)).collect();
    let same_slot = |slot: TimeSlot| lives.iter().filter(|live| live.0 == slot).count() > 1;
    let row = |&(slot, traversal): &(TimeSlot, TraversalId)| {
        let own: Vec<_> = cells.iter().filter(|cell| cell.outcome.live_traversal == traversal).collect();
        let at = |column: &Column| own.iter().find(|cell| Column::of(&cell.outcome) == *column).map(|cell| **cell);
        let label = if same_slot(slot) { format!("{slot} ({})", traversal.short()) } else { slot.to_string() };
        Row { slot, label, cells: columns.iter().map(at).collect() }
    };
    let rows = lives.iter().map(row).collect();
    Setting { title, columns, rows, crowded }
}
