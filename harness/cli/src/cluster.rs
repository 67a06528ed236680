//! `check` with several processes: who starts them, and how they find each other.

use std::net::{Ipv4Addr, TcpListener};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use stillpoint_engine::subject::Subject;
use stillpoint_model::{Cluster, digest};

use super::Failure;

/// How long a process tries to reach the one it joins.
const PATIENCE: Duration = Duration::from_secs(60);

#[derive(Args)]
pub struct ClusterOptions {
    /// Explore with this many processes, each with its share of the states
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024),
        conflicts_with_all = ["checkpoint", "resume", "reduce"])]
    processes: Option<u16>,
    /// Start no processes, but wait at this address until N-1 have joined (needs --processes)
    #[arg(long, value_name = "HOST:PORT", requires = "processes")]
    listen: Option<String>,
    /// Explore as one of the processes of the one that listens at this address
    #[arg(long, value_name = "HOST:PORT", conflicts_with_all = ["processes", "json", "checkpoint", "resume", "reduce"])]
    join: Option<String>,
}

/// The place of this process among those that explore together.
pub struct Place {
    pub cluster: Option<Arc<Cluster>>,
    /// Those that this process has started. They end when it does.
    _started: Started,
}

impl Place {
    /// Whether another process makes the report.
    pub fn is_helper(&self) -> bool {
        self.cluster.as_ref().is_some_and(|c| c.process() != 0)
    }
}

/// Processes that are killed when nobody needs them any more.
#[derive(Default)]
struct Started(Vec<Child>);

impl Drop for Started {
    fn drop(&mut self) {
        for child in &mut self.0 {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

impl ClusterOptions {
    /// Whether several processes are to explore.
    pub fn is_asked(&self) -> bool {
        self.processes.is_some() || self.join.is_some()
    }

    /// Meets the other processes, if any are wanted. `options` are those a started process needs besides the file.
    pub fn meet(
        &self,
        file: &Path,
        subject: &Subject,
        threads: usize,
        options: &[String],
    ) -> Result<Place, Failure> {
        // Everything that is explored, with its parameter values and readings.
        let systems: Vec<_> = subject.tasks.iter().map(|t| &t.bound).collect();
        let number = digest(format!("{systems:?}").as_bytes());
        let mut started = Started::default();
        let cluster =
            if let Some(address) = &self.join {
                let joined = Cluster::join(address, number, PATIENCE);
                Some(joined.map_err(|e| Failure::Other(format!("--join {address}: {e}")))?)
            } else if let Some(processes) = self.processes {
                let processes = usize::from(processes);
                let listener = match &self.listen {
                    Some(address) => TcpListener::bind(address)
                        .map_err(|e| Failure::Other(format!("--listen {address}: {e}")))?,
                    None => TcpListener::bind((Ipv4Addr::LOCALHOST, 0))
                        .map_err(|e| Failure::Other(format!("--processes {processes}: {e}")))?,
                };
                match (&self.listen, listener.local_addr()) {
                    (_, Err(e)) => return Err(Failure::Other(e.to_string())),
                    (Some(_), Ok(address)) => eprintln!(
                        "waiting at {address} for {} to join with --join",
                        processes - 1
                    ),
                    (None, Ok(address)) => {
                        for _ in 1..processes {
                            let child = start(file, &address.to_string(), options);
                            started.0.push(child.map_err(|e| {
                                Failure::Other(format!("cannot start a process: {e}"))
                            })?);
                        }
                    }
                }
                let threads = match threads {
                    0 => share_of_processors(if self.listen.is_some() { 1 } else { processes }),
                    given => given,
                };
                let mut alive = || ended(&mut started.0);
                let gathered = Cluster::gather(listener, processes, threads, number, &mut alive);
                let cluster = gathered
                    .map_err(|e| Failure::Other(format!("--processes {processes}: {e}")))?;
                if self.listen.is_some() {
                    eprintln!("all {processes} processes are there");
                }
                Some(cluster)
            } else {
                None
            };
        Ok(Place {
            cluster: cluster.map(Arc::new),
            _started: started,
        })
    }
}

/// Worker threads for each of the processes that share this machine.
fn share_of_processors(processes: usize) -> usize {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    (all / processes).max(1)
}

fn start(file: &Path, address: &str, options: &[String]) -> std::io::Result<Child> {
    Command::new(std::env::current_exe()?)
        .arg("check")
        .arg(file)
        .args(["--join", address])
        .args(options)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
}

/// Fails if a process that was started has ended already.
fn ended(started: &mut [Child]) -> Result<(), String> {
    for (number, child) in (1..).zip(started) {
        if let Ok(Some(status)) = child.try_wait() {
            return Err(format!(
                "process {number} has ended before it joined ({status})"
            ));
        }
    }
    Ok(())
}
