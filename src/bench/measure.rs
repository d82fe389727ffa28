//! Sample after sample, everything in turn: a control loop, the limits, then every executor with the same work.
//!
//! The first round is not counted: it compiles shaders and fills caches. In every round all bytes are compared.

use super::clock::{Spread, free_cores};
use super::cost::Cost;
use super::executor::{Executor, Kind};
use super::limits::{Limit, Meter};
use super::result::{LimitRate, Row, Share, TaskReport};
use super::tasks::{Done, Task};
use super::{BenchError, same};

/// Share of the cores that must be free for a figure on all of them.
const FREE: f64 = 0.9;

/// Everything that was measured of some kinds of work.
#[derive(Debug)]
pub struct Measured {
    /// Free cores, of each sample.
    pub free_cores: Vec<f64>,
    /// Rates of the limits, of each sample.
    pub limits: Vec<[f64; Limit::ALL.len()]>,
    /// The kinds of work.
    pub tasks: Vec<TaskReport>,
}

/// One sample of one executor.
struct Sample {
    units: u64,
    per_second: f64,
    per_cpu_second: f64,
    free: bool,
    limits: [f64; Limit::ALL.len()],
}

impl Measured {
    /// Nothing yet.
    pub fn new() -> Self {
        Self { free_cores: Vec::new(), limits: Vec::new(), tasks: Vec::new() }
    }

    /// The limits over all samples.
    pub fn limit_rates(&self) -> Vec<LimitRate> {
        let rate = |limit: Limit| Spread::of(self.limits.iter().map(|rates| rates[limit as usize]));
        Limit::ALL.into_iter().filter_map(|limit| Some(LimitRate { limit, rate: rate(limit)? })).collect()
    }

    /// Measures one kind of work.
    ///
    /// # Errors
    /// [`BenchError::Differs`] where two executors leave different bytes; else where one fails.
    pub fn add(
        &mut self,
        task: &dyn Task,
        executors: &mut [Executor],
        meter: &mut Meter,
        samples: u32,
    ) -> Result<(), BenchError> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let mut taken: Vec<Vec<Sample>> = executors.iter().map(|_| Vec::new()).collect();
        for number in 0..=samples {
            let free = if cores > 1 { free_cores(cores) } else { 1.0 };
            let mut limits = [0.0; Limit::ALL.len()];
            for limit in Limit::ALL {
                limits[limit as usize] = meter.rate(limit)?;
            }
            let done = round(task, executors, number)?;
            if number == 0 {
                continue;
            }
            self.free_cores.push(free.min(cores as f64));
            self.limits.push(limits);
            for (taken, done) in taken.iter_mut().zip(done) {
                taken.extend(done.map(|done| Sample {
                    units: done.units,
                    per_second: done.units as f64 / done.span.wall,
                    per_cpu_second: done.units as f64 / done.span.cpu,
                    free: free >= FREE * cores as f64,
                    limits,
                }));
            }
        }
        let cost = task.cost();
        let rows =
            executors.iter().enumerate().filter_map(|(number, _)| row(number, executors, &taken, cost)).collect();
        let (name, about) = (task.name().to_owned(), task.about());
        self.tasks.push(TaskReport { name, about, cost: cost.map(|(cost, ..)| cost), rows });
        Ok(())
    }
}

impl Default for Measured {
    fn default() -> Self {
        Self::new()
    }
}

/// Every executor does the work of one sample, and all bytes are compared with those of the first.
fn round(task: &dyn Task, executors: &mut [Executor], sample: u32) -> Result<Vec<Option<Done>>, BenchError> {
    let mut done: Vec<Option<Done>> = Vec::new();
    for executor in executors.iter_mut() {
        done.push(task.run(executor, sample)?);
    }
    let mut found = executors.iter().zip(&done).filter_map(|(executor, done)| Some((executor, done.as_ref()?)));
    if let Some((first, expected)) = found.next() {
        for (executor, done) in found {
            let left = (first.about.name.as_str(), &expected.words[..]);
            same(task.name(), left, (executor.about.name.as_str(), &done.words))?;
        }
    }
    Ok(done)
}

fn row(
    number: usize,
    executors: &[Executor],
    taken: &[Vec<Sample>],
    cost: Option<(Cost, Limit, Option<Limit>)>,
) -> Option<Row> {
    let (own, samples) = (&executors[number].about, &taken[number]);
    let of = |kind: Kind, threads: usize| {
        let found = executors.iter().position(|other| other.about.kind == kind && other.about.threads == threads)?;
        (found != number && taken[found].len() == samples.len()).then(|| &taken[found])
    };
    // A graphics card takes no CPU-seconds.
    let rate = |sample: &Sample| if own.kind == Kind::Gpu { sample.per_second } else { sample.per_cpu_second };
    let over_scalar = of(Kind::Scalar, 1)
        .and_then(|scalar| Spread::of(samples.iter().zip(scalar).map(|(own, scalar)| rate(own) / rate(scalar))));
    let over_one_thread = of(Kind::Cpu, 1).filter(|_| own.kind == Kind::Cpu).and_then(|one| {
        let free = samples.iter().zip(one).filter(|(own, _)| own.free);
        Spread::of(free.map(|(own, one)| own.per_second / one.per_second))
    });
    let share = |limit: Limit, amount: f64| {
        let shares = samples.iter().map(|own| own.per_cpu_second * amount / own.limits[limit as usize]);
        Some(Share { limit, share: Spread::of(shares)? })
    };
    let mut shares = Vec::new();
    if let (Some((cost, arithmetic, traffic)), Kind::Scalar | Kind::Cpu) = (cost, own.kind) {
        shares.extend(share(arithmetic, cost.lane_operations));
        shares.extend(traffic.and_then(|traffic| share(traffic, cost.bytes)));
    }
    Some(Row {
        executor: own.name.clone(),
        units: samples.first()?.units,
        per_second: Spread::of(samples.iter().map(|own| own.per_second))?,
        per_cpu_second: Spread::of(samples.iter().map(|own| own.per_cpu_second))?,
        over_scalar,
        over_one_thread,
        shares,
    })
}
