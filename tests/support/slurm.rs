//! A Slurm of one node, started for a test or a measurement and gone with it.

use super::command::Furrow;
use super::store::Store;
use serde_json::{Value, json};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// The daemons, in a folder of their own.
pub struct Slurm {
    folder: tempfile::TempDir,
    host: String,
    munged: Child,
    controller: Child,
    node: Option<Child>,
}

impl Slurm {
    /// Starts one; `None`, and a word why, where the machine has no Slurm.
    pub fn start() -> Option<Self> {
        let there = |program: &str| {
            ["/usr/sbin", "/usr/bin", "/sbin", "/usr/local/sbin"]
                .iter()
                .any(|bin| Path::new(bin).join(program).exists())
        };
        if let Some(missing) = ["slurmctld", "slurmd", "munged"].iter().find(|program| !there(program)) {
            eprintln!("SKIPPED: the cluster is not tested, this machine has no {missing}");
            return None;
        }
        let folder = tempfile::tempdir().unwrap();
        let host = stdout_of(Command::new("hostname").arg("-s")).trim().to_owned();
        let at = |name: &str| folder.path().join(name);
        for name in ["state", "spool"] {
            std::fs::create_dir(at(name)).unwrap();
        }
        std::fs::write(at("munge.key"), rand_bytes()).unwrap();
        let _ = Command::new("chmod").arg("400").arg(at("munge.key")).status();
        std::fs::write(at("slurm.conf"), configuration(folder.path(), &host)).unwrap();
        // The path of a socket has at most 107 characters: the folder's is short.
        let mut munged = Command::new("/usr/sbin/munged");
        munged.args(["--foreground", "--force"]);
        for (option, name) in [
            ("key-file", "munge.key"),
            ("socket", "munge.socket"),
            ("pid-file", "munged.pid"),
            ("log-file", "munged.log"),
            ("seed-file", "munge.seed"),
        ] {
            munged.arg(format!("--{option}={}", at(name).display()));
        }
        let munged = quiet(&mut munged);
        wait_for("munged", || at("munge.socket").exists());
        let controller = quiet(Command::new("/usr/sbin/slurmctld").args(["-D", "-c", "-f"]).arg(at("slurm.conf")));
        let mut slurm = Self { folder, host, munged, controller, node: None };
        slurm.start_node();
        wait_for("the node", || {
            stdout_of(slurm.command("sinfo").args(["--noheader", "--format=%T"])).starts_with("idle")
        });
        Some(slurm)
    }

    /// The cluster's configuration: what `SLURM_CONF` must name for every command that calls Slurm.
    pub fn conf(&self) -> PathBuf {
        self.folder.path().join("slurm.conf")
    }

    /// `furrow run` of the store's matrix on the cluster, with more options.
    pub fn run(&self, store: &Store, more: &str) -> Furrow {
        let matrix = store.file("matrix.toml");
        store.furrow(format!("run {matrix} --executor slurm {more}")).env("SLURM_CONF", self.conf())
    }

    /// One of Slurm's commands.
    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", self.conf());
        command
    }

    /// Jobs in the queue, one line for each task.
    pub fn queue(&self) -> Vec<String> {
        let text = stdout_of(self.command("squeue").args(["--noheader", "--array", "--format=%i %j %T"]));
        text.lines().map(str::to_owned).collect()
    }

    /// Starts the node's daemon.
    pub fn start_node(&mut self) {
        self.node = Some(quiet(Command::new("/usr/sbin/slurmd").args(["-D", "-N", &self.host, "-f"]).arg(self.conf())));
    }

    /// Kills the node's daemon with SIGKILL.
    pub fn kill_node(&mut self) {
        if let Some(mut node) = self.node.take() {
            let _ = node.kill();
            let _ = node.wait();
        }
    }
}

/// All that must not depend on where a run was computed: its id, and its cells with all their numbers and objects.
pub fn result(run: &Value) -> Value {
    let mut cells = run["cells"].clone();
    for cell in cells.as_array_mut().unwrap() {
        cell["cached"] = Value::Null;
    }
    json!([run["run"], cells, run["failed"], run["contrasts"]])
}

impl Drop for Slurm {
    fn drop(&mut self) {
        let _ = self.command("scancel").args(["--partition", "field"]).status();
        let gone = || self.queue().is_empty();
        let began = Instant::now();
        while !gone() && began.elapsed() < Duration::from_secs(10) {
            std::thread::sleep(Duration::from_millis(100));
        }
        self.kill_node();
        for daemon in [&mut self.controller, &mut self.munged] {
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

fn quiet(command: &mut Command) -> Child {
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

fn stdout_of(command: &mut Command) -> String {
    let output = command.output().unwrap();
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn wait_for(what: &str, ready: impl Fn() -> bool) {
    let began = Instant::now();
    while !ready() {
        assert!(began.elapsed() < Duration::from_secs(30), "{what} did not start within 30 s");
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// A key that no other cluster on this machine has.
fn rand_bytes() -> Vec<u8> {
    std::fs::File::open("/dev/urandom")
        .and_then(|mut random| {
            let mut bytes = vec![0; 128];
            std::io::Read::read_exact(&mut random, &mut bytes).map(|()| bytes)
        })
        .unwrap()
}

fn configuration(folder: &Path, host: &str) -> String {
    // Both are held until both are known, so that they differ.
    let listeners = [(); 2].map(|()| TcpListener::bind("127.0.0.1:0").unwrap());
    let [controller, node] = listeners.each_ref().map(|listener| listener.local_addr().unwrap().port());
    let (folder, user) = (folder.display(), stdout_of(Command::new("id").arg("-un")).trim().to_owned());
    format!(
        "ClusterName=furrow\nSlurmctldHost={host}(127.0.0.1)\nSlurmUser={user}\nSlurmdUser={user}\n\
         AuthType=auth/munge\nAuthInfo=socket={folder}/munge.socket\nSlurmctldPort={controller}\nSlurmdPort={node}\n\
         StateSaveLocation={folder}/state\nSlurmdSpoolDir={folder}/spool\nSlurmctldPidFile={folder}/slurmctld.pid\n\
         SlurmdPidFile={folder}/slurmd.pid\nSlurmctldLogFile={folder}/slurmctld.log\n\
         SlurmdLogFile={folder}/slurmd.log\n\
         ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nJobAcctGatherType=jobacct_gather/none\n\
         AccountingStorageType=accounting_storage/none\nJobCompType=jobcomp/none\nSelectType=select/cons_tres\n\
         SelectTypeParameters=CR_CPU\nMpiDefault=none\nReturnToService=2\nMinJobAge=60\n\
         SchedulerParameters=sched_interval=1,batch_sched_delay=0,sched_min_interval=0\n\
         NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\n\
         PartitionName=field Nodes={host} Default=YES MaxTime=INFINITE State=UP\n"
    )
}
