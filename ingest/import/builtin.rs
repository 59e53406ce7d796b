//! Profiles by name: those that furrow brings, and files of users.

use super::check::check_profile;
use super::error::ImportError;
use super::profile::Profile;
use std::fs;
use std::path::Path;

/// The largest profile that is read.
const MOST_BYTES: usize = 1 << 20;

/// A profile that furrow brings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Builtin {
    /// What it is called.
    pub name: &'static str,
    /// The file.
    pub text: &'static str,
}

macro_rules! builtin {
    ($($name:literal),* $(,)?) => {
        &[$(Builtin { name: $name, text: include_str!(concat!("profiles/", $name, ".toml")) }),*]
    };
}

/// All of them. A new one: a file in `profiles/`, and its name here.
pub const BUILTIN: &[Builtin] = builtin![
    "botanicgarden",
    "citrusfarm",
    "euroc",
    "fieldsafe",
    "kitti-odometry",
    "kitti-raw",
    "mono",
    "newer-college",
    "robotcar",
    "rosario-v1",
    "rosario-v2",
    "rover",
    "tum-rgbd",
    "tum-vi",
    "vpr",
];

/// The profile of a built-in name, or of a file ending in `.toml`, with its text.
///
/// # Errors
/// A name that is not built in, with the nearest that is; a file that cannot be read or is no profile.
pub fn find_profile(name: &str) -> Result<(Profile, String), ImportError> {
    let text = if name.ends_with(".toml") {
        let path = Path::new(name);
        let bytes = fs::read(path).map_err(ImportError::unreadable(path))?;
        let text = String::from_utf8(bytes).ok().filter(|text| text.len() <= MOST_BYTES);
        text.ok_or_else(|| wrong(name, format!("expected a text of at most {MOST_BYTES} bytes in UTF-8")))?
    } else {
        builtin_named(name)?.text.to_owned()
    };
    Ok((parse_profile(name, &text)?, text))
}

/// The built-in profile of a name.
///
/// # Errors
/// Where there is none; with the nearest name.
pub fn builtin_named(name: &str) -> Result<&'static Builtin, ImportError> {
    BUILTIN.iter().find(|builtin| builtin.name == name).ok_or_else(|| {
        let known: Vec<&str> = BUILTIN.iter().map(|builtin| builtin.name).collect();
        let asked = name.to_lowercase();
        let nearness = |known: &&&str| (strsim::jaro_winkler(&asked, known) * 1e6) as u64;
        let near = known.iter().max_by_key(nearness).filter(|known| nearness(known) > 700_000);
        ImportError::Unknown {
            name: name.to_owned(),
            advice: near.map_or_else(String::new, |near| format!(": did you mean {near}?")),
            known: known.join(", "),
        }
    })
}

/// Reads a profile from its text.
///
/// # Errors
/// Keys that are not known or missing, and what no profile may ask.
pub fn parse_profile(name: &str, text: &str) -> Result<Profile, ImportError> {
    let profile: Profile =
        toml::from_str(text).map_err(|error| wrong(name, error.to_string().trim_end().to_owned()))?;
    check_profile(&profile).map_err(|fault| wrong(name, fault))?;
    Ok(profile)
}

fn wrong(name: &str, fault: String) -> ImportError {
    ImportError::Profile { name: name.to_owned(), fault }
}
