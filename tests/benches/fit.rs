//! The default fit by number of triangles, and again after one changed pressure:
//! `cargo bench -p wovenfit-tests --bench fit`.
//!
//! A machine's figures are compared with others of the same run: growth from size to size should be no
//! worse than n^1.3, and a second solve take a third of the first or less. `fit` is the fit's steps alone;
//! `pattern` is what a designer waits for: first from the scan to the pattern and its report, then from the
//! changed pressure to the next.

#![allow(missing_docs, reason = "criterion's macros make undocumented functions")]

use std::sync::Mutex;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use wovenfit_core::Prepared;
use wovenfit_core::design::Design;
use wovenfit_core::parameters::Parameters;
use wovenfit_core::progress::{Progress, Silent, Stage};
use wovenfit_core::samples::sample;

/// The time between the beginning of the fit and that of the next stage.
#[derive(Default)]
struct FitTime(Mutex<(Option<Instant>, Duration)>);

impl Progress for FitTime {
    fn report(&self, stage: Stage, _fraction: f64, _energy: Option<f64>) {
        let mut time = self.0.lock().expect("no thread panicked");
        match (stage, time.0) {
            (Stage::Fit, None) => time.0 = Some(Instant::now()),
            (Stage::Fit, Some(_)) | (_, None) => {}
            (_, Some(begun)) => *time = (None, time.1 + begun.elapsed()),
        }
    }
}

impl FitTime {
    fn total(&self) -> Duration {
        self.0.lock().expect("no thread panicked").1
    }
}

fn elbow(triangles: usize) -> (Prepared, Design) {
    let limb = sample("elbow", triangles, 0.0).expect("the elbow is a sample");
    let prepared =
        Prepared::new(&limb.mesh, &limb.design, &Parameters::default(), &FitTime::default())
            .expect("the elbow can be cut");
    (prepared, limb.design)
}

fn fit(criterion: &mut Criterion) {
    let parameters = Parameters::default();
    let mut group = criterion.benchmark_group("fit");
    group.sample_size(10);
    for triangles in [20_000, 60_000, 200_000] {
        let (prepared, design) = elbow(triangles);
        let solve = |design: &Design, earlier| {
            let time = FitTime::default();
            let done = prepared.solve(design, &parameters, earlier, &time).expect("it is solved");
            (done, time.total())
        };
        let (first, _) = solve(&design, None);
        let mut changed = design.clone();
        changed.pressures[1].kpa *= 1.2;
        group.bench_function(BenchmarkId::new("first", triangles), |bencher| {
            bencher.iter_custom(|count| (0..count).map(|_| solve(&design, None).1).sum());
        });
        group.bench_function(BenchmarkId::new("again", triangles), |bencher| {
            bencher.iter_custom(|count| (0..count).map(|_| solve(&changed, Some(&first)).1).sum());
        });
    }
    group.finish();
}

fn pattern(criterion: &mut Criterion) {
    let parameters = Parameters::default();
    let mut group = criterion.benchmark_group("pattern");
    group.sample_size(10);
    for triangles in [20_000, 60_000, 200_000] {
        let limb = sample("elbow", triangles, 0.0).expect("the elbow is a sample");
        let first = || {
            let prepared = Prepared::new(&limb.mesh, &limb.design, &parameters, &Silent)?;
            let done = prepared.solve(&limb.design, &parameters, None, &Silent)?;
            Ok::<_, wovenfit_core::Error>((prepared, done))
        };
        let (prepared, done) = first().expect("it is solved");
        let mut changed = limb.design.clone();
        changed.pressures[1].kpa *= 1.2;
        group.bench_function(BenchmarkId::new("first", triangles), |bencher| {
            bencher.iter(|| first().expect("it is solved"));
        });
        group.bench_function(BenchmarkId::new("again", triangles), |bencher| {
            bencher.iter(|| {
                prepared.solve(&changed, &parameters, Some(&done), &Silent).expect("it is solved")
            });
        });
    }
    group.finish();
}

criterion_group!(benches, fit, pattern);
criterion_main!(benches);
