//! The nearest right name, for errors.

/// `: did you mean 'x'?` with the nearest of the names, or a list of them; empty where there are none.
pub fn nearest<'a>(wanted: &str, names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    let best = names.iter().max_by(|a, b| strsim::jaro_winkler(wanted, a).total_cmp(&strsim::jaro_winkler(wanted, b)));
    match best {
        Some(best) if strsim::jaro_winkler(wanted, best) > 0.75 => format!(": did you mean '{best}'?"),
        Some(_) => format!(": there are {}", names.join(", ")),
        None => String::new(),
    }
}
