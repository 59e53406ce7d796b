use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::options::{CellFilter, MatrixFile, Threads};
use crate::output::print;
use crate::progress::with_bar;
use crate::views::cells::{CellView, CellWithout, find_origins};
use crate::views::contrasts::{found_json, found_text};
use crate::views::listing::Listing;
use furrow_catalog::Catalog;
use furrow_model::RunId;
use furrow_runner::slurm::{Following, Queue, run_on_slurm};
use furrow_runner::{Conduct, Study, StudyResult, run};
use serde_json::json;

/// Run a matrix: compute every cell that is not finished. Killed at any moment, the same command continues.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow run matrix.toml\n  \
furrow run matrix.toml --keep-going         # a failure stops only the cells that need what failed\n  \
furrow run matrix.toml --failed             # only the cells that failed last time\n  \
furrow run matrix.toml --only 'live=08:00,experience=10:00*' -j 2\n  \
furrow run matrix.toml --executor slurm --partition long --time 2:00:00 --array-limit 64")]
pub struct RunMatrix {
    #[command(flatten)]
    matrix: MatrixFile,
    #[command(flatten)]
    threads: Threads,
    /// Memory that the verification of live traversals may use, as in 4GB. Results do not depend on it.
    /// [default: half of the machine's; tasks of a cluster always take half of their node's]
    #[arg(long, value_name = "SIZE", value_parser = furrow_runner::stages::memory::parse_size)]
    memory: Option<u64>,
    /// Continue after a cell has failed; exit with 3 at the end.
    #[arg(long)]
    keep_going: bool,
    /// Only the cells that failed the last time they were run.
    #[arg(long)]
    failed: bool,
    #[command(flatten)]
    filter: CellFilter,
    /// Where cells are computed: on this machine, or as job arrays of a Slurm cluster that sees the store.
    #[arg(long, value_enum, default_value_t, value_name = "WHERE")]
    executor: Executor,
    #[command(flatten)]
    slurm: SlurmOptions,
}

/// Where cells are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
enum Executor {
    /// On this machine.
    #[default]
    Local,
    /// As job arrays of a Slurm cluster.
    Slurm,
}

/// How jobs are submitted to Slurm.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "With --executor slurm")]
struct SlurmOptions {
    /// The partition.
    #[arg(long, value_name = "NAME")]
    partition: Option<String>,
    /// The longest time for a task, as Slurm writes it. A task that exceeds it is submitted again.
    #[arg(long, value_name = "TIME")]
    time: Option<String>,
    /// At most N tasks of a stage run at once.
    #[arg(long, value_name = "N")]
    array_limit: Option<u32>,
    /// A further option of sbatch, as in `--sbatch=--account=robots`. May be given several times.
    #[arg(long, value_name = "OPTION", allow_hyphen_values = true)]
    sbatch: Vec<String>,
    /// Exit once the jobs are submitted. `furrow collect` or the same command takes in their results later.
    #[arg(long)]
    detach: bool,
}

impl SlurmOptions {
    /// How to submit; every task has so many threads.
    fn queue(&self, threads: Option<usize>) -> Queue {
        Queue {
            partition: self.partition.clone(),
            time: self.time.clone(),
            array_limit: self.array_limit,
            threads,
            more: self.sbatch.clone(),
        }
    }

    /// What to do after submitting.
    fn following(&self) -> Following {
        if self.detach { Following::Leave } else { Following::Wait }
    }

    /// What to say of cells that are not finished.
    fn unfinished_text(&self, cells: usize, run: RunId) -> String {
        match self.detach {
            true => format!(
                "{cells} cells are not finished: `furrow status` shows their tasks, `furrow collect {}` takes in those that are done",
                run.short()
            ),
            false => format!("{cells} cells were not asked for and are not finished"),
        }
    }
}

impl RunMatrix {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        if self.executor == Executor::Local {
            self.threads.apply()?;
        }
        let catalog = context.catalog()?;
        let mut study = self.matrix.read(&catalog)?;
        self.filter.apply(&mut study)?;
        if self.failed && study.only_failed(&catalog)? == 0 {
            eprintln!("no cell of this matrix failed the last time it was run");
        }
        let result = self.compute(&catalog, &study)?;
        for doubt in &result.doubts {
            eprintln!("warning: {doubt}");
        }
        self.print(context, &catalog, &study, &result)?;
        let blocked = study.parts.iter().any(|part| !part.blocked.is_empty());
        Ok(Ending::with_faults_if(blocked || !result.failed.is_empty()))
    }

    fn compute(&self, catalog: &Catalog, study: &Study) -> Result<StudyResult, Failure> {
        let conduct = Conduct { keep_going: self.keep_going, memory: self.memory };
        let result = with_bar(|progress| match self.executor {
            Executor::Local => run(catalog, study, conduct, progress),
            Executor::Slurm => {
                let how = (&self.slurm.queue(self.threads.count()), conduct, self.slurm.following());
                run_on_slurm(catalog, study, &self.matrix.matrix, how, progress)
            }
        });
        Ok(result?)
    }

    fn print(&self, context: &Context, catalog: &Catalog, study: &Study, result: &StudyResult) -> Result<(), Failure> {
        let origins = find_origins(catalog, result.run)?;
        let cells = result.cells.iter().map(|(setting, cell)| {
            let view = CellView::of(&cell.outcome, cell.cached).with_setting(setting);
            if cell.cached { view.with_origin(&origins) } else { view }
        });
        let cells: Vec<CellView> = cells.collect();
        let failed: Vec<CellWithout<'_>> = (result.failed.iter())
            .map(|failed| CellWithout {
                live: failed.cell.live,
                experience: &failed.cell.experience,
                setting: &failed.setting,
                reason: &failed.cell.reason,
            })
            .collect();
        let more = vec![
            ("failed", json!(failed)),
            ("left", json!(result.left)),
            ("work", json!(result.work)),
            ("contrasts", found_json(&result.contrasts)),
        ];
        Listing { run: result.run, study, cells: &cells, failed: &failed }.print(context, more)?;
        if !context.json {
            print(&found_text(&result.contrasts))?;
            if result.left > 0 {
                eprintln!("{}", self.slurm.unfinished_text(result.left, result.run));
            }
        }
        Ok(())
    }
}
