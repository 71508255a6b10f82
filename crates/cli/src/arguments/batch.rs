//! `limitmesh batch`, and the command that its processes run.

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;

use super::values::{self, Shard};

const EXAMPLES: &str = "\
A job is an object on a line of its own: its input, the file to write, and any option of `limitmesh
refine` by its name. A value is text or a number; true is an option without one; a list of
texts for an option that is given several times, a list of numbers for a point.

  {\"input\": \"scans/a.stl\", \"output\": \"smooth/a.ply\", \"tolerance\": \"0.1%\"}
  {\"input\": \"duck.glb\", \"output\": \"smooth/duck.glb\", \"triangles\": \"20k\", \"optimize\": true}
  {\"input\": \"part.stl\", \"output\": \"smooth/part.stl\", \"crease-angle\": 30, \"weld\": 1e-6}

A result is a line, too, with the number of the job's:

  {\"line\":1,\"key\":\"…\",\"input\":…,\"output\":…,\"status\":\"done\",\"output_bytes\":…,\"report\":{…}}
  {\"line\":2,…,\"status\":\"stopped-short\",\"why\":\"…\",\"output_bytes\":…,\"report\":{…}}
  {\"line\":3,…,\"status\":\"failed\",\"error\":{\"kind\":\"file\",\"message\":\"…\"}}

The report is that of `refine --report` without its times. Kinds of errors are line (it is no job,
or writes what another one writes or reads), options, file (the input or the output is at fault),
time and memory (with the limit that the job passed), and crash.

Examples:
  limitmesh batch jobs.jsonl -o results.jsonl
  limitmesh batch jobs.jsonl -o results.jsonl --resume --time-limit 600 --memory-limit 2G
  ls scans/*.stl | sed 's|.*/\\(.*\\).stl|{\"input\": \"&\", \"output\": \"smooth/\\1.ply\"}|' |
    limitmesh batch - -o results.jsonl
  limitmesh batch jobs.jsonl -o results-2.jsonl --shard 2/8
  cat results-*.jsonl | sort -t: -k2n > results.jsonl

Exit codes: 0 all jobs are done, 1 some failed, or the jobs cannot be read, 2 usage, 3 none failed
and some stopped short; 130, 143 and 129 where Ctrl-C, SIGTERM or SIGHUP cancelled it: --resume
goes on.";

/// Refine many meshes, each in a process of its own: a JSON line in, a JSON line out
///
/// Jobs that fail, take too long or crash are lines of the results like others, and nothing of them is left behind. Each
/// mesh is written whole or not at all. While it works, results stand in the order in which jobs end; in the end in that of the
/// jobs, the same bytes for any number of processes, and however often it was killed and resumed.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct BatchArguments {
    /// File of jobs, or - for standard input
    #[arg(value_name = "JOBS.jsonl")]
    pub(crate) jobs: PathBuf,

    /// File of results, or - for standard output
    #[arg(short, long, value_name = "RESULTS.jsonl")]
    pub(crate) output: PathBuf,

    /// Number of processes at once [default: as many as there are processors for --threads of each]
    ///
    /// Each has one thread unless --threads says otherwise.
    #[arg(long = "jobs", value_name = "N", value_parser = values::positive)]
    pub(crate) processes: Option<usize>,

    /// Keep the results that there are, and do what is missing
    ///
    /// A result is kept where input (by its content), output, options and the program's version are those of a job, and the
    /// output is there. Failures are tried again, but for those at a limit that is not higher now.
    #[arg(long)]
    pub(crate) resume: bool,

    /// Do a part of the jobs: shard I of N, counted from 0
    ///
    /// For array jobs: a machine for each I from 0 to N - 1, with a file of results of its own. I is AWS_BATCH_JOB_ARRAY_INDEX of AWS
    /// Batch, JOB_COMPLETION_INDEX of Kubernetes, or SLURM_ARRAY_TASK_ID of `sbatch --array=0-7` for 8. Each line of the jobs belongs to one
    /// shard, every Nth to the same; results keep the numbers of the lines.
    #[arg(long, value_name = "I/N")]
    pub(crate) shard: Option<Shard>,

    /// Seconds that a job may take; then it is ended
    #[arg(long, value_name = "SECONDS", value_parser = values::seconds)]
    pub(crate) time_limit: Option<Duration>,

    /// Memory that a job may take [such as 500MB; K, M, G and T are powers of 1024]; then it is ended
    ///
    /// The memory of its process is measured fifty times a second (Linux alone). For a result that ends in good order before
    /// that, give jobs a `max-memory` as well.
    #[arg(long, value_name = "BYTES", value_parser = values::memory, allow_hyphen_values = true)]
    pub(crate) memory_limit: Option<usize>,

    /// Keep the seconds of reports: then results are not the same bytes twice
    #[arg(long)]
    pub(crate) seconds: bool,
}

/// A job of `limitmesh batch`, for it alone: ends when standard input does
#[derive(Args, Debug)]
pub(crate) struct BatchJobArguments {
    /// The arguments after `limitmesh refine`
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    pub(crate) words: Vec<OsString>,
}
