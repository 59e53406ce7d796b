//! A generator that is a program of its own: one long-lived child, asked over JSON lines.
//!
//! To it: `{"id", "in", "out", "z", "dir", "seed"}`, a line per image; `in` is a PNG file, `out` the file that it shall
//! write. From it: `{"id", "ok", "ms", "err"}`. Its stderr is ours. What it writes is decoded and checked; a child that
//! takes too long is killed.

use super::translator::Translator;
use crate::RunError;
use crate::generation::images::lossless;
use furrow_catalog::images::decode_colour;
use furrow_generator::Seed;
use furrow_model::ColourImage;
use serde::{Deserialize, Serialize};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A program that paints.
pub(crate) struct CommandPainter {
    name: String,
    translator: Translator,
    direction: String,
    folder: PathBuf,
    /// Started for the first image; images go through one by one.
    running: Mutex<Option<Running>>,
}

struct Running {
    child: Child,
    stdin: ChildStdin,
    answers: Receiver<String>,
    asked: u64,
}

#[derive(Serialize)]
struct Question<'a> {
    id: u64,
    r#in: &'a Path,
    out: &'a Path,
    z: f64,
    dir: &'a str,
    seed: u64,
}

#[derive(Deserialize)]
struct Answer {
    id: u64,
    ok: bool,
    #[serde(default)]
    err: Option<String>,
}

impl CommandPainter {
    /// For images going `direction`; the files of the exchange lie in `folder`, which is made when needed.
    pub fn new(translator: &Translator, direction: &str, folder: PathBuf) -> Self {
        let (translator, direction) = (translator.clone(), direction.to_owned());
        Self { name: translator.name.clone(), translator, direction, folder, running: Mutex::default() }
    }

    /// One image through the program.
    pub fn paint(&self, image: &ColourImage, z: f64, seed: Seed) -> Result<ColourImage, RunError> {
        let wrong = |reason: String| RunError::generator(&self.name, reason);
        let mut running = self.running.lock().unwrap_or_else(PoisonError::into_inner);
        let mut exchange = match running.take() {
            Some(exchange) => exchange,
            None => self.start()?,
        };
        exchange.asked += 1;
        let file = |what: &str| self.folder.join(format!("{}-{}-{what}.png", std::process::id(), exchange.asked));
        let (input, output) = (file("in"), file("out"));
        let bytes = lossless(image).map_err(|error| wrong(error.to_string()))?;
        std::fs::write(&input, bytes).map_err(|error| wrong(format!("cannot write {}: {error}", input.display())))?;
        let question = Question {
            id: exchange.asked,
            r#in: &input,
            out: &output,
            z,
            dir: &self.direction,
            seed: seed.seed ^ seed.stamp_ns as u64,
        };
        let answered = exchange.ask(&question, Duration::from_secs_f64(self.translator.timeout_s)).map_err(wrong);
        let painted = answered.and_then(|()| {
            let bytes = std::fs::read(&output)
                .map_err(|error| wrong(format!("it said ok but wrote no {}: {error}", output.display())))?;
            decode_colour(&bytes, None).map_err(|error| wrong(format!("what it wrote is no image: {error}")))
        });
        for file in [input, output] {
            // Left behind, it is cleared away by the next ingest.
            let _ = std::fs::remove_file(file);
        }
        match &painted {
            Ok(_) => *running = Some(exchange),
            // After a failure, what the child would say next cannot be trusted.
            Err(_) => exchange.end(),
        }
        painted
    }

    fn start(&self) -> Result<Running, RunError> {
        let wrong = |reason: String| RunError::generator(&self.name, reason);
        std::fs::create_dir_all(&self.folder)
            .map_err(|error| wrong(format!("cannot make {}: {error}", self.folder.display())))?;
        let [program, arguments @ ..] = self.translator.command.as_slice() else {
            return Err(wrong("it has no command".to_owned()));
        };
        let spawned = Command::new(program)
            .args(arguments)
            .current_dir(&self.translator.folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn();
        let mut child = spawned.map_err(|error| {
            wrong(format!(
                "cannot start '{program}' in {}: {error}; is it installed?",
                self.translator.folder.display()
            ))
        })?;
        let (Some(stdin), Some(stdout)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(wrong("it cannot be spoken to".to_owned()));
        };
        let (sender, answers) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    return;
                }
            }
        });
        Ok(Running { child, stdin, answers, asked: 0 })
    }
}

impl Running {
    /// Asks and waits for the answer to this question; others' are passed over.
    fn ask(&mut self, question: &Question<'_>, limit: Duration) -> Result<(), String> {
        // A question is numbers and paths: writing it to memory fails only where a path is not Unicode.
        let line = serde_json::to_string(question).map_err(|error| error.to_string())?;
        let died = |error: std::io::Error| format!("it has ended: {error}; its own words are above");
        writeln!(self.stdin, "{line}").and_then(|()| self.stdin.flush()).map_err(died)?;
        let until = Instant::now() + limit;
        loop {
            let line = match self.answers.recv_timeout(until.saturating_duration_since(Instant::now())) {
                Ok(line) => line,
                Err(RecvTimeoutError::Timeout) => {
                    return Err(format!("it took longer than {} s for an image and was ended", limit.as_secs_f64()));
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err("it ended without an answer; its own words are above".to_owned());
                }
            };
            let answer: Answer = serde_json::from_str(&line).map_err(|error| {
                format!("it answered '{line}': {error}; expected {{\"id\", \"ok\", \"ms\", \"err\"}}")
            })?;
            if answer.id == question.id {
                return if answer.ok {
                    Ok(())
                } else {
                    Err(answer.err.unwrap_or_else(|| "it failed without a reason".to_owned()))
                };
            }
        }
    }

    fn end(mut self) {
        // A child that is gone already cannot be killed again.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for CommandPainter {
    fn drop(&mut self) {
        if let Some(exchange) = self.running.get_mut().unwrap_or_else(PoisonError::into_inner).take() {
            exchange.end();
        }
        // Only an empty folder goes.
        let _ = std::fs::remove_dir(&self.folder);
    }
}
