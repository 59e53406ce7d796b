//! Figures, read back through their own scales and data.

use crate::made::{self, Frame, campaign, cell, input, live_frames, member};
use crate::read::{attribute, between, keep};
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
