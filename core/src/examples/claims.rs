//! The paper's sentences about its results, each with what is computed here.
//!
//! A sentence is the paper's or close to it; the answer is made from the outcomes alone. Whether it
//! holds is decided by figures that stand in the answer, with bounds that are argued where they
//! are used. Nothing here is a truth about braces: the paper's scans and pressures were others.

use super::measures::{Threads, course};
use super::{Extent, Outcome};
use crate::geometry::Locator;
use crate::report::{FitReport, PressureReport};

/// Whether a sentence holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// As the paper says.
    Holds,
    /// In kind, but not as far as the words go.
    InPart,
    /// It does not.
    Differs,
}

impl Verdict {
    /// For people.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds here",
            Self::InPart => "holds here in part",
            Self::Differs => "does not hold here",
        }
    }

    fn of(all: bool, some: bool) -> Self {
        match (all, some) {
            (true, _) => Self::Holds,
            (false, true) => Self::InPart,
            (false, false) => Self::Differs,
        }
    }
}

/// A sentence of the paper and its answer.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Claim {
    /// A frozen short name.
    pub code: &'static str,
    /// The figure of the paper that it is said about.
    pub figure: u8,
    /// What the paper says.
    pub paper: &'static str,
    /// What is computed here, with figures.
    pub here: String,
    /// Whether it holds.
    pub verdict: Verdict,
}

/// The share of the fall of E_SSD at which a fit is said to be there: the plateau, whose window
/// goes with the fabric, does not decide.
pub const THERE: f64 = 0.99;

/// The outcomes by name.
#[derive(Clone, Copy)]
struct All<'a>(&'a [Outcome]);

impl<'a> All<'a> {
    fn of(self, name: &str) -> &'a Outcome {
        let found = self.0.iter().find(|outcome| outcome.example.name == name);
        found.expect("every name in this file stands in the list of examples")
    }

    fn fit(self, name: &str) -> &'a FitReport {
        &self.of(name).flattening.report.fit
    }

    fn pressures(self, name: &str) -> &'a [PressureReport] {
        &self.of(name).flattening.report.pressures
    }

    /// Strains of the threads through the wanted pressures of `name`, in another outcome of the
    /// same limb.
    fn strains(self, name: &str, in_: &str) -> Vec<f64> {
        let (from, to) = (&self.of(name).flattening, &self.of(in_).flattening);
        let locator = Locator::new(to.disk());
        let threads = Threads::of(to);
        let strain = |p: &PressureReport| {
            let (point, _) = locator.closest(p.at.into())?;
            Some(threads.at(point.interpolate(to.disk(), &to.coordinates).y)?.strain)
        };
        from.report.pressures.iter().map(|p| strain(p).unwrap_or(f64::NAN)).collect()
    }
}

fn percent(value: f64) -> String {
    let text = format!("{:.1}", 100.0 * value);
    if text == "-0.0" { "0.0 %".to_owned() } else { text.replace('-', "\u{2212}") + " %" }
}

/// "7", "7 and 9", "7, 8 and 9".
fn listed(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}

/// The paper's sentences and what is computed here, in the order of its figures.
///
/// # Panics
/// If the outcomes are not those of all examples.
#[must_use]
pub fn findings(outcomes: &[Outcome]) -> Vec<Claim> {
    let all = All(outcomes);
    vec![
        tighter_in_the_middle(all),
        one_end(all),
        middle_unstretched(all),
        falls(all),
        isotropic_faster(all),
        knee_conflict(all),
        wrist_start(all),
        wrist_lowered(all),
        thumb_outline(all),
    ]
}

/// A pressure is large if its thread is stretched at least so much more than a small one's.
const MUCH: f64 = 3.0;

/// "Almost no stretch": below this share of the strain at both ends.
const ALMOST_NONE: f64 = 0.25;

fn tighter_in_the_middle(all: All<'_>) -> Claim {
    let here = all.strains("elbow-isotropic-b", "elbow-isotropic-b");
    let [upper, middle, lower] = here[..] else { unreachable!("B has three pressures") };
    let ends = upper.max(lower);
    Claim {
        code: "b_tight_middle",
        figure: 2,
        paper: "Configuration B, a large pressure in the middle and very small ones at the ends, \
                leads to a tighter stretch in the middle.",
        here: format!(
            "The thread in the middle is stretched by {}, those at the ends by {} and {}. Without \
             pressures (A) the same three threads have {}.",
            percent(middle),
            percent(upper),
            percent(lower),
            strains_of_a(all, "elbow-isotropic-b"),
        ),
        verdict: Verdict::of(middle > MUCH * ends, middle > ends),
    }
}

fn strains_of_a(all: All<'_>, pressed: &str) -> String {
    let strains = all.strains(pressed, "elbow-isotropic-a");
    listed(&strains.iter().map(|&s| percent(s)).collect::<Vec<_>>())
}

fn one_end(all: All<'_>) -> Claim {
    let here = all.strains("elbow-isotropic-c", "elbow-isotropic-c");
    let [upper, lower] = here[..] else { unreachable!("C has two pressures") };
    Claim {
        code: "c_one_side",
        figure: 2,
        paper: "Configuration C has large stretch on one side while almost stretch free on the \
                other.",
        here: format!(
            "The thread at the pressed end is stretched by {}, that at the other end by {}: {} of \
             it. Without pressures (A) the two have {}.",
            percent(upper),
            percent(lower),
            percent(lower / upper),
            strains_of_a(all, "elbow-isotropic-c"),
        ),
        verdict: Verdict::of(lower.abs() < ALMOST_NONE * upper, lower < upper / MUCH),
    }
}

fn middle_unstretched(all: All<'_>) -> Claim {
    let name = "elbow-isotropic-d";
    let here = all.strains(name, name);
    let [upper, middle, lower] = here[..] else { unreachable!("D has three pressures") };
    let ends = upper.min(lower);
    let threads = Threads::of(&all.of(name).flattening);
    let least = threads.profile().iter().map(|thread| thread.strain).fold(f64::INFINITY, f64::min);
    Claim {
        code: "d_middle_unstretched",
        figure: 2,
        paper: "Configuration D, large pressures at both ends, shows almost no stretch in the \
                middle part.",
        here: format!(
            "The thread in the middle is stretched by {}, those at the ends by {} and {}; the \
             least stretched thread has {}. In the middle {} was wanted; what is left is the \
             limb\u{2019}s shape, which stretches that thread also without pressures (A: {}), and \
             the fabric\u{2019}s shear, which ties threads to their neighbours. The paper names no pressure in \
             the middle; without one the strain function would be level between two like ends, \
             and nothing would be slack there.",
            percent(middle),
            percent(upper),
            percent(lower),
            percent(least),
            percent(wanted_strain(all, name, 1)),
            percent(all.strains(name, "elbow-isotropic-a")[1]),
        ),
        verdict: Verdict::of(middle < ALMOST_NONE * ends, middle < ends / MUCH),
    }
}

/// The strain that a wanted pressure asks of its thread, by Eq. (3).
fn wanted_strain(all: All<'_>, name: &str, number: usize) -> f64 {
    let report = &all.of(name).flattening.report;
    let p = &report.pressures[number];
    // Eq. (3) for a single point with ε_weft = 0; 1/m and kPa make N/mm.
    let per_strain = report.fabric.s * std::f64::consts::PI * p.mean_curvature_per_m;
    p.asked_kpa / (per_strain * report.fabric.warp)
}

fn falls(all: All<'_>) -> Claim {
    // What the stop at a pass's end leaves: nodes come and go at the edge between two entries.
    const LEVEL: f64 = 0.01;
    let fits: Vec<(&str, &FitReport)> = all
        .0
        .iter()
        .filter(|outcome| outcome.example.extent != Extent::Start)
        .map(|outcome| (outcome.example.name, &outcome.flattening.report.fit))
        .collect();
    let share = |fit: &FitReport| {
        let [first, last] = course::ends(fit);
        last / first
    };
    let most = fits.iter().map(|(_, fit)| share(fit)).fold(0.0, f64::max);
    let (risers, steady): (Vec<_>, Vec<_>) =
        fits.iter().partition(|(_, fit)| course::largest_rise(fit) > LEVEL);
    let least = steady.iter().map(|(_, fit)| course::largest_rise(fit)).fold(0.0, f64::max);
    let stopped: Vec<String> = fits
        .iter()
        .filter(|(_, fit)| !fit.converged)
        .map(|(name, fit)| format!("{name} after {} steps", fit.iterations))
        .collect();
    let rest = if stopped.is_empty() {
        "All of them came to rest by themselves.".to_owned()
    } else {
        format!("Not converged, stopped at the most steps allowed: {}.", listed(&stopped))
    };
    let jumps = risers.iter().map(|(name, fit)| {
        format!(
            " {name} jumps up {} times, by up to {} of the whole fall: the wanted points are given \
             anew to their closest nodes after every pass (section 5.1), and when one changes its \
             thread the wanted strains, against which E_SSD is measured, change with it. Its end \
             is one of these states, and no more at rest than the jumps allow.",
            course::jumps(fit, LEVEL),
            percent(course::largest_rise(fit))
        )
    });
    let jumps: String = jumps.collect();
    Claim {
        code: "e_ssd_falls",
        figure: 8,
        paper: "E_SSD falls during the diffusion.",
        here: format!(
            "In all {} fits E_SSD ends at {} of its start or less. In {} of them it never rises \
             again by more than {} of the whole fall.{jumps} {rest}",
            fits.len(),
            percent(most),
            steady.len(),
            percent(least)
        ),
        verdict: Verdict::of(most < 1.0 && risers.is_empty(), most < 1.0),
    }
}

fn isotropic_faster(all: All<'_>) -> Claim {
    let pairs = ["a", "b", "c", "d"].map(|c| {
        let steps = |fabric: &str| course::steps_to(all.fit(&format!("elbow-{fabric}-{c}")), THERE);
        (steps("isotropic"), steps("anisotropic"))
    });
    let words = |which: fn(&(u64, u64)) -> u64| {
        listed(&pairs.iter().map(|pair| which(pair).to_string()).collect::<Vec<_>>())
    };
    let ratio: Vec<f64> =
        pairs.iter().map(|&(iso, aniso)| aniso as f64 / iso.max(1) as f64).collect();
    let (low, high) =
        ratio.iter().fold((f64::INFINITY, 0.0), |(l, h), &r| (f64::min(l, r), f64::max(h, r)));
    let stiffest = |name: &str| {
        let fabric = &all.of(name).flattening.report.fabric;
        fabric.warp.max(fabric.weft)
    };
    let lambda = stiffest("elbow-anisotropic-a") / stiffest("elbow-isotropic-a");
    Claim {
        code: "isotropic_faster",
        figure: 10,
        paper: "The diffusion converges faster in the isotropic case than in the anisotropic one, \
                since stiff weft threads reduce the move-ability of nodes.",
        here: format!(
            "Steps until E_SSD has made {:.0} % of its fall, A to D: {} isotropic, {} anisotropic, \
             {low:.1} to {high:.1} times as many. The step \u{3bb} = 0.125 / max(k_warp, k_weft) is \
             {lambda:.0} times smaller for the stiffer fabric, so that a factor of {lambda:.0} \
             comes from the step alone{}.",
            100.0 * THERE,
            words(|pair| pair.0),
            words(|pair| pair.1),
            if high < lambda {
                "; measured in steps times \u{3bb} the stiff weft threads do not slow the fabric down, \
                 they even it out"
            } else if low > lambda {
                "; the stiff weft threads add the rest"
            } else {
                ", which is about all of it"
            },
        ),
        verdict: Verdict::of(low > 1.0, high > 1.0),
    }
}

fn knee_conflict(all: All<'_>) -> Claim {
    let pressures = all.pressures("knee-pressed");
    let find = |kpa: f64| pressures.iter().position(|p| (p.asked_kpa - kpa).abs() < 1e-9);
    let (low, high) = find(0.06).zip(find(2.29)).expect("the knee wants both");
    let names_other = |a: usize, b: usize| {
        pressures[a].reason.as_ref().is_some_and(|reason| {
            reason.code == "thread_conflict" && reason.text.contains(&format!("point {}", b + 1))
        })
    };
    let got = |k: usize| pressures[k].got_kpa.unwrap_or(f64::NAN);
    let reason = |k: usize| {
        let reason = pressures[k].reason.as_ref();
        reason.map_or_else(|| "it is met".to_owned(), |reason| reason.text.clone())
    };
    let told = names_other(low, high) && names_other(high, low);
    let missed = pressures[low].reason.is_some() && pressures[high].reason.is_some();
    Claim {
        code: "knee_conflict",
        figure: 11,
        paper: "It is impossible to realize the two drastically different pressures 2.29 and 0.06 \
                at two points of similar curvature that are close in the weft direction.",
        here: format!(
            "Point {} asks {:.2} kPa and gets {:.2}; point {} asks {:.2} and gets {:.2}. Mean \
             curvature is {:.1} and {:.1} per metre, and their threads are {} apart of {} in all. \
             The report says of point {}: \u{201c}{}\u{201d}, and of point {}: \u{201c}{}\u{201d}.",
            low + 1,
            pressures[low].asked_kpa,
            got(low),
            high + 1,
            pressures[high].asked_kpa,
            got(high),
            pressures[low].mean_curvature_per_m,
            pressures[high].mean_curvature_per_m,
            threads_apart(&pressures[low], &pressures[high]),
            all.of("knee-pressed").flattening.report.strain_function.rows.len(),
            low + 1,
            reason(low),
            high + 1,
            reason(high),
        ),
        verdict: Verdict::of(missed && told, missed),
    }
}

fn threads_apart(a: &PressureReport, b: &PressureReport) -> String {
    match a.thread.zip(b.thread).map(|(a, b)| (a - b).abs()) {
        Some(0) => "none (they are one)".to_owned(),
        Some(n) => n.to_string(),
        None => "unknown threads".to_owned(),
    }
}

/// Root mean square strain of warp and weft springs in the first woven fitting.
fn start_rms(fit: &FitReport) -> f64 {
    course::finest(fit).next().map_or(0.0, course::rms)
}

fn wrist_start(all: All<'_>) -> Claim {
    let at_scale =
        ["elbow", "knee", "wrist"].map(|limb| start_rms(all.fit(&format!("{limb}-start"))));
    let scaled =
        ["elbow-isotropic-a", "knee-free", "wrist-free"].map(|name| start_rms(all.fit(name)));
    let times = |[elbow, knee, wrist]: [f64; 3]| wrist / (0.5 * (elbow + knee));
    let [elbow, knee, wrist] = at_scale;
    let (against_elbow, against_knee) = (wrist / elbow, wrist / knee);
    let least = against_elbow.min(against_knee);
    let [e, k, w] = scaled.map(percent);
    Claim {
        code: "wrist_start",
        figure: 13,
        paper: "The wrist\u{2019}s initial fitting incurs very high distortion, twice that of the \
                examples before.",
        here: format!(
            "Root mean square strain of warp and weft springs when laid by \u{3a9} at true scale: \
             elbow {}, knee {}, wrist {}. That is {against_elbow:.1} times the elbow and \
             {against_knee:.1} times the knee, {:.1} times their mean. With \u{3a9} scaled by r = \
             {} as the diffusion starts, the scaling drowns the difference: {e}, {k} and {w}, {:.1} \
             times.",
            percent(elbow),
            percent(knee),
            percent(wrist),
            times(at_scale),
            parameter(all, "start_warp"),
            times(scaled),
        ),
        // "Twice" is a word, not a measurement: half as much again of either is the same kind.
        verdict: Verdict::of(least >= 1.5, times(at_scale) > 1.2),
    }
}

fn parameter(all: All<'_>, name: &str) -> String {
    let entries = all.of("wrist-free").flattening.report.parameters.entries();
    entries.iter().find(|(n, _)| *n == name).map(|(_, value)| value.clone()).unwrap_or_default()
}

fn wrist_lowered(all: All<'_>) -> Claim {
    let start = start_rms(all.fit("wrist-start"));
    let end = course::finest(all.fit("wrist-free")).last().map_or(0.0, course::rms);
    Claim {
        code: "wrist_lowered",
        figure: 13,
        paper: "The fitting without wanted pressures has a much lowered strain distribution.",
        here: format!(
            "The root mean square strain falls from {} in the initial fitting to {}.",
            percent(start),
            percent(end)
        ),
        verdict: Verdict::of(end < 0.5 * start, end < start),
    }
}

/// The part of the brace about the thumb's thread that counts as near, as a share of its height.
const NEAR: f64 = 0.08;

fn thumb_outline(all: All<'_>) -> Claim {
    let name = "wrist-pressed";
    let pressed = &all.of(name).flattening;
    let free = &all.of("wrist-free").flattening;
    let thumb = (0..pressed.report.pressures.len())
        .max_by(|&a, &b| {
            let kpa = |k: usize| pressed.report.pressures[k].asked_kpa;
            kpa(a).total_cmp(&kpa(b))
        })
        .expect("the wrist wants pressures");
    let height = |of: &crate::Flattening| of.coordinates.iter().map(|p| p.y).fold(0.0, f64::max);
    let t = pressed.drawing.points[thumb].0.y / height(pressed);
    let widths = |of: &crate::Flattening, part: f64| {
        Threads::of(of).at(part * height(of)).map_or(f64::NAN, |thread| thread.rest_mm)
    };
    let change = |part: f64| widths(pressed, part) / widths(free, part) - 1.0;
    let near = change(t);
    let far: Vec<f64> = (1..10)
        .map(|k| f64::from(k) / 10.0)
        .filter(|part| (part - t).abs() > 2.0 * NEAR)
        .map(change)
        .collect();
    let mean = far.iter().map(|c| c.abs()).sum::<f64>() / far.len().max(1) as f64;
    Claim {
        code: "thumb_outline",
        figure: 13,
        paper: "The fitting with a high pressure at the base of the thumb has another pattern \
                (shown in Fig. 13(c), without words).",
        here: format!(
            "At the height of the wanted pressure the pattern is {:.1} mm wide instead of {:.1}: \
             {}. Away from it the widths change by {} on average.",
            widths(pressed, t),
            widths(free, t),
            percent(near),
            percent(mean),
        ),
        verdict: Verdict::of(near < -0.01 && near.abs() > 1.5 * mean, near < 0.0),
    }
}
