//! Sample after sample, every executor in turn with the same work.
//!
//! The first round is not counted: it compiles shaders and fills caches. In every round all bytes are compared.

use super::benchmarks::{BenchSizes, Benchmark, HierarchyLearners, Measurement, UpdateRule};
use super::benchmarks::{decisions, robot_steps, transitions, whole_learners};
use super::embedded_configs::{HIERARCHY, ONE_POINT, THRESHOLDS};
use super::executor::{Executor, ExecutorInfo, ExecutorKind, ExecutorSet, open_executors};
use super::result::{BenchOrigin, BenchReport, FORMAT, RateRow, TaskReport};
use super::timing::{Spread, cores};
use super::{BenchError, compare};

/// Whole learners that a graphics card trains at a time, unless told otherwise.
const CARD_LEARNERS: u32 = 1024;
/// Times that an action is carried out where the host is to be out of the way.
const REPEATS: u32 = 8;

/// Measures everything, `samples` times each. `learners` are the whole learners to train on each executor, 0 for none; as
/// many as the CPU has cores, and a graphics card room, if not given. `note` is told what is being measured, `command` is
/// kept in the report.
///
/// # Errors
/// [`BenchError::Differs`] where two executors leave different bytes; else where one fails.
pub fn bench(
    executors: ExecutorSet,
    samples: u32,
    learners: Option<u32>,
    command: &str,
    note: &mut dyn FnMut(&str),
) -> Result<BenchReport, BenchError> {
    let origin = BenchOrigin::new(command);
    let (mut executors, mut left_out) = open_executors(executors)?;
    let has = |kind| executors.iter().any(|executor| executor.info.kind == kind);
    let (card, software) = (has(ExecutorKind::Gpu), has(ExecutorKind::SoftwareGpu));
    let sizes = if card { BenchSizes::CARD } else { BenchSizes::CPU };
    let on_cpu = learners.unwrap_or(cores() as u32);
    let on_card = learners.unwrap_or(if card { CARD_LEARNERS } else { 0 });
    let most = on_cpu.max(on_card);
    let hierarchy = HierarchyLearners::new(HIERARCHY, &[], sizes.learners.max(most))?;
    let lean = if most > 0 { Some(HierarchyLearners::new(THRESHOLDS, &ONE_POINT, most)?) } else { None };
    let mut benchmarks = vec![robot_steps(sizes, 1)?, robot_steps(sizes, REPEATS)?];
    for rule in UpdateRule::ALL {
        benchmarks.push(transitions(sizes, rule)?);
    }
    benchmarks.push(decisions(&hierarchy, sizes));
    if let Some(lean) = &lean {
        benchmarks.push(whole_learners("learners", &hierarchy, on_cpu, on_card));
        benchmarks.push(whole_learners("learners-lean", lean, on_cpu, on_card));
        if software {
            left_out.push("learners on software adapters: they would take too long".to_owned());
        }
    }
    let mut tasks = Vec::new();
    for benchmark in &benchmarks {
        note(&format!("{}: {}", benchmark.name, benchmark.about));
        tasks.push(measure(benchmark, &mut executors, samples)?);
    }
    Ok(BenchReport {
        format: FORMAT,
        origin,
        samples,
        executors: executors.into_iter().map(|executor| executor.info).collect(),
        left_out,
        tasks,
    })
}

/// Measures one kind of work.
///
/// # Errors
/// [`BenchError::Differs`] where two executors leave different bytes; else where one fails.
pub fn measure(benchmark: &Benchmark<'_>, executors: &mut [Executor], samples: u32) -> Result<TaskReport, BenchError> {
    let mut taken: Vec<Vec<Measurement>> = executors.iter().map(|_| Vec::new()).collect();
    for sample in 0..=samples {
        let mut first: Option<(String, Vec<u32>)> = None;
        for (executor, taken) in executors.iter_mut().zip(&mut taken) {
            let Some(mut found) = (benchmark.run)(executor, sample)? else { continue };
            let (name, words) = (&executor.info.name, std::mem::take(&mut found.words));
            match &first {
                None => first = Some((name.clone(), words)),
                Some((left, expected)) => compare(benchmark.name, (left, expected), (name, &words))?,
            }
            if sample > 0 {
                taken.push(found);
            }
        }
    }
    let infos: Vec<&ExecutorInfo> = executors.iter().map(|executor| &executor.info).collect();
    let reference = infos.iter().position(|info| info.kind == ExecutorKind::Reference).map(|number| &taken[number][..]);
    let rows = infos.iter().zip(&taken).filter_map(|(info, own)| row(info, own, reference)).collect();
    Ok(TaskReport { name: benchmark.name.to_owned(), about: benchmark.about.clone(), rows })
}

/// What the samples of an executor say, beside those of the reference if it did the same work.
fn row(info: &ExecutorInfo, samples: &[Measurement], reference: Option<&[Measurement]>) -> Option<RateRow> {
    let per_second = |sample: &Measurement| sample.units as f64 / sample.elapsed.wall;
    let per_cpu_second = |sample: &Measurement| sample.units as f64 / sample.elapsed.cpu;
    // A graphics card takes no CPU-seconds.
    let own = |sample| if info.kind == ExecutorKind::Gpu { per_second(sample) } else { per_cpu_second(sample) };
    let pairs = reference.filter(|_| info.kind != ExecutorKind::Reference).unwrap_or_default().iter().zip(samples);
    Some(RateRow {
        executor: info.name.clone(),
        units: samples.first()?.units,
        per_second: Spread::of(samples.iter().map(per_second))?,
        per_cpu_second: Spread::of(samples.iter().map(per_cpu_second))?,
        over_reference: Spread::of(pairs.map(|(reference, sample)| own(sample) / per_cpu_second(reference))),
    })
}
