//! Campaign files: what they stand for, what is wrong with them and where, and what is left to record.

use furrow_field::{CameraSettings, Campaign, CampaignError, Date, Site, Traversal, Weather, record};
use furrow_model::Purpose;
use std::path::{Path, PathBuf};

const TWO_ROUTES: &str = r#"# many passes at once
folder = "recordings"
container = "mcap"
site = "old-zoo"
date = "2026-01-15"
seed = 3
length_m = 40
size = "640x360"
weather = "clear"
rate_hz = 15

[[pass]]
route = "main"
slots = ["08:00", "10:00"]
purposes = ["experience", "evaluation"]

[[pass]]
route = "vocabulary"
sites = ["old-zoo", "lindenhof"]
slots = ["10:00"]
purposes = ["vocabulary"]
length_m = 60.5
weather = "hazy"
distorted = true
dropped = 0.1
clock_skew_ppm = -20
clock_offset_ms = 4.5
"#;

fn read(text: &str) -> Result<Campaign, CampaignError> {
    Campaign::read(text, Path::new("trials/campaign.toml"))
}

#[test]
fn a_file_stands_for_all_its_sites_slots_and_purposes() {
    let campaign = read(TWO_ROUTES).expect("a campaign");
    assert_eq!(campaign.folder, PathBuf::from("recordings"));
    let found: Vec<(&str, u32, Purpose)> = campaign
        .traversals
        .iter()
        .map(|planned| (planned.file.as_str(), planned.traversal.number, planned.purpose))
        .collect();
    let expected = [
        ("old-zoo-main-0800-experience.mcap", 0, Purpose::Experience),
        ("old-zoo-main-0800-evaluation.mcap", 1, Purpose::Evaluation),
        ("old-zoo-main-1000-experience.mcap", 0, Purpose::Experience),
        ("old-zoo-main-1000-evaluation.mcap", 1, Purpose::Evaluation),
        ("old-zoo-vocabulary-1000-vocabulary.mcap", 0, Purpose::Vocabulary),
        ("lindenhof-vocabulary-1000-vocabulary.mcap", 0, Purpose::Vocabulary),
    ];
    assert_eq!(found, expected);
    let plain = CameraSettings { rate_hz: 15.0, ..CameraSettings::default() };
    let first = Traversal {
        site: Site::OldZoo,
        route: "main".to_owned(),
        slot: "08:00".parse().expect("a slot"),
        date: Date::DEFAULT,
        weather: Weather::Clear,
        seed: 3,
        number: 0,
        length_m: 40.0,
        size: (640, 360),
        camera: plain,
    };
    let last = Traversal {
        site: Site::Lindenhof,
        route: "vocabulary".to_owned(),
        slot: "10:00".parse().expect("a slot"),
        weather: Weather::Hazy,
        length_m: 60.5,
        camera: CameraSettings { distorted: true, dropped: 0.1, clock_skew_ppm: -20.0, clock_offset_ms: 4.5, ..plain },
        ..first.clone()
    };
    assert_eq!((&campaign.traversals[0].traversal, &campaign.traversals[5].traversal), (&first, &last));
}

#[test]
fn several_dates_are_in_the_names_and_tables_of_one_slot_never_drive_alike() {
    let campaign = read(
        "site = \"backsburg\"\nslots = [\"06:00\"]\ncontainer = \"bag\"\n\
         [[pass]]\npurposes = [\"experience\"]\n[[pass]]\npurposes = [\"evaluation\"]\n\
         [[pass]]\npurposes = [\"evaluation\"]\ndate = \"2026-07-01\"\n",
    )
    .expect("a campaign");
    let found: Vec<(&str, u32)> =
        campaign.traversals.iter().map(|planned| (planned.file.as_str(), planned.traversal.number)).collect();
    let expected = [
        ("backsburg-main-0600-experience-2026-01-15.bag", 0),
        ("backsburg-main-0600-evaluation-2026-01-15.bag", 1),
        ("backsburg-main-0600-evaluation-2026-07-01.bag", 0),
    ];
    assert_eq!((found, campaign.folder), (expected.to_vec(), PathBuf::from(".")));
}

#[test]
fn what_is_wrong_is_said_with_its_place_and_what_is_expected() {
    // What in the file is replaced by what; line, column; words of the message.
    let cases: [(&str, &str, usize, usize, &[&str]); 25] = [
        ("weather = \"clear\"", "wether = \"clear\"", 9, 1, &["found the key 'wether'", "'weather' perhaps"]),
        ("length_m = 60.5", "lenght_m = 60.5", 22, 1, &["found the key 'lenght_m'", "expected 'length_m'"]),
        ("route = \"main\"", "folder = \"x\"", 13, 1, &["found the key 'folder'"]),
        ("\"old-zoo\", \"lind", "\"old-soo\", \"lind", 19, 10, &["found 'old-soo'", "'old-zoo' perhaps", "lindenhof"]),
        ("\"08:00\", ", "\"8:00\", ", 14, 10, &["found '8:00'", "HH:MM"]),
        ("slots = [\"08:00\", \"10:00\"]", "slots = []", 14, 9, &["found an empty list", "expected slots"]),
        ("slots = [\"08:00\", \"10:00\"]", "slots = \"08:00\"", 14, 9, &["found '08:00'", "expected slots"]),
        ("slots = [\"10:00\"]\n", "", 17, 1, &["found a pass without 'slots'"]),
        ("site = \"old-zoo\"\n", "", 11, 1, &["found a pass without 'site'", "expected site ="]),
        ("sites = [", "site = \"old-zoo\"\nsites = [", 20, 9, &["found both 'site' and 'sites'"]),
        ("[\"vocabulary\"]", "[\"vocabluary\"]", 21, 13, &["found 'vocabluary'", "'vocabulary' perhaps"]),
        ("[\"vocabulary\"]", "[]", 21, 12, &["found an empty list", "expected purposes"]),
        ("\"2026-01-15\"", "\"2026-02-30\"", 5, 8, &["found '2026-02-30'", "YYYY-MM-DD"]),
        ("\"2026-01-15\"", "2026-01-15", 5, 8, &["datetime", "in quotes"]),
        ("seed = 3", "seed = -3", 6, 8, &["found -3", "from 0 on"]),
        ("seed = 3", "seed = \"3\"", 6, 8, &["found '3'", "expected a whole number"]),
        ("640x360", "641x360", 8, 8, &["found a pass that cannot be driven", "641x360", "even numbers"]),
        ("640x360", "640*360", 8, 8, &["found '640*360'", "expected COLUMNSxROWS"]),
        ("rate_hz = 15", "rate_hz = 150", 10, 11, &["150", "expected 1 to 60"]),
        ("clock_offset_ms = 4.5", "clock_offset_ms = 45", 27, 19, &["45 ms", "expected -26.6"]),
        ("distorted = true", "distorted = 1", 24, 13, &["found 1", "expected true or false"]),
        ("route = \"main\"", "route = \"../main\"", 13, 9, &["found '../main'", "letters"]),
        ("\"recordings\"", "\"a/../../b\"", 2, 10, &["found 'a/../../b'", "without '..'"]),
        ("\"recordings\"", "\"/tmp\"", 2, 10, &["found '/tmp'", "below"]),
        ("\"mcap\"", "\"avi\"", 3, 13, &["found 'avi'", "mcap, bag"]),
    ];
    for (from, to, line, column, words) in cases {
        assert!(TWO_ROUTES.contains(from), "{from}");
        let error = read(&TWO_ROUTES.replacen(from, to, 1)).expect_err(to);
        assert_eq!((error.line, error.column), (line, column), "{to}: {error}");
        let text = error.to_string();
        assert!(text.starts_with(&format!("trials/campaign.toml:{line}:{column}: found ")), "{text}");
        assert!(words.iter().all(|word| text.contains(word)), "{to}: {text}");
    }
}

#[test]
fn two_passes_of_one_name_no_pass_and_no_toml_are_refused() {
    let twice = format!("{TWO_ROUTES}\n[[pass]]\nslots = [\"12:00\", \"08:00\"]\npurposes = [\"evaluation\"]\n");
    let error = read(&twice).expect_err("two of a name");
    assert_eq!((error.line, error.column), (30, 19));
    assert!(error.found.contains("old-zoo-main-0800-evaluation.mcap, after that of 14:10"), "{error}");
    let error = read("site = \"old-zoo\"\n").expect_err("no [[pass]]");
    assert_eq!(error.expected, "at least one [[pass]]");
    let error = read("site = \"old-zoo\"\npass = 3\n").expect_err("no tables");
    assert_eq!((error.line, error.column, error.found.as_str()), (2, 8, "3"));
    let error = read("site = \"old-zoo\"\n[[pass]\n").expect_err("no TOML");
    assert!(error.line == 2 && error.found.starts_with("no TOML"), "{error}");
}

#[test]
fn what_is_recorded_is_not_missing_until_its_description_changes() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "site = \"backsburg\"\nslots = [\"08:00\"]\nsize = \"64x36\"\nlength_m = 1\nrate_hz = 2\n\
                [[pass]]\npurposes = [\"experience\", \"evaluation\"]\n";
    let campaign = read(text).expect("a campaign");
    let missing = |campaign: &Campaign| -> Vec<String> {
        campaign.missing(folder.path()).iter().map(|planned| planned.purpose.to_string()).collect()
    };
    assert_eq!(missing(&campaign), ["experience", "evaluation"]);
    let first = &campaign.traversals[0];
    let path = folder.path().join(&first.file);
    record(&first.traversal, &path, &mut |_, _| ()).expect("a recording");
    assert_eq!(missing(&campaign), ["evaluation"]);
    // Every setting is part of the description.
    let changes = [
        ("length_m = 1\n", "length_m = 1.5\n"),
        ("rate_hz = 2\n", "rate_hz = 3\n"),
        ("rate_hz = 2\n", "rate_hz = 2\ndistorted = true\n"),
        ("rate_hz = 2\n", "rate_hz = 2\ndropped = 0.1\n"),
        ("rate_hz = 2\n", "rate_hz = 2\nclock_skew_ppm = 1\n"),
        ("rate_hz = 2\n", "rate_hz = 2\nclock_offset_ms = 1\n"),
        ("rate_hz = 2\n", "rate_hz = 2\nseed = 2\n"),
        ("rate_hz = 2\n", "rate_hz = 2\nweather = \"hazy\"\n"),
        ("rate_hz = 2\n", "rate_hz = 2\ndate = \"2026-01-16\"\n"),
        ("64x36", "64x38"),
        ("[\"experience\", \"evaluation\"]", "[\"evaluation\", \"experience\"]"),
    ];
    for (from, to) in changes {
        let changed = read(&text.replacen(from, to, 1)).expect("a campaign");
        assert_eq!(missing(&changed).len(), 2, "{to}");
    }
    let about = path.with_extension("pass.json");
    let whole = std::fs::read(&about).expect("the description");
    std::fs::write(&about, &whole[..whole.len() / 2]).expect("half of it");
    assert_eq!(missing(&campaign), ["experience", "evaluation"], "half a description is none");
    std::fs::write(&about, &whole).expect("all of it");
    std::fs::remove_file(&path).expect("the recording");
    assert_eq!(missing(&campaign), ["experience", "evaluation"], "a description is no recording");
}
