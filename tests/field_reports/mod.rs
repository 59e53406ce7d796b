//! Inputs that people reported to other tools, one table per subject: what is right is the true length of the drive
//! that the frames were taken from, or a refusal that names the cause. The generators are a set of its own, beside the
//! real recordings; this folder holds no expected value that furrow printed.

mod cameras;
mod case;
mod containers;
mod folders;
mod made;
mod pixels;
mod stamps;
mod topics;
mod tracks;

use case::Case;
use rayon::prelude::*;

#[test]
fn every_reported_input_gives_the_right_number_or_a_clear_no() {
    let Some(folder) = made::cases() else { return };
    let tables =
        [cameras::CASES, pixels::CASES, stamps::CASES, topics::CASES, containers::CASES, folders::CASES, tracks::CASES];
    let all: Vec<&Case> = tables.iter().flat_map(|table| table.iter()).collect();
    let faults: Vec<String> = all.par_iter().filter_map(|case| case.try_in(&folder).err()).collect();
    assert!(faults.is_empty(), "{} of {} cases:\n{}", faults.len(), all.len(), faults.join("\n"));
}
