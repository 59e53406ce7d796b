//! Pages made from a made-up run: what they show is what the outcomes say.

#![allow(clippy::unwrap_used, reason = "helpers of tests: a panic is how they fail")]

mod made;

use furrow_model::{CellKey, CodebookId, Contrast, ContrastPass, Difference, Outcome, TraversalId, Verdict};
use furrow_reports::{
    ContrastInput, MissingCell, ReportError, TrackInput, choose_still, choose_tiles, figure_files, page,
};
use made::{Frame, campaign, cell, digest, drive, input, member};

/// The value of an attribute in the first tag after `from` in which it occurs.
fn attribute<'a>(text: &'a str, name: &str) -> &'a str {
    let from = text.split_once(&format!(" {name}=\"")).unwrap_or_else(|| panic!("no {name}")).1;
    from.split_once('"').unwrap().0
}

fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    text.split_once(from).unwrap_or_else(|| panic!("no {from}")).1.split_once(to).unwrap_or_else(|| panic!("no {to}")).0
}

fn row_value(html: &str, outcome: &Outcome, name: &str) -> String {
    let row = between(html, &format!("<tr id=\"cell-{}\"", outcome.key.short()), "</tr>");
    between(row, &format!("<data class=\"{name}\" value=\""), "\"").to_owned()
}

/// Leaves the page where a person can look at it.
fn keep(name: &str, html: &str) {
    std::fs::write(std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name), html).unwrap();
}

/// One contender against another, better by far, worse by far and neither.
fn contrasts() -> ContrastInput {
    let difference = |difference: f64, low: f64, high: f64, verdict| Difference {
        of: 60.0 + difference,
        over: 60.0,
        difference,
        interval: [low, high],
        verdict,
    };
    let passes = |n: usize| {
        (0..n).map(|i| ContrastPass {
            slot: made::slot("08:00"),
            traversal: TraversalId(digest(i)),
            cells: [CellKey(digest(1)), CellKey(digest(2))],
        })
    };
    let contrast = |of: &str, over: &str, live: usize| Contrast {
        of: of.to_owned(),
        over: over.to_owned(),
        setting: String::new(),
        live: passes(live).collect(),
        frames: 200,
        good: difference(24.0, 8.0, 40.5, Verdict::Better),
        right: Some(difference(-30.0, -50.0, -4.0, Verdict::Worse)),
        lost_fraction: difference(0.0625, -0.03, 0.15, Verdict::NotSeparable),
        area_m: difference(-1.25, -3.0, -0.5, Verdict::Better),
        truth: Some("simulation".to_owned()),
    };
    let long = "10:00 as 14:00 (otf:10:00>16:00 z 0.66) <b>";
    ContrastInput {
        found: vec![
            contrast("children", "children (placebo)", 1),
            contrast(long, "14:00", 1),
            contrast(long, "14:00", 2),
        ],
        notes: vec!["'children' is set against '10:00' and against no placebo".to_owned()],
    }
}

#[test]
fn contrasts_are_shown_with_their_intervals_verdicts_and_doubts() {
    let mut input = campaign(true);
    assert!(!page(&input).unwrap().contains("id=\"contrasts\""), "nothing is said where nothing is asked");
    input.contrasts = contrasts();
    let html = page(&input).unwrap();
    keep("contrasts.html", &html);
    let section = between(&html, "<section id=\"contrasts\"", "</section>");
    assert!(between(section, "class=\"notice\"", "</div>").contains("against no placebo"));
    for (name, value) in [("right", "-30"), ("good", "24"), ("lost_fraction", "0.0625"), ("area_m", "-1.25")] {
        assert_eq!(section.matches(&format!("<data class=\"{name}\" value=\"{value}\">")).count(), 3, "{name}");
    }
    assert!(
        section.contains("\u{2212}50 to \u{2212}4")
            && section.contains("2 passes pooled")
            && !section.contains("<b> over")
    );
    // 24 of 200 live frames are 12 points, from 4 to 20.25.
    let good = between(section, "id=\"contrasts-good-desc\"", "</desc>");
    assert!(good.contains("+12.00 (95 % interval +4.00 to +20.25), better"), "{good}");
    let whiskers: Vec<&str> =
        section.split("data-low=\"").skip(1).map(|rest| rest.split_once('"').unwrap().0).collect();
    assert_eq!(whiskers, ["-25", "-25", "4", "4", "-3", "-3", "-3", "-3"]);
    assert!(between(&html, "<figcaption>", "</figcaption>").contains("Figure 1."), "the first figure is counted first");
    assert_eq!(html.matches("Figure 1.").count(), 1);
    // Every number leads to what it is the difference of: 84 less 60, of two cells.
    assert_eq!(section.matches("href=\"#lineage-contrast-3\"").count(), 5);
    let lineage = between(&html, "id=\"lineage-contrast-3\"", "</details>");
    assert!(lineage.contains("84 less 60") && lineage.contains("simulation"), "{lineage}");
    for cell in [1, 2].map(|cell| CellKey(digest(cell)).short()) {
        assert!(lineage.contains(&format!("<a href=\"#lineage-{cell}\"><code>{cell}</code></a>")), "{lineage}");
        assert!(html.contains(&format!("id=\"lineage-{cell}\"")), "{cell}");
    }
    let elsewhere = CellKey(digest(901));
    input.contrasts.found[2].live.iter_mut().for_each(|pass| pass.cells[1] = elsewhere);
    let html = page(&input).unwrap();
    let lineage = between(&html, "id=\"lineage-contrast-3\"", "</details>");
    assert!(
        lineage.contains(&format!("less cell <code>{}</code>", elsewhere.short())),
        "cells that the page has not are not linked to"
    );
    // Settings are told where there are several.
    assert!(!section.contains("setting</th>"));
    input.contrasts.found.iter_mut().for_each(|contrast| contrast.setting = "300 words".to_owned());
    let html = page(&input).unwrap();
    let section = between(&html, "<section id=\"contrasts\"", "</section>");
    assert!(section.contains("setting</th>"));
    assert_eq!(section.matches("<td class=\"words\"><bdi>300 words</bdi></td>").count(), 3);
    assert!(section.contains("children over children (placebo) [300 words]"));
}

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
            ("average_precision", real(truth.average_precision)),
            ("false_positive_rate", real(truth.false_positive_rate)),
            ("position_rmse_m", real(truth.position_rmse_m)),
        ] {
            assert_eq!(row_value(&html, outcome, name), expected, "{name} of {outcome:?}");
        }
    }
}

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

/// SPEC 4.1's table: d, then A and B in survival, length-biased and per gap.
const FIG_6_3: [[f64; 7]; 5] = [
    [0.0, 0.50, 0.50, 0.5, 0.5, 1.0, 1.0],
    [5.0, 0.25, 0.45, 0.5, 0.5, 1.0, 1.0],
    [10.0, 0.0, 0.40, 0.0, 0.5, 0.0, 1.0],
    [25.0, 0.0, 0.25, 0.0, 0.5, 0.0, 1.0],
    [50.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
];

#[test]
fn figure_6_3_is_drawn_as_the_thesis_tells_it() {
    let mut cells: Vec<_> = ["10:00", "14:00"]
        .into_iter()
        .enumerate()
        .map(|(i, at)| cell(i, "08:00", at, vec![member(at, i)], &drive(0.0, 1, false)))
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
    assert!(html.contains("of <data class=\"accepted\" value=\"3\">3</data> accepted answers <data class=\"correct\" value=\"2\">2</data> were right"));
    let gallery = between(&html, "<section id=\"frames\"", "</section>");
    assert!(gallery.find("class=\"wrong\"").unwrap() < gallery.find("class=\"right\"").unwrap());
}

#[test]
fn histogram_bars_hold_every_verified_candidate() {
    let html =
        page(&input(vec![cell(0, "08:00", "10:00", vec![member("10:00", 0)], &drive(2.0, 5, true))], Vec::new()))
            .unwrap();
    let figure = between(&html, "<figure id=\"s0-inliers-figure\"", "</figure>");
    let total: usize = figure
        .split("data-count=\"")
        .skip(1)
        .map(|rest| rest.split('"').next().unwrap().parse::<usize>().unwrap())
        .sum();
    let verified = drive(2.0, 5, true).iter().filter(|frame| matches!(frame, Frame::Verified(..))).count();
    assert_eq!(total, verified);
    assert!(figure.contains("threshold 15"));
    let bars = figure.split("data-from=\"").skip(1).map(|rest| {
        let (from, rest) = rest.split_once('"').unwrap();
        (from.parse::<u32>().unwrap(), attribute(rest, "data-count").parse::<usize>().unwrap())
    });
    let reaching: usize = bars.filter(|(from, _)| *from >= made::THRESHOLD).map(|(_, count)| count).sum();
    let expected = drive(2.0, 5, true)
        .iter()
        .filter(|frame| matches!(frame, Frame::Verified(n, _) if *n >= made::THRESHOLD))
        .count();
    assert_eq!(reaching, expected, "no bar stands on both sides of the threshold");
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
    assert!(html.contains("Not known to be right."));
    assert!(!html.contains(">precision<"));
    let html = page(&input(vec![none], Vec::new())).unwrap();
    assert!(html.contains("did not find its place in any live picture"));
    let html =
        page(&input(Vec::new(), vec![MissingCell { label: "08:00".to_owned(), reason: "killed".to_owned() }])).unwrap();
    assert!(html.contains("No combination of live drive and memory was finished") && html.contains("killed"));
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
        .map(|i| cell(i, "08:00", &format!("{name}{i}"), vec![member("10:00", i)], &drive(1.0, 3, true)))
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
        let mut cell = cell(digit, "08:00", experience, vec![member(experience, 0)], &drive(1.0, 3, false));
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
    let one = || cell(0, "08:00", "10:00", vec![member("10:00", 0)], &drive(1.0, 3, false));
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
    let told = page(&input(vec![bare], Vec::new())).unwrap_err().to_string();
    assert!(told.contains("inliers"), "{told}");
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
            let mut made =
                cell(seed, &at, &name, vec![member("12:00", experience)], &drive(seed as f64 % 4.0, seed as u32, true));
            // The command chooses 60 pictures in all for a run of any size.
            made.tiles.truncate(usize::from(seed.is_multiple_of(17)));
            cells.push(made);
        }
    }
    let html = page(&input(cells, Vec::new())).unwrap();
    keep("thousand.html", &html);
    let rows = html.matches("<tr id=\"cell-").count();
    assert!(rows == 1000 && html.len() <= 10_000_000, "{rows} cells, {} bytes", html.len());
}

#[test]
fn vocabularies_and_generators_are_drawn_where_a_run_has_them() {
    let mut cells: Vec<_> =
        (0..2).map(|i| cell(i, "08:00", "10:00", vec![member("10:00", 0)], &drive(1.0, 3, false))).collect();
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
    input.cells = vec![cell(7, "08:00", name, vec![member("12:00", 7)], &drive(1.0, 3, false))];
    let html = page(&input).unwrap();
    assert!(sheet(&html) < numbers(&html), "where all is painted, the paint comes first");
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
        name: "Live 08:00, <b>pass</b>".to_owned(),
        source: "true poses".to_owned(),
        truth_m: vec![[10.0, 20.0], [13.0, 20.0], [13.0, 24.0]],
        odometry_m: vec![[10.0, 20.25], [13.0, 20.25], [13.0, 24.25]],
        rms_m: 0.25,
        length_m: 7.0,
    }];
    let html = page(&input).unwrap();
    let figure = between(&html, "id=\"tracks-figure\"", "</figure>");
    assert!(figure.contains("0.25 m off over 7 m") && !figure.contains("<b>pass"));
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
