//! What makes no sense in a matrix file, with its place in the text.

use super::contrast::WORDS;
use super::{ExperienceEntry, Fault, Matrix, Method, Selection, Side, Trainer};
use crate::RunError;
use crate::suggest;
use std::path::Path;
use toml::Spanned;

impl Matrix {
    /// # Errors
    /// [`RunError::Matrix`] naming file, line, column and what is wrong.
    pub(super) fn check(&self, path: &Path, text: &str, methods: &[&Method]) -> Result<(), RunError> {
        match self.fault(text, methods) {
            None => Ok(()),
            Some((at, reason)) => {
                let place = at.map(|at| place_of(text, at)).unwrap_or_default();
                Err(RunError::Matrix { path: path.to_owned(), reason: format!("{place}{reason}") })
            }
        }
    }

    /// What makes no sense, and where it stands.
    fn fault(&self, text: &str, methods: &[&Method]) -> Option<(Option<usize>, String)> {
        let at = |key: &str| position_of(text, key);
        if self.axes.live.is_empty() {
            let reason = "the axis 'live' is empty: name at least one slot, as in live = [\"08:00\"]";
            return Some((at("live"), reason.to_owned()));
        }
        if self.axes.experience.is_empty() {
            return Some((at("experience"), "the axis 'experience' is empty: name at least one slot".to_owned()));
        }
        if let Some(axis) = self.axes.empty() {
            return Some((at(axis), format!("the axis '{axis}' is empty: name at least one value, or leave it out")));
        }
        let localiser = match self.axes.method {
            None => self.localiser.check_owners(methods),
            // Where several methods stand side by side, each uses its own keys.
            Some(_) => self.localiser.check_method(methods),
        };
        if let Err(fault) = localiser {
            return Some(localiser_fault(text, fault));
        }
        let settings = self.settings();
        settings.iter().find_map(|setting| setting.matrix.setting_fault(text, methods)).or_else(|| self.entry_fault())
    }

    /// What makes no sense in one setting.
    fn setting_fault(&self, text: &str, methods: &[&Method]) -> Option<(Option<usize>, String)> {
        let at = |key: &str| position_of(text, key);
        let of_axis = |axis: &str, key: &str| at(axis).or_else(|| at(key));
        if let Err(fault) = self.localiser.check(methods) {
            return Some(localiser_fault(text, fault));
        }
        let (words, sequential) = (self.codebook.words, self.codebook.trainer == Trainer::Sequential);
        if words < 2 && !sequential {
            return Some((of_axis("words", "codebook"), format!("a codebook needs at least 2 words, not {words}")));
        }
        if words > 0 && sequential {
            let reason = "a sequential trainer finds out how many words there are: leave words out, and set radius";
            return Some((of_axis("words", "codebook"), reason.to_owned()));
        }
        if !(self.codebook.radius > 0.0 && self.codebook.radius.is_finite()) {
            return Some((at("codebook"), "radius must be greater than 0".to_owned()));
        }
        if self.codebook.images == 0 {
            return Some((of_axis("images", "codebook"), "a codebook needs at least 1 image".to_owned()));
        }
        if !(self.keyframes.distance_m > 0.0 && self.keyframes.yaw_rad > 0.0) {
            return Some((at("keyframes"), "distance_m and yaw_rad must be greater than 0".to_owned()));
        }
        if !(self.features.hessian > 0.0 && self.features.hessian.is_finite()) {
            return Some((at("features"), "hessian must be greater than 0".to_owned()));
        }
        None
    }

    /// What makes no sense in an entry that knows its place.
    fn entry_fault(&self) -> Option<(Option<usize>, String)> {
        for entry in &self.axes.experience {
            if let ExperienceEntry::Generated(generated) = entry.get_ref()
                && let Err(reason) = generated.check()
            {
                return Some((Some(entry.span().start), reason));
            }
        }
        for collective in &self.collective {
            if let Err(reason) = Selection::parse(collective.of.get_ref()) {
                return Some((Some(collective.of.span().start), reason));
            }
            if collective.policy.get_ref().count() == Some(0) {
                let reason = "a policy of 0 experiences asks none: expected at least 1".to_owned();
                return Some((Some(collective.policy.span().start), reason));
            }
            if !self.contrast.is_empty() && WORDS.contains(&collective.name.as_str()) {
                let name = &collective.name;
                let reason = format!(
                    "a collective called '{name}' cannot be told from the word of contrasts: call it otherwise"
                );
                return Some((Some(collective.of.span().start), reason));
            }
        }
        self.contrast.iter().find_map(|contrast| {
            let read = |side: &Spanned<String>, read: fn(&str) -> Result<Side, String>| {
                read(side.get_ref()).err().map(|reason| (Some(side.span().start), reason))
            };
            read(&contrast.of, Side::of).or_else(|| read(&contrast.over, Side::over))
        })
    }
}

/// What is wrong in the table `localiser`: at its key where the place is known, else at the table.
fn localiser_fault(text: &str, Fault { key, at, reason }: Fault) -> (Option<usize>, String) {
    let of_table = || position_of(text, "localiser").max(position_of(text, &key));
    (at.or_else(of_table).or_else(|| position_of(text, "method")), with_hint(&reason))
}

/// `line 3, column 7: `.
pub(crate) fn place_of(text: &str, at: usize) -> String {
    let before = &text[..at];
    let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
    format!("line {}, column {column}: ", before.matches('\n').count() + 1)
}

/// Where a line sets `key`.
fn position_of(text: &str, key: &str) -> Option<usize> {
    let sets = |line: &str| {
        let rest = line.trim_start().strip_prefix(key)?;
        rest.trim_start().starts_with(['=', '.']).then(|| line.len() - line.trim_start().len())
    };
    let mut begin = 0;
    for line in text.split_inclusive('\n') {
        if let Some(indent) = sets(line) {
            return Some(begin + indent);
        }
        begin += line.len();
    }
    None
}

/// What the TOML reader says, with the nearest of the keys it expected.
pub(super) fn with_hint(said: &str) -> String {
    let quoted = |text: &str| -> Vec<String> { text.split('`').skip(1).step_by(2).map(str::to_owned).collect() };
    let behind = |words: &str| said.rsplit_once(words).and_then(|(_, rest)| rest.split_once(", expected "));
    let unknown = ["unknown field ", "unknown variant ", "unknown method "].into_iter().find_map(behind);
    let Some((strange, expected)) = unknown else { return said.to_owned() };
    let (strange, expected) = (quoted(strange), quoted(expected));
    let hint = strange.first().map(|name| suggest::nearest(name, expected.iter().map(String::as_str)));
    match hint.filter(|hint| hint.contains("did you mean")) {
        Some(hint) => format!("{said}{hint}"),
        None => said.to_owned(),
    }
}
