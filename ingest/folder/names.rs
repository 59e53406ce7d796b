//! What the names of a folder's images say: frame numbers or moments.
//!
//! Names of one folder are read together: they have the same letters in the same places, and one of their numbers
//! counts or tells the time. Dates may be cut by separators, and seconds may have a fraction.

use super::numbers::{Reading, date_ns, days_of, decimal_ns, read_digits};

/// What the names of a folder's images say, one number an image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Named {
    /// Frame numbers.
    Frames(Vec<u64>),
    /// Stamps, nanoseconds.
    Stamps(Vec<i64>),
}

/// Names that are not understood: which of them, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct NameFault {
    /// The place of a name.
    pub(super) at: usize,
    /// What was expected, what was found.
    pub(super) fault: String,
}

/// A name cut at its digits.
struct Cut<'a> {
    /// Runs of digits.
    runs: Vec<&'a str>,
    /// What stands before, between and behind them.
    texts: Vec<&'a str>,
}

/// Reads names without their extensions.
pub(super) fn read_names(stems: &[&str]) -> Result<Named, NameFault> {
    let cuts: Vec<Cut<'_>> = stems.iter().map(|stem| cut(stem)).collect();
    let fault = |at: usize, fault: String| Err(NameFault { at, fault });
    let Some(first) = cuts.first() else { return Ok(Named::Frames(Vec::new())) };
    if let Some(at) = cuts.iter().position(|cut| cut.texts != first.texts) {
        return fault(at, format!("expected a name like '{}'", stems[0]));
    }
    if first.runs.is_empty() {
        return fault(0, "its name has no number".to_owned());
    }
    if let Some(stamps) = dates(&cuts).or_else(|| decimals(&cuts)) {
        return Ok(Named::Stamps(stamps));
    }
    let is_point = |at: &usize| first.texts[at + 1] == "." && first.runs[*at].len() == 10;
    let is_second = |at: usize| matches!(read_digits(first.runs[at]), Ok(Reading::Stamp(_)));
    if (0..first.runs.len() - 1).filter(is_point).any(is_second) {
        let why = "the digits behind the point of its seconds are of uneven length: fractions of a second, or \
                   nanoseconds? Fill them up to nine digits";
        return fault(0, why.to_owned());
    }
    let varies = |&run: &usize| cuts.iter().any(|cut| cut.runs[run] != first.runs[run]);
    let mut varying: Vec<usize> = (0..first.runs.len()).filter(varies).collect();
    if varying.is_empty() {
        varying.push(first.runs.len() - 1);
    }
    if let [run] = varying[..] {
        return numbers(&cuts, run);
    }
    // Behind a running number, a moment. What follows a moment may be a part of it: nobody can tell.
    match varying.last().map(|&run| numbers(&cuts, run)) {
        Some(Ok(Named::Stamps(stamps))) => Ok(Named::Stamps(stamps)),
        _ => fault(0, format!("{} of its numbers change from name to name: expected one that counts", varying.len())),
    }
}

/// One run of digits of every name; all must be of one kind.
fn numbers(cuts: &[Cut<'_>], run: usize) -> Result<Named, NameFault> {
    let (mut frames, mut stamps, mut stamped) = (Vec::new(), Vec::new(), None);
    for (at, cut) in cuts.iter().enumerate() {
        match read_digits(cut.runs[run]).map_err(|fault| NameFault { at, fault })? {
            Reading::Frame(number) => frames.push(number),
            Reading::Stamp(stamp_ns) => {
                stamped.get_or_insert(cut.runs[run]);
                stamps.push(stamp_ns);
            }
        }
        if let Some(stamp) = stamped.filter(|_| !frames.is_empty()) {
            let fault =
                format!("some images are named by frame numbers, but {stamp} is a stamp: expected names of one kind");
            return Err(NameFault { at, fault });
        }
    }
    let all = |is: &dyn Fn(&str) -> bool| cuts.iter().all(|cut| is(cut.runs[run]));
    if !stamps.is_empty() {
        let is_date = |digits: &str| match digits.len() {
            10 => date_ns(&format!("{digits}0000")).is_some(),
            16 => date_ns(&digits[..14]).is_some(),
            _ => false,
        };
        if all(&is_date) {
            let fault = "its name may be a date or count from 1970: expected a date YYYYMMDDhhmmss with or without \
                         milliseconds";
            return Err(NameFault { at: 0, fault: fault.to_owned() });
        }
        return Ok(Named::Stamps(stamps));
    }
    // A day is no frame number: 20240630 and 20240701 do not lie 71 frames apart.
    if cuts.len() > 1 && all(&|digits| days_of(digits).is_some()) {
        return Err(NameFault { at: 0, fault: "its name is a date without a time of day".to_owned() });
    }
    Ok(Named::Frames(frames))
}

/// Dates with times of day, in whole or cut by separators, in the same place of every name.
fn dates(cuts: &[Cut<'_>]) -> Option<Vec<i64>> {
    let runs = cuts.first()?.runs.len();
    let windows = (0..runs).flat_map(|from| (from + 1..=runs).rev().map(move |to| (from, to)));
    windows.into_iter().find_map(|(from, to)| cuts.iter().map(|cut| date(cut, from, to)).collect())
}

fn date(cut: &Cut<'_>, from: usize, to: usize) -> Option<i64> {
    // Between runs stands one character, and a run ends where a part of the date does.
    let is_apart = |text: &&str| text.chars().count() == 1;
    let last = cut.runs[to - 1];
    let mut length = 0;
    for run in &cut.runs[from..to - 1] {
        length += run.len();
        if !matches!(length, 4 | 6 | 8 | 10 | 12 | 14) {
            return None;
        }
    }
    let digits = cut.runs[from..to].concat();
    // A date and six digits that start as a counter does are a day's running number: 20240612_000001.
    let is_counter = length == 8 && last.starts_with("0000");
    (!is_counter && cut.texts[from + 1..to].iter().all(is_apart)).then(|| date_ns(&digits))?
}

/// Seconds and their fraction, or seconds and nine digits of nanoseconds, in the same place of every name.
fn decimals(cuts: &[Cut<'_>]) -> Option<Vec<i64>> {
    let runs = cuts.first()?.runs.len();
    (0..runs.saturating_sub(1)).find_map(|at| {
        let is_point = cuts[0].texts[at + 1] == ".";
        let fractions: Vec<&str> = cuts.iter().map(|cut| cut.runs[at + 1]).collect();
        let is_even = fractions.iter().all(|fraction| fraction.len() == fractions[0].len());
        // Of uneven length they are decimals whose last zeros were left out, unless they may be nanoseconds that were
        // not filled up with zeros: then nobody can tell.
        let is_cut =
            fractions.iter().all(|fraction| fraction.len() < 9 && (*fraction == "0" || !fraction.ends_with('0')));
        // A camera that counts from power-on: the name is nothing else, and its seconds go on.
        let is_alone =
            runs == 2 && cuts[0].texts[0].is_empty() && cuts.iter().any(|cut| cut.runs[0] != cuts[0].runs[0]);
        let has_seconds = |cut: &Cut<'_>| {
            let (seconds, fraction) = (cut.runs[at].len(), cut.runs[at + 1].len());
            (is_point && (seconds == 10 || (is_alone && fraction >= 3))) || (seconds == 10 && fraction == 9)
        };
        let is_readable = cuts.iter().all(has_seconds) && (is_even || (is_point && is_cut));
        let stamp = |cut: &Cut<'_>| decimal_ns(cut.runs[at], cut.runs[at + 1]);
        is_readable.then(|| cuts.iter().map(stamp).collect())?
    })
}

fn cut(stem: &str) -> Cut<'_> {
    let (mut runs, mut texts, mut rest) = (Vec::new(), Vec::new(), stem);
    loop {
        let text = rest.find(|c: char| c.is_ascii_digit()).unwrap_or(rest.len());
        texts.push(&rest[..text]);
        rest = &rest[text..];
        let run = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        if run == 0 {
            return Cut { runs, texts };
        }
        runs.push(&rest[..run]);
        rest = &rest[run..];
    }
}

#[cfg(test)]
#[path = "names_tests.rs"]
mod tests;
