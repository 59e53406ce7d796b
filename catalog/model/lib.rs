//! The data types of furrow, plain: no file, socket or clock is touched here.
//!
//! A tour, in the order the data comes into being:
//! - [`id`]: what names a thing: BLAKE3 digests with a kind, so that an image's id cannot stand for an experience's;
//! - [`slot`]: the time of day and the [`Purpose`] of a traversal;
//! - [`image`]: grey and colour images, row by row;
//! - [`camera`]: calibrations as recorded and the rectified [`StereoRig`];
//! - [`pose`]: rigid transforms, named `b_from_a`;
//! - [`trajectory`]: the chain of odometry steps and keyframing on it;
//! - [`experience`]: immutable versions: nodes on a chain, recorded or generated;
//! - [`outcome`]: what running a cell of a matrix gave;
//! - [`evaluation`]: the numbers in it;
//! - [`contrast`]: whether one contender beats another;
//! - [`gate`]: what is measured of a generator;
//! - [`seconds`], [`tum`], [`pose_lines`]: stamps and poses as text, as other programs write them;
//! - [`truth`]: the true poses of a traversal, and which moments have one;
//! - [`name`]: names that people read, and what may not be in them.
//!
//! Conventions everywhere: camera axes x right, y down, z forward; metres, radians and nanoseconds; `f64` for geometry.
//!
//! # Glossary
//!
//! One meaning each; the code, the help and the pages use these words for nothing else.
//!
//! In the field:
//! - **site**: a place with routes, such as Old Zoo;
//! - **route**: a path at a site that is travelled again and again;
//! - **recording**: a bag's bytes, in one file or several parts;
//! - **rig**: a calibrated, rectified stereo pair, or a single camera: a rig without a baseline;
//! - **traversal**: one run along a route in one recording, at a time slot, for a purpose;
//! - **slot** (time slot): the time of day that a traversal stands for, in the site's local time;
//! - **purpose**: what a traversal is for: experience, evaluation or vocabulary;
//! - **number**: which of a slot's traversals of one purpose is meant, counted from 1 in the order of time;
//! - **live traversal**: the evaluation traversal that plays the robot in an experiment;
//! - **vocabulary traversal**: one whose images train a codebook, and nothing else;
//! - **frame**: one moment of a traversal: a stereo pair, or the image of a single camera;
//! - **stamp**: the header stamp of a frame's left image, in nanoseconds: the frame's time;
//! - **step**: the motion of the left camera between two consecutive frames;
//! - **trajectory** (chain): the steps of a traversal end to end;
//! - **ground truth**: true positions from outside the odometry: a simulation, a file of poses, satellite fixes.
//!
//! Experiences:
//! - **experience**: an immutable stored version of what was seen along a route: nodes on a trajectory;
//! - **node**: one place of an experience: a stamp and its left image;
//! - **keyframe**: a frame that becomes a node, chosen by distance and turn;
//! - **recorded**, **generated**: with images of a camera; of a generator, on the trajectory of its parent;
//! - **parent**, **child**: the recorded experience whose images were moved, and the generated one that came of it;
//! - **generator**: what moves images of one slot towards another;
//! - **domainness** (z): how far it moves them: 0 is the parent, 1 the target slot, beyond is extrapolation;
//! - **mimic**: to stand for a slot without having been recorded at it;
//! - **placebo**: a generator that knows nothing of any slot: what a real one has to beat;
//! - **gate**: measures of a generator taken before anyone localises with it; **doubts** are what it finds.
//!
//! Recognising places:
//! - **feature**: a keypoint with its descriptor;
//! - **word**: a centre of the vocabulary; **presence**: which words an image shows;
//! - **vocabulary**: the words; **codebook**: vocabulary, Chow-Liu tree and sample presences, trained together;
//! - **recogniser**: what ranks an experience's nodes for a live frame, such as FAB-MAP 2.0 or SeqSLAM;
//! - **candidate**: a node that a recogniser offers for a live frame;
//! - **new place**: a recogniser's answer that no node shows what the live frame shows;
//! - **verification**: counts the matches of a live frame and a candidate that agree on a motion: its **inliers**;
//! - **threshold**: the inliers that a localisation must reach;
//! - **localiser**: recogniser and verification over one experience: says a node or "new place";
//! - **control hub**: keeps the best answer of several localisers; its **policy** says who is asked and believed;
//! - **localisation**: an accepted answer: good by the threshold, right by the ground truth;
//! - **lost stretch**: the distance between accepted localisations.
//!
//! Experiments:
//! - **matrix**: a file that declares an experiment: axes, collectives, contrasts, settings;
//! - **setting**: one choice of the parameters that a matrix varies, such as a number of words;
//! - **contender**: what an experience axis came to: an experience that is there or is to be generated;
//! - **collective**: several contenders behind one control hub;
//! - **member**: a contender inside a cell or collective;
//! - **cell**: a live traversal against a contender or collective in a setting; its **key** hashes its inputs;
//! - **plan**: a matrix resolved against the store: cells, finished or blocked, and why;
//! - **run**: a plan that was carried out, or part of it; **stage**: one kind of work in it;
//! - **outcome**: what a cell gave: its **evaluation** and its **events**, a row per live frame and candidate;
//! - **contrast**: one contender's numbers less another's on the same live traversals, with a verdict;
//! - **claim**: a finding of the thesis, held against the outcomes.
//!
//! The store:
//! - **store**: a folder that `furrow init` made; **catalogue**: the store, opened; **index**: its SQLite file;
//! - **object**: immutable bytes named by their BLAKE3 digest; **record**: one that is JSON of a kind and version;
//! - **derivation**: a result remembered under the **key** of all that it depends on.

pub mod camera;
pub mod contrast;
pub mod evaluation;
pub mod experience;
pub mod fix;
pub mod gate;
pub mod id;
pub mod image;
pub mod metric;
pub mod name;
pub mod outcome;
pub mod pose;
pub mod pose_lines;
pub mod seconds;
pub mod slot;
pub mod trajectory;
pub mod truth;
pub mod tum;
mod wide;

pub use camera::{CameraCalibration, Distortion, StereoRig};
pub use contrast::{Contrast, ContrastTraversal, Difference, Verdict, chance, signed};
pub use evaluation::{
    AtThreshold, Censored, Evaluation, GroundTruthScore, LostDistance, LostPoint, LostStretch, PrecisionRecall,
    RecallWithin, RouteRecalled,
};
pub use experience::{Domainness, Experience, ExperienceKind, Node};
pub use fix::is_satellite_fix;
pub use gate::{Measures, SwitchIndex};
pub use id::{CellKey, CodebookId, ExperienceId, ObjectId, RecordingId, RunId, TraversalId};
pub use image::{ColourImage, GreyImage};
pub use name::shown;
pub use outcome::{Member, Outcome};
pub use pose::Se3;
pub use seconds::parse_seconds_ns;
pub use slot::{Purpose, TimeSlot};
pub use trajectory::{KeyframePolicy, Step, StepCovariance, Trajectory};
pub use truth::{TruePoses, TruthError};
pub use tum::{TumError, TumPose, parse_tum};
