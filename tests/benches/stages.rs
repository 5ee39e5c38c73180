//! What each stage costs on the elbow sample: `cargo bench -p wovenfit-tests`.
//!
//! A diffusion step should cost the same per node at any number of nodes; every stage is measured at
//! 20,000 triangles. Machines differ and are noisy: compare figures of one run.

#![allow(missing_docs, reason = "criterion's macros make undocumented functions")]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::{DVec2, DVec3};
use wovenfit_core::Flattening;
use wovenfit_core::design::{Design, Limits, RegionPlane};
use wovenfit_core::export::{flat_obj, pattern_svg, raw_obj, worn_obj};
use wovenfit_core::field::{FieldInput, Relief, everywhere};
use wovenfit_core::fit::diffusion::{step, step_length};
use wovenfit_core::geometry::{Curvature, Locator, measure, noise};
use wovenfit_core::mapping::Mapping;
use wovenfit_core::page::{PageInput, report_html};
use wovenfit_core::parameterize::initial;
use wovenfit_core::parameters::Parameters;
use wovenfit_core::pattern::{free_edges, pattern};
use wovenfit_core::progress::Silent;
use wovenfit_core::samples::sample;
use wovenfit_core::seams::{CutSurface, Markers, clip, open_to_disk, place};
use wovenfit_core::sheet::SheetUnit;
use wovenfit_core::sparse::Matrix;
use wovenfit_core::surface::{Format, RawMesh, Surface, SurfaceOptions, read, validate};
use wovenfit_core::units::LengthUnit;
use wovenfit_core::weave::{RestLengths, WovenModel, lay};

const TRIANGLES: usize = 20_000;

struct Elbow {
    mesh: RawMesh,
    design: Design,
    options: SurfaceOptions,
    surface: Surface,
    cut: CutSurface,
    markers: Markers,
    omega: Vec<DVec2>,
}

fn elbow() -> Elbow {
    let sample = sample("elbow", TRIANGLES, 0.0).expect("the elbow exists");
    let options = SurfaceOptions {
        unit: LengthUnit::Millimetre,
        keep_largest: false,
        close_holes: 30.0,
        facing: None,
    };
    let surface = validate(&sample.mesh, &options).expect("the elbow is sound").surface;
    let cut = open_to_disk(&surface, &[]).expect("the elbow is a tube");
    let (markers, _) = place(&cut, sample.design.orientation).expect("its markers are on it");
    let matrix = Matrix::new(&cut.disk, &[]).expect("it fits");
    let omega = initial(&cut.disk, &matrix, &markers.points, &Silent)
        .expect("it can be laid flat")
        .coordinates;
    Elbow { mesh: sample.mesh, design: sample.design, options, surface, cut, markers, omega }
}

/// A woven model of about `nodes` nodes.
fn woven(elbow: &Elbow, nodes: usize) -> WovenModel {
    let spacing = (elbow.surface.total_area() / nodes as f64).sqrt();
    let squeezed: Vec<DVec2> = elbow.omega.iter().map(|&p| p * DVec2::new(0.9, 1.0)).collect();
    lay(&elbow.cut.disk, &squeezed, spacing)
}

fn diffusion_step(criterion: &mut Criterion) {
    let elbow = elbow();
    let fabric = &elbow.design.fabric;
    let mut group = criterion.benchmark_group("diffusion step");
    for nodes in [2_000, 8_000, 32_000] {
        let model = woven(&elbow, nodes);
        let rest = RestLengths::new(model.spacing(), 0, vec![0.1], 0.0);
        let lambda = step_length(0.125, fabric);
        group.throughput(Throughput::Elements(model.node_count() as u64));
        group.bench_function(BenchmarkId::from_parameter(model.node_count()), |bencher| {
            bencher.iter(|| step(&elbow.cut.disk, black_box(&model), &rest, fabric, lambda));
        });
    }
    group.finish();
}

/// The report page of a flattened limb.
fn page_of(done: &Flattening) -> PageInput<'_> {
    PageInput {
        disk: done.disk(),
        coordinates: &done.coordinates,
        drawing: &done.drawing,
        report: &done.report,
        girths: &done.girths,
        warp_strain: &done.field.warp_strain,
        pressure_kpa: Some(&done.field.pressure_kpa),
        limit_kpa: Limits::WARN_KPA,
        workshop: None,
    }
}

fn stages(criterion: &mut Criterion) {
    let elbow = elbow();
    let parameters = Parameters::default();
    let disk = &elbow.cut.disk;
    let mut group = criterion.benchmark_group("stage at 20k triangles");
    group.sample_size(10);
    let file = raw_obj(&elbow.mesh, "elbow").into_bytes();
    group.bench_function("reading", |b| b.iter(|| read(&file, Format::Obj)));
    group.bench_function("surface", |b| b.iter(|| validate(&elbow.mesh, &elbow.options)));
    group.bench_function("girths", |b| b.iter(|| measure(&elbow.surface, 20.0)));
    group.bench_function("noise", |b| b.iter(|| noise(&elbow.surface)));
    let across = [RegionPlane { point: DVec3::new(0.0, 0.0, 60.0), normal: DVec3::NEG_Z }];
    group.bench_function("region", |b| b.iter(|| clip(&elbow.surface, &across)));
    group.bench_function("cut", |b| b.iter(|| open_to_disk(&elbow.surface, &[])));
    group.bench_function("nearest triangles, prepared", |b| b.iter(|| Locator::new(disk)));
    group.bench_function("curvature at every vertex", |b| {
        b.iter(|| Curvature::new(&elbow.surface, &parameters).at_vertices());
    });
    group.bench_function("parameterization", |b| {
        b.iter(|| initial(disk, &Matrix::new(disk, &[])?, &elbow.markers.points, &Silent));
    });
    group.bench_function("laying", |b| b.iter(|| lay(disk, &elbow.omega, 5.0)));
    let model = woven(&elbow, 2_000);
    group.bench_function("mapping", |b| b.iter(|| Mapping::new(disk, &model).vertices()));
    group.bench_function("whole flow", |b| {
        b.iter(|| wovenfit_core::flatten(&elbow.mesh, &elbow.design, &parameters, &Silent));
    });
    let done = wovenfit_core::flatten(&elbow.mesh, &elbow.design, &parameters, &Silent)
        .expect("the elbow can be flattened");
    // Without seams the scan is cut as the elbow here.
    let (cut, coordinates) = (&elbow.cut, &done.coordinates);
    assert_eq!(&cut.disk, done.disk());
    group.bench_function("pattern", |b| b.iter(|| pattern(cut, coordinates)));
    let free = free_edges(cut);
    group.bench_function("relief", |b| {
        b.iter(|| Relief::new(&elbow.surface, disk, &cut.seams, &parameters, &Silent));
    });
    let worn = FieldInput {
        relief: &Relief::new(&elbow.surface, disk, &cut.seams, &parameters, &Silent)
            .expect("nobody cancels"),
        disk,
        coordinates,
        free_edges: &free,
        fabric: &elbow.design.fabric,
        pressure_model: elbow.design.pressure_model,
        parameters: &parameters,
    };
    group.bench_function("field", |b| b.iter(|| everywhere(&worn)));
    let page = page_of(&done);
    group.bench_function("page", |b| b.iter(|| report_html(&page)));
    group.bench_function("files", |b| {
        b.iter(|| {
            (
                worn_obj(done.disk(), &done.coordinates),
                flat_obj(done.disk(), &done.coordinates),
                pattern_svg(&done.sheet(SheetUnit::Millimetre)),
                done.report.to_json(),
            )
        });
    });
    group.finish();
}

/// The page must not take longer than the fit: two figures of one run that are to be compared. The fit
/// is what the command line calls so, the whole flow from the scan to the pattern.
fn page_against_fit(criterion: &mut Criterion) {
    let elbow = elbow();
    let parameters = Parameters::default();
    let flow = || wovenfit_core::flatten(&elbow.mesh, &elbow.design, &parameters, &Silent);
    let done = flow().expect("the elbow can be flattened");
    let page = page_of(&done);
    let mut group = criterion.benchmark_group("the page against the fit at 20k triangles");
    group.sample_size(10);
    group.bench_function("fit", |b| b.iter(flow));
    group.bench_function("page", |b| b.iter(|| report_html(black_box(&page))));
    group.finish();
}

criterion_group!(benches, diffusion_step, stages, page_against_fit);
criterion_main!(benches);
