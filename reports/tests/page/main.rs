//! Pages made from a made-up run: what they show is what the outcomes say.

#![allow(clippy::unwrap_used, reason = "helpers of tests: a panic is how they fail")]

mod contrasts;
mod figures;
mod lost_distance;
mod made;
mod read;

use furrow_model::{CellKey, CodebookId};
use furrow_reports::{MissingCell, ReportError, choose_tiles, page};
use made::{Frame, campaign, cell, digest, input, live_frames, member};
use read::{between, keep, row_value};

#[test]
fn every_number_of_the_table_is_the_outcomes() {
    let input = campaign(true);
    let html = page(&input).unwrap();
    keep("report.html", &html);
    for outcome in input.cells.iter().map(|cell| &cell.outcome) {
        let e = &outcome.evaluation;
        let truth = e.ground_truth.as_ref().unwrap();
        let real = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
        for (name, expected) in [
            ("frames", e.frames.to_string()),
            ("good", e.good.to_string()),
            ("percent_of_frames", real(Some(e.percent_of_frames))),
            ("percent_good", real(e.percent_good)),
            ("returned", e.returned.to_string()),
            ("new_place", e.new_place.to_string()),
            ("rejected", e.rejected.to_string()),
            ("jumps", e.jumps.to_string()),
            ("lost_fraction", real(Some(e.lost.lost_fraction))),
            ("max_lost_m", real(Some(e.lost.max_lost_m))),
            ("mean_lost_m", real(Some(e.lost.mean_lost_m))),
            ("correct", truth.correct.to_string()),
            ("wrong", truth.wrong.to_string()),
            ("precision", real(truth.precision)),
            ("recall", real(truth.recall)),
            ("recall_at_1", real(truth.recall_at_1)),
            ("recall_at_5", real(truth.recall_at_5)),
            ("recall_at_10", real(truth.recall_at_10)),
            ("recall_at_20", real(truth.recall_at_20)),
            ("recall_of_answers", real(truth.recall_of_answers)),
            ("recall_at_full_precision", real(truth.recall_at_full_precision)),
            ("average_precision", real(truth.average_precision)),
            ("false_positive_rate", real(truth.false_positive_rate)),
            ("position_rmse_m", real(truth.position_rmse_m)),
        ] {
            assert_eq!(row_value(&html, outcome, name), expected, "{name} of {outcome:?}");
        }
    }
}

#[test]
fn nothing_returned_never_lost_and_no_ground_truth_are_said_in_words() {
    let none = cell(0, "08:00", "16:00", vec![member("16:00", 0)], &[Frame::NewPlace; 41]);
    let always = cell(1, "08:00", "08:00", vec![member("08:00", 1)], &[Frame::Verified(90, None); 41]);
    let html = page(&input(vec![none.clone(), always.clone()], Vec::new())).unwrap();
    keep("edges.html", &html);
    assert_eq!(row_value(&html, &none.outcome, "percent_good"), "");
    assert_eq!(row_value(&html, &always.outcome, "max_lost_m"), "0");
    assert!(html.contains("and it was never lost") && html.contains("08:00: never lost"));
    assert!(html.contains("<strong>No ground truth.</strong>"));
    assert!(!html.contains(">precision<"));
    let html = page(&input(vec![none], Vec::new())).unwrap();
    assert!(html.contains("was not localised in any live frame, in the one cell"));
    let html =
        page(&input(Vec::new(), vec![MissingCell { label: "08:00".to_owned(), reason: "killed".to_owned() }])).unwrap();
    assert!(html.contains("No cell was finished") && html.contains("killed"));
}

#[test]
fn hostile_names_are_shown_and_not_executed() {
    let hostile = [
        "<script>alert(1)</script>",
        "</script></style><img src=x onerror=alert(1)>",
        "\" onload=\"alert(1)",
        "שלום \u{202e}olleh",
        "{{ 7 * 7 }}{% x %}",
    ];
    let long = "x".repeat(300);
    let name = format!("{} {long}", hostile.join(" "));
    let mut cells: Vec<_> = (0..2)
        .map(|i| cell(i, "08:00", &format!("{name}{i}"), vec![member("10:00", i)], &live_frames(1.0, 3, true)))
        .collect();
    for cell in &mut cells {
        cell.outcome.evaluation.distance_source = name.clone();
        cell.outcome.method = name.clone();
        if let Some(truth) = &mut cell.outcome.evaluation.ground_truth {
            truth.source = name.clone();
        }
    }
    let mut input = input(cells, vec![MissingCell { label: name.clone(), reason: name.clone() }]);
    (input.matrix_name, input.site, input.command, input.matrix_source) =
        (name.clone(), name.clone(), name.clone(), name.clone());
    input.furrow_version = name;
    let html = page(&input).unwrap();
    keep("hostile.html", &html);
    // In the page's data a quotation mark is JSON's, and `<` is written as an escape.
    let data = between(&html, "<script type=\"application/json\" id=\"page-data\">", "</script>").to_owned();
    assert!(!data.contains('<') && data.contains("\\u003c"));
    let html = html.replace(&data, "");
    assert!(!html.contains("<img") && !html.contains('\u{202e}') && !html.contains("\" onload"));
    assert!(
        html.contains("&lt;script&gt;alert(1)&lt;&#x2f;script&gt;")
            && html.contains("שלום")
            && html.contains("{{ 7 * 7 }}")
    );
    assert!(html.contains(&long));
    assert_eq!(html.matches("</style>").count(), 1);
    // The page's data and its own script, and nothing else that a parser would take for one.
    assert_eq!((html.matches("<script").count(), html.matches("</script").count()), (2, 2));
}

#[test]
fn a_page_asks_nothing_of_the_network_and_its_ids_are_unique() {
    let html = page(&campaign(true)).unwrap();
    for (attribute, allowed) in [("src=\"", "-"), ("href=\"", "#d"), ("url(", "#")] {
        for target in html.split(attribute).skip(1) {
            assert!(target.starts_with(|c| allowed.contains(c)), "{attribute}{}", &target[..40.min(target.len())]);
        }
    }
    let mut ids: Vec<&str> = html.split(" id=\"").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    let all = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), all);
    for target in html.split("href=\"#").skip(1).map(|rest| rest.split('"').next().unwrap()) {
        assert!(ids.binary_search(&target).is_ok(), "#{target}");
    }
    assert_eq!(page(&campaign(true)).unwrap(), html);
}

#[test]
fn cells_that_differ_in_vocabulary_get_figures_of_their_own() {
    let of = |digit, experience: &str, words| {
        let mut cell = cell(digit, "08:00", experience, vec![member(experience, 0)], &live_frames(1.0, 3, false));
        cell.outcome.codebook_words = words;
        // Another size is another vocabulary: its name adds nothing to the title.
        cell.outcome.codebook = Some(CodebookId(digest(100 + words as usize)));
        cell
    };
    let html = page(&input(vec![of(0, "10:00", 60), of(1, "10:00", 23)], Vec::new())).unwrap();
    assert!(html.contains("vocabulary: 60 words") && html.contains("vocabulary: 23 words"));
    assert!(!html.contains("codebook: "));
    assert!(html.contains("id=\"s0-lost-figure\"") && html.contains("id=\"s1-lost-figure\""));
    // One cell each: one table, and no grid of one mark. What changes with the vocabulary comes first.
    let section = &html[html.find("<section id=\"cells\"").unwrap()..];
    let section = &section[..section.find("</section>").unwrap()];
    assert_eq!((section.matches("<table").count(), section.matches("setting</th>").count()), (1, 1));
    assert!(!html.contains("-heat-figure"));
    assert!(html.find("id=\"vocabulary-figure\"").unwrap() < html.find("<section id=\"cells\"").unwrap());

    let grids = [of(0, "10:00", 60), of(1, "12:00", 60), of(2, "10:00", 23), of(3, "12:00", 23)];
    let html = page(&input(grids.into(), Vec::new())).unwrap();
    assert!(html.contains("id=\"s0-heat-figure\"") && html.contains("id=\"s1-heat-figure\""));
    assert!(!html.contains("setting</th>"));
}

#[test]
fn contradictions_are_refused() {
    let one = || cell(0, "08:00", "10:00", vec![member("10:00", 0)], &live_frames(1.0, 3, false));
    assert!(
        matches!(page(&input(vec![one(), one()], Vec::new())), Err(ReportError::TwiceGiven(key)) if key == CellKey(digest(0)))
    );
    let mut other = one();
    other.outcome.evaluation.good += 1;
    assert!(matches!(page(&input(vec![other], Vec::new())), Err(ReportError::OtherEvents { .. })));
    let mut torn = one();
    torn.tiles[0].live_jpeg.truncate(5);
    assert!(matches!(page(&input(vec![torn], Vec::new())), Err(ReportError::Picture { which: "live", .. })));
    let mut bare = one();
    bare.events = bare.events.drop("inliers").unwrap();
    let error = page(&input(vec![bare], Vec::new())).unwrap_err().to_string();
    assert!(error.contains("inliers"), "{error}");
}

#[test]
fn the_gallery_takes_wrong_frames_first_and_spreads_the_others() {
    let mut frames = vec![Frame::Verified(40, Some(true)); 100];
    frames[70] = Frame::Verified(16, Some(false));
    frames[5] = Frame::Verified(2, Some(true));
    let made = cell(0, "08:00", "10:00", vec![member("10:00", 0)], &frames);
    let chosen = choose_tiles(&made.outcome, &made.events, 3, 2).unwrap();
    let at: Vec<f64> = chosen.iter().map(|choice| choice.caption.travelled_m / made::STEP_M).collect();
    assert_eq!(at[0], 70.0);
    assert_eq!(at[4..], [5.0]);
    assert!(at[1] < 34.0 && (34.0..67.0).contains(&at[2]) && at[3] >= 67.0, "{at:?}");
}

#[test]
fn a_thousand_cells_fit_on_a_page() {
    let mut cells = Vec::new();
    for live in 0..25_usize {
        let at = format!("{:02}:{:02}", 6 + live / 2, 30 * (live % 2));
        for experience in 0..40_usize {
            let seed = cells.len();
            let name = format!("10:00 as 12:00 (generator {experience})");
            let mut made = cell(
                seed,
                &at,
                &name,
                vec![member("12:00", experience)],
                &live_frames(seed as f64 % 4.0, seed as u32, true),
            );
            // The command chooses 60 images in all for a run of any size.
            made.tiles.truncate(usize::from(seed.is_multiple_of(17)));
            cells.push(made);
        }
    }
    let html = page(&input(cells, Vec::new())).unwrap();
    keep("thousand.html", &html);
    let rows = html.matches("<tr id=\"cell-").count();
    assert!(rows == 1000 && html.len() <= 10_000_000, "{rows} cells, {} bytes", html.len());
}
