//! `make bench`: one whole localisation step on two cores, from a grey pair to the verified answers of eight
//! experiences, in the simulated Old Zoo at 640x360. The thesis' robot managed 3 to 5 a second.

use crate::field_views::{Stretch, View, places, views};
use crate::row::{Row, cpu_ms, row, wall_ms_on_two};
use crate::synthetic::images;
use furrow_field::Site;
use furrow_ingest::odometry::{FrameFeatures, StereoFrame, VerifyParams, verify};
use furrow_model::{GreyImage, StereoRig};
use furrow_runner::localiser::fabmap::{FabMap, FabMapParams};
use furrow_runner::localiser::surf::{Descriptor, SurfParams, surf};
use furrow_runner::localiser::{Presence, Vocabulary, chow_liu};
use rayon::prelude::*;

/// Slot and number of the traversals behind the experiences.
const TRAVERSALS: [(&str, u32); 8] =
    [("06:00", 0), ("08:00", 0), ("10:00", 0), ("12:00", 0), ("14:00", 0), ("16:00", 0), ("10:00", 2), ("12:00", 2)];
const WORDS: usize = 6000;
/// Places of an experience: those seen here, and made-up ones up to a loop of the Old Zoo.
const PLACES: usize = 105;

struct Experience {
    places: FabMap,
    nodes: Vec<FrameFeatures>,
}

struct Step {
    rig: StereoRig,
    params: VerifyParams,
    surf: SurfParams,
    vocabulary: Vocabulary,
    experiences: Vec<Experience>,
}

impl Step {
    fn of(traversals: &[Vec<View>]) -> Option<Step> {
        let surf_params = SurfParams { upright: true, ..SurfParams::GOLDEN };
        let params = VerifyParams::default();
        let describe =
            |views: &Vec<View>| views.iter().map(|view| surf(&view.left, &surf_params).descriptors).collect();
        let described: Vec<Vec<Vec<Descriptor>>> = traversals.iter().map(describe).collect();
        let all: Vec<Descriptor> = described.iter().flatten().flatten().copied().collect();
        let words = (0..WORDS).flat_map(|word| all[word * all.len() / WORDS]).collect();
        let vocabulary = Vocabulary::from_flat(words).ok()?;
        let presence = |descriptors: &Vec<Descriptor>| vocabulary.presence(descriptors).ok();
        let seen: Vec<Vec<Presence>> =
            described.iter().map(|views| views.iter().map(presence).collect()).collect::<Option<_>>()?;
        let samples = images(500, WORDS as u64, 11);
        let tree = chow_liu::train(&samples, WORDS, 0.0).ok()?;
        let experience = |(views, seen): (&Vec<View>, &Vec<Presence>)| {
            let mut places = FabMap::new(&tree, FabMapParams::OPENFABMAP, &samples).ok()?;
            for place in seen.iter().chain(&images(PLACES - seen.len(), WORDS as u64, 17)) {
                places.add_place(place).ok()?;
            }
            let features = |view: &View| FrameFeatures::extract(&view.left, &params.matcher);
            Some(Experience { places, nodes: views.iter().map(features).collect() })
        };
        let experiences = traversals.iter().zip(&seen).map(experience).collect::<Option<_>>()?;
        let rig = furrow_field::camera::rig((640, 360));
        Some(Step { rig, params, surf: surf_params, vocabulary, experiences })
    }

    fn pair(&self, view: &View) -> StereoFrame {
        let features = |image: &GreyImage| FrameFeatures::extract(image, &self.params.matcher);
        let (left, right) = rayon::join(|| features(&view.left), || features(&view.right));
        StereoFrame::new(left, right, &self.rig, &self.params.stereo)
    }

    fn words(&self, descriptors: &[Descriptor]) -> Presence {
        self.vocabulary.presence(descriptors).unwrap_or_default()
    }

    /// Each experience's likeliest real node.
    fn best(&self, experience: &Experience, words: &Presence) -> usize {
        let found = experience.places.query(words).map(|answer| answer.ranked(PLACES)).unwrap_or_default();
        found.into_iter().find(|place| *place < experience.nodes.len()).unwrap_or(0)
    }

    /// As `furrow live` does it, but every experience's likeliest real node is verified, also where it would say new
    /// place.
    fn inliers(&self, view: &View) -> Vec<usize> {
        let words = || self.words(&surf(&view.left, &self.surf).descriptors);
        let (words, pair) = rayon::join(words, || self.pair(view));
        let ask = |experience: &Experience| {
            let node = self.best(experience, &words);
            verify(&pair, &experience.nodes[node], &self.rig, &self.params).inliers
        };
        self.experiences.par_iter().map(ask).collect()
    }

    /// CPU time of each part, for whoever wants the whole faster.
    fn parts(&self, live: &[View], rows: &mut Vec<Row>) {
        let view = |i: usize| &live[i % live.len()];
        let seen: Vec<Vec<Descriptor>> = live.iter().map(|view| surf(&view.left, &self.surf).descriptors).collect();
        let words: Vec<Presence> = seen.iter().map(|descriptors| self.words(descriptors)).collect();
        let pairs: Vec<StereoFrame> = live.iter().map(|view| self.pair(view)).collect();
        let words = &words;
        let nodes = |i: usize| self.experiences.iter().map(move |e| (e, self.best(e, &words[i % live.len()])));
        let verified = |i: usize| {
            let pair = &pairs[i % live.len()];
            nodes(i).map(|(e, node)| verify(pair, &e.nodes[node], &self.rig, &self.params).inliers).sum::<usize>()
        };
        let asked = cpu_ms(20, |i| nodes(i).map(|(_, node)| node).sum::<usize>());
        let parts = [
            ("  of it SURF, CPU time", cpu_ms(20, |i| surf(&view(i).left, &self.surf).descriptors.len())),
            ("  nearest of 6000 words", cpu_ms(20, |i| self.words(&seen[i % live.len()]))),
            ("  both images' features and depths", cpu_ms(20, |i| self.pair(view(i)).stereo_matches())),
            ("  FAB-MAP, 8 experiences", asked),
            ("  verification, 8 candidates", cpu_ms(20, verified) - asked),
        ];
        rows.extend(parts.map(|(name, ms)| row(name, ms, "ms", "", None)));
    }
}

pub fn localisation_step(rows: &mut Vec<Row>) {
    let stretch = Stretch::of(Site::OldZoo, 60.0..72.0);
    let (nodes_at, live_at) = (places(&stretch, 2.0), places(&stretch, 3.0));
    let traversals: Vec<Vec<View>> =
        TRAVERSALS.iter().map(|(slot, number)| views(&stretch, slot, *number, &nodes_at)).collect();
    let live = views(&stretch, "10:00", 1, &live_at);
    let Some(step) = Step::of(&traversals) else { return };
    let times: Vec<f64> = live.iter().map(|view| wall_ms_on_two(7, || step.inliers(view))).collect();
    let mean = times.iter().sum::<f64>() / times.len() as f64;
    let name = "localisation step, 8 experiences, wall time on two cores";
    rows.push(row(name, mean, "ms", "the thesis' 5 Hz", Some(200.0)));
    step.parts(&live, rows);
}
