//! Axes beside traversals and experiences: whatever else is compared has a list of values, and every combination of
//! them is a setting.

use super::{Axes, Collective, ContrastSpec, Matrix};
use furrow_localiser::hub::Policy;
use furrow_model::KeyframePolicy;
use serde::{Deserialize, Deserializer, Serialize};
use toml::Spanned;

/// A value of the axis `threshold`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ThresholdEntry {
    /// Inliers.
    Inliers(u32),
    /// `"calibrated"` on wrong places of the vocabulary route.
    Calibrated,
}

impl<'de> Deserialize<'de> for ThresholdEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = toml::Value::deserialize(deserializer)?;
        let inliers = value.as_integer().and_then(|inliers| u32::try_from(inliers).ok()).map(Self::Inliers);
        let entry = inliers.or_else(|| (value.as_str() == Some("calibrated")).then_some(Self::Calibrated));
        entry.ok_or_else(|| {
            serde::de::Error::custom(format!("{value} is no threshold: expected inliers, as in 40, or \"calibrated\""))
        })
    }
}

/// How words are found in the vocabulary's features.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Trainer {
    /// k-means with as many words as asked for.
    #[default]
    KMeans,
    /// openFABMAP's clustering by radius: the words are as many as the features need.
    Sequential,
}

/// One combination of all values: a matrix without these axes, and what tells it from the others.
#[derive(Debug, Clone)]
pub struct Setting {
    /// What differs, as in `2400 words, seed 1`; empty where there is one setting only.
    pub label: String,
    /// The matrix.
    pub matrix: Matrix,
}

impl Axes {
    /// The axis that is given without a value.
    pub(super) fn empty(&self) -> Option<&'static str> {
        let axes = [
            ("words", self.words.as_ref().map(Vec::len)),
            ("images", self.images.as_ref().map(Vec::len)),
            ("keyframes", self.keyframes.as_ref().map(Vec::len)),
            ("threshold", self.threshold.as_ref().map(Vec::len)),
            ("method", self.method.as_ref().map(Vec::len)),
            ("policy", self.policy.as_ref().map(Vec::len)),
            ("seed", self.seed.as_ref().map(Vec::len)),
        ];
        axes.into_iter().find(|(_, len)| *len == Some(0)).map(|(name, _)| name)
    }
}

impl Matrix {
    /// Every combination of the values of the axes beside `live` and `experience`, the last axis changing fastest:
    /// codebook, keyframes, method, threshold, seed.
    pub fn settings(&self) -> Vec<Setting> {
        let axes = self.axes.clone();
        let plain = Axes {
            words: None,
            images: None,
            keyframes: None,
            threshold: None,
            method: None,
            policy: None,
            seed: None,
            ..axes.clone()
        };
        let (collective, contrast) = by_policy(self, axes.policy.as_deref());
        let base = Matrix { axes: plain, collective, contrast, ..self.clone() };
        let mut settings = vec![Setting { label: String::new(), matrix: base }];
        cross(
            &mut settings,
            &axes.words,
            |words| format!("{words} words"),
            |matrix, words| matrix.codebook.words = words,
        );
        let images = |matrix: &mut Matrix, images| matrix.codebook.images = images;
        cross(&mut settings, &axes.images, |images| format!("{images} vocabulary images"), images);
        let keyframes = |matrix: &mut Matrix, keyframes| matrix.keyframes = keyframes;
        let every = |policy: KeyframePolicy| format!("keyframes {} m {} rad", policy.distance_m, policy.yaw_rad);
        cross(&mut settings, &axes.keyframes, every, keyframes);
        // What belongs to another method is left aside, so that they can stand side by side.
        cross(&mut settings, &axes.method, Spanned::into_inner, |matrix, method| matrix.localiser.method = method);
        let name = |entry: ThresholdEntry| match entry {
            ThresholdEntry::Inliers(inliers) => format!("threshold {inliers}"),
            ThresholdEntry::Calibrated => "calibrated threshold".to_owned(),
        };
        cross(&mut settings, &axes.threshold, name, |matrix, entry| {
            matrix.verification.threshold = match entry {
                ThresholdEntry::Inliers(inliers) => Some(inliers),
                ThresholdEntry::Calibrated => None,
            };
        });
        cross(&mut settings, &axes.seed, |seed| format!("seed {seed}"), |matrix, seed| matrix.seed = seed);
        settings
    }
}

/// Every setting with every value of an axis that is given. An axis of one value tells nothing apart.
fn cross<T: Clone + PartialEq>(
    settings: &mut Vec<Setting>,
    values: &Option<Vec<T>>,
    name: impl Fn(T) -> String,
    set: impl Fn(&mut Matrix, T),
) {
    let Some(values) = values else { return };
    let mut distinct: Vec<T> = Vec::new();
    for value in values {
        if !distinct.contains(value) {
            distinct.push(value.clone());
        }
    }
    let with = |setting: &Setting, value: T| {
        let mut setting = setting.clone();
        set(&mut setting.matrix, value.clone());
        if distinct.len() > 1 {
            let comma = if setting.label.is_empty() { "" } else { ", " };
            setting.label = format!("{}{comma}{}", setting.label, name(value));
        }
        setting
    };
    *settings = settings.iter().flat_map(|setting| distinct.iter().map(|value| with(setting, value.clone()))).collect();
}

/// Collectives without a policy of their own, and contrasts that name one, stand once for each policy of the axis.
fn by_policy(matrix: &Matrix, policies: Option<&[Policy]>) -> (Vec<Collective>, Vec<ContrastSpec>) {
    let Some(policies) = policies else { return (matrix.collective.clone(), matrix.contrast.clone()) };
    // The default stands nowhere in the file.
    let spreads = |collective: &Collective| collective.policy.span() == (0..0);
    let named = |name: &str, policy: &Policy| match policies.len() {
        1 => name.to_owned(),
        _ => format!("{name} ({policy})"),
    };
    let collectives = matrix.collective.iter().flat_map(|collective| {
        let of = |policy: &Policy| Collective {
            name: named(&collective.name, policy),
            policy: Spanned::new(0..0, *policy),
            ..collective.clone()
        };
        if spreads(collective) { policies.iter().map(of).collect() } else { vec![collective.clone()] }
    });
    let is_spread = |side: &Spanned<String>| {
        matrix.collective.iter().any(|collective| spreads(collective) && collective.name == *side.get_ref())
    };
    let contrasts = matrix.contrast.iter().flat_map(|contrast| {
        let side = |side: &Spanned<String>, policy: &Policy| match is_spread(side) {
            true => Spanned::new(side.span(), named(side.get_ref(), policy)),
            false => side.clone(),
        };
        let of = |policy: &Policy| ContrastSpec { of: side(&contrast.of, policy), over: side(&contrast.over, policy) };
        let spread = is_spread(&contrast.of) || is_spread(&contrast.over);
        if spread { policies.iter().map(of).collect() } else { vec![contrast.clone()] }
    });
    (collectives.collect(), contrasts.collect())
}
