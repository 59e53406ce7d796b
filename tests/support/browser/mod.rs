//! A headless Chromium that opens pages as people do, and tells what they asked for and complained of.
//!
//! It is spoken to over its debugging pipe (`pipe`): JSON on two file descriptors, so there is no port to find, no
//! WebSocket and no generated protocol crate to compile. `page` is one tab.

mod page;
mod pipe;

pub use page::{Page, View};
use pipe::Pipe;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};

/// A running Chromium with a profile of its own; both go when this is dropped.
pub struct Browser {
    child: Child,
    pipe: Pipe,
    _profile: tempfile::TempDir,
}

impl Browser {
    /// Starts one; `None`, and a word why, where the machine has no Chromium.
    pub fn start() -> Option<Self> {
        let Some(program) = installed() else {
            eprintln!("SKIPPED: pages are not opened, this machine has no chromium, chromium-browser or google-chrome");
            return None;
        };
        let profile = tempfile::tempdir().unwrap();
        // The pipe is descriptors 3 (to Chromium) and 4 (from it): the shell moves them there.
        let mut child = Command::new("sh")
            .args(["-c", "exec \"$0\" \"$@\" 3<&0 4>&1 0</dev/null 1>/dev/null"])
            .arg(program)
            .args(["--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--disable-gpu"])
            .args(["--disable-dev-shm-usage", "--hide-scrollbars", "--force-color-profile=srgb", "--no-first-run"])
            .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg("about:blank")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let pipe = Pipe::new(child.stdin.take().unwrap(), child.stdout.take().unwrap());
        Some(Self { child, pipe, _profile: profile })
    }

    /// Opens a `file://` or loopback URL in a new tab, and waits until it is loaded.
    pub fn open(&mut self, url: &str, view: View) -> Page<'_> {
        Page::open(&mut self.pipe, url, view)
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn installed() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    let in_folders = |name: &str| folders.iter().map(|folder| folder.join(name)).find(|file| file.is_file());
    ["chromium", "chromium-browser", "google-chrome"].into_iter().find_map(in_folders)
}
