//! Matrix files, put together key by key.

use super::command::{Quoted, quoted};
use std::fmt::Write as _;
use std::path::Path;

/// Keys with their values as TOML, in the order of the file.
type Keys = Vec<(&'static str, String)>;

/// A matrix to be written.
#[derive(Clone)]
pub struct Matrix {
    top: Keys,
    codebook: Keys,
    axes: Keys,
    collectives: Vec<String>,
    tables: Vec<String>,
}

impl Matrix {
    /// No words, no axes; the vocabulary is trained on the route `vocabulary`.
    pub fn new(name: &str, site: &str) -> Self {
        let (axes, collectives, tables) = (Keys::new(), Vec::new(), Vec::new());
        let codebook = vec![("route", text("vocabulary"))];
        Self { top: vec![("name", text(name)), ("site", text(site))], codebook, axes, collectives, tables }
    }

    /// The one that most tests run over the recordings of `recordings`: two experiences and both together, live at
    /// 08:00.
    pub fn small() -> Self {
        let alone = Self::new("small", "old-zoo").words(600).images(60).keyframes(1.0).threshold(40);
        alone.live(&["08:00"]).experiences(&["08:00", "10:00"]).collective("both", "recorded", "")
    }

    pub fn named(self, name: &str) -> Self {
        self.key("name", &text(name))
    }

    /// Sets a key at the top of the file.
    pub fn key(mut self, key: &'static str, toml: &str) -> Self {
        set(&mut self.top, key, toml);
        self
    }

    pub fn keyframes(self, distance_m: f64) -> Self {
        self.key("keyframes", &format!("{{ distance_m = {distance_m:?}, yaw_rad = 0.2536 }}"))
    }

    pub fn threshold(self, inliers: u32) -> Self {
        self.key("verification", &format!("{{ threshold = {inliers} }}"))
    }

    /// The threshold is calibrated, or an axis.
    pub fn without_threshold(mut self) -> Self {
        self.top.retain(|(key, _)| *key != "verification");
        self
    }

    /// The route that the vocabulary is trained on.
    pub fn vocabulary(mut self, route: &str) -> Self {
        set(&mut self.codebook, "route", &text(route));
        self
    }

    pub fn words(mut self, count: usize) -> Self {
        set(&mut self.codebook, "words", &count.to_string());
        self
    }

    /// How many words is an axis.
    pub fn without_words(mut self) -> Self {
        self.codebook.retain(|(key, _)| *key != "words");
        self
    }

    /// Vocabulary images.
    pub fn images(mut self, count: usize) -> Self {
        set(&mut self.codebook, "images", &count.to_string());
        self
    }

    /// Sets an axis: a list as TOML.
    pub fn axis(mut self, name: &'static str, toml: &str) -> Self {
        set(&mut self.axes, name, toml);
        self
    }

    pub fn live(self, slots: &[&str]) -> Self {
        self.axis("live", &list(slots))
    }

    /// Experiences by texts, such as slots.
    pub fn experiences(self, entries: &[&str]) -> Self {
        self.axis("experience", &list(entries))
    }

    /// A collective; `more` is the rest of its table as TOML.
    pub fn collective(mut self, name: &str, of: &str, more: &str) -> Self {
        self.collectives.push(format!("[[collective]]\nname = {}\nof = {}\n{more}", text(name), text(of)));
        self
    }

    pub fn without_collectives(mut self) -> Self {
        self.collectives.clear();
        self
    }

    pub fn contrast(self, of: &str, over: &str) -> Self {
        self.table(&format!("[[contrast]]\nof = {}\nover = {}", text(of), text(over)))
    }

    /// Any more TOML behind all tables.
    pub fn table(mut self, toml: &str) -> Self {
        self.tables.push(toml.to_owned());
        self
    }

    pub fn toml(&self) -> String {
        let pairs: Vec<String> = self.codebook.iter().map(|(key, value)| format!("{key} = {value}")).collect();
        let mut toml = String::new();
        let line =
            |toml: &mut String, (key, value): &(&str, String)| writeln!(toml, "{key} = {value}").expect("a line");
        self.top.iter().for_each(|pair| line(&mut toml, pair));
        line(&mut toml, &("codebook", format!("{{ {} }}", pairs.join(", "))));
        toml += "[axes]\n";
        self.axes.iter().for_each(|pair| line(&mut toml, pair));
        self.collectives
            .iter()
            .chain(&self.tables)
            .for_each(|table| writeln!(toml, "{}", table.trim_end()).expect("a table"));
        toml
    }

    /// The number of the only line with this text, from 1, as errors name it.
    pub fn line_of(&self, words: &str) -> usize {
        let toml = self.toml();
        let found: Vec<usize> =
            toml.lines().enumerate().filter(|(_, line)| line.contains(words)).map(|(i, _)| i + 1).collect();
        let [line] = found.as_slice() else { panic!("'{words}' stands on lines {found:?} of\n{toml}") };
        *line
    }

    /// Writes it into a folder, over one that was there.
    pub fn write(&self, folder: &Path) -> Quoted {
        let file = folder.join("matrix.toml");
        std::fs::write(&file, self.toml()).expect("a matrix file");
        quoted(file)
    }
}

fn set(keys: &mut Keys, key: &'static str, toml: &str) {
    match keys.iter_mut().find(|(known, _)| *known == key) {
        Some((_, value)) => toml.clone_into(value),
        None => keys.push((key, toml.to_owned())),
    }
}

/// A TOML string: JSON's escapes are TOML's, too.
fn text(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

fn list(entries: &[&str]) -> String {
    serde_json::Value::from(entries).to_string()
}
