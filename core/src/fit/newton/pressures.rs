//! The target strains of the threads, and their correction until the pressures are met.
//!
//! Eq. (3) gives every thread with annotated points the strain that its pressures need. At the
//! minimum of J_E the thread takes, over its whole length, a little more or less than its target, since
//! a doubly curved limb shares the misfit out. The paper stops there. Here the targets are
//! corrected: the pressures P that the pattern gives are computed from the whole threads' strains, how
//! they answer to each target is read off the fit's own Hessian (one solve a thread, or a bundle of
//! neighbours where they are many), and the targets that bring P nearest to what was asked (least squares,
//! within [0, max_strain]) are taken:
//!
//! min ½ Σ_j (P_j + Σ_i S_ji Δ_i − P⁰_j)² + ½ α Σ_i (p_i (τ_i + Δ_i − w_i))²
//!
//! The second sum, with w the strain of Eq. (3) and p the pressure per strain of a thread by itself,
//! keeps a thread that does not answer (at a free edge, say) from being pulled to the end of its range
//! for nothing; α is so small that a thread which answers by half is off by 0.4 %.

mod answers;
mod bundles;

use std::ops::Range;
use std::sync::Arc;

use glam::DVec2;

pub use self::answers::Answers;
use self::answers::PROBE;
use self::bundles::bundled;
use super::course::{Course, NEAR_MM};
use crate::fit::FitInput;
use crate::pressure::{
    Annotation, FLAT_CURVATURE, Reached, Reader, Stretch, Targets, ThreadTarget, Wish,
    pressing_curvature, pressure_kpa, warp_strain,
};

/// Pressures within this fraction of each other agree, or within this pressure (kPa): a twentieth of what is
/// promised, so that it hardly matters from where a fit began.
const AGREE: f64 = 0.001;

/// What is promised, in the same way: only what misses by more can have become worse.
const PROMISED: f64 = 0.02;

/// Target strains that are to change by less are as they should be.
const SETTLED_STRAIN: f64 = 2e-4;

/// How the targets are to change.
pub struct Correction {
    /// By bundle of threads.
    changes: Vec<f64>,
    /// Whether the pressures are as near to what was asked as they will come.
    pub settled: bool,
    /// Whether the last one made the pressures worse.
    pub worse: bool,
    /// Whether no way to the pressures was found: the best targets met are kept.
    pub lost: bool,
}

impl Correction {
    /// Whether it is more than a trifle.
    pub fn counts(&self) -> bool {
        self.most() >= SETTLED_STRAIN
    }

    /// The largest change of a target.
    fn most(&self) -> f64 {
        self.changes.iter().fold(0.0, |most: f64, change| most.max(change.abs()))
    }
}

/// The threads with annotated points and their targets.
pub struct Threads<'a> {
    input: &'a FitInput<'a>,
    reader: Reader<'a>,
    /// The annotations of each thread, from the lowest thread.
    groups: Vec<Vec<usize>>,
    /// The threads whose targets are corrected as one.
    bundles: Vec<Range<usize>>,
    /// Eq. (3) for each.
    wanted: Vec<Option<f64>>,
    /// The corrected target of each.
    asked: Vec<Option<f64>>,
    wishes: Vec<Wish>,
    answers: Option<Arc<Answers>>,
    rounds: usize,
    course: Course,
    /// Whether corrections were given up.
    lost: bool,
    /// Whether the pressures were met as promised at the last correction.
    met: bool,
    /// Whether their function is drawn taut.
    taut: bool,
    /// Targets that no longer follow the fabric.
    held: Option<Targets>,
}

/// Corrections are given up after so many: a pressure that has not come by then does not.
const MOST_ROUNDS: usize = 30;

impl<'a> Threads<'a> {
    /// The threads through the annotations at these pattern coordinates.
    pub fn new(input: &'a FitInput<'a>, coordinates: &[DVec2]) -> Self {
        let mut threads = Self {
            input,
            reader: Reader::new(input.disk, input.annotations, input.parameters.curvature_radius),
            groups: Vec::new(),
            bundles: Vec::new(),
            wanted: Vec::new(),
            asked: Vec::new(),
            wishes: Vec::new(),
            answers: None,
            rounds: 0,
            course: Course::default(),
            lost: false,
            met: false,
            taut: false,
            held: None,
        };
        threads.find(coordinates, None);
        threads
    }

    /// Continues with the targets of an earlier fit where it has one for the same annotation, and with its
    /// answers if nothing but wanted pressures has changed. Whether the answers serve: then the targets are
    /// the earlier fit's and are to be corrected before the first step.
    pub fn resume(&mut self, earlier: &Targets, answers: Option<&Arc<Answers>>) -> bool {
        self.answers = answers.filter(|answers| answers.serve(self)).map(Arc::clone);
        self.course.near = self.answers.is_some();
        let limit = self.input.fabric.max_strain;
        for (group, asked) in self.groups.iter().zip(&mut self.asked) {
            let before = earlier.threads.iter().find(|t| t.annotations == *group);
            let (Some(before), Some(asked)) = (before, asked.as_mut()) else { continue };
            if let (Some(wanted), Some(given)) = (before.wanted, before.asked) {
                *asked = if self.answers.is_some() {
                    given
                } else {
                    // The correction stays, the wish may have changed.
                    (*asked + given - wanted.clamp(0.0, limit)).clamp(0.0, limit)
                };
            }
        }
        self.answers.is_some() && self.corrects()
    }

    /// The answers, for the next fit.
    pub fn into_answers(self) -> Option<Arc<Answers>> {
        self.answers
    }

    /// Whether the pressures were met when the targets were last corrected.
    pub fn met(&self) -> bool {
        self.met
    }

    /// Whether there are targets to correct.
    pub fn corrects(&self) -> bool {
        self.input.parameters.correct_pressures && !self.input.annotations.is_empty()
    }

    /// The corrected targets by thread, as numbers.
    pub fn asked(&self) -> impl Iterator<Item = f64> {
        self.asked.iter().map(|asked| asked.unwrap_or(0.0))
    }

    /// Replaces them; they stay within their range.
    fn ask(&mut self, targets: impl Iterator<Item = f64>) {
        let limit = self.input.fabric.max_strain;
        for (asked, target) in self.asked.iter_mut().zip(targets) {
            *asked = asked.map(|_| target.clamp(0.0, limit));
        }
    }

    /// Changes the targets; how the vertices move with them, in mm, as far as that is known.
    pub fn take(&mut self, correction: &Correction) -> Vec<DVec2> {
        if self.lost {
            // It was made for other targets than those gone back to.
            return Vec::new();
        }
        let mut changed: Vec<f64> = self.asked().collect();
        for (bundle, change) in self.bundles.iter().zip(&correction.changes) {
            changed[bundle.clone()].iter_mut().for_each(|asked| *asked += change);
        }
        self.ask(changed.into_iter());
        let motions = self.answers.iter().flat_map(|answers| &answers.motions);
        let mut whole = Vec::new();
        for (motion, change) in motions.zip(&correction.changes).filter(|(m, _)| !m.is_empty()) {
            whole.resize(motion.len(), DVec2::ZERO);
            whole.iter_mut().zip(motion).for_each(|(sum, &m)| *sum += *change * m);
        }
        whole
    }

    /// Whether no target has been corrected yet.
    pub fn untouched(&self) -> bool {
        self.rounds == 0
    }

    /// The pattern has moved so far that it answers to the targets in another way.
    pub fn forget_answers(&mut self) {
        self.answers = None;
    }

    /// Finds the threads anew, as long as none has been corrected: while the fabric still moves much.
    pub fn follow(&mut self, coordinates: &[DVec2]) {
        if self.rounds == 0 {
            self.find(coordinates, None);
        }
    }

    fn find(&mut self, coordinates: &[DVec2], known: Option<&[Reached]>) {
        let FitInput { annotations, fabric, pressure_model, parameters, .. } = *self.input;
        if annotations.is_empty() || self.held.is_some() {
            return;
        }
        let own;
        let reached = match known {
            Some(reached) => reached,
            None => {
                own = self.reader.read(coordinates);
                &own
            }
        };
        if self.rounds == 0 {
            let mut order: Vec<usize> = (0..annotations.len()).collect();
            order.sort_by(|&a, &b| {
                reached[a].place.y.total_cmp(&reached[b].place.y).then(a.cmp(&b))
            });
            self.groups.clear();
            let mut heights = Vec::new();
            let mut first = f64::NEG_INFINITY;
            for k in order {
                let y = reached[k].place.y;
                if y - first > 0.5 * parameters.spacing {
                    self.groups.push(Vec::new());
                    heights.push(y);
                    first = y;
                }
                if let Some(group) = self.groups.last_mut() {
                    group.push(k);
                }
            }
            for group in &mut self.groups {
                group.sort_unstable();
            }
            self.bundles = bundled(&heights);
        }
        self.wishes = annotations
            .iter()
            .zip(reached)
            .map(|(annotation, reached)| Wish {
                kpa: annotation.kpa,
                curvature: reached.curvature,
                // Lemma 4, or what the weft threads really have.
                weft_strain: if parameters.correct_pressures {
                    reached.threads.weft
                } else {
                    fabric.weft_strain
                },
            })
            .collect();
        self.wanted = self
            .groups
            .iter()
            .map(|group| {
                let points: Vec<Wish> = group.iter().map(|&k| self.wishes[k]).collect();
                warp_strain(pressure_model, fabric, &points)
            })
            .collect();
        let within = |strain: f64| strain.clamp(0.0, fabric.max_strain);
        if self.rounds == 0 {
            self.asked = self.wanted.iter().map(|wanted| wanted.map(within)).collect();
        }
        // A place may become too flat for any tension to press there, or cease to be.
        for (asked, wanted) in self.asked.iter_mut().zip(&self.wanted) {
            *asked = wanted.map(|wanted| asked.unwrap_or_else(|| within(wanted)));
        }
    }

    /// Draws their function taut, and begins the corrections anew.
    pub fn draw_taut(&mut self) {
        self.taut = true;
        self.lost = false;
        self.answers = None;
        self.course = Course { best: self.course.best.take(), ..Course::default() };
        self.rounds = self.rounds.min(1);
    }

    /// Keeps the targets as they are at these pattern coordinates, uncorrected and at their places in the pattern: the
    /// energy is then that of a fabric alone, and falls to a minimum.
    pub fn hold(&mut self, coordinates: &[DVec2]) {
        self.give_up();
        self.held = Some(self.targets(coordinates));
    }

    /// The targets at these pattern coordinates.
    pub fn targets(&self, coordinates: &[DVec2]) -> Targets {
        if let Some(held) = &self.held {
            return held.clone();
        }
        self.with(coordinates, &self.asked)
    }

    fn with(&self, coordinates: &[DVec2], asked: &[Option<f64>]) -> Targets {
        let FitInput { disk, annotations, fabric, parameters, .. } = self.input;
        let [low, high] = coordinates
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], p| [l.min(p.y), h.max(p.y)]);
        let place = |k: usize| annotations[k].point.interpolate(disk, coordinates).y;
        let mut threads: Vec<ThreadTarget> = self
            .groups
            .iter()
            .zip(&self.wanted)
            .zip(asked)
            .map(|((group, &wanted), &asked)| ThreadTarget {
                y: group.iter().map(|&k| place(k)).sum::<f64>() / group.len() as f64,
                t: 0.0,
                annotations: group.clone(),
                wanted,
                asked,
                fitted: 0.0,
            })
            .collect();
        threads.sort_by(|a, b| a.y.total_cmp(&b.y));
        // Two threads at one height are one datum to the strain function.
        let apart = 1e-6 * (high - low);
        for k in 1..threads.len() {
            threads[k].y = threads[k].y.max(threads[k - 1].y + apart);
        }
        let wishes = self.wishes.clone();
        let (most, near) = (fabric.max_strain, parameters.row_spacing);
        Targets::new(threads, wishes, [low, high], most, near, self.taut)
    }

    /// Pressures with the whole threads' strains, in kPa; of a slack thread less than nothing by what it lacks of
    /// its length, so that a correction knows the way, unless nothing is asked.
    fn pressures(&self, reached: &[Reached]) -> Vec<f64> {
        let FitInput { annotations, fabric, pressure_model, .. } = *self.input;
        let kpa = |reached: &Reached, threads: &Stretch| {
            pressure_kpa(pressure_model, fabric, &reached.curvature, threads)
        };
        let lacking = |reached: &Reached| {
            let slack = reached.threads.warp;
            let [taut, more] =
                [0.0, PROBE].map(|warp| Stretch::without_shear(warp, reached.threads.weft));
            let taut = kpa(reached, &taut);
            taut + slack * (kpa(reached, &more) - taut) / PROBE
        };
        let pressure = |(reached, annotation): (&Reached, &Annotation)| {
            if reached.threads.warp < 0.0 && annotation.kpa > 0.0 {
                lacking(reached)
            } else {
                kpa(reached, &reached.threads)
            }
        };
        reached.iter().zip(annotations).map(pressure).collect()
    }

    /// Which places count: one that no tension presses on does not pull at its thread.
    fn counts(&self, reached: &[Reached]) -> Vec<bool> {
        let presses = |r: &Reached| {
            pressing_curvature(self.input.pressure_model, &r.curvature) > FLAT_CURVATURE
        };
        reached.iter().map(presses).collect()
    }

    fn agree(&self, got: &[f64], counts: &[bool]) -> bool {
        self.input
            .annotations
            .iter()
            .zip(got)
            .zip(counts)
            .all(|((a, &got), &counts)| !counts || (got - a.kpa).abs() <= AGREE * a.kpa.max(1.0))
    }

    /// How the targets are to be corrected after a step that moved a vertex by `largest` mm. `answers` gives
    /// how the pattern moves when the present targets are replaced by each of others, or nothing if the job is
    /// cancelled: then it is of no use.
    pub fn correction(
        &mut self,
        coordinates: &[DVec2],
        largest: f64,
        answers: impl Fn(&[Targets]) -> Vec<Vec<DVec2>>,
    ) -> Correction {
        let here = self.reader.read(coordinates);
        self.rounds += 1;
        self.find(coordinates, Some(&here));
        let got = self.pressures(&here);
        let counts = self.counts(&here);
        let (mut missed, mut promised) = (0.0, 0.0);
        for k in (0..got.len()).filter(|&k| counts[k]) {
            let asked = self.input.annotations[k].kpa;
            missed += (got[k] - asked).powi(2);
            promised += (PROMISED * asked.max(1.0)).powi(2);
        }
        let misses = missed > promised;
        self.met = !misses;
        let near = largest < NEAR_MM;
        // What was given up makes nothing worse.
        let worse = !self.lost && misses && self.course.worse(missed, near);
        let changes = vec![0.0; self.bundles.len()];
        let mut correction =
            Correction { changes, settled: true, worse, lost: self.lost && misses };
        if self.lost {
            return correction;
        }
        self.course.adapt(worse);
        self.course.remember(missed, largest, &self.asked, self.taut);
        if self.agree(&got, &counts) {
            self.course.missed = None;
            return correction;
        }
        if self.rounds > MOST_ROUNDS {
            self.give_up();
            return Correction { settled: false, worse: true, ..correction };
        }
        if worse {
            self.answers = None;
        }
        loop {
            if self.answers.is_none() {
                self.answers = Some(Arc::new(self.answers(coordinates, &got, &answers)));
                self.course.near = near;
            }
            correction.changes = self.changes(&here, &got, &counts);
            let most = correction.most();
            let reach = self.course.reach_of(self.rounds, near);
            if most > reach {
                let share = reach / most;
                correction.changes.iter_mut().for_each(|change| *change *= share);
            }
            // Nothing more to be done: by answers from elsewhere that is not to be believed.
            if correction.counts() || !misses || !near || self.course.near {
                break;
            }
            self.answers = None;
        }
        correction.settled = !correction.counts();
        if correction.settled && misses && self.course.was_better(missed) {
            // It has settled where more is missed than was.
            self.give_up();
            return Correction { settled: false, worse: true, ..correction };
        }
        self.course.missed = Some((missed, correction.counts()));
        self.course.last = correction.most();
        correction
    }

    /// No more corrections: back to the targets that came nearest to the pressures, or to those of Eq. (3).
    pub fn give_up(&mut self) {
        let limit = self.input.fabric.max_strain;
        self.lost = true;
        self.asked = match &self.course.best {
            Some((_, best, taut)) => {
                self.taut = *taut;
                best.clone()
            }
            None => self.wanted.iter().map(|w| w.map(|w| w.clamp(0.0, limit))).collect(),
        };
    }

    /// Replaces the targets by what the acceleration makes of them, no farther than a correction may go.
    pub fn accelerate(&mut self, targets: impl Iterator<Item = f64>) {
        if self.lost {
            return;
        }
        let reach = self.course.reach;
        let within: Vec<f64> = self
            .asked()
            .zip(targets)
            .map(|(asked, target)| target.clamp(asked - reach, asked + reach))
            .collect();
        self.ask(within.into_iter());
    }
}
