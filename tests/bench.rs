//! `make bench`: what furrow computes for long, timed against the peers' figures. Prints a table and writes `target/bench.json`.
//! `cargo bench --profile release --bench peers -- step vocabulary` measures only these groups, and writes nothing.
//!
//! The peers' figures are CPU times of one thread on their authors' reference box (libviso2, openFABMAP, OpenCV SURF), so ours are measured
//! on one thread too, as CPU time, but for the rows that say otherwise. Real images come from FURROW_DATA; without them those rows are left out and said so.

use furrow_catalog::images::{Rectifier, Side, decode_grey, read_calibration_files};
use furrow_ingest::odometry::{FrameFeatures, Odometry, OdometryParams, StereoFrame, VerifyParams, estimate, verify};
use furrow_model::{GreyImage, StereoRig};
use furrow_runner::localiser::fabmap::{Answer, FabMap, FabMapParams};
use furrow_runner::localiser::surf::{SurfParams, surf};
use furrow_runner::localiser::vocabulary::{Descriptor, train_kmeans};
use furrow_runner::localiser::{Presence, chow_liu};
use serde::Serialize;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[path = "bench_generator.rs"]
mod bench_generator;
#[path = "bench_ingest.rs"]
mod bench_ingest;
#[path = "bench_odometry.rs"]
mod bench_odometry;
#[path = "bench_step.rs"]
mod bench_step;
#[path = "cpu_time.rs"]
mod cpu_time;
#[path = "field_views.rs"]
#[allow(dead_code, reason = "the tests use the rest")]
mod field_views;
#[path = "golden_data.rs"]
mod golden_data;

use cpu_time::cpu_ns;

/// A measured figure beside the peer's.
#[derive(Serialize)]
struct Row {
    name: &'static str,
    value: f64,
    unit: &'static str,
    peer: &'static str,
    peer_value: Option<f64>,
    /// Ours over the peer's; below 1 is faster.
    ratio: Option<f64>,
}

fn row(name: &'static str, value: f64, unit: &'static str, peer: &'static str, peer_value: Option<f64>) -> Row {
    let row = Row { name, value, unit, peer, peer_value, ratio: peer_value.map(|peer| value / peer) };
    let beside = row
        .peer_value
        .map_or(String::new(), |value| format!("{peer} {value} {unit}, ratio {:.2}", row.ratio.unwrap_or(0.0)));
    println!("{:<58} {:>10.3} {:<9} {beside}", row.name, row.value, row.unit);
    row
}

/// CPU time of a round in milliseconds: the mean over `rounds`, after one that warms up. What other programs do meanwhile does not count.
fn cpu_ms<T>(rounds: usize, mut work: impl FnMut(usize) -> T) -> f64 {
    black_box(work(0));
    let before = cpu_ns();
    (0..rounds).for_each(|round| drop(black_box(work(round))));
    (cpu_ns() - before) as f64 / 1e6 / rounds as f64
}

/// Wall time of a round on two threads in milliseconds: the shortest of `rounds`, which other programs disturbed least.
fn wall_ms_on_two<T: Send>(rounds: usize, work: impl Fn() -> T + Sync) -> f64 {
    let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(2).build() else { return f64::NAN };
    let round = || {
        let start = Instant::now();
        black_box(pool.install(&work));
        start.elapsed().as_secs_f64() * 1e3
    };
    (0..rounds).map(|_| round()).fold(f64::INFINITY, f64::min)
}

/// A stream of numbers for synthetic words, the same every time (Steele, Lea and Flood 2014).
struct Mix(u64);

impl Mix {
    fn below(&mut self, count: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % count
    }
}

/// Images of about 190 words, frequent ones more often.
fn images(count: usize, words: u64, seed: u64) -> Vec<Presence> {
    let mut mix = Mix(seed);
    let mut word = || (mix.below(words).min(mix.below(words))) as u32;
    (0..count).map(|_| (0..190).map(|_| word()).collect()).collect()
}

fn chow_liu_and_fabmap(rows: &mut Vec<Row>) {
    let trainings = [
        ("Chow-Liu tree, 2000 words x 500 images", 2000, 500, Some(53_000.0)),
        ("Chow-Liu tree, 6000 words x 2000 images", 6000, 2000, None),
        // Extrapolated in PEERS.md: about 5 hours.
        ("Chow-Liu tree, 6000 words x 18709 images", 6000, 18_709, Some(18_000_000.0)),
    ];
    for (name, words, count, peer) in trainings {
        let samples = images(count, words, 7);
        let time = cpu_ms(2, |_| chow_liu::train(&samples, words as usize, 0.0).map(|tree| tree.words()));
        rows.push(row(name, time, "ms", "openFABMAP", peer));
    }
    let samples = images(500, 6000, 11);
    let Ok(tree) = chow_liu::train(&samples, 6000, 0.0) else { return };
    let queries = images(64, 6000, 13);
    let maps = [
        ("FAB-MAP 2.0 query, 6000 words, 500 places", 500, Some(0.69)),
        ("FAB-MAP 2.0 query, 6000 words, 2000 places", 2000, Some(0.98)),
        ("FAB-MAP 2.0 query, 6000 words, 8000 places", 8000, Some(2.1)),
        ("FAB-MAP 2.0 query, 6000 words, 100000 places", 100_000, None),
    ];
    for (name, places, peer) in maps {
        let Ok(mut map) = FabMap::new(&tree, FabMapParams::OPENFABMAP, &samples) else { return };
        for place in images(places, 6000, 17) {
            if map.add_place(&place).is_err() {
                return;
            }
        }
        let mut answer = Answer::default();
        let time = cpu_ms(200, |i| map.query_into(&queries[i % queries.len()], &mut answer).is_ok());
        rows.push(row(name, time, "ms", "openFABMAP", peer));
    }
}

/// Unit vectors around 20 000 directions, some of them often: as hard to cluster as descriptors of a field.
fn descriptors(count: usize) -> Vec<Descriptor> {
    let mut mix = Mix(3);
    let mut bell = || (0..4).map(|_| mix.below(1 << 20) as f32 / (1 << 19) as f32 - 1.0).sum::<f32>();
    let directions: Vec<Descriptor> = (0..20_000).map(|_| std::array::from_fn(|_| bell())).collect();
    let mut choice = Mix(5);
    let mut around = || {
        let direction = choice.below(20_000).min(choice.below(20_000)) as usize;
        let near: Descriptor = std::array::from_fn(|k| directions[direction][k] + 0.6 * bell());
        let length = near.iter().map(|number| number * number).sum::<f32>().sqrt();
        near.map(|number| number / length)
    };
    (0..count).map(|_| around()).collect()
}

fn vocabulary(rows: &mut Vec<Row>) {
    let descriptors = descriptors(300_000);
    let before = cpu_ns();
    let Ok((_, record)) = train_kmeans(&descriptors, 6000, 1, &mut |_| ()) else { return };
    let seconds = (cpu_ns() - before) as f64 / 1e9;
    let name = "vocabulary (k-means), 300000 descriptors, 6000 words";
    rows.push(row(name, seconds, "s", "none at this size", None));
    rows.push(row("its quantisation error, root mean square", record.quantisation_error, "", "none known", None));
}

fn grey(path: &Path) -> Option<GreyImage> {
    decode_grey(&std::fs::read(path).ok()?, None).ok()
}

/// The first rectified street pairs of the data and their rig.
fn street(data: &Path) -> Option<(StereoRig, Vec<(GreyImage, GreyImage)>)> {
    let folder = furrow_ingest::folder::StereoFolder::open(&data.join("kitti_odo_seqA")).ok()?;
    let rig = Rectifier::from_record(&folder.calibration).ok()?.rig();
    let pairs = folder
        .pairs
        .iter()
        .take(20)
        .map(|pair| Some((grey(&pair.left)?, grey(&pair.right)?)))
        .collect::<Option<_>>()?;
    Some((rig, pairs))
}

fn on_street_images(data: &Path, rows: &mut Vec<Row>) {
    let Some((rig, pairs)) = street(data) else {
        eprintln!("SKIPPED: no kitti_odo_seqA in {}: no figures for SURF and odometry", data.display());
        return;
    };
    let image = &pairs[0].0;
    let upright = SurfParams { upright: true, ..SurfParams::GOLDEN };
    rows.push(row(
        "SURF, Hessian 400, 1226x370",
        cpu_ms(9, |_| surf(image, &SurfParams::GOLDEN)),
        "ms",
        "OpenCV SURF",
        Some(212.0),
    ));
    rows.push(row(
        "SURF upright, Hessian 400, 1226x370",
        cpu_ms(9, |_| surf(image, &upright)),
        "ms",
        "OpenCV SURF",
        Some(92.0),
    ));
    rows.push(row(
        "SURF, Hessian 400, 1226x370, wall time on two cores",
        wall_ms_on_two(29, || surf(image, &SurfParams::GOLDEN)),
        "ms",
        "OpenCV SURF",
        Some(212.0),
    ));

    let params = OdometryParams::default();
    let odometry = Odometry::new(rig, params.clone());
    let prepare = |i: usize| odometry.prepare(&pairs[i % pairs.len()].0, &pairs[i % pairs.len()].1);
    let frames: Vec<StereoFrame> = (0..pairs.len()).map(prepare).collect();
    let features = cpu_ms(19, prepare);
    let motion = cpu_ms(19, |i| estimate(&frames[i % 19], &frames[i % 19 + 1], &rig, &params).is_ok());
    rows.push(row("stereo odometry, whole frame, 1226x370", features + motion, "ms", "libviso2", Some(24.4)));

    let verify_params = VerifyParams::default();
    let extract = |image: &GreyImage| FrameFeatures::extract(image, &verify_params.matcher);
    let live = StereoFrame::new(extract(&pairs[3].0), extract(&pairs[3].1), &rig, &verify_params.stereo);
    let node = extract(&pairs[1].0);
    rows.push(row(
        "three-view verification of a candidate, 1226x370",
        cpu_ms(19, |_| verify(&live, &node, &rig, &verify_params)),
        "ms",
        "none known",
        None,
    ));
}

fn on_the_real_drive(data: &Path, rows: &mut Vec<Row>) {
    let folder = data.join("kitti_raw_drive_A");
    let image: Option<PathBuf> =
        std::fs::read_dir(folder.join("image_00")).ok().and_then(|files| files.flatten().map(|file| file.path()).min());
    let calibration = read_calibration_files(&[folder.join("calib_cam_to_cam.txt")]).ok();
    let rectifier = calibration.and_then(|record| Rectifier::from_record(&record).ok());
    let bytes = image.and_then(|path| std::fs::read(path).ok());
    let (Some(rectifier), Some(bytes)) = (rectifier, bytes) else {
        eprintln!("SKIPPED: no kitti_raw_drive_A in {}: no figure for rectification", data.display());
        return;
    };
    let work = |_| decode_grey(&bytes, None).ok().and_then(|image| rectifier.rectify_grey(Side::Left, image).ok());
    rows.push(row("decode and rectify (OpenCV), 1392x512 JPEG", cpu_ms(19, work), "ms", "this machine", None));
}

/// Measures a group of rows; the folder is FURROW_DATA, where there is one.
type Group = fn(&Path, &mut Vec<Row>);

/// Groups by name, and whether they need the real images.
const GROUPS: [(&str, bool, Group); 8] = [
    ("street", true, on_street_images),
    ("drive", true, on_the_real_drive),
    ("tracks", true, bench_odometry::tracks),
    ("generators", false, |_, rows| bench_generator::generators(rows)),
    ("ingest", false, |_, rows| bench_ingest::large_images(rows)),
    ("step", false, |_, rows| bench_step::localisation_step(rows)),
    ("fabmap", false, |_, rows| chow_liu_and_fabmap(rows)),
    ("vocabulary", false, |_, rows| vocabulary(rows)),
];

fn main() {
    // Cargo passes --bench.
    let chosen: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    if let Some(unknown) = chosen.iter().find(|name| GROUPS.iter().all(|group| group.0 != name.as_str())) {
        eprintln!("no group {unknown}: there are {}", GROUPS.map(|group| group.0).join(", "));
        std::process::exit(2);
    }
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build_global();
    if let Err(error) = one_thread {
        eprintln!("cannot measure on one thread: {error}");
        std::process::exit(1);
    }
    println!(
        "CPU time of one thread where a row does not say otherwise; ratio = ours / peer's published figure (other machine)"
    );
    let mut rows = Vec::new();
    let data = golden_data::data();
    for (_, needs_data, group) in GROUPS.iter().filter(|group| chosen.is_empty() || chosen.iter().any(|c| c == group.0))
    {
        match &data {
            Some(data) => group(data, &mut rows),
            None if !needs_data => group(Path::new(""), &mut rows),
            None => {}
        }
    }
    if !chosen.is_empty() {
        return;
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/bench.json");
    let written =
        serde_json::to_string_pretty(&rows).map_err(std::io::Error::from).and_then(|text| std::fs::write(&path, text));
    match written {
        Ok(()) => println!("written to target/bench.json"),
        Err(error) => {
            eprintln!("cannot write {}: {error}", path.display());
            std::process::exit(1);
        }
    }
}
