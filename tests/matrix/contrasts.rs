//! Contrasts stand in every setting of a matrix, say which, and are said once where two settings come to the same
//! cells.

use crate::support::matrix::Matrix;
use crate::support::recordings::ingested;
use serde_json::Value;

/// What each contrast names: of, over, setting.
fn named(result: &Value) -> Vec<[String; 3]> {
    let word = |contrast: &Value, key: &str| contrast[key].as_str().unwrap_or_default().to_owned();
    let names = |contrast: &Value| ["of", "over", "setting"].map(|key| word(contrast, key));
    result["contrasts"].as_array().unwrap().iter().map(names).collect()
}

#[test]
fn contrasts_are_asked_in_every_setting() {
    let store = ingested();
    let asked = Matrix::small().contrast("both", "10:00");
    let plan = |matrix: &Matrix| store.json(format!("plan {}", matrix.write(store.path())));
    let name = |of: &str, setting: &str| [of, "10:00", setting].map(str::to_owned);

    let by_words = asked.clone().without_words().axis("words", "[200, 300]");
    let planned = plan(&by_words);
    assert_eq!(named(&planned), [name("both", "200 words"), name("both", "300 words")]);
    let matrix = by_words.write(store.path());
    let ran = store.json(format!("run {matrix}"));
    assert_eq!(named(&ran), named(&planned));
    let cells = ran["cells"].as_array().unwrap();
    for contrast in ran["contrasts"].as_array().unwrap() {
        let good = |key: &str| {
            let is = |cell: &&Value| cell["experience"] == contrast[key] && cell["setting"] == contrast["setting"];
            cells.iter().find(is).unwrap()["good"].as_f64().unwrap()
        };
        assert_eq!(contrast["good"]["difference"], good("of") - good("over"), "{contrast}");
    }
    let again = store.json(format!("run {matrix}"));
    assert_eq!((&again["run"], &again["contrasts"]), (&ran["run"], &ran["contrasts"]));
    let printed = store.text(format!("run {matrix}"));
    assert!(printed.contains("both over 10:00 [300 words]"), "{printed}");
    let page = store.file("report.html");
    store.json(format!("report latest -o {page}"));
    assert!(std::fs::read_to_string(&page).unwrap().contains("<bdi>300 words</bdi>"));

    // Both policies of a collective; settings that come to the same cells; one setting, which needs no name.
    let planned = plan(&asked.clone().axis("policy", "[\"all\", { agree = 2 }]"));
    assert_eq!(named(&planned), [name("both (all)", ""), name("both (agree 2)", "")]);
    let planned = plan(&asked.clone().axis("images", "[5000, 6000]"));
    assert_eq!(named(&planned), [name("both", "5000 vocabulary images")]);

    let wrong = Matrix::small().contrast("both", "10:01");
    let place = format!("line {}, column 8", wrong.line_of("over"));
    let words = format!("{place}: contrast: nothing is called '10:01': did you mean '10:00'?");
    store.fails(format!("plan {}", wrong.write(store.path())), 1, &[&words]);
}
