//! A function that rises along a limb, and the centre line through its level sets.

use faer::{Mat, Side};
use glam::{DMat3, DQuat, DVec3};

use crate::sparse::{Pattern, SparseError};
use crate::surface::{HalfEdgeId, Surface, TriangleId, VertexId};

/// Level sets from which a centre line is made.
const LEVELS: usize = 64;

/// Slabs in which the axis of a slit limb is found.
const SLABS: usize = 24;

/// Rounds in which the axis of a slit limb is refined: from its chord, the girths of a limb bent
/// by 90° are within 0.1 % after five, and change no more.
const ROUNDS: usize = 6;

/// A slab of a slit limb with less than this share of the median slab's area is a scrap.
const WHOLE_SLAB: f64 = 0.7;

/// Weight of an even rise along a slit limb against level sets that run straight round it.
const EVENNESS: f64 = 0.01;

/// Cotangent weights are held inside this range, so that the function has no extremum inside.
const WEIGHTS: (f64, f64) = (1e-2, 1e2);

/// A function of the vertices that is 0 at one end loop and 1 at the other and balanced
/// (harmonic) between them.
pub(super) fn between_loops(surface: &Surface, ends: [usize; 2]) -> Result<Vec<f64>, SparseError> {
    let mut held = vec![None; surface.vertex_count()];
    for (value, &end) in [0.0, 1.0].into_iter().zip(&ends) {
        for v in surface.loop_vertices(&surface.boundary_loops()[end]) {
            held[v.index()] = Some(value);
        }
    }
    let mut column = vec![0; held.len()];
    let mut unknowns = 0;
    for (i, value) in held.iter().enumerate() {
        if value.is_none() {
            column[i] = unknowns;
            unknowns += 1;
        }
    }
    let (mut entries, mut values) = (Vec::new(), Vec::new());
    let mut right = vec![0.0; unknowns];
    for h in surface.half_edges() {
        let twin = surface.twin(h);
        if twin.is_some_and(|t| t < h) {
            continue;
        }
        let weight = (cotangent(surface, h) + twin.map_or(0.0, |t| cotangent(surface, t)))
            .clamp(WEIGHTS.0, WEIGHTS.1);
        let (i, j) = (surface.from(h).index(), surface.to(h).index());
        for (a, b) in [(i, j), (j, i)] {
            if held[a].is_some() {
                continue;
            }
            entries.push((column[a], column[a]));
            values.push(weight);
            if let Some(value) = held[b] {
                right[column[a]] += weight * value;
            } else if column[a] > column[b] {
                entries.push((column[a], column[b]));
                values.push(-weight);
            }
        }
    }
    if unknowns == 0 {
        return Ok(held.into_iter().map(Option::unwrap_or_default).collect());
    }
    let solution = Pattern::new(unknowns, &entries)?.factorize(&values)?.solve(&[right]);
    Ok(held.iter().zip(column).map(|(h, c)| h.unwrap_or_else(|| solution[0][c])).collect())
}

/// Cotangent of the angle opposite a half-edge.
fn cotangent(surface: &Surface, h: HalfEdgeId) -> f64 {
    let apex = surface.point(surface.from(h.prev()));
    let (a, b) = (surface.point(surface.from(h)) - apex, surface.point(surface.to(h)) - apex);
    let cotangent = a.dot(b) / a.cross(b).length();
    if cotangent.is_finite() { cotangent } else { 0.0 }
}

/// A function of the vertices, in mm, that rises along the axis of a limb without two end loops:
/// slit, or closed.
///
/// The normals of a slab of limb are perpendicular to its axis, however much of the ring there
/// is: the axis is the direction in which they vary least. By least squares the function is found
/// that is most nearly constant round the axes and rises along them, first for the axis of the
/// whole limb, then again and again for the axes of the function's own slabs.
pub(super) fn along_normals(surface: &Surface) -> Result<Vec<f64>, SparseError> {
    let shapes: Vec<Option<[DVec3; 3]>> =
        surface.triangle_ids().map(|t| hat_gradients(surface, t.index())).collect();
    let areas: Vec<f64> = surface.triangle_ids().map(|t| surface.area(t)).collect();
    let (first, n) = (VertexId::new(0), surface.vertex_count());
    let mut entries: Vec<(usize, usize)> = vec![(first.index(), first.index())];
    for (corners, _) in surface.triangles().iter().zip(&shapes).filter(|(_, s)| s.is_some()) {
        entries.extend(lower_pairs(corners));
    }
    entries.extend((0..n).map(|i| (i, i)));
    let pattern = Pattern::new(n, &entries)?;

    let everything: Vec<usize> = (0..surface.triangle_count()).collect();
    let whole = axis(surface, &areas, &everything, DVec3::ZERO);
    let mut function: Vec<f64> = surface.points().iter().map(|p| p.dot(whole)).collect();
    for _ in 0..ROUNDS {
        let at = |t: usize| {
            surface.triangles()[t].iter().map(|v| function[v.index()]).sum::<f64>() / 3.0
        };
        let (low, high) = range(&function);
        let slab = |f: f64| ((f - low) / (high - low).max(f64::MIN_POSITIVE)) * SLABS as f64;
        let mut members = vec![Vec::new(); SLABS];
        for t in 0..surface.triangle_count() {
            members[(slab(at(t)) as usize).min(SLABS - 1)].push(t);
        }
        let mut axes: Vec<DVec3> = (0..SLABS)
            .map(|k| {
                // With its neighbours, so that a slab has many triangles and axes turn smoothly.
                let near = members[k.saturating_sub(2)..(k + 3).min(SLABS)].concat();
                let rising: DVec3 = near
                    .iter()
                    .filter_map(|&t| {
                        let g = shapes[t]?;
                        let corners = surface.triangles()[t];
                        let sum: DVec3 = (0..3).map(|i| function[corners[i].index()] * g[i]).sum();
                        Some(areas[t] * sum)
                    })
                    .sum();
                axis(surface, &areas, &near, if rising == DVec3::ZERO { whole } else { rising })
            })
            .collect();
        // Slabs of little area are scraps of the ends, without a ring to show the axis: they
        // turn on as the whole slabs next to them do.
        let area = |k: usize| members[k].iter().map(|&t| areas[t]).sum::<f64>();
        let slab_areas: Vec<f64> = (0..SLABS).map(area).collect();
        let mut sorted = slab_areas.clone();
        sorted.sort_by(f64::total_cmp);
        let is_whole = |k: &usize| slab_areas[*k] >= WHOLE_SLAB * sorted[SLABS / 2];
        if let (Some(first), Some(last)) =
            ((0..SLABS).find(is_whole), (0..SLABS).rev().find(is_whole))
        {
            // The window of a whole slab must not reach into the scraps either.
            let (first, last) = (first + 2, last.saturating_sub(2));
            if first <= last {
                let reach = ((last - first) / 2).min(4);
                for k in (0..first).rev() {
                    axes[k] = turned_on(axes[first + reach], axes[first], reach, first - k);
                }
                for k in last + 1..SLABS {
                    axes[k] = turned_on(axes[last - reach], axes[last], reach, k - last);
                }
            }
        }
        // Constant round the limb, rising along it: mostly the former, since the outer side of a
        // bend is longer than the inner and no function rises evenly on both.
        let (mut values, mut right) = (vec![0.0], vec![0.0; n]);
        for (t, gradients) in shapes.iter().enumerate() {
            let Some(g) = gradients else { continue };
            let place = (slab(at(t)) - 0.5).clamp(0.0, SLABS as f64 - 1.0);
            let k = (place as usize).min(SLABS - 2);
            let axis = axes[k].lerp(axes[k + 1], place - k as f64);
            let normal = surface.normal(TriangleId::new(t));
            let round = normal.cross(axis).normalize_or_zero();
            let along = round.cross(normal);
            for i in 0..3 {
                right[surface.triangles()[t][i].index()] += EVENNESS * areas[t] * g[i].dot(along);
                for j in 0..=i {
                    let level = g[i].dot(round) * g[j].dot(round);
                    let even = g[i].dot(along) * g[j].dot(along);
                    values.push(areas[t] * (level + EVENNESS * even));
                }
            }
        }
        // Constants cost nothing: hold the first vertex. Whatever else is loose (a second
        // component, a vertex of needles only) is held by a hair.
        let mean = values.iter().map(|v: &f64| v.abs()).sum::<f64>() / values.len() as f64;
        values[0] = mean;
        values.extend(std::iter::repeat_n(1e-10 * mean, n));
        function = pattern.factorize(&values)?.solve(&[right]).remove(0);
    }
    let (low, _) = range(&function);
    Ok(function.into_iter().map(|f| f - low).collect())
}

/// The axis `beyond` slabs past `near`, if it turns on as it turned over the `reach` slabs from
/// `far` to `near`.
fn turned_on(far: DVec3, near: DVec3, reach: usize, beyond: usize) -> DVec3 {
    if reach == 0 {
        return near;
    }
    let turn = DQuat::from_rotation_arc(far, near);
    let (axis, angle) = turn.to_axis_angle();
    DQuat::from_axis_angle(axis, angle * beyond as f64 / reach as f64) * near
}

/// The pairs of a triangle's corners as entries of a lower triangle, each pair once.
fn lower_pairs(corners: &[VertexId; 3]) -> impl Iterator<Item = (usize, usize)> {
    let index = corners.map(VertexId::index);
    (0..3).flat_map(move |i| (0..=i).map(move |j| (index[i].max(index[j]), index[i].min(index[j]))))
}

/// Gradients of a triangle's hat functions; `None` if it has no area to speak of.
fn hat_gradients(surface: &Surface, t: usize) -> Option<[DVec3; 3]> {
    let p = surface.triangles()[t].map(|v| surface.point(v));
    let across = (p[1] - p[0]).cross(p[2] - p[0]);
    let squared = across.length_squared();
    let longest = (0..3).map(|k| p[k].distance_squared(p[(k + 1) % 3])).fold(0.0, f64::max);
    // Needles of less than 1e-6 rad say nothing of the axis and spoil the system.
    if squared <= 1e-12 * longest * longest {
        return None;
    }
    Some(std::array::from_fn(|k| across.cross(p[(k + 2) % 3] - p[(k + 1) % 3]) / squared))
}

/// The direction in which the normals of these triangles vary least, on the side of `rising`.
fn axis(surface: &Surface, areas: &[f64], triangles: &[usize], rising: DVec3) -> DVec3 {
    let (mut total, mut normal, mut middle) = (0.0, DVec3::ZERO, DVec3::ZERO);
    let facts: Vec<(f64, DVec3, DVec3)> = triangles
        .iter()
        .map(|&t| {
            let p = surface.triangles()[t].map(|v| surface.point(v));
            let n = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
            (areas[t], n, (p[0] + p[1] + p[2]) / 3.0)
        })
        .collect();
    for &(area, n, p) in &facts {
        total += area;
        normal += area * n;
        middle += area * p;
    }
    if total <= 0.0 {
        return rising.normalize_or_zero();
    }
    (normal, middle) = (normal / total, middle / total);
    let (mut varies, mut extends) = (DMat3::ZERO, DMat3::ZERO);
    for &(area, n, p) in &facts {
        varies += square(n - normal) * (area / total);
        extends += square(p - middle) * (area / total);
    }
    let size = extends.x_axis.x + extends.y_axis.y + extends.z_axis.z;
    // Where the normals do not decide (flat): in the surface, along its greatest extent.
    let matrix = varies + 1e-2 * square(normal) - extends * (1e-3 / size.max(f64::MIN_POSITIVE));
    let least = least_eigenvector(matrix);
    if least.dot(rising) < 0.0 { -least } else { least }
}

fn square(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

fn least_eigenvector(matrix: DMat3) -> DVec3 {
    let m = Mat::from_fn(3, 3, |i, j| matrix.col(j)[i]);
    m.self_adjoint_eigen(Side::Lower).map_or(DVec3::Z, |eigen| {
        let u = eigen.U();
        DVec3::new(u[(0, 0)], u[(1, 0)], u[(2, 0)])
    })
}

pub(super) fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::MAX, f64::MIN), |(low, high), &v| (low.min(v), high.max(v)))
}

/// A line through the middles of the level sets of a function.
#[derive(Debug)]
pub(super) struct CentreLine {
    points: Vec<DVec3>,
    /// The function's value at each point.
    levels: Vec<f64>,
    /// Length along the line up to each point, in mm.
    along: Vec<f64>,
}

impl CentreLine {
    /// The line through the length-weighted middles of level sets; `None` if the function does
    /// not rise. The outermost `inset` share of the function's range at both ends is left out
    /// (where the level sets of a slit limb are scraps) and the line is drawn on straight.
    pub(super) fn new(surface: &Surface, function: &[f64], inset: f64) -> Option<Self> {
        let (low, high) = range(function);
        let rise = high - low;
        if rise.is_nan() || rise <= 0.0 {
            return None;
        }
        let share = |k: usize| {
            let nudge = inset.max(1e-9);
            nudge + (1.0 - 2.0 * nudge) * k as f64 / LEVELS as f64
        };
        let levels: Vec<f64> = (0..=LEVELS).map(|k| low + rise * share(k)).collect();
        let mut sums = vec![(0.0, DVec3::ZERO); levels.len()];
        for t in surface.triangle_ids() {
            let f = surface.triangle(t).map(|v| function[v.index()]);
            let p = surface.corners(t);
            let (least, most) = range(&f);
            let first = levels.partition_point(|&l| l <= least);
            let last = levels.partition_point(|&l| l <= most);
            for k in first..last {
                let mut ends = (0..3).filter_map(|i| {
                    let (a, b) = (f[i], f[(i + 1) % 3]);
                    ((a < levels[k]) != (b < levels[k]))
                        .then(|| p[i].lerp(p[(i + 1) % 3], (levels[k] - a) / (b - a)))
                });
                if let (Some(a), Some(b)) = (ends.next(), ends.next()) {
                    sums[k].0 += a.distance(b);
                    sums[k].1 += a.distance(b) * 0.5 * (a + b);
                }
            }
        }
        let mut points: Vec<DVec3> = Vec::new();
        let mut kept = Vec::new();
        for ((length, sum), level) in sums.into_iter().zip(levels) {
            if length > 0.0 {
                points.push(sum / length);
                kept.push(level);
            }
        }
        let n = points.len();
        if n < 4 {
            return None;
        }
        // Draw the ends on to the ends of the function.
        let on = |a: usize, b: usize, to: f64| {
            points[b].lerp(points[a], (to - kept[b]) / (kept[a] - kept[b]))
        };
        let (first, last) = (on(0, 2, low), on(n - 1, n - 3, high));
        points.insert(0, first);
        points.push(last);
        kept.insert(0, low);
        kept.push(high);
        let mut along = vec![0.0];
        for w in points.windows(2) {
            along.push(along[along.len() - 1] + w[0].distance(w[1]));
        }
        Some(Self { points, levels: kept, along })
    }

    /// Length of the line, in mm.
    pub(super) fn length(&self) -> f64 {
        self.along[self.along.len() - 1]
    }

    /// The place at a length along the line.
    pub(super) fn at(&self, along: f64) -> DVec3 {
        let k = self.along.partition_point(|&a| a < along).clamp(1, self.along.len() - 1);
        let (a, b) = (self.along[k - 1], self.along[k]);
        let share = if b > a { ((along - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
        self.points[k - 1].lerp(self.points[k], share)
    }

    /// The length along the line at which the function has this value.
    pub(super) fn along(&self, value: f64) -> f64 {
        let k = self.levels.partition_point(|&l| l < value).clamp(1, self.levels.len() - 1);
        let (a, b) = (self.levels[k - 1], self.levels[k]);
        let share = ((value - a) / (b - a)).clamp(0.0, 1.0);
        self.along[k - 1] + share * (self.along[k] - self.along[k - 1])
    }

    /// The unit direction of the line at a length along it: over a sixteenth of its length both
    /// ways, so that noise does not tilt it; at the ends through a parabola.
    pub(super) fn direction(&self, along: f64) -> DVec3 {
        let h = self.length() / 16.0;
        let middle = along.clamp(h, self.length() - h);
        let at = |s: f64| self.at(s);
        let (before, here, after) = (at(middle - h), at(middle), at(middle + h));
        let slope = (after - before) / (2.0 * h);
        let bend = (after - 2.0 * here + before) / (h * h);
        (slope + (along - middle) * bend).normalize_or_zero()
    }
}
