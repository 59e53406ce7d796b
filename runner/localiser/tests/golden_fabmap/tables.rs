//! Finds and reads sets of FAB-MAP's golden numbers.

use crate::golden_data::files_below;
use furrow_localiser::Presence;
use std::collections::{BTreeMap, HashMap};
use std::io::Read;
use std::path::{Path, PathBuf};

pub struct TreeRow {
    pub parent: u32,
    pub p: f64,
    pub p_if_parent: f64,
    pub p_if_not_parent: f64,
}

pub struct LikelihoodRow {
    pub query: usize,
    pub method: String,
    /// -1 is the new place.
    pub place: i64,
    pub log_likelihood: f64,
    pub posterior: f64,
}

pub struct Set {
    pub name: String,
    pub train: Vec<Presence>,
    pub places: Vec<Presence>,
    pub queries: Vec<Presence>,
    pub tree: Vec<TreeRow>,
    pub likelihoods: Vec<LikelihoodRow>,
    /// What FabMap2's log-likelihoods of a query leave out, where the set says so.
    pub constants: BTreeMap<usize, f64>,
    pub information_threshold: f64,
    pub p_detect_present: f64,
    pub p_detect_absent: f64,
    pub smoothing: f64,
}

/// A CSV table: its rows as column name to text.
struct Table {
    path: PathBuf,
    columns: Vec<String>,
    rows: Vec<HashMap<String, String>>,
}

impl Table {
    fn read(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_str()?;
        let bytes = std::fs::read(path).ok()?;
        let mut text = String::new();
        if name.ends_with(".csv.gz") {
            flate2::read::GzDecoder::new(&bytes[..]).read_to_string(&mut text).ok()?;
        } else if name.ends_with(".csv") {
            text = String::from_utf8(bytes).ok()?;
        } else {
            return None;
        }
        let mut lines = text.lines();
        let columns: Vec<String> = lines.next()?.split(',').map(str::to_owned).collect();
        let row = |line: &str| columns.iter().cloned().zip(line.split(',').map(str::to_owned)).collect();
        let rows = lines.map(row).collect();
        Some(Self { path: path.to_owned(), columns, rows })
    }

    fn has(&self, columns: &[&str]) -> bool {
        columns.iter().all(|column| self.columns.iter().any(|own| own == column))
    }

    fn presences(&self) -> Vec<Presence> {
        let presence = |row: &HashMap<String, String>| {
            let words: Presence = row["words"].split_whitespace().map(|word| word.parse::<u32>().unwrap()).collect();
            assert_eq!(words.len().to_string(), row["n_words"], "{}", self.path.display());
            words
        };
        self.rows.iter().map(presence).collect()
    }
}

fn number<T: std::str::FromStr>(row: &HashMap<String, String>, column: &str) -> T {
    row[column].parse().ok().unwrap_or_else(|| panic!("column {column} holds '{}'", row[column]))
}

/// Every folder below that holds a complete set.
pub fn sets_below(folder: &Path) -> Vec<Set> {
    let mut folders: BTreeMap<PathBuf, Vec<PathBuf>> = BTreeMap::new();
    for path in files_below(folder) {
        folders.entry(path.parent().unwrap_or(folder).to_owned()).or_default().push(path);
    }
    folders.into_iter().filter_map(|(folder, files)| set(&folder, &files)).collect()
}

fn set(folder: &Path, files: &[PathBuf]) -> Option<Set> {
    let name = folder.display().to_string();
    let is_meta =
        |value: &serde_json::Value| ["p_z_given_e", "training_images"].iter().all(|key| value[key].is_number());
    let json = |path: &PathBuf| serde_json::from_slice(&std::fs::read(path).ok()?).ok();
    let meta =
        files.iter().filter(|path| path.extension().is_some_and(|e| e == "json")).find_map(|p| json(p).filter(is_meta));
    let tables: Vec<Table> = files.iter().filter_map(|path| Table::read(path)).collect();
    let with = |columns: &[&str]| tables.iter().find(|table| table.has(columns));
    let tree = with(&["word", "parent", "p_z", "p_z_given_parent_present", "p_z_given_parent_absent"]);
    let likelihoods = with(&["query", "method", "place", "log_likelihood", "posterior"]);
    let queries = with(&["index", "true_place", "n_words", "words"]);
    let plain: Vec<&Table> = tables
        .iter()
        .filter(|table| table.has(&["index", "n_words", "words"]) && !table.has(&["true_place"]))
        .collect();
    let (Some(meta), Some(tree), Some(likelihoods), Some(queries), [_, _]) =
        (meta, tree, likelihoods, queries, &plain[..])
    else {
        if tree.is_some() || likelihoods.is_some() {
            eprintln!("SKIPPED: {name} holds a part of a FAB-MAP set only");
        }
        return None;
    };
    // Training images and places look alike; likelihoods tell how many places there are.
    let places = likelihoods.rows.iter().map(|row| number::<i64>(row, "place")).max()? as usize + 1;
    let is_places = |table: &&Table| table.rows.len() == places;
    let says_place =
        |table: &&Table| table.path.file_name().is_some_and(|name| name.to_string_lossy().contains("place"));
    let places_at = match plain.iter().filter(|table| is_places(table)).count() {
        1 => plain.iter().position(is_places)?,
        _ => plain.iter().position(says_place)?,
    };
    let constant = |row| Some((number(row, "query"), number(row, "fabmap2_constant")));
    let constants = with(&["query", "fabmap2_constant"]).map(|table| table.rows.iter().filter_map(constant).collect());
    Some(Set {
        name,
        train: plain[1 - places_at].presences(),
        places: plain[places_at].presences(),
        queries: queries.presences(),
        tree: tree.rows.iter().enumerate().map(|(word, row)| tree_row(word, row)).collect(),
        likelihoods: likelihoods.rows.iter().map(likelihood_row).collect(),
        constants: constants.unwrap_or_default(),
        information_threshold: meta["info_threshold"].as_f64()?,
        p_detect_present: meta["p_z_given_e"].as_f64()?,
        p_detect_absent: meta["p_z_given_not_e"].as_f64()?,
        smoothing: meta["smoothing_factor"].as_f64()?,
    })
}

fn tree_row(word: usize, row: &HashMap<String, String>) -> TreeRow {
    assert_eq!(number::<usize>(row, "word"), word, "the tree's rows are in the words' order");
    TreeRow {
        parent: number(row, "parent"),
        p: number(row, "p_z"),
        p_if_parent: number(row, "p_z_given_parent_present"),
        p_if_not_parent: number(row, "p_z_given_parent_absent"),
    }
}

fn likelihood_row(row: &HashMap<String, String>) -> LikelihoodRow {
    LikelihoodRow {
        query: number(row, "query"),
        method: row["method"].clone(),
        place: number(row, "place"),
        log_likelihood: number(row, "log_likelihood"),
        posterior: number(row, "posterior"),
    }
}
