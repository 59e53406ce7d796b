//! What is missing, packed, cut or in another form; and names of files.

use super::case::{Case, read, refused};

pub const CASES: &[Case] = &[
    read("31-no-metadata/run_db3", 12, 13.116),
    read("31-no-metadata/run_mcap", 12, 13.116),
    read("32-file-compression/packed_db3", 12, 13.116),
    read("32-file-compression/packed_mcap", 12, 13.116),
    read("32-file-compression/expanded_db3", 12, 13.116),
    read("32-file-compression/expanded_mcap", 12, 13.116),
    read("33-message-compression/db3", 12, 13.116),
    read("33-message-compression/mcap", 12, 13.116),
    read("34-mcap-forms/plain.mcap", 12, 13.116),
    read("34-mcap-forms/no-chunks.mcap", 12, 13.116),
    read("34-mcap-forms/no-index-no-stats.mcap", 12, 13.116),
    read("34-mcap-forms/tiny-chunks.mcap", 12, 13.116),
    read("34-mcap-forms/zstd.mcap", 12, 13.116),
    read("34-mcap-forms/lz4.mcap", 12, 13.116),
    read("34-mcap-forms/zstd-no-size.mcap", 12, 13.116),
    refused("34-mcap-forms/unknown-compression.mcap", &["br1", "not read: compression"]),
    refused("34-mcap-forms/truncated-tail.mcap", &["mcap recover"]),
    refused("35-bag-active/drive_2024.bag.active", &["rosbag reindex"]),
    read("37-no-definition/a.bag", 12, 13.116),
    read("00-baseline/b/metadata.yaml", 12, 13.116),
    read("00-baseline/c/metadata.yaml", 12, 13.116),
    read("36-split/ros2_split/metadata.yaml", 24, 27.451),
    read("55-paths/link.bag", 12, 13.116),
    refused("55-paths/dangling.bag", &["dangling.bag"]),
    refused("55-paths/loop.bag", &["loop.bag", "links"]),
    read("55-paths/Row 7 (morning) ünï.BAG", 12, 13.116),
];
