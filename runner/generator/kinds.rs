//! The registry of generators that are built in: one line for each kind. Names, placebos and every list that a user
//! reads come from here.

use crate::invariant::Invariant;
use crate::{GenerateError, Generator};
use std::ops::RangeInclusive;

/// A kind of built-in generator.
pub struct Kind {
    /// Its name, as records have it.
    pub name: &'static str,
    /// Whether it knows nothing of any hour.
    pub is_placebo: bool,
    /// How a name makes one that needs no training; none of kinds that are trained.
    untrained: Option<Untrained>,
}

/// How a name becomes a generator that needs no training.
enum Untrained {
    /// The kind's name alone.
    Plain(fn() -> Generator),
    /// The kind's name, or `NAME:NUMBER`.
    Number {
        make: fn(f64) -> Generator,
        default: f64,
        range: RangeInclusive<f64>,
        what: &'static str,
        expected: &'static str,
    },
}

use Untrained::{Number, Plain};

/// The kind that `furrow generator train` trains: optimal-transport flow.
pub const OTF: &str = "otf";

/// Every kind, in the order in which lists name them.
pub static KINDS: [Kind; 6] = [
    Kind { name: OTF, is_placebo: false, untrained: None },
    Kind { name: "identity", is_placebo: true, untrained: Some(Plain(|| Generator::Identity)) },
    Kind {
        name: "invariant",
        is_placebo: false,
        untrained: Some(Plain(|| Generator::Invariant(Invariant::default()))),
    },
    Kind {
        name: "gamma",
        is_placebo: true,
        untrained: Some(Number {
            make: Generator::Gamma,
            default: 0.8,
            range: 0.1..=10.0,
            what: "the exponent of gamma",
            expected: "0.1 to 10, as in gamma:0.8",
        }),
    },
    Kind {
        name: "noise",
        is_placebo: true,
        untrained: Some(Number {
            make: Generator::Noise,
            default: 3.0,
            range: 0.0..=64.0,
            what: "the standard deviation of noise",
            expected: "0 to 64 grey levels, as in noise:3",
        }),
    },
    Kind {
        name: "blur",
        is_placebo: true,
        untrained: Some(Number {
            make: Generator::Blur,
            default: 0.8,
            range: 0.0..=32.0,
            what: "the width of blur",
            expected: "0 to 32 pixels, as in blur:0.8",
        }),
    },
];

/// Whether records of this kind are of placebos; plug-ins never are.
pub fn is_placebo(kind: &str) -> bool {
    KINDS.iter().any(|known| known.name == kind && known.is_placebo)
}

/// Names of generators that need no training, as a user may type them: `identity`, `invariant`, `gamma:0.8`, ….
pub fn untrained_names() -> Vec<String> {
    let name = |kind: &Kind| match kind.untrained.as_ref()? {
        Plain(_) => Some(kind.name.to_owned()),
        Number { default, .. } => Some(format!("{}:{default}", kind.name)),
    };
    KINDS.iter().filter_map(name).collect()
}

impl Generator {
    /// The generator of a name that needs no training; `None` for other names.
    ///
    /// # Errors
    /// [`GenerateError::Parameter`] for numbers outside the kind's range.
    pub fn named(name: &str) -> Option<Result<Self, GenerateError>> {
        let (kind, number) = name.split_once(':').map_or((name, None), |(kind, number)| (kind, Some(number)));
        match KINDS.iter().find(|known| known.name == kind)?.untrained.as_ref()? {
            Plain(make) => number.is_none().then(|| Ok(make())),
            Number { make, default, range, what, expected } => {
                // What is no number lies in no range.
                let found = number.map_or(*default, |number| number.parse().unwrap_or(f64::NAN));
                let refused = GenerateError::Parameter { what, found, expected };
                Some(if range.contains(&found) { Ok(make(found)) } else { Err(refused) })
            }
        }
    }

    /// Whether it knows nothing of any hour.
    pub fn is_placebo(&self) -> bool {
        is_placebo(self.kind())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_in_a_list_makes_a_generator_of_its_kind() {
        let names = untrained_names();
        assert_eq!(names.len(), KINDS.iter().filter(|kind| kind.untrained.is_some()).count());
        for name in names {
            let generator = Generator::named(&name).unwrap().unwrap();
            assert_eq!(
                (generator.name(), generator.is_placebo()),
                (name.clone(), is_placebo(generator.kind())),
                "{name}"
            );
            assert!(name.starts_with(generator.kind()), "{name}");
        }
        assert!(Generator::named(OTF).is_none() && Generator::named("identity:3").is_none() && !is_placebo("command"));
        assert!(matches!(Generator::named("gamma:x"), Some(Err(GenerateError::Parameter { .. }))));
    }
}
