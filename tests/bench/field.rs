//! `cargo bench --bench field -- [speed] [appearance] [drift] [likeness] [sheet] [SITE...]`: the simulated field at
//! full scale. `make bench` asks for `speed`.
//!
//! - `speed`: CPU seconds and wall time of a stereo pair at 640x360 on all cores, against the ten pairs a second that
//!   are wanted;
//! - `appearance`: keypoints and verification inliers of every slot against every slot over whole routes (minutes a
//!   site);
//! - `drift`: odometry against the truth over whole routes, slot by slot (some minutes a traversal);
//! - `likeness`: how images of the field compare with photographs and another renderer's, where FURROW_DATA has them;
//! - `sheet`: draws the README's contact sheet anew, `tests/field/contact-sheet.jpg`.

#[path = "../support/cpu_time.rs"]
mod cpu_time;
#[path = "../support/field_views.rs"]
#[allow(dead_code, reason = "the tests use the rest")]
mod field_views;
#[path = "../support/golden_data.rs"]
mod golden_data;
#[path = "../support/likeness.rs"]
mod likeness;

use cpu_time::cpu_ns;
use field_views::{Stretch, colour, colours, drift, keypoints, median, places, same_place, views};
use furrow_catalog::images::{ColourImage, Picture, encode_jpeg};
use furrow_field::{Simulation, Site, Traversal};
use likeness::{Likeness, NAMES, each, likeness, of_folder};
use std::time::Instant;

const SLOTS: [&str; 7] = ["04:30", "06:00", "08:00", "10:00", "12:00", "14:00", "16:00"];
/// Pairs timed per site and slot.
const PAIRS: u64 = 16;

/// The length of a main route in metres, less the last step.
fn route_m(site: Site) -> f64 {
    match site {
        Site::Backsburg => 104.0,
        Site::Lindenhof => 157.0,
        Site::OldZoo => 209.0,
    }
}

fn speed(site: Site) {
    for slot in ["04:30", "08:00", "12:00"] {
        let Ok(slot) = slot.parse() else { continue };
        let Ok(simulation) = Simulation::prepare(&Traversal { length_m: route_m(site), ..Traversal::new(site, slot) })
        else {
            continue;
        };
        let mut camera = simulation.camera();
        simulation.take(&mut camera, 0);
        let (cpu, wall) = (cpu_ns(), Instant::now());
        (0..PAIRS).for_each(|k| drop(simulation.take(&mut camera, k * simulation.frames() / PAIRS)));
        let (cpu, wall) = ((cpu_ns() - cpu) as f64 / 1e9 / PAIRS as f64, wall.elapsed().as_secs_f64() / PAIRS as f64);
        println!("{site:<10} {slot}  {cpu:.3} CPU s a pair, {:.1} pairs/s (wanted: 10)", 1.0 / wall);
    }
}

fn appearance(site: Site) {
    let route = Stretch::of(site, 0.0..route_m(site));
    let [nodes_at, live_at] = [places(&route, 2.0), places(&route, 6.3)];
    let experiences: Vec<_> = SLOTS.iter().map(|slot| views(&route, slot, 0, &nodes_at)).collect();
    let keypoints: Vec<String> = experiences.iter().map(|nodes| format!("{:5.0}", keypoints(nodes))).collect();
    println!("{site}: keypoints by slot            {}", keypoints.join(" "));
    for slot in SLOTS {
        let live = views(&route, slot, 1, &live_at);
        let row: Vec<String> =
            experiences.iter().map(|nodes| format!("{:5.0}", median(same_place(&live, nodes)))).collect();
        println!("{site}: inliers of live {slot} against {}", row.join(" "));
    }
}

fn drifts(site: Site) {
    for slot in SLOTS {
        let found = drift(&Stretch::of(site, 0.0..route_m(site)), slot, &[20.0, 50.0, 100.0]);
        let drifts = found.relative.iter().map(|(length_m, share)| format!("{:.2} % over {length_m} m", 100.0 * share));
        println!(
            "{site:<10} {slot}  drift {}, {} of {} steps failed, {} inliers",
            drifts.collect::<Vec<_>>().join(", "),
            found.failed_steps,
            found.steps,
            found.inliers
        );
    }
}

/// Folders of images to hold the field against.
const OTHERS: [&str; 7] = [
    "stromovka_12conditions/images",
    "stromovka_2season_traverse/autumn",
    "kitti_raw_drive_A/image_00",
    "path_traced_places/0800A/left",
    "path_traced_places/1000B/left",
    "path_traced_places/1400B/left",
    "path_traced_places/0430B/left",
];

fn likenesses(sites: &[Site]) {
    let print = |what: String, all: &[Likeness]| {
        if !all.is_empty() {
            let cells = [0.1, 0.5, 0.9].map(|share| each(all, share));
            let cell = |k: usize| {
                format!("{:>18}", [0, 1, 2].map(|i| format!("{:.*}", usize::from(k > 5) * 2, cells[i][k])).join(" "))
            };
            println!("{what:<34}{}", (0..NAMES.len()).map(cell).collect::<String>());
        }
    };
    println!("10th, 50th and 90th percentile of images at 640 columns");
    println!("{:<34}{}", "", NAMES.map(|name| format!("{name:>18}")).concat());
    let data = golden_data::data();
    for folder in data.iter().flat_map(|data| OTHERS.map(|folder| (folder, data.join(folder)))) {
        print(folder.0.to_owned(), &of_folder(&folder.1));
    }
    for site in sites {
        let route = Stretch::of(*site, 0.0..route_m(*site));
        let places = places(&route, route_m(*site) / 12.0);
        for slot in SLOTS {
            let images = colours(&route, slot, 1, &places);
            print(format!("{site} {slot}"), &images.iter().map(likeness).collect::<Vec<_>>());
        }
    }
}

/// Where the views of the contact sheet are taken, metres along the route: Lindenhof twice, where its road enters the
/// dark row and within.
const SHEET: [(Site, f64); 4] =
    [(Site::Backsburg, 40.0), (Site::Lindenhof, 20.0), (Site::Lindenhof, 40.0), (Site::OldZoo, 40.0)];
/// Columns of the sheet: each view shrinks from 640 to 240.
const SHEET_COLUMNS: usize = 240 * SLOTS.len();

/// Every place of [`SHEET`] (rows) at every slot (columns).
fn sheet() -> Result<(), String> {
    let (width, height) = (640, 360);
    let mut rgb = vec![0; 3 * width * SLOTS.len() * height * SHEET.len()];
    for (row, (site, along_m)) in SHEET.into_iter().enumerate() {
        for (column, slot) in SLOTS.iter().enumerate() {
            let slot = slot.parse().map_err(|error| format!("{slot}: {error}"))?;
            let traversal = Traversal { length_m: along_m + 2.0, ..Traversal::new(site, slot) };
            let simulation = Simulation::prepare(&traversal).map_err(|error| error.to_string())?;
            let mut camera = simulation.camera();
            let image = simulation.take(&mut camera, simulation.frames() - 20).left.ok_or("no image")?;
            for (v, line) in colour(&image, &simulation.rig()).rgb.chunks_exact(3 * width).enumerate() {
                let at = 3 * width * ((row * height + v) * SLOTS.len() + column);
                rgb[at..at + 3 * width].copy_from_slice(line);
            }
        }
    }
    let picture = ColourImage { width: width * SLOTS.len(), height: height * SHEET.len(), rgb };
    let jpeg = encode_jpeg(Picture::Colour(&picture), SHEET_COLUMNS, 88).map_err(|error| error.to_string())?;
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/field/contact-sheet.jpg");
    std::fs::write(path, jpeg).map_err(|error| format!("{path}: {error}"))
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let named: Vec<Site> = words.iter().filter_map(|word| word.parse().ok()).collect();
    let sites = if named.is_empty() { Site::ALL.to_vec() } else { named };
    let asked = |what: &str| words.iter().any(|word| word == what);
    if asked("sheet") {
        match sheet() {
            Ok(()) => println!("drawn: tests/field/contact-sheet.jpg"),
            Err(error) => {
                eprintln!("the contact sheet: {error}");
                std::process::exit(1);
            }
        }
        return;
    }
    if asked("likeness") {
        likenesses(&sites);
        return;
    }
    for site in sites {
        if asked("appearance") {
            appearance(site);
        }
        if asked("drift") {
            drifts(site);
        }
        if asked("speed") || !(asked("appearance") || asked("drift")) {
            speed(site);
        }
    }
}
