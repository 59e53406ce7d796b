//! Figures, read back through their own scales and data.

use crate::made::{self, Frame, campaign, cell, input, live_frames, member};
use crate::read::{attribute, between, keep, row_value};
use furrow_reports::{TrackInput, choose_still, figure_files, page};

#[test]
fn counts_and_heat_map_draw_each_cells_good_localisations() {
    let input = campaign(true);
    let html = page(&input).unwrap();
    for figure in ["s0-counts-figure", "s0-heat-figure"] {
        let figure = between(&html, &format!("<figure id=\"{figure}\""), "</figure>");
        for outcome in input.cells.iter().map(|cell| &cell.outcome) {
            let drawn = format!("data-cell=\"{}\" data-good=\"{}\"", outcome.key.short(), outcome.evaluation.good);
            assert_eq!(figure.matches(&drawn).count(), 1, "{drawn}");
        }
    }
}

/// Thesis Fig 6.3 in numbers: d, then robots A and B in survival, length-biased and per gap.
const FIG_6_3: [[f64; 7]; 5] = [
    [0.0, 0.50, 0.50, 0.5, 0.5, 1.0, 1.0],
    [5.0, 0.25, 0.45, 0.5, 0.5, 1.0, 1.0],
    [10.0, 0.0, 0.40, 0.0, 0.5, 0.0, 1.0],
    [25.0, 0.0, 0.25, 0.0, 0.5, 0.0, 1.0],
    [50.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
];

#[test]
fn figure_6_3_is_drawn_as_in_the_thesis() {
    let mut cells: Vec<_> = ["10:00", "14:00"]
        .into_iter()
        .enumerate()
        .map(|(i, at)| cell(i, "08:00", at, vec![member(at, i)], &live_frames(0.0, 1, false)))
        .collect();
    for (robot, cell) in cells.iter_mut().enumerate() {
        let stretches: &[f64] = if robot == 0 { &[10.0; 5] } else { &[50.0] };
        let lost = &mut cell.outcome.evaluation.lost;
        *lost = made::from_stretches(100.0, stretches, &[]);
        lost.curve = FIG_6_3
            .iter()
            .map(|row| furrow_model::LostPoint {
                distance_m: row[0],
                survival: row[1 + robot],
                survival_band: [0.5 * row[1 + robot], row[1 + robot]],
                length_biased: row[3 + robot],
                length_biased_band: [0.5 * row[3 + robot], row[3 + robot]],
                per_gap: row[5 + robot],
                per_gap_band: [0.5 * row[5 + robot], row[5 + robot]],
            })
            .collect();
    }
    let html = page(&input(cells.clone(), Vec::new())).unwrap();
    keep("figure_6_3.html", &html);
    for (robot, cell) in cells.iter().enumerate() {
        for (nth, variant) in ["survival", "length-biased", "per gap"].into_iter().enumerate() {
            let id = format!("data-cell=\"{}\" data-variant=\"{variant}\"", cell.outcome.key.short());
            let line = html.split(&id).nth(1).unwrap();
            let numbers = |name: &str| -> Vec<f64> {
                attribute(line, name).split(' ').map(|number| number.parse().unwrap()).collect()
            };
            // Robot A is never lost for more than 10 m: its lines end there, at zero.
            let rows = if robot == 0 { &FIG_6_3[..3] } else { &FIG_6_3[..] };
            let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<_>>();
            assert_eq!(numbers("data-d"), column(0));
            assert_eq!(numbers("data-p"), column(1 + 2 * nth + robot), "{variant} of robot {robot}");
        }
        let drawn = drawn_points(&html, &cell.outcome.key.short());
        for (row, (d, p)) in FIG_6_3.iter().zip(drawn) {
            assert!((d - row[0]).abs() < 0.01 && (p - row[1 + robot]).abs() < 1e-4, "{row:?}: drawn at {d}, {p}");
        }
    }
    assert_eq!(row_value(&html, &cells[0].outcome, "max_lost_m"), "10");
    assert_eq!(row_value(&html, &cells[1].outcome, "max_lost_m"), "50");
    assert!(html.contains("keyframes every 2 m"));
}

/// The survival line's corners, read back through the chart's own ticks.
fn drawn_points(html: &str, cell: &str) -> Vec<(f64, f64)> {
    let chart = html
        .split("<svg ")
        .find(|svg| svg.contains(&format!("data-cell=\"{cell}\" data-variant=\"survival\"")))
        .unwrap();
    let line = chart.split("<path ").find(|path| path.contains(&format!("data-cell=\"{cell}\" data-variant"))).unwrap();
    let axis = |text: &str, anchor: &str| -> f64 {
        let tick = chart
            .split("<text ")
            .find(|t| t.contains(anchor) && t.split('>').nth(1).is_some_and(|t| t.starts_with(&format!("{text}<"))))
            .unwrap();
        let name = if anchor.contains("middle") { "x" } else { "y" };
        between(&format!(" {tick}"), &format!(" {name}=\""), "\"").parse().unwrap()
    };
    let (x0, x50) = (axis("0", "middle"), axis("50", "middle"));
    let (y0, y1) = (axis("0", "\"end\""), axis("1", "\"end\""));
    let d = between(line, " d=\"M", "\"");
    let point = |pair: &str| {
        let (x, y) = pair.split_once(' ').unwrap();
        // Tick texts stand 4 units below their tick; that cancels here.
        ((x.parse::<f64>().unwrap() - x0) / (x50 - x0) * 50.0, (y.parse::<f64>().unwrap() + 4.0 - y0) / (y1 - y0))
    };
    d.split('L').map(point).collect()
}

#[test]
fn dots_on_the_route_are_where_frames_were_accepted_and_wrong_ones_are_crosses() {
    let mut frames = vec![Frame::Verified(3, Some(true)); 41];
    frames[4] = Frame::Verified(80, Some(true));
    frames[10] = Frame::Verified(20, Some(false));
    frames[20] = Frame::Verified(15, Some(true));
    let html = page(&input(vec![cell(0, "08:00", "10:00", vec![member("10:00", 0)], &frames)], Vec::new())).unwrap();
    let figure = between(&html, "<figure id=\"s0-route-figure\"", "</figure>");
    assert_eq!(attribute(figure, "data-m"), "2 10");
    assert_eq!(figure.matches("data-m=\"5\" data-wrong=\"true\"").count(), 1);
    assert!(figure.contains("10:00 at 5.0 m: accepted but wrong, 31.5 m off, 20 inliers"));
    assert!(html.contains("of <data class=\"accepted\" value=\"3\">3</data> accepted localisations <data class=\"correct\" value=\"2\">2</data> were right"));
    let gallery = between(&html, "<section id=\"frames\"", "</section>");
    assert!(gallery.find("class=\"wrong\"").unwrap() < gallery.find("class=\"right\"").unwrap());
}

#[test]
fn histogram_bars_hold_every_verified_candidate() {
    let html =
        page(&input(vec![cell(0, "08:00", "10:00", vec![member("10:00", 0)], &live_frames(2.0, 5, true))], Vec::new()))
            .unwrap();
    let figure = between(&html, "<figure id=\"s0-inliers-figure\"", "</figure>");
    let total: usize = figure
        .split("data-count=\"")
        .skip(1)
        .map(|rest| rest.split('"').next().unwrap().parse::<usize>().unwrap())
        .sum();
    let verified = live_frames(2.0, 5, true).iter().filter(|frame| matches!(frame, Frame::Verified(..))).count();
    assert_eq!(total, verified);
    assert!(figure.contains("threshold 15"));
    let bars = figure.split("data-from=\"").skip(1).map(|rest| {
        let (from, rest) = rest.split_once('"').unwrap();
        (from.parse::<u32>().unwrap(), attribute(rest, "data-count").parse::<usize>().unwrap())
    });
    let reaching: usize = bars.filter(|(from, _)| *from >= made::THRESHOLD).map(|(_, count)| count).sum();
    let expected = live_frames(2.0, 5, true)
        .iter()
        .filter(|frame| matches!(frame, Frame::Verified(n, _) if *n >= made::THRESHOLD))
        .count();
    assert_eq!(reaching, expected, "no bar stands on both sides of the threshold");
}

#[test]
fn vocabularies_and_generators_are_drawn_where_a_run_has_them() {
    let mut cells: Vec<_> =
        (0..2).map(|i| cell(i, "08:00", "10:00", vec![member("10:00", 0)], &live_frames(1.0, 3, false))).collect();
    cells[1].outcome.codebook_words = 2300;
    let mut input = input(cells, Vec::new());
    let html = page(&input).unwrap();
    let figure = between(&html, "<figure id=\"vocabulary-figure\"", "</figure>");
    for cell in &input.cells {
        let (words, good) = (cell.outcome.codebook_words, cell.outcome.evaluation.good);
        assert!(figure.contains(&format!("data-words=\"{words}\" data-value=\"{good}\"")), "{words} words");
    }
    assert!(!html.contains("id=\"training-figure\"") && !html.contains("id=\"generators-figure\""));
    let trained = |codebook: &str, images, words, seconds| furrow_reports::Training {
        codebook: codebook.to_owned(),
        trainer: "k-means".to_owned(),
        images,
        words,
        seconds,
    };
    input.trained = vec![trained("a", 250, 2300, Some(1800.0)), trained("b", 1000, 6000, Some(9000.0))];
    let point = |z, good_matches| furrow_reports::GatePoint { z, good_matches, matchable: 400.0 };
    input.generators = vec![furrow_reports::GeneratorInput {
        name: "otf <b>".to_owned(),
        curves: vec![furrow_reports::GateCurve {
            parent: "3fa8".to_owned(),
            points: vec![point(0.0, 400.0), point(0.5, 120.0), point(1.0, 180.0)],
        }],
        sheet: Some((made::LIVE_JPEG.to_vec(), "recorded, z = 1".to_owned())),
    }];
    let html = page(&input).unwrap();
    keep("across.html", &html);
    let figure = between(&html, "<figure id=\"training-figure\"", "</figure>");
    // 1800 s are half an hour, 9000 s are two and a half.
    assert!(
        figure.contains("data-images=\"250\" data-value=\"0.5\"")
            && figure.contains("data-images=\"1000\" data-value=\"2.5\"")
    );
    let figure = between(&html, "<figure id=\"generators-figure\"", "</figure>");
    assert!(figure.contains("data-z=\"0.5\" data-good=\"120\"") && !figure.contains("otf <b>"));
    assert!(html.contains("Contact sheet of <bdi class=\"name\">otf &lt;b&gt;</bdi>"));
    let sheet = |html: &str| html.find("Contact sheet of").expect("a sheet");
    let numbers = |html: &str| html.find("<section id=\"cells\"").expect("numbers");
    assert!(numbers(&html) < sheet(&html), "what was recorded comes first");
    let name = "10:00 as 12:00 (generator otf)";
    input.cells = vec![cell(7, "08:00", name, vec![member("12:00", 7)], &live_frames(1.0, 3, false))];
    let html = page(&input).unwrap();
    assert!(sheet(&html) < numbers(&html), "where all is generated, the generated images come first");
}

#[test]
fn one_frame_is_set_against_every_experience() {
    let mut input = campaign(true);
    for cell in input.cells.iter_mut().take(3) {
        let stamp_ns = 1_700_000_000_000_000_000 + 10 * 125_000_000;
        let choice = choose_still(&cell.outcome, &cell.events, stamp_ns).unwrap().expect("the frame was verified");
        assert_eq!(choice.caption.live_stamp_ns, stamp_ns);
        let mut still = cell.tiles[0].clone();
        (still.caption, still.compared) = (choice.caption, true);
        cell.tiles.push(still);
        assert!(choose_still(&cell.outcome, &cell.events, 7).unwrap().is_none(), "no frame has this stamp");
    }
    let html = page(&input).unwrap();
    let section = between(&html, "<section id=\"stills\"", "</section>");
    assert!(section.contains("Live 08:00 at 5.0 m"));
    assert_eq!(section.matches("data-stamp=\"1700000001250000000\"").count(), 3);
}

#[test]
fn tracks_are_drawn_beside_their_truth_to_one_scale() {
    let mut input = campaign(true);
    assert!(!page(&input).unwrap().contains("tracks-figure"));
    // Three metres east and four north; odometry a quarter of a metre beside it.
    input.tracks = vec![TrackInput {
        name: "Live 08:00, <b>traversal</b>".to_owned(),
        source: "true poses".to_owned(),
        truth_m: vec![[10.0, 20.0], [13.0, 20.0], [13.0, 24.0]],
        odometry_m: vec![[10.0, 20.25], [13.0, 20.25], [13.0, 24.25]],
        rms_m: 0.25,
        length_m: 7.0,
    }];
    let html = page(&input).unwrap();
    let figure = between(&html, "id=\"tracks-figure\"", "</figure>");
    assert!(figure.contains("RMS error 0.25 m over 7 m") && !figure.contains("<b>traversal"));
    let truth = between(figure, "ground truth: 7.0 m by odometry", "</path>");
    assert!(truth.contains("0.25 m (root mean square)"));
    let path =
        figure.split(" d=\"").filter(|d| d.starts_with('M') && d.contains('L')).map(|d| d.split('"').next().unwrap());
    let corners: Vec<f64> = path
        .filter_map(|d| d[1..].split(['L', ' ', ',']).map(|n| n.parse().ok()).collect::<Option<Vec<f64>>>())
        .find(|numbers| numbers.len() == 6)
        .unwrap();
    let (east, north) = (corners[2] - corners[0], corners[3] - corners[5]);
    assert!((north / east - 4.0 / 3.0).abs() < 0.01, "{corners:?}");
    let files = figure_files(&input).unwrap();
    let csv = files.iter().find(|file| file.name == "tracks").unwrap().csv();
    assert!(csv.ends_with("2,13,24,13,24.25\n"), "{csv}");
}
