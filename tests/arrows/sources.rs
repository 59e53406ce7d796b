//! Which file of a crate uses which, read from its sources: every path that begins with `crate`, `self` or `super`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A crate's files by module path, such as `["plan", "draft"]`; the root is empty.
pub struct Sources {
    files: BTreeMap<Vec<String>, Source>,
}

struct Source {
    /// Below the crate's folder.
    file: String,
    /// The code without comments, strings and test modules.
    code: String,
    /// What it passes on: name to path.
    exports: BTreeMap<String, Vec<String>>,
}

impl Sources {
    /// Reads the crate below `folder`, without the folders in `beside`, which are crates or commands of their own.
    pub fn read(folder: &Path, beside: &[&str]) -> Self {
        let mut files = BTreeMap::new();
        for path in rust_files(folder, beside) {
            let file = path.strip_prefix(folder).expect("a file below the crate").to_string_lossy().into_owned();
            let text = std::fs::read_to_string(&path).expect("a source file");
            files.insert(module_of(&file), Source { file, code: plain_code(&text), exports: BTreeMap::new() });
        }
        let modules: Vec<Vec<String>> = files.keys().cloned().collect();
        for module in modules {
            let exports = exports(&files[&module].code, &module);
            files.get_mut(&module).expect("a module").exports = exports;
        }
        Self { files }
    }

    /// For each file the files whose items it names. A parent that declares or passes on its children does not use them
    /// by that.
    pub fn arrows(&self) -> BTreeMap<String, BTreeSet<String>> {
        let used = |(module, source): (&Vec<String>, &Source)| {
            let named = paths(&uses(&source.code, false), module).into_iter().map(|(_, path)| path);
            let inline = inline_paths(&source.code).into_iter().filter_map(|path| absolute(&path, module));
            let files = named.chain(inline).filter_map(|path| self.home(&path, 0));
            (source.file.clone(), files.filter(|file| *file != source.file).collect())
        };
        self.files.iter().map(used).collect()
    }

    /// The file in which what `path` names is defined.
    fn home(&self, path: &[String], depth: usize) -> Option<String> {
        let known = (0..=path.len()).rev().find(|end| self.files.contains_key(&path[..*end]))?;
        let source = &self.files[&path[..known]];
        match path.get(known).and_then(|name| source.exports.get(name)) {
            Some(passed_on) if depth < 8 => {
                let further: Vec<String> = passed_on.iter().chain(&path[known + 1..]).cloned().collect();
                self.home(&further, depth + 1)
            }
            _ => Some(source.file.clone()),
        }
    }
}

/// Groups of two and more files that use each other in a circle.
pub fn circles(arrows: &BTreeMap<String, BTreeSet<String>>) -> Vec<Vec<String>> {
    let reach: BTreeMap<&String, BTreeSet<&String>> = arrows.keys().map(|file| (file, reached(file, arrows))).collect();
    let mut groups: BTreeSet<Vec<String>> = BTreeSet::new();
    for (file, there) in &reach {
        let back = there.iter().filter(|other| reach.get(**other).is_some_and(|from| from.contains(*file)));
        let mut group: Vec<String> = back.map(|other| (*other).clone()).collect();
        if !group.is_empty() {
            group.push((*file).clone());
            group.sort();
            group.dedup();
            groups.insert(group);
        }
    }
    groups.into_iter().filter(|group| group.len() > 1).collect()
}

fn reached<'a>(file: &str, arrows: &'a BTreeMap<String, BTreeSet<String>>) -> BTreeSet<&'a String> {
    let (mut found, mut todo) = (BTreeSet::new(), vec![file]);
    while let Some(from) = todo.pop() {
        for next in arrows.get(from).into_iter().flatten() {
            if found.insert(next) {
                todo.push(next);
            }
        }
    }
    found
}

fn rust_files(folder: &Path, beside: &[&str]) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        let name = entry.file_name().unwrap_or_default().to_string_lossy().into_owned();
        // Tests of a crate stand outside of it.
        if entry.is_dir() && name != "tests" && name != "examples" && !beside.contains(&name.as_str()) {
            files.extend(rust_files(&entry, &[]));
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            files.push(entry);
        }
    }
    files
}

fn module_of(file: &str) -> Vec<String> {
    let mut path: Vec<String> = file.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
    if path.last().is_some_and(|last| last == "mod") || file == "lib.rs" || file == "main.rs" {
        path.pop();
    }
    path
}

/// Code without comments and strings, up to the module of its tests.
fn plain_code(text: &str) -> String {
    let lines = text.lines().take_while(|line| *line != "#[cfg(test)]");
    let mut code = String::new();
    for line in lines {
        let mut quoted = false;
        let mut before = ' ';
        for (i, c) in line.char_indices() {
            match c {
                '"' if before != '\\' && before != '\'' => quoted = !quoted,
                '/' if !quoted && line[i..].starts_with("//") => break,
                c if !quoted => code.push(c),
                _ => {}
            }
            before = c;
        }
        code.push('\n');
    }
    code
}

/// What follows `use` in every import, `pub` ones where asked for, others where not.
fn uses(code: &str, public: bool) -> Vec<String> {
    let mut found = Vec::new();
    for statement in code.split(';') {
        let Some(at) =
            statement.rfind("use ").filter(|at| !statement[..*at].ends_with(|c: char| c.is_alphanumeric() || c == '_'))
        else {
            continue;
        };
        let line = statement[..at].rsplit(['\n', '{', '}']).next().unwrap_or_default();
        if line.contains("pub") == public && !statement[at..].contains("impl ") {
            found.push(statement[at + 4..].split_whitespace().collect::<Vec<_>>().join(" "));
        }
    }
    found
}

/// The single paths of imports, each with the name it brings, from the crate's root.
fn paths(uses: &[String], module: &[String]) -> Vec<(String, Vec<String>)> {
    let single = uses.iter().flat_map(|tree| spread(tree));
    single
        .filter_map(|path| {
            let (path, name) = path.split_once(" as ").map_or((path.as_str(), None), |(path, name)| (path, Some(name)));
            let segments: Vec<String> = path.split("::").map(|part| part.trim().to_owned()).collect();
            let name = name.map_or_else(|| segments.last().cloned(), |name| Some(name.trim().to_owned()))?;
            Some((name, absolute(&segments, module)?))
        })
        .collect()
}

/// `a::{b, c::{d, e}}` as `a::b`, `a::c::d`, `a::c::e`.
fn spread(tree: &str) -> Vec<String> {
    let Some(open) = tree.find('{') else { return vec![tree.trim().to_owned()] };
    let (head, body) = (tree[..open].trim(), tree[open + 1..tree.rfind('}').unwrap_or(tree.len())].trim());
    let (mut parts, mut depth, mut part) = (Vec::new(), 0, String::new());
    for c in body.chars() {
        match c {
            ',' if depth == 0 => parts.push(std::mem::take(&mut part)),
            c => {
                depth += i32::from(c == '{') - i32::from(c == '}');
                part.push(c);
            }
        }
    }
    parts.push(part);
    let whole = |part: &String| spread(part).into_iter().map(|inner| format!("{head}{inner}")).collect::<Vec<_>>();
    parts.iter().filter(|part| !part.trim().is_empty()).flat_map(whole).collect()
}

/// Paths in the code itself: `crate::a::b`.
fn inline_paths(code: &str) -> Vec<Vec<String>> {
    let words = code.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':'));
    let begins = |word: &&str| ["crate::", "super::", "self::"].iter().any(|head| word.starts_with(head));
    words.filter(begins).map(|word| word.trim_end_matches(':').split("::").map(str::to_owned).collect()).collect()
}

fn exports(code: &str, module: &[String]) -> BTreeMap<String, Vec<String>> {
    paths(&uses(code, true), module).into_iter().collect()
}

/// A path from the crate's root; `None` where it leads into another crate. A bare first name is a child of the module.
fn absolute(path: &[String], module: &[String]) -> Option<Vec<String>> {
    let mut from: Vec<String> = module.to_vec();
    let mut rest = path;
    match path.first()?.as_str() {
        "crate" => (from, rest) = (Vec::new(), &path[1..]),
        "self" => rest = &path[1..],
        "super" => {}
        first if first.starts_with(|c: char| c.is_lowercase()) => {}
        _ => return None,
    }
    while rest.first().is_some_and(|first| first == "super") {
        from.pop()?;
        rest = &rest[1..];
    }
    from.extend(rest.iter().filter(|part| part.as_str() != "*").cloned());
    Some(from)
}
