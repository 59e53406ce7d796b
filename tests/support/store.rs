//! A store in a temporary folder, and what any program can read in it.

use super::command::{Furrow, Quoted, furrow, quoted};
use furrow_catalog::images::{ColourImage, decode_colour};
use serde_json::Value;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A store; the folder goes with it.
pub struct Store {
    root: Quoted,
    /// `None` where the folder is another's.
    _folder: Option<TempDir>,
}

impl Store {
    /// A new one. Its path holds a space, so that a path without quotes fails the test.
    #[track_caller]
    pub fn new() -> Self {
        let store = Self::empty_folder();
        furrow(format!("init {}", store.root)).text();
        store
    }

    /// One that stands in a folder already.
    pub fn at(root: impl AsRef<Path>) -> Self {
        Self { root: quoted(root), _folder: None }
    }

    /// A copy with a life of its own. Objects and recordings, which never change, are shared by hard links: [`replace`]
    /// one to damage it.
    pub fn copy(&self) -> Self {
        let copy = Self::empty_folder();
        copy_tree(&self.root, &copy.root, false);
        copy
    }

    fn empty_folder() -> Self {
        let folder = tempfile::Builder::new().prefix("furrow store ").tempdir().expect("a temporary folder");
        Self { root: quoted(folder.path()), _folder: Some(folder) }
    }

    pub fn path(&self) -> &Path {
        &self.root
    }

    /// The store's folder as a word of a line.
    pub fn root(&self) -> &Quoted {
        &self.root
    }

    /// A file of the store's folder by its name.
    pub fn file(&self, name: &str) -> Quoted {
        quoted(self.root.join(name))
    }

    /// Writes a file into the store's folder.
    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> Quoted {
        let file = self.file(name);
        std::fs::write(&file, bytes).expect("a file that can be written");
        file
    }

    /// `furrow --store STORE LINE`.
    #[track_caller]
    pub fn furrow(&self, line: impl AsRef<str>) -> Furrow {
        furrow(format!("--store {} {}", self.root, line.as_ref()))
    }

    /// Success: what a line prints with `--json`.
    #[track_caller]
    pub fn json(&self, line: impl AsRef<str>) -> Value {
        self.furrow(line).json()
    }

    /// Success: what a line prints.
    #[track_caller]
    pub fn text(&self, line: impl AsRef<str>) -> String {
        self.furrow(line).text()
    }

    /// Failure with this exit code, and with `words` on stderr: what stands there.
    #[track_caller]
    pub fn fails(&self, line: impl AsRef<str>, code: i32, words: &[&str]) -> String {
        self.furrow(line).fails(code, words)
    }

    /// `fsck` finds no fault: what it prints.
    #[track_caller]
    pub fn assert_intact(&self) -> Value {
        let state = self.json("fsck");
        assert_eq!(state["faults"], serde_json::json!([]));
        state
    }

    /// The recorded experience of a slot, as `ls` lists it.
    #[track_caller]
    pub fn experience(&self, slot: &str) -> Value {
        let listing = self.json("ls");
        let mut experiences = listing["experiences"].as_array().expect("experiences").iter();
        experiences.find(|one| one["slot"] == slot && one["generated"] == false).expect("an experience").clone()
    }

    /// The file of an object.
    pub fn object(&self, id: &Value) -> PathBuf {
        let id = id.as_str().expect("an id");
        self.root.join("objects").join(&id[..2]).join(id)
    }

    /// The body of a record, read as any program could.
    pub fn record(&self, id: &Value) -> Value {
        let bytes = std::fs::read(self.object(id)).expect("a record");
        serde_json::from_slice::<Value>(&bytes).expect("JSON")["body"].clone()
    }

    /// The left image of a node of a record.
    pub fn image(&self, node: &Value) -> ColourImage {
        decode_colour(&std::fs::read(self.object(&node["left"])).expect("an image"), None).expect("an image")
    }

    /// The file of the left image of an experience's first node.
    pub fn first_image(&self, slot: &str) -> PathBuf {
        let record = self.record(&self.experience(slot)["experience"]);
        self.object(&record["nodes"][0]["left"])
    }

    /// Files that are written at the moment; a command that has ended leaves none.
    pub fn unfinished_files(&self) -> usize {
        std::fs::read_dir(self.root.join("tmp")).expect("tmp/").count()
    }
}

/// Puts other bytes under the name of a file that other stores may share.
pub fn replace(file: &Path, bytes: impl AsRef<[u8]>) {
    std::fs::remove_file(file).expect("a file that can be removed");
    std::fs::write(file, bytes).expect("a file that can be written");
}

/// Copies a folder; what lies below `objects` and `recordings` becomes a second name of the same file.
fn copy_tree(from: &Path, to: &Path, shared: bool) {
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(from).expect("a folder").flatten() {
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        if entry.file_type().expect("a file type").is_dir() {
            let shared = shared || ["objects", "recordings"].iter().any(|name| entry.file_name() == *name);
            copy_tree(&from, &to, shared);
        } else if shared {
            std::fs::hard_link(&from, &to).expect("a second name");
        } else {
            std::fs::copy(&from, &to).expect("a copy");
        }
    }
}
