//! C7: vocabularies: how they grow with images, and whether more words localise better.

use super::evidence::{Cell, Evidence};
use super::verdict::{Claim, Measured, Verdict};
use crate::RunError;
use furrow_catalog::Catalog;
use furrow_catalog::records::{self, CodebookRecord};
use furrow_model::ObjectId;
use std::collections::BTreeMap;

/// The longest training must take so long for the times to tell anything; seconds.
const TELLING_S: f64 = 10.0;

/// C7, first half: words flatten out with images, time does not.
pub(super) fn growth(catalog: &Catalog, evidence: &Evidence) -> Result<Claim, RunError> {
    let (id, experiments) = ("C7 growth", "X01");
    let finding = "Words grow steeply with images and then level off; training time grows ever faster.";
    let mut points: BTreeMap<usize, (u32, Option<f64>)> = BTreeMap::new();
    for cell in evidence.cells(&["X01"]) {
        let Some(codebook) = cell.outcome.codebook else { continue };
        let record: CodebookRecord = records::read(catalog.objects(), ObjectId(codebook.0))?;
        let took = catalog.timings("codebook", 10_000)?.into_iter().find(|row| row.subject == codebook.to_string());
        points.insert(record.images.len(), (record.words, took.map(|row| row.seconds)));
    }
    if points.len() < 3 {
        return Ok(Claim::unmeasured(
            id,
            experiments,
            finding,
            "Fewer than three vocabularies of different numbers of images",
        ));
    }
    let text = |(images, (words, seconds)): (&usize, &(u32, Option<f64>))| {
        let took = seconds.map_or("time not known".to_owned(), |seconds| format!("{seconds:.1} s"));
        format!("{images} images {words} words {took}")
    };
    let rows: Vec<String> = points.iter().map(text).collect();
    let words: Vec<(f64, f64)> = points.iter().map(|(n, (words, _))| (*n as f64, f64::from(*words))).collect();
    let times: Option<Vec<(f64, f64)>> =
        points.iter().map(|(n, (_, seconds))| seconds.map(|s| (*n as f64, s))).collect();
    let concave = slopes(&words).windows(2).all(|pair| pair[1] <= pair[0]);
    let power = times.as_deref().and_then(power);
    // Below that, one measurement on a machine that does other things says nothing.
    let long = times.is_some_and(|times| times.iter().any(|(_, seconds)| *seconds >= TELLING_S));
    let verdict = match (concave, power) {
        (_, None) => Verdict::NotMeasured,
        (false, _) => Verdict::DoesNotHold,
        (true, Some(power)) if long && power.low > 1.0 => Verdict::Holds,
        (true, Some(power)) if long && power.high < 1.0 => Verdict::DoesNotHold,
        (true, Some(_)) => Verdict::NotSeparable,
    };
    let grows = power.map_or("not known".to_owned(), |p| format!("{:.2} [{:.2}, {:.2}]", p.value, p.low, p.high));
    let ours = format!(
        "{}. Words level off: {}; the power of images that time grows with: {grows}.",
        rows.join("; "),
        if concave { "yes" } else { "no" },
    );
    let why = format!(
        "Time grows ever faster where the power is above 1: least squares of logarithms over one measurement each, with Student's interval; \
         where none takes {TELLING_S} s, times tell nothing. Words are counts, without interval."
    );
    Ok(Claim { id, experiments, finding, ours, verdict, why })
}

/// The power of x that y grows with, by least squares of logarithms, and its 95 % interval by Student's t; None below
/// three points, and where a logarithm does not exist.
fn power(points: &[(f64, f64)]) -> Option<Measured> {
    // Two-sided 5 % points of t with 1, 2, 3 … degrees of freedom; the last serves for more.
    const STUDENT: [f64; 10] = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228];
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (libm::log(*x), libm::log(*y))).collect();
    let n = logs.len() as f64;
    let freedom = logs.len().checked_sub(2).filter(|freedom| *freedom > 0)?;
    let [mean_x, mean_y] = [logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n];
    let spread: f64 = logs.iter().map(|p| (p.0 - mean_x) * (p.0 - mean_x)).sum();
    let value = logs.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum::<f64>() / spread;
    let rest: f64 = logs.iter().map(|p| p.1 - mean_y - value * (p.0 - mean_x)).map(|rest| rest * rest).sum();
    let wide = STUDENT[freedom.min(STUDENT.len()) - 1] * (rest / (freedom as f64 * spread)).sqrt();
    wide.is_finite().then_some(Measured { value, low: value - wide, high: value + wide })
}

fn slopes(points: &[(f64, f64)]) -> Vec<f64> {
    points.windows(2).map(|pair| (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0)).collect()
}

/// C7, second half: the share of good localisations has its maximum at a middle size.
pub(super) fn peak(evidence: &Evidence) -> Claim {
    let (id, experiments) = ("C7 peak", "X02");
    let finding = "The share of good localisations is greatest at a middle number of words, about 6000; more words are not better.";
    let mut by_words: BTreeMap<u32, Vec<Measured>> = BTreeMap::new();
    for Cell { outcome, .. } in evidence.cells(&["X02"]) {
        let returned = f64::from(outcome.evaluation.returned.max(1));
        let Measured { value, low, high } = Measured::good(outcome);
        let share = Measured { value: value / returned, low: low / returned, high: (high / returned).min(1.0) };
        by_words.entry(outcome.codebook_words).or_default().push(share);
    }
    let points: Vec<(u32, Measured)> =
        by_words.into_iter().filter_map(|(words, shares)| Measured::mean(&shares).map(|mean| (words, mean))).collect();
    let best = points.iter().max_by(|a, b| a.1.value.total_cmp(&b.1.value));
    let (Some(best), true) = (best, points.len() > 2) else {
        return Claim::unmeasured(id, experiments, finding, "Fewer than three vocabularies of different sizes");
    };
    let (first, last) = (&points[0], &points[points.len() - 1]);
    let inner = best.0 != first.0 && best.0 != last.0;
    let verdict = match inner {
        true if [first, last].iter().all(|end| best.1.exceeds(end.1) == Verdict::Holds) => Verdict::Holds,
        false
            if points
                .iter()
                .filter(|p| p.0 != first.0 && p.0 != last.0)
                .all(|p| best.1.exceeds(p.1) == Verdict::Holds) =>
        {
            Verdict::DoesNotHold
        }
        _ => Verdict::NotSeparable,
    };
    let text = |(words, m): &(u32, Measured)| {
        format!("{words} words {:.1} % [{:.1}, {:.1}]", 100.0 * m.value, 100.0 * m.low, 100.0 * m.high)
    };
    let rows: Vec<String> = points.iter().map(text).collect();
    let ours =
        format!("Share of the frames with an answer that are good: {}. Greatest at {} words.", rows.join("; "), best.0);
    let why = match (verdict, inner) {
        (Verdict::Holds, _) => "The greatest share is a middle one, and its interval lies above those of both ends.",
        (Verdict::DoesNotHold, _) => "The greatest share is at an end, and its interval lies above all in the middle.",
        (_, true) => "The greatest share is a middle one, but its interval meets that of an end.",
        (_, false) => "The greatest share is at an end, but its interval meets one in the middle.",
    };
    Claim { id, experiments, finding, ours, verdict, why: why.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_gives_its_power_and_scatter_an_interval() {
        let exact: Vec<(f64, f64)> = [250.0, 500.0, 1000.0, 2000.0].map(|x: f64| (x, 3.0 * x * x.sqrt())).to_vec();
        let found = power(&exact).unwrap();
        assert!([found.value, found.low, found.high].iter().all(|power| (power - 1.5).abs() < 1e-9), "{found:?}");
        // Logarithms 0, 1, 2 and 0, 2, 2 to base e: a slope of 1, residuals of -1/3, 2/3 and -1/3, so a standard error
        // of sqrt(6/9 / 2).
        let e = std::f64::consts::E;
        let found = power(&[(1.0, 1.0), (e, e * e), (e * e, e * e)]).unwrap();
        assert!(
            (found.value - 1.0).abs() < 1e-9 && (found.high - 1.0 - 12.706 / 3.0_f64.sqrt()).abs() < 1e-6,
            "{found:?}"
        );
        assert!(power(&exact[..2]).is_none() && power(&[(1.0, 1.0), (2.0, 0.0), (3.0, 1.0)]).is_none());
    }
}
