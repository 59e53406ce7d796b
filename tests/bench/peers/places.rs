//! Place recognition: Chow-Liu tree, FAB-MAP 2.0 queries, vocabulary.

use crate::cpu_time::cpu_ns;
use crate::row::{Row, cpu_ms, row};
use crate::synthetic::{descriptors, images};
use furrow_runner::localiser::chow_liu;
use furrow_runner::localiser::fabmap::{Answer, FabMap, FabMapParams};
use furrow_runner::localiser::vocabulary::train_kmeans;

pub fn chow_liu_and_fabmap(rows: &mut Vec<Row>) {
    let trainings = [
        ("Chow-Liu tree, 2000 words x 500 images", 2000, 500, Some(53_000.0)),
        ("Chow-Liu tree, 6000 words x 2000 images", 6000, 2000, None),
        // Extrapolated in PEERS.md: about 5 hours.
        ("Chow-Liu tree, 6000 words x 18709 images", 6000, 18_709, Some(18_000_000.0)),
    ];
    for (name, words, count, peer) in trainings {
        let samples = images(count, words, 7);
        let time = cpu_ms(2, |_| chow_liu::train(&samples, words as usize, 0.0).map(|tree| tree.words()));
        rows.push(row(name, time, "ms", "openFABMAP", peer));
    }
    let samples = images(500, 6000, 11);
    let Ok(tree) = chow_liu::train(&samples, 6000, 0.0) else { return };
    let queries = images(64, 6000, 13);
    let maps = [
        ("FAB-MAP 2.0 query, 6000 words, 500 places", 500, Some(0.69)),
        ("FAB-MAP 2.0 query, 6000 words, 2000 places", 2000, Some(0.98)),
        ("FAB-MAP 2.0 query, 6000 words, 8000 places", 8000, Some(2.1)),
        ("FAB-MAP 2.0 query, 6000 words, 100000 places", 100_000, None),
    ];
    for (name, places, peer) in maps {
        let Ok(mut map) = FabMap::new(&tree, FabMapParams::OPENFABMAP, &samples) else { return };
        for place in images(places, 6000, 17) {
            if map.add_place(&place).is_err() {
                return;
            }
        }
        let mut answer = Answer::default();
        let time = cpu_ms(200, |i| map.query_into(&queries[i % queries.len()], &mut answer).is_ok());
        rows.push(row(name, time, "ms", "openFABMAP", peer));
    }
}

pub fn vocabulary(rows: &mut Vec<Row>) {
    let descriptors = descriptors(300_000);
    let before = cpu_ns();
    let Ok((_, record)) = train_kmeans(&descriptors, 6000, 1, &mut |_| ()) else { return };
    let seconds = (cpu_ns() - before) as f64 / 1e9;
    let name = "vocabulary (k-means), 300000 descriptors, 6000 words";
    rows.push(row(name, seconds, "s", "none at this size", None));
    rows.push(row("its quantisation error, root mean square", record.quantisation_error, "", "none known", None));
}
