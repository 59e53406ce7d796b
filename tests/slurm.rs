//! The second executor: a real Slurm, started here, gives the same answer as this machine alone. `kill_9` kills it.

use crate::support::matrix::Matrix;
use crate::support::recordings::{ingested, ran};
use crate::support::slurm::{Slurm, result};
use crate::support::store::{Store, replace};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

#[test]
fn a_cluster_gives_the_same_outcomes_as_one_machine() {
    let Some(slurm) = Slurm::start() else { return };
    // A generated experience, a collective, a calibrated threshold: a unit of every kind.
    let generated = "{ parent = \"10:00\", generator = \"gamma\", domainness = [0.5] }";
    let matrix = Matrix::small()
        .without_threshold()
        .axis("threshold", "[40, \"calibrated\"]")
        .axis("experience", &format!("[\"08:00\", \"10:00\", {generated}]"));
    let (fresh, alone, two) = (ingested(), ingested(), ingested());
    let expected = alone.json(format!("run {} -j 1", matrix.write(alone.path())));
    matrix.write(fresh.path());
    let database = |store: &Store| std::fs::metadata(store.file("catalogue.db")).unwrap().modified().unwrap();

    // Left at once: workers go on without the database, whose bytes nobody touches meanwhile.
    let left = slurm.run(&fresh, "--detach --array-limit 2 --partition field").json();
    assert_eq!((left["cells"].as_array().unwrap().len(), left["run"].clone()), (0, expected["run"].clone()));
    let touched = database(&fresh);
    let began = Instant::now();
    while !slurm.queue().is_empty() {
        assert!(began.elapsed() < Duration::from_secs(240), "{:?}", slurm.queue());
        std::thread::sleep(Duration::from_millis(200));
    }
    assert_eq!(database(&fresh), touched, "a worker wrote into the catalogue");

    // Come back to.
    let collected = fresh.furrow("collect latest").env("SLURM_CONF", slurm.conf()).json();
    let cells = expected["cells"].as_array().unwrap().len();
    assert_eq!((&collected["finished"], &collected["tasks_in_queue"]), (&json!(cells), &json!(0)));
    let again = slurm.run(&fresh, "").json();
    assert_eq!(result(&again), result(&expected));
    assert!(again["cells"].as_array().unwrap().iter().all(|cell| cell["cached"] == true));

    // The catalogue lists what a local run would have listed.
    assert_eq!(fresh.json("ls"), alone.json("ls"));
    assert_eq!(fresh.assert_intact()["rows"], alone.json("fsck")["rows"]);

    // And two threads of this machine say the same.
    let local = two.json(format!("run {} -j 2", matrix.write(two.path())));
    assert_eq!(result(&local), result(&expected));
}

#[test]
fn what_fails_on_the_cluster_is_told_with_its_logs_last_lines() {
    let Some(slurm) = Slurm::start() else { return };
    let (store, expected) = (ingested(), &ran().run);
    Matrix::small().write(store.path());
    // The images of the 10:00 experience are damaged: what hangs on them fails, the rest is computed.
    let image = store.first_image("10:00");
    let bytes = std::fs::read(&image).unwrap();
    replace(&image, "not this image any more");

    let run = slurm.run(&store, "--keep-going").json_with_code(3);
    let failed = run["failed"].as_array().unwrap();
    let of_08 = |cell: &&Value| cell["experience"] == "08:00";
    assert!(
        !failed.iter().any(|cell| of_08(&cell)) && failed.iter().any(|cell| cell["experience"] == "10:00"),
        "{failed:?}"
    );
    let reason = failed[0]["reason"].as_str().unwrap();
    let name = &image.file_name().unwrap().to_str().unwrap()[..12];
    assert!(reason.contains(name) && reason.contains("the end of the log of task"), "{reason}");
    let whole = |value: &Value| value["cells"].as_array().unwrap().iter().filter(of_08).count();
    assert_eq!(whole(&run), whole(expected));

    // Without --keep-going it is an error.
    slurm.run(&store, "").fails(1, &[]);

    // Mended, the same command computes what is left.
    replace(&image, bytes);
    assert_eq!(result(&slurm.run(&store, "").json()), result(expected));
}

#[test]
fn without_slurm_the_command_says_what_to_do() {
    let store = ingested();
    let matrix = Matrix::small().write(store.path());
    let run = store.furrow(format!("run {matrix} --executor slurm")).env("PATH", "/nowhere");
    run.fails(1, &["'squeue' is not on this machine", "--executor local"]);
}
