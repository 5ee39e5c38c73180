//! The two orientation markers: in the pattern they stand on a vertical line, the first on top.
//!
//! The designer's are projected to the surface. Without them a cut tube takes the middles of its
//! ends, a disk the two ends of its principal axis. Limit: which end is near the body is a guess
//! from the girths, or from the widths of a disk's ends, and is said.

use glam::{DMat3, DVec3};

use super::cut::CutSurface;
use super::error::{REACH_MM, SeamError, place as show};
use crate::geometry::{Locator, SurfacePoint};
use crate::surface::{HalfEdgeId, Surface, VertexId};
use crate::warning::Warning;

/// Least distance of the two markers, in mm: they are set by hand to about a millimetre, and
/// nearer than this would not give a direction.
const APART_MM: f64 = 2.0;

/// Two points of the disk that stand on a vertical line in the pattern.
#[derive(Debug, Clone, PartialEq)]
pub struct Markers {
    /// The markers on the disk; the first, at the end near the body, on top.
    pub points: [SurfacePoint; 2],
    /// Whether they were placed without the designer.
    pub automatic: bool,
}

/// Places the orientation markers on the disk: at the designer's points (mm), or automatically
/// (warning `orientation_automatic`).
///
/// # Errors
/// If a designer's marker is more than [`REACH_MM`] from the surface, or both are at one place.
pub fn place(
    cut: &CutSurface,
    orientation: Option<[DVec3; 2]>,
) -> Result<(Markers, Vec<Warning>), SeamError> {
    if let Some(given) = orientation {
        return Ok((Markers { points: given_points(&cut.disk, given)?, automatic: false }, vec![]));
    }
    let (points, reason) = match &cut.ends {
        Some(ends) => {
            let proximal = mid_loop(cut, &ends.proximal)?;
            let distal = mid_loop(cut, &ends.distal)?;
            let reason = format!(
                "opposite the seam, the first on the end of {:.0} mm girth, taken as the one near \
                 the body (the other has {:.0} mm)",
                ends.girths[0], ends.girths[1]
            );
            ([proximal, distal], reason)
        }
        None => (
            axis_ends(&cut.disk)?,
            "at the two ends of the piece's long axis, the first on \
             the wider end, taken as the one near the body"
                .to_owned(),
        ),
    };
    let [first, second] = points.map(|p| p.position(&cut.disk));
    let warning = Warning::at(
        "orientation_automatic",
        format!(
            "the orientation markers were placed automatically, {reason}: ({}) and ({}); if that is \
             wrong, give `orientation`",
            show(first),
            show(second)
        ),
        first,
    );
    Ok((Markers { points, automatic: true }, vec![warning]))
}

fn given_points(disk: &Surface, given: [DVec3; 2]) -> Result<[SurfacePoint; 2], SeamError> {
    let locator = Locator::new(disk);
    let locate = |i: usize| {
        let at = given[i];
        let far = |distance| SeamError::MarkerFar { marker: i + 1, at, distance };
        if !at.is_finite() {
            return Err(far(f64::INFINITY));
        }
        let (point, distance) = locator.closest(at).ok_or_else(|| far(f64::INFINITY))?;
        if distance > REACH_MM { Err(far(distance)) } else { Ok(point) }
    };
    let points = [locate(0)?, locate(1)?];
    let distance = points[0].position(disk).distance(points[1].position(disk));
    if distance < APART_MM {
        return Err(SeamError::MarkersCoincide { at: given[0], distance });
    }
    Ok(points)
}

/// The point of an end farthest along it from where seams begin, darts apart.
fn mid_loop(cut: &CutSurface, end: &[VertexId]) -> Result<SurfacePoint, SeamError> {
    let disk = &cut.disk;
    let lost = || SeamError::Internal("an end of the tube is no part of the boundary".to_owned());
    let is_dart = |v: VertexId| {
        cut.seams.iter().any(|seam| {
            let tip =
                seam.left.first() == seam.right.first() || seam.left.last() == seam.right.last();
            let opens =
                [seam.left.first(), seam.right.first(), seam.left.last(), seam.right.last()];
            tip && opens.contains(&Some(&v))
        })
    };
    // Half-edges along the end with the length before each, and where seams begin.
    let mut edges: Vec<(f64, HalfEdgeId)> = Vec::new();
    let mut seams: Vec<f64> = Vec::new();
    let mut darts: Vec<f64> = Vec::new();
    let mut along = 0.0;
    let mut note = |at: f64, v: VertexId| if is_dart(v) { darts.push(at) } else { seams.push(at) };
    note(0.0, *end.first().ok_or_else(lost)?);
    for pair in end.windows(2) {
        match disk.outgoing(pair[0]).find(|&h| disk.to(h) == pair[1]) {
            Some(h) => {
                edges.push((along, h));
                along += disk.length(h);
            }
            None => note(along, pair[0]),
        }
    }
    let breaks = if seams.is_empty() { darts } else { seams };
    let mut best = (0.0, 0.0);
    for (i, &from) in breaks.iter().enumerate() {
        let to = breaks.get(i + 1).copied().unwrap_or(breaks[0] + along);
        // Equal gaps: the first.
        if to - from > best.0 * (1.0 + 1e-9) {
            best = (to - from, f64::midpoint(from, to));
        }
    }
    let middle = best.1 % along;
    let (before, h) =
        edges.iter().copied().take_while(|&(at, _)| at <= middle).last().ok_or_else(lost)?;
    Ok(on_edge(h, (middle - before) / disk.length(h)))
}

fn on_edge(h: HalfEdgeId, part: f64) -> SurfacePoint {
    let mut weights = [0.0; 3];
    let part = part.clamp(0.0, 1.0);
    weights[h.corner()] = 1.0 - part;
    weights[(h.corner() + 1) % 3] = part;
    SurfacePoint { triangle: h.triangle(), barycentric: DVec3::from_array(weights) }
}

/// Where the boundary crosses the plane through the middle that holds the long axis and is upright
/// on the piece, farthest out on both sides; the farthest point where an end is closed.
fn axis_ends(disk: &Surface) -> Result<[SurfacePoint; 2], SeamError> {
    let (middle, spread) = moments(disk);
    let axis = principal(spread);
    let across = principal(spread - outer(axis) * axis.dot(spread * axis));
    let mut far: [Option<(f64, SurfacePoint)>; 2] = [None, None];
    for h in disk.boundary_loops().iter().flat_map(|l| l.half_edges.iter().copied()) {
        let (p, q) = (disk.point(disk.from(h)) - middle, disk.point(disk.to(h)) - middle);
        let (a, b) = (p.dot(across), q.dot(across));
        if (a > 0.0) == (b > 0.0) {
            continue;
        }
        let part = a / (a - b);
        let out = p.lerp(q, part).dot(axis);
        let side = &mut far[usize::from(out < 0.0)];
        if side.is_none_or(|(best, _)| out.abs() > best) {
            *side = Some((out.abs(), on_edge(h, part)));
        }
    }
    let [ahead, behind] = far;
    let lost = || SeamError::Internal("the piece has no extent along its axis".to_owned());
    let (ahead, first) = ahead.or_else(|| farthest(disk, middle, axis)).ok_or_else(lost)?;
    let (behind, second) = behind.or_else(|| farthest(disk, middle, -axis)).ok_or_else(lost)?;
    // The middle of the area lies nearer to the wider end; of equal ones the first is the one
    // nearer to the first vertex, which stays so however the limb is turned in space.
    let length = ahead + behind;
    let first_is_ahead = if (ahead - behind).abs() > 1e-6 * length {
        ahead < behind
    } else {
        (disk.points()[0] - middle).dot(axis) >= 0.0
    };
    Ok(if first_is_ahead { [first, second] } else { [second, first] })
}

/// The vertex farthest along a direction: the toe of a sock, whose far end is closed.
fn farthest(disk: &Surface, middle: DVec3, along: DVec3) -> Option<(f64, SurfacePoint)> {
    let out = |v: VertexId| (disk.point(v) - middle).dot(along);
    let v = disk.vertex_ids().reduce(|best, v| if out(v) > out(best) { v } else { best })?;
    let h = disk.outgoing(v).next()?;
    Some((out(v), on_edge(h, 0.0)))
}

/// The middle of the area and its second moments about it.
fn moments(disk: &Surface) -> (DVec3, DMat3) {
    let mut area = 0.0;
    let mut sum = DVec3::ZERO;
    for t in disk.triangle_ids() {
        area += disk.area(t);
        sum += disk.area(t) * disk.corners(t).iter().sum::<DVec3>() / 3.0;
    }
    let middle = sum / area;
    let mut spread = DMat3::ZERO;
    for t in disk.triangle_ids() {
        let p = disk.corners(t).map(|p| p - middle);
        let s: DVec3 = p.iter().sum();
        // ∫ x xᵀ over a triangle = area / 12 · (Σ pᵢ pᵢᵀ + s sᵀ), s = Σ pᵢ.
        spread += (outer(p[0]) + outer(p[1]) + outer(p[2]) + outer(s)) * (disk.area(t) / 12.0);
    }
    (middle, spread)
}

fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// The direction of the largest eigenvalue, by squaring: 30 times tells eigenvalues apart that
/// differ by one part in 10⁸ and leaves others, which only rounding tells apart, undecided.
fn principal(matrix: DMat3) -> DVec3 {
    let mut m = matrix;
    for _ in 0..30 {
        let size = m.x_axis.length().max(m.y_axis.length()).max(m.z_axis.length());
        if size > 0.0 {
            m *= 1.0 / size;
        }
        m = m * m;
    }
    let columns = [m.x_axis, m.y_axis, m.z_axis];
    let largest = columns.into_iter().fold(DVec3::ZERO, |best, c| {
        if c.length() > best.length() * (1.0 + 1e-9) { c } else { best }
    });
    largest.normalize_or(DVec3::X)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::super::fixtures::{Mesh, cylinder, frustum, slit_cylinder, strip};
    use super::super::open_to_disk;
    use super::*;

    fn angle(p: DVec3) -> f64 {
        p.y.atan2(p.x)
    }

    fn turn(a: f64, b: f64) -> f64 {
        (a - b).rem_euclid(TAU)
    }

    #[test]
    fn a_cut_tube_is_marked_opposite_its_seam_the_wide_end_first() {
        for mesh in Mesh::ALL {
            let s = frustum(35.0, 50.0, 200.0, mesh);
            let cut = open_to_disk(&s, &[]).unwrap();
            let (markers, warnings) = place(&cut, None).unwrap();
            assert!(markers.automatic);
            assert_eq!(warnings.len(), 1);
            assert_eq!(warnings[0].code, "orientation_automatic");
            let [first, second] = markers.points.map(|p| p.position(&cut.disk));
            assert!((first.z - 200.0).abs() < 1e-9 && second.z.abs() < 1e-9, "{first} {second}");
            let seam = &cut.seams[0].left;
            for (marker, end) in [(first, seam[0]), (second, seam[seam.len() - 1])] {
                let off = turn(angle(marker), angle(cut.disk.point(end))) - TAU / 2.0;
                assert!(off.abs() < 0.02, "{mesh:?} {off}");
            }
        }
    }

    #[test]
    fn a_sock_is_marked_from_its_opening_to_its_toe() {
        let (sides, rows) = (24, 30);
        let ring = |k: usize| {
            let far = 150.0 * k as f64 / rows as f64;
            let radius = 40.0 * (1.0 - (far / 150.0).powi(4)).sqrt();
            (0..sides).map(move |i| {
                let (sin, cos) = (TAU * i as f64 / sides as f64).sin_cos();
                DVec3::new(radius * cos, radius * sin, far)
            })
        };
        let mut points: Vec<DVec3> = (0..rows).flat_map(ring).collect();
        points.push(DVec3::new(0.0, 0.0, 150.0));
        let id = |k: usize, i: usize| VertexId::new(k * sides + i % sides);
        let mut triangles = Vec::new();
        for i in 0..sides {
            for k in 0..rows - 1 {
                triangles.push([id(k, i), id(k, i + 1), id(k + 1, i + 1)]);
                triangles.push([id(k, i), id(k + 1, i + 1), id(k + 1, i)]);
            }
            triangles.push([id(rows - 1, i), id(rows - 1, i + 1), VertexId::new(rows * sides)]);
        }
        let cut = open_to_disk(&Surface::new(points, triangles).unwrap(), &[]).unwrap();
        let (markers, warnings) = place(&cut, None).unwrap();
        let [opening, toe] = markers.points.map(|p| p.position(&cut.disk));
        assert!(opening.z.abs() < 1e-9 && toe.z > 140.0, "{opening} {toe}");
        assert_eq!(warnings[0].code, "orientation_automatic");
    }

    #[test]
    fn a_limb_that_came_slit_is_marked_like_a_cut_one() {
        let cut = open_to_disk(&slit_cylinder(40.0, 150.0), &[]).unwrap();
        let (markers, _) = place(&cut, None).unwrap();
        for p in markers.points.map(|p| p.position(&cut.disk)) {
            assert!(p.distance(DVec3::new(-40.0, 0.0, p.z)) < 1e-9, "{p}");
        }
    }

    #[test]
    fn a_flat_piece_is_marked_at_the_ends_of_its_long_axis_the_wide_one_first() {
        // A trapezium, 80 wide at y = 0 and 60 at y = 300: the middle of its area is lower.
        let s = strip(80.0, 300.0);
        let narrow = |p: &DVec3| DVec3::new((p.x - 40.0) * (1.0 - p.y / 1200.0), p.y, 0.0);
        let s = s.with_points(s.points().iter().map(narrow).collect());
        let cut = open_to_disk(&s, &[]).unwrap();
        let (markers, _) = place(&cut, None).unwrap();
        let [first, second] = markers.points.map(|p| p.position(&cut.disk));
        assert!(first.distance(DVec3::ZERO) < 1e-6, "{first}");
        assert!(second.distance(DVec3::new(0.0, 300.0, 0.0)) < 1e-6, "{second}");
    }

    #[test]
    fn given_markers_are_projected_and_wrong_ones_named() {
        let cut = open_to_disk(&cylinder(40.0, 200.0, Mesh::Right), &[]).unwrap();
        let given = [DVec3::new(0.0, 45.0, 150.0), DVec3::new(0.0, 40.0, 20.0)];
        let (markers, warnings) = place(&cut, Some(given)).unwrap();
        assert!(!markers.automatic && warnings.is_empty());
        let first = markers.points[0].position(&cut.disk);
        assert!(first.distance(DVec3::new(0.0, 40.0, 150.0)) < 0.1, "{first}");
        let text = place(&cut, Some([given[0], DVec3::new(0.0, 52.0, 20.0)])).unwrap_err();
        assert!(text.to_string().starts_with("orientation marker 2, (0.0, 52.0, 20.0), lies 12."));
        let error = place(&cut, Some([given[0], given[0] + DVec3::Z])).unwrap_err();
        assert!(matches!(error, SeamError::MarkersCoincide { .. }), "{error}");
        let nan = place(&cut, Some([DVec3::NAN, given[0]])).unwrap_err();
        assert!(matches!(nan, SeamError::MarkerFar { marker: 1, .. }));
    }
}
