//! True poses as people have them, beside the 12 frames of the baseline.

use super::case::{Case, read, read_or_refused, refused};

const BAG: &str = "00-baseline/a.bag";

pub const CASES: &[Case] = &[
    read(BAG, 12, 13.116).with("--ground-truth {cases}/51-tracks/good.tum"),
    read(BAG, 12, 13.116).with("--ground-truth {cases}/51-tracks/crlf.tum"),
    read(BAG, 12, 13.116).with("--ground-truth {cases}/51-tracks/hash-header.tum"),
    read(BAG, 12, 13.116).with("--ground-truth {cases}/51-tracks/trailing-space.tum"),
    read(BAG, 12, 13.116).with("--ground-truth {cases}/51-tracks/tabs.tum"),
    read(BAG, 12, 13.116).with("--ground-truth {cases}/51-tracks/exponent.tum"),
    read(BAG, 12, 13.116).with("--ground-truth {cases}/51-tracks/unnormalised.tum"),
    read_or_refused(BAG, 12, 13.116, &["line 1"]).with("--ground-truth {cases}/51-tracks/bom.tum"),
    read_or_refused(BAG, 12, 13.116, &["line 1"]).with("--ground-truth {cases}/51-tracks/header.tum"),
    read_or_refused(BAG, 12, 13.116, &["line 1"]).with("--ground-truth {cases}/51-tracks/comma.csv"),
    read_or_refused(BAG, 12, 13.116, &["line"]).with("--ground-truth {cases}/51-tracks/twice.tum"),
    read_or_refused(BAG, 12, 13.116, &["line 7"]).with("--ground-truth {cases}/51-tracks/duplicate-middle.tum"),
    read_or_refused(BAG, 12, 13.116, &["line 5"]).with("--ground-truth {cases}/51-tracks/nan-line.tum"),
    read_or_refused(BAG, 12, 13.116, &["wxyz-euroc.csv"]).with("--ground-truth {cases}/51-tracks/wxyz-euroc.csv"),
    refused(BAG, &["line 2", "sort"]).with("--ground-truth {cases}/51-tracks/unsorted.tum"),
    refused(BAG, &["0 of 12", "nanoseconds"]).with("--ground-truth {cases}/51-tracks/nanoseconds.tum"),
    refused(BAG, &["0 of 12", "from 0"]).with("--ground-truth {cases}/51-tracks/relative-stamps.tum"),
    refused(BAG, &["line 1"]).with("--ground-truth {cases}/51-tracks/kitti-short.txt"),
    refused(BAG, &["text"]).with("--ground-truth {cases}/51-tracks/utf16.tum"),
    refused(BAG, &["line 1"]).with("--ground-truth {cases}/51-tracks/zero-quaternion.tum"),
];
