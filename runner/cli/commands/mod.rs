//! One file or folder per command; its doc comment is the help text. A command uses no other command, except that
//! `browse` shows the report's page.

pub mod attach_truth;
pub mod browse;
pub mod claims;
pub mod collect;
pub mod compare;
pub mod compare_trajectory;
pub mod completions;
pub mod explain;
pub mod export;
pub mod features;
pub mod fsck;
pub mod generate;
pub mod generator;
pub mod import;
pub mod ingest;
pub mod init;
pub mod live;
pub mod ls;
pub mod man;
pub mod plan;
pub mod report;
pub mod reproduce;
pub mod run;
pub mod simulate;
pub mod site;
pub mod status;
pub mod worker;
