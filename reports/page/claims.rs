//! The thesis' claims as one page: what it found, what was found here, and whether the claim holds.

use super::template::Templates;
use crate::chart::palette::{Tone, Tones};
use crate::error::ReportError;
use crate::wording;
use serde::Serialize;
use std::collections::BTreeSet;

/// Everything the page shows.
#[derive(Debug, Clone)]
pub struct ClaimsInput {
    /// The claims, in order.
    pub claims: Vec<ClaimInput>,
    /// The runs that they are judged by.
    pub runs: Vec<RunInput>,
    /// The command that makes this page again.
    pub command: String,
    /// The version of furrow that made it.
    pub furrow_version: String,
}

/// A claim and its verdict.
#[derive(Debug, Clone)]
pub struct ClaimInput {
    /// Its name.
    pub id: String,
    /// The experiments that it is judged by.
    pub experiments: String,
    /// What the thesis found.
    pub finding: String,
    /// What was found here.
    pub ours: String,
    /// `holds`, `does not hold`, `not separable` or `not measured`.
    pub verdict: String,
    /// What the verdict rests on.
    pub why: String,
}

/// A run behind the claims.
#[derive(Debug, Clone)]
pub struct RunInput {
    /// The experiment.
    pub experiment: String,
    /// The matrix' name.
    pub name: String,
    /// The site.
    pub site: String,
    /// The beginning of the run's id.
    pub run: String,
    /// Finished cells.
    pub cells: usize,
    /// Cells that are blocked or not finished.
    pub missing: usize,
    /// Its report's file, as a link from this page; none where there is none.
    pub report: Option<String>,
}

#[derive(Serialize)]
struct View {
    tones: Vec<Tone>,
    claims: Vec<ClaimView>,
    tally: Vec<(String, usize)>,
    runs: Vec<RunView>,
    command: String,
    version: String,
}

#[derive(Serialize)]
struct ClaimView {
    id: String,
    experiments: String,
    finding: String,
    ours: String,
    verdict: String,
    why: String,
    badge: &'static str,
    sign: &'static str,
}

#[derive(Serialize)]
struct RunView {
    experiment: String,
    name: String,
    site: String,
    run: String,
    cells: String,
    missing: usize,
    report: Option<String>,
}

/// How verdicts are marked: never by colour alone.
const VERDICTS: [(&str, &str, &str); 4] =
    [("holds", "right", "✓"), ("does not hold", "wrong", "✕"), ("not separable", "", "≈"), ("not measured", "", "–")];

/// Draws the claims as one self-contained HTML page: no network, no script, every name escaped. Equal inputs give equal
/// bytes.
///
/// # Errors
/// [`ReportError::Template`], a bug in the crate itself.
pub fn claims_page(input: &ClaimsInput) -> Result<String, ReportError> {
    let mark = |verdict: &str| VERDICTS.iter().find(|known| known.0 == verdict).copied().unwrap_or(VERDICTS[3]);
    let claim = |claim: &ClaimInput| {
        let (verdict, badge, sign) = mark(&claim.verdict);
        ClaimView {
            id: wording::shown(&claim.id),
            experiments: wording::shown(&claim.experiments),
            finding: wording::shown(&claim.finding),
            ours: wording::shown(&claim.ours),
            verdict: verdict.to_owned(),
            why: wording::shown(&claim.why),
            badge,
            sign,
        }
    };
    let run = |run: &RunInput| RunView {
        experiment: wording::shown(&run.experiment),
        name: wording::shown(&run.name),
        site: wording::shown(&run.site),
        run: wording::shown(&run.run),
        cells: wording::counted(run.cells, "cell", "cells"),
        missing: run.missing,
        report: run.report.as_deref().map(wording::shown),
    };
    let count = |verdict: &str| input.claims.iter().filter(|claim| claim.verdict == verdict).count();
    Templates::new()?.claims(View {
        tones: Tones::new(BTreeSet::new()).all(),
        claims: input.claims.iter().map(claim).collect(),
        tally: VERDICTS.iter().map(|(verdict, ..)| ((*verdict).to_owned(), count(verdict))).collect(),
        runs: input.runs.iter().map(run).collect(),
        command: wording::shown(&input.command),
        version: wording::shown(&input.furrow_version),
    })
}
