//! What the simulated field looks like to furrow's own eyes: keypoints, verification inliers between traversals,
//! odometry against the truth. Included by the tests of the field's appearance and by its benchmark.

use furrow_catalog::images::{ColourImage, grey_of};
use furrow_field::{Frame, Simulation, Site, Traversal};
use furrow_ingest::odometry::compare::{Track, errors_per_length};
use furrow_ingest::odometry::{
    ChainBuilder, FrameFeatures, Odometry, OdometryParams, StereoFrame, VerifyParams, verify,
};
use furrow_model::{GreyImage, StereoRig};
use furrow_runner::localiser::surf::{SurfParams, detect};
use rayon::prelude::*;
use std::ops::Range;

/// Places at least this far apart are wrong for each other.
const APART_M: f64 = 10.0;

/// Part of a route, in metres along it.
#[derive(Debug, Clone)]
pub struct Stretch {
    pub site: Site,
    pub route: &'static str,
    pub metres: Range<f64>,
}

impl Stretch {
    pub fn of(site: Site, metres: Range<f64>) -> Stretch {
        Stretch { site, route: "main", metres }
    }

    fn traversal(&self, slot: &str, number: u32) -> Traversal {
        let traversal = Traversal::new(self.site, slot.parse().expect("a slot"));
        Traversal { route: self.route.to_owned(), number, length_m: self.metres.end + 2.0, ..traversal }
    }
}

/// A view of a traversal.
pub struct View {
    /// Position in the world.
    pub position: [f64; 3],
    pub left: GreyImage,
    pub right: GreyImage,
}

fn apart_m(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// A frame's image, red first.
pub fn colour(bgr: &[u8], rig: &StereoRig) -> ColourImage {
    let rgb = bgr.chunks_exact(3).flat_map(|pixel| [pixel[2], pixel[1], pixel[0]]).collect();
    ColourImage { width: rig.width as usize, height: rig.height as usize, rgb }
}

fn grey(bgr: &[u8], rig: &StereoRig) -> GreyImage {
    grey_of(&colour(bgr, rig))
}

fn images(frame: &Frame, rig: &StereoRig) -> Option<[GreyImage; 2]> {
    Some([grey(frame.left.as_ref()?, rig), grey(frame.right.as_ref()?, rig)])
}

/// Where the left camera truly is at every frame.
fn positions(simulation: &Simulation) -> Vec<[f64; 3]> {
    (0..simulation.frames()).map(|index| simulation.world_from_left(simulation.time_s(index)).translation_m).collect()
}

/// Places on a stretch, `every_m` metres: where the first traversal of 10:00 came by.
pub fn places(stretch: &Stretch, every_m: f64) -> Vec<[f64; 3]> {
    let simulation = Simulation::prepare(&stretch.traversal("10:00", 0)).expect("a sound traversal");
    let positions = positions(&simulation);
    let (mut along_m, mut next_m) = (0.0, stretch.metres.start);
    let mut last = positions[0];
    let mut chosen = Vec::new();
    for here in positions {
        along_m += apart_m(here, last);
        last = here;
        if along_m >= next_m && along_m < stretch.metres.end {
            next_m += every_m;
            chosen.push(here);
        }
    }
    chosen
}

/// What the `number`th traversal of a slot saw where it came nearest to each of `places`.
pub fn views(stretch: &Stretch, slot: &str, number: u32, places: &[[f64; 3]]) -> Vec<View> {
    let view = |position: [f64; 3], frame: &Frame, rig: &StereoRig| {
        let [left, right] = images(frame, rig).expect("no image is dropped");
        View { position, left, right }
    };
    at_places(stretch, slot, number, places, view)
}

/// The same in colour, left images only.
pub fn colours(stretch: &Stretch, slot: &str, number: u32, places: &[[f64; 3]]) -> Vec<ColourImage> {
    let left = |_, frame: &Frame, rig: &StereoRig| colour(frame.left.as_ref().expect("no image is dropped"), rig);
    at_places(stretch, slot, number, places, left)
}

/// What `taken` makes of the frame of a traversal that is nearest to each place.
fn at_places<T>(
    stretch: &Stretch,
    slot: &str,
    number: u32,
    places: &[[f64; 3]],
    taken: impl Fn([f64; 3], &Frame, &StereoRig) -> T,
) -> Vec<T> {
    let simulation = Simulation::prepare(&stretch.traversal(slot, number)).expect("a sound traversal");
    let positions = positions(&simulation);
    let nearest = |place: &[f64; 3]| {
        let from_place = |index: &usize| apart_m(positions[*index], *place);
        (0..positions.len()).min_by(|a, b| from_place(a).total_cmp(&from_place(b))).expect("a traversal has frames")
    };
    // A camera of its own at each place: between frames far apart its exposure would lag as it never does along a
    // route.
    let take = |index: usize| {
        taken(positions[index], &simulation.take(&mut simulation.camera(), index as u64), &simulation.rig())
    };
    places.iter().map(nearest).map(take).collect()
}

/// Median number of SURF keypoints (Hessian 400) of the left images.
pub fn keypoints(views: &[View]) -> f64 {
    median(views.par_iter().map(|view| detect(&view.left, &SurfParams::GOLDEN).len() as f64).collect())
}

/// Upper median; NaN of nothing.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Three-view inliers of every live view against the views of an experience, row by row.
pub fn inliers(live: &[View], experience: &[View]) -> Vec<Vec<u32>> {
    let params = VerifyParams::default();
    let rig = furrow_field::camera::rig((640, 360));
    let features = |image: &GreyImage| FrameFeatures::extract(image, &params.matcher);
    let nodes: Vec<FrameFeatures> = experience.par_iter().map(|node| features(&node.left)).collect();
    let of_view = |view: &View| {
        let stereo = StereoFrame::new(features(&view.left), features(&view.right), &rig, &params.stereo);
        nodes.iter().map(|node| verify(&stereo, node, &rig, &params).inliers as u32).collect()
    };
    live.par_iter().map(of_view).collect()
}

/// The inliers of every live view against the nearest node of an experience.
pub fn same_place(live: &[View], experience: &[View]) -> Vec<f64> {
    let nearest = |view: &View| {
        let from_view = |node: &&View| apart_m(view.position, node.position);
        let node =
            experience.iter().min_by(|a, b| from_view(a).total_cmp(&from_view(b))).expect("an experience has nodes");
        f64::from(inliers(std::slice::from_ref(view), std::slice::from_ref(node))[0][0])
    };
    live.par_iter().map(nearest).collect()
}

/// The inliers of views of places that are wrong for each other: at least 10 m apart.
pub fn wrong_places(live: &[View], experience: &[View]) -> Vec<u32> {
    let pairs = |(view, row): (&View, Vec<u32>)| {
        let apart = |node: &View| apart_m(view.position, node.position) >= APART_M;
        let chosen = experience.iter().zip(row).filter(|(node, _)| apart(node));
        chosen.map(|(_, inliers)| inliers).collect::<Vec<_>>()
    };
    live.iter().zip(inliers(live, experience)).flat_map(pairs).collect()
}

/// How far furrow's odometry strays from the truth.
#[derive(Debug, Clone)]
pub struct Drift {
    /// Each length asked for that the stretch has, with the mean end error of all pieces of it, as a share of it
    /// (KITTI's relative translation error).
    pub relative: Vec<(f64, f64)>,
    pub steps: usize,
    pub failed_steps: usize,
    /// Median inliers of the steps.
    pub inliers: f64,
}

/// Simulates a stretch frame by frame and judges the chain over pieces of some lengths in metres.
pub fn drift(stretch: &Stretch, slot: &str, pieces_m: &[f64]) -> Drift {
    let simulation = Simulation::prepare(&stretch.traversal(slot, 0)).expect("a sound traversal");
    let rig = simulation.rig();
    let odometry = Odometry::new(rig, OdometryParams::default());
    let mut camera = simulation.camera();
    let mut chain = ChainBuilder::new(rig, OdometryParams::default());
    let mut truth = Vec::new();
    let start_m = |index: u64| {
        let from_start =
            simulation.world_from_left(0.0).inverse().compose(&simulation.world_from_left(simulation.time_s(index)));
        from_start.distance_m()
    };
    for index in (0..simulation.frames()).skip_while(|&index| start_m(index) < stretch.metres.start) {
        let frame = simulation.take(&mut camera, index);
        let [left, right] = images(&frame, &rig).expect("no image is dropped");
        chain.extend(vec![(frame.stamps_ns[0], odometry.prepare(&left, &right))]);
        truth.push(frame.world_from_left);
    }
    let trajectory = chain.finish();
    let found = Track::of_chain(&trajectory);
    let errors = errors_per_length(&truth, &found.poses, pieces_m);
    Drift {
        relative: errors.iter().map(|error| (error.length_m, error.translation)).collect(),
        steps: trajectory.steps.len(),
        failed_steps: trajectory.failed_steps(),
        inliers: median(trajectory.steps.iter().map(|step| f64::from(step.inliers)).collect()),
    }
}
