//! Whether one contender beats another, in tables and figures.

use crate::made::{self, campaign, digest};
use crate::read::{between, keep};
use furrow_model::{CellKey, Contrast, ContrastTraversal, Difference, TraversalId, Verdict};
use furrow_reports::{ContrastInput, page};

/// One contender against another, better by far, worse by far and neither.
fn contrasts() -> ContrastInput {
    let difference = |difference: f64, low: f64, high: f64, verdict| Difference {
        of: 60.0 + difference,
        over: 60.0,
        difference,
        interval: Some([low, high]),
        verdict,
        p: Some(0.0124),
        p_holm: Some(0.0372),
        blocks: Some(9),
        block_m: Some(23.2),
        error_within: Some(8.0),
        error_between: None,
    };
    let traversals = |n: usize| {
        (0..n).map(|i| ContrastTraversal {
            slot: made::slot("08:00"),
            traversal: TraversalId(digest(i)),
            cells: [CellKey(digest(1)), CellKey(digest(2))],
        })
    };
    let contrast = |of: &str, over: &str, live: usize| Contrast {
        of: of.to_owned(),
        over: over.to_owned(),
        setting: String::new(),
        live: traversals(live).collect(),
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
            && section.contains("2 traversals pooled")
            && !section.contains("<b> over")
    );
    // 24 of 200 live frames are 12 points, from 4 to 20.25.
    let good = between(section, "id=\"contrasts-good-desc\"", "</desc>");
    assert!(good.contains("+12.00 (95 % interval +4.00 to +20.25), better, p 0.012, Holm 0.037"), "{good}");
    let whiskers: Vec<&str> =
        section.split("data-low=\"").skip(1).map(|rest| rest.split_once('"').unwrap().0).collect();
    assert_eq!(whiskers, ["-25", "-25", "4", "4", "-3", "-3", "-3", "-3"]);
    assert!(between(&html, "<figcaption>", "</figcaption>").contains("Figure 1."), "the first figure is counted first");
    assert_eq!(html.matches("Figure 1.").count(), 1);
    // Every number links to what it is the difference of: 84 minus 60, of two cells.
    assert_eq!(section.matches("href=\"#lineage-contrast-3\"").count(), 5);
    let lineage = between(&html, "id=\"lineage-contrast-3\"", "</details>");
    assert!(lineage.contains("84 minus 60") && lineage.contains("simulation"), "{lineage}");
    for cell in [1, 2].map(|cell| CellKey(digest(cell)).short()) {
        assert!(lineage.contains(&format!("<a href=\"#lineage-{cell}\"><code>{cell}</code></a>")), "{lineage}");
        assert!(html.contains(&format!("id=\"lineage-{cell}\"")), "{cell}");
    }
    // What a verdict hangs on is to be seen: 0.004 of 200 frames are 0.002 points.
    input.contrasts.found[0].good.interval = Some([0.004, 40.5]);
    let html = page(&input).unwrap();
    let good = between(&html, "id=\"contrasts-good-desc\"", "</desc>");
    assert!(html.contains("+0.004 to +40") && good.contains("(95 % interval +0.002 to +20.25), better"), "{good}");
    // What a correction undoes is not called better, and what has no interval says why.
    input.contrasts.found[0].good.p_holm = Some(0.06);
    let short = &mut input.contrasts.found[1].good;
    (short.interval, short.p, short.p_holm, short.verdict) = (None, None, None, Verdict::TooLittleRoad);
    let html = page(&input).unwrap();
    let table = between(between(&html, "<section id=\"contrasts\"", "</section>"), "<tbody>", "</tbody>");
    assert_eq!(
        table.matches("<span class=\"badge\">better</span><br><span class=\"soft\">not when corrected</span>").count(),
        1
    );
    assert_eq!(table.matches("<span class=\"badge\">too little road</span>").count(), 1);
    let elsewhere = CellKey(digest(901));
    input.contrasts.found[2].live.iter_mut().for_each(|traversal| traversal.cells[1] = elsewhere);
    let html = page(&input).unwrap();
    let lineage = between(&html, "id=\"lineage-contrast-3\"", "</details>");
    assert!(
        lineage.contains(&format!("minus cell <code>{}</code>", elsewhere.short())),
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
