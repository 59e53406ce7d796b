//! Lost-distance curves (thesis 6.3, Fig 6.3; as in Churchill and Newman 2013, Linegar et al. 2015, Porav et al. 2018).

mod bands;

pub(super) use bands::CELL_M;
use bands::{Span, bands};
use furrow_model::{Censored, LostDistance, LostPoint, LostStretch};

/// A live frame's fate on its route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Distance travelled when it was taken, metres; never falling from event to event.
    pub travelled_m: f64,
    /// Whether it was localised and accepted.
    pub localised: bool,
}

/// Two neighbouring localisations farther apart than this many median event spacings count as a lost stretch: frames
/// are missing.
const CONTINUITY: f64 = 2.0;
/// But never within this distance: a robot that stands still for half its frames has a median spacing of nearly
/// nothing.
const LEAST_GAP_M: f64 = 0.5;

/// The lost stretches of a traversal from `start_m` to `end_m` and their curves. `events` are in the order driven.
/// A traversal without any localisation keeps its one stretch also where cut-off
/// ones are dropped: nothing else would be left to judge.
pub fn lost_distance(events: &[Event], start_m: f64, end_m: f64, censored: Censored) -> LostDistance {
    Stretches::of(events, start_m, end_m, censored).curves()
}

/// Where a traversal was lost, before anything is drawn of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretches {
    lost: Vec<LostStretch>,
    span: Span,
}

impl Stretches {
    /// As [`lost_distance`].
    pub fn of(events: &[Event], start_m: f64, end_m: f64, censored: Censored) -> Self {
        let mut lost = stretches(events, start_m, end_m);
        let mut span = Span { from_m: start_m, to_m: end_m.max(start_m) };
        if censored == Censored::Drop && events.iter().any(|event| event.localised) {
            span = uncensored(&lost, span);
            lost.retain(|stretch| !stretch.censored);
        }
        Self { lost, span }
    }

    fn lengths(&self) -> impl ExactSizeIterator<Item = f64> {
        self.lost.iter().map(|stretch| stretch.length_m())
    }

    /// What share of the route `metres` are.
    fn share(&self, metres: f64) -> f64 {
        let route_m = self.route_m();
        // An empty sum of floats is -0.
        if route_m > 0.0 { (metres + 0.0) / route_m } else { 0.0 }
    }

    /// The share of the route driven lost.
    pub fn fraction(&self) -> f64 {
        self.share(self.lost_m())
    }

    /// The longest stretch, metres.
    pub fn max_m(&self) -> f64 {
        self.lengths().fold(0.0, f64::max)
    }

    /// The route's length in metres, without what was dropped.
    pub fn route_m(&self) -> f64 {
        self.span.to_m - self.span.from_m
    }

    /// Metres driven lost.
    pub fn lost_m(&self) -> f64 {
        self.lengths().sum::<f64>() + 0.0
    }

    /// The integral of the distance since the last localisation along the route, square metres: half the sum of squared
    /// lengths.
    pub fn area_m2(&self) -> f64 {
        self.lengths().map(|length| length * length / 2.0).sum::<f64>() + 0.0
    }

    /// Every 0.1 m of a traversal from `start_m` to `end_m`: metres driven since the last localisation, 0 where not
    /// lost; `None` where nothing is judged.
    pub(super) fn along(&self, start_m: f64, end_m: f64) -> Vec<Option<f64>> {
        let whole = Span { from_m: start_m, to_m: end_m };
        let places = bands::cells(&self.lost, whole).into_iter().enumerate();
        let judged = |cell: usize| {
            let here_m = start_m + (cell as f64 + 0.5) * CELL_M;
            self.span.from_m < here_m && here_m < self.span.to_m
        };
        places.map(|(i, cell)| judged(i).then_some(cell.since_m)).collect()
    }

    /// The curves.
    pub fn curves(self) -> LostDistance {
        let route_m = self.route_m();
        let lengths: Vec<f64> = self.lengths().collect();
        let grid = distances(route_m);
        let bands = bands(&self.lost, self.span, &grid);
        let curve = grid.iter().zip(bands).map(|(&distance_m, band)| {
            let longer = || lengths.iter().copied().filter(|length| *length > distance_m);
            let survival = self.share(longer().map(|length| length - distance_m).sum());
            let length_biased = self.share(longer().sum());
            let per_gap = if lengths.is_empty() { 0.0 } else { longer().count() as f64 / lengths.len() as f64 };
            LostPoint {
                distance_m,
                survival,
                survival_band: around(survival, band.survival),
                length_biased,
                length_biased_band: around(length_biased, band.length_biased),
                per_gap,
                per_gap_band: around(per_gap, band.per_gap),
            }
        });
        LostDistance {
            route_m,
            lost_fraction: self.fraction(),
            max_lost_m: self.max_m(),
            mean_lost_m: lengths.iter().sum::<f64>() / lengths.len().max(1) as f64 + 0.0,
            area_m: self.share(self.area_m2()),
            curve: curve.collect(),
            stretches: self.lost,
        }
    }
}

/// What is left of `span` without the stretches at its ends.
fn uncensored(stretches: &[LostStretch], span: Span) -> Span {
    stretches.iter().filter(|stretch| stretch.censored).fold(span, |span, stretch| {
        if stretch.from_m <= span.from_m {
            Span { from_m: stretch.to_m, ..span }
        } else {
            Span { to_m: stretch.from_m, ..span }
        }
    })
}

/// A band that holds its value.
fn around(value: f64, band: Option<[f64; 2]>) -> Option<[f64; 2]> {
    band.map(|[low, high]| [low.min(value), high.max(value)])
}

/// Maximal runs with at least one failed event, from the localisation before to the one after; and pairs of
/// localisations too far apart.
fn stretches(events: &[Event], start_m: f64, end_m: f64) -> Vec<LostStretch> {
    let continuity_m = (CONTINUITY * median_spacing(events)).max(LEAST_GAP_M);
    let mut stretches = Vec::new();
    let (mut last_m, mut failed, mut localised_before) = (start_m, false, false);
    let mut push = |from_m: f64, to_m: f64, censored: bool| {
        if to_m > from_m {
            stretches.push(LostStretch { from_m, to_m, censored });
        }
    };
    for (i, event) in events.iter().enumerate() {
        if !event.localised {
            failed = true;
            continue;
        }
        let missing_frames = i > 0 && event.travelled_m - last_m > continuity_m;
        if failed || missing_frames {
            push(last_m, event.travelled_m, !localised_before);
        }
        (last_m, failed, localised_before) = (event.travelled_m, false, true);
    }
    if failed || events.is_empty() {
        push(last_m, end_m, true);
    }
    stretches
}

fn median_spacing(events: &[Event]) -> f64 {
    let mut spacings: Vec<f64> = events.windows(2).map(|pair| pair[1].travelled_m - pair[0].travelled_m).collect();
    spacings.sort_by(f64::total_cmp);
    // Without two events no spacing is known, and no pair of localisations can be too far apart.
    spacings.get(spacings.len() / 2).copied().unwrap_or(f64::INFINITY)
}

/// Where curves are drawn: every 0.25 m to 10 m, every metre to 50 m, every 5 m to the route's end.
fn distances(route_m: f64) -> Vec<f64> {
    let fine = (0..40).map(|i| f64::from(i) * 0.25);
    let middle = (10..50).map(f64::from);
    let coarse = (10..).map(|i| f64::from(i) * 5.0).take_while(move |d| *d <= route_m.max(50.0));
    fine.chain(middle).chain(coarse).collect()
}

#[cfg(test)]
mod tests;
