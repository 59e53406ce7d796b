//! The contrasts of a matrix resolved: which cell is set against which, and what is to be said of claims without a
//! placebo.

use super::cell::{Against, Labelled};
use super::draft::Draft;
use super::index::{ContenderIx, LiveIx};
use crate::matrix::{ContrastSpec, Part, Selection, Side, place_of};
use crate::{RunError, suggest};
use furrow_catalog::records::{ContrastPair, RunContrasts};
use furrow_generator::kinds::is_placebo;
use furrow_model::CellKey;
use std::ops::Range;

/// What a contender is, as claims see it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Recorded,
    Generated,
    Placebo,
}

/// What a side of a contrast came to: places among what cells localise against, or why there are none.
type Places = Result<Vec<usize>, String>;

impl Draft<'_> {
    /// The matrix' contrasts over `against`; `none` are the collectives that have no members, with the reason.
    pub(super) fn resolve_contrasts(
        &self,
        against: &[Against],
        none: &[Labelled<String>],
    ) -> Result<Option<RunContrasts>, RunError> {
        if self.matrix.contrast.is_empty() {
            return Ok(None);
        }
        let names = Names { draft: self, against, none };
        let (mut pairs, mut warnings) = (Vec::new(), Vec::new());
        for spec in &self.matrix.contrast {
            for (of, over) in names.pairs(spec, &mut warnings)? {
                if !pairs.contains(&(of, over)) {
                    pairs.push((of, over));
                }
            }
        }
        warnings.extend(names.without_placebo(&pairs));
        let pair = |(of, over): &(usize, usize)| {
            let (of, over) = (against[*of].label.clone(), against[*over].label.clone());
            ContrastPair { cells: self.shared(&of, &over), of, over }
        };
        Ok(Some(RunContrasts {
            setting: self.setting.to_owned(),
            pairs: pairs.iter().map(pair).collect(),
            censored: self.matrix.evaluation.censored,
            seed: self.matrix.seed,
            warnings,
        }))
    }

    /// The cells of two contenders on each live traversal that both meet.
    fn shared(&self, of: &str, over: &str) -> Vec<[CellKey; 2]> {
        let key = |live: LiveIx, label: &str| {
            self.cells.iter().find(|cell| cell.live == live && cell.label == label).map(|cell| cell.key)
        };
        LiveIx::all(self.lives.len()).filter_map(|live| Some([key(live, of)?, key(live, over)?])).collect()
    }
}

/// What contrasts may name.
struct Names<'a> {
    draft: &'a Draft<'a>,
    against: &'a [Against],
    none: &'a [Labelled<String>],
}

impl Names<'_> {
    /// The pairs of one entry of the matrix.
    fn pairs(&self, spec: &ContrastSpec, warnings: &mut Vec<String>) -> Result<Vec<(usize, usize)>, RunError> {
        let read = |side: Result<Side, String>, span: Range<usize>| side.map_err(|reason| self.wrong(span, reason));
        let of = read(Side::of(spec.of.get_ref()), spec.of.span())?;
        let over = read(Side::over(spec.over.get_ref()), spec.over.span())?;
        let title = format!("contrast of \"{}\" over \"{}\"", spec.of.get_ref(), spec.over.get_ref());
        let mut found = Vec::new();
        let asked = match self.places(&of, spec.of.span())? {
            Ok(places) => places,
            Err(reason) => {
                warnings.push(format!("{title}: {reason}"));
                return Ok(found);
            }
        };
        for of in asked {
            let beaten = match &over {
                Side::Parent => self.parents(of).map_err(|reason| self.wrong(spec.over.span(), reason))?,
                Side::Mimicked => self.mimicked(of).map_err(|reason| self.wrong(spec.over.span(), reason))?,
                Side::Placebo => self.placebo(of).map_err(|reason| self.wrong(spec.over.span(), reason))?,
                named => self.places(named, spec.over.span())?,
            };
            match beaten {
                Ok(places) if places == [of] => {
                    let label = &self.against[of].label;
                    return Err(self.wrong(spec.over.span(), format!("'{label}' is set against itself")));
                }
                Ok(places) => found.extend(places.into_iter().filter(|over| *over != of).map(|over| (of, over))),
                Err(reason) => {
                    let warning = format!("{title}: {reason}");
                    if !warnings.contains(&warning) {
                        warnings.push(warning);
                    }
                }
            }
        }
        Ok(found)
    }

    /// What a side names by itself.
    fn places(&self, side: &Side, span: Range<usize>) -> Result<Places, RunError> {
        match side {
            Side::Each(selection) => Ok(self.each(selection)),
            Side::Name(name) => self.named(name, span),
            Side::Parent | Side::Mimicked | Side::Placebo => Ok(Ok(Vec::new())),
        }
    }

    fn each(&self, selection: &Selection) -> Places {
        let places: Vec<usize> = self.draft.selected(selection).into_iter().filter_map(|i| self.alone(i)).collect();
        if places.is_empty() { Err("it selects no experience of the axis that exists".to_owned()) } else { Ok(places) }
    }

    /// Where cells localise against a contender alone.
    fn alone(&self, contender: ContenderIx) -> Option<usize> {
        self.against.iter().position(|against| against.members == [contender])
    }

    /// A collective or experience of this name, or the one generated experience whose label begins with it.
    fn named(&self, name: &str, span: Range<usize>) -> Result<Places, RunError> {
        let among = |count: usize, is: &dyn Fn(&str) -> bool| -> Vec<usize> {
            (0..count).filter(|i| is(&self.against[*i].label)).collect()
        };
        let begin = format!("{name} (");
        let mut places = among(self.against.len(), &|label| label == name);
        if places.is_empty() {
            // Entries of the axis come first.
            places = among(self.draft.axis, &|label| label.starts_with(&begin));
        }
        let missing = self.draft.no_contenders.iter().chain(self.none).find(|(label, _)| label == name);
        match (places.as_slice(), missing) {
            ([place], _) => Ok(Ok(vec![*place])),
            ([], Some((_, reason))) => Ok(Err(format!("'{name}': {reason}"))),
            ([], None) => {
                let known = self.against.iter().map(|against| &*against.label);
                let hint = suggest::nearest(name, known);
                Err(self.wrong(span, format!("nothing is called '{name}'{hint}")))
            }
            (several, _) => {
                let listed: Vec<&str> = several.iter().map(|i| &*self.against[*i].label).collect();
                let reason = format!("'{name}' may be {}: write one of them out", listed.join(" or "));
                Err(self.wrong(span, reason))
            }
        }
    }

    /// The recorded experiences that the members of one were generated from.
    fn parents(&self, of: usize) -> Result<Places, String> {
        let (mut places, mut absent) = (Vec::new(), Vec::new());
        for i in &self.against[of].members {
            let Some(making) = &self.draft.contender(*i).making else { continue };
            let is_parent = |other: &ContenderIx| {
                let other = self.draft.contender(*other);
                other.making.is_none() && other.record == making.parent
            };
            match ContenderIx::all(self.draft.contenders.len()).find(is_parent).and_then(|parent| self.alone(parent)) {
                Some(place) if !places.contains(&place) => places.push(place),
                Some(_) => {}
                None => absent.push(making.parent_slot),
            }
        }
        match (places.is_empty(), absent.first()) {
            (true, None) => Err(format!("'{}' has no parent: none of it is generated", self.against[of].label)),
            (_, Some(slot)) => {
                Ok(Err(format!("the parent at {slot} is not on the axis: add \"{slot}\" to experience")))
            }
            _ => Ok(Ok(places)),
        }
    }

    /// The recorded experiences at the slot that one mimics.
    fn mimicked(&self, of: usize) -> Result<Places, String> {
        let against = &self.against[of];
        let [member] = against.members.as_slice() else {
            return Err(format!(
                "'{}' mimics several slots: ask for \"each generated\" over \"mimicked\"",
                against.label
            ));
        };
        let contender = self.draft.contender(*member);
        if contender.making.is_none() {
            return Err(format!("'{}' is recorded and mimics nothing", against.label));
        }
        let slot = contender.slot;
        let places = self.each(&Selection { parts: vec![Part::Slots(vec![slot])] });
        Ok(places.map_err(|_| format!("nothing recorded at {slot} is on the axis: add \"{slot}\" to experience")))
    }

    /// The collective of placebos beside one.
    fn placebo(&self, of: usize) -> Result<Places, String> {
        let label = &self.against[of].label;
        if !self.draft.matrix.collective.iter().any(|collective| collective.name == *label && collective.placebo) {
            return Err(format!("'{label}' has no placebo: collectives with placebo = true have one"));
        }
        let placebo = format!("{label} (placebo)");
        let place = self.against.iter().position(|against| against.label == placebo);
        Ok(place.map(|place| vec![place]).ok_or_else(|| {
            let reason = self.none.iter().find(|(label, _)| *label == placebo).map(|(_, reason)| reason.clone());
            reason.unwrap_or_else(|| format!("'{placebo}' has no members"))
        }))
    }

    fn kind(&self, place: usize) -> Kind {
        let makings = self.against[place].members.iter().filter_map(|i| self.draft.contender(*i).making.as_ref());
        let placebos: Vec<bool> = makings.map(|making| is_placebo(&making.record.kind)).collect();
        match placebos.as_slice() {
            [] => Kind::Recorded,
            all if all.iter().all(|placebo| *placebo) => Kind::Placebo,
            _ => Kind::Generated,
        }
    }

    /// Of every claim that something generated beats something recorded: is the same set against a placebo? Without,
    /// luck is not told from skill, since the best of many answers is taken.
    fn without_placebo(&self, pairs: &[(usize, usize)]) -> Vec<String> {
        let is = |(of, over): &(usize, usize), kind| self.kind(*of) == Kind::Generated && self.kind(*over) == kind;
        let checked: Vec<usize> = pairs.iter().filter(|pair| is(pair, Kind::Placebo)).map(|pair| pair.0).collect();
        let bare = |pair: &&(usize, usize)| {
            let collective = self.against[pair.0].members.len() > 1;
            is(pair, Kind::Recorded) && if collective { !checked.contains(&pair.0) } else { checked.is_empty() }
        };
        let warning = |(of, over): &(usize, usize)| {
            let (of, over) = (&self.against[*of].label, &self.against[*over].label);
            format!(
                "'{of}' is set against '{over}' and against no placebo: that it wins may be luck; add a contrast of it over its placebo"
            )
        };
        pairs.iter().filter(bare).map(warning).collect()
    }

    fn wrong(&self, span: Range<usize>, reason: String) -> RunError {
        RunError::Plan(format!("matrix, {}contrast: {reason}", place_of(self.draft.source, span.start)))
    }
}
