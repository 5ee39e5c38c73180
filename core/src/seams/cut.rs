//! Cuts a tube open into a disk, along smooth curves through the triangles.
//!
//! The automatic seam is the shortest straight path between the tube's two end loops; a designer's
//! seam joins the given points by straight paths. Each is carved into the triangulation and cut.
//! Limits: planar surfaces only (no handles), and a path is locally shortest.

use glam::DVec3;

use super::cutter::Cutter;
use super::error::SeamError;
use super::pieces::{Joined, join};
use super::sewing::{Seam, Sewing};
use super::shape::{Shape, same_edge};
use crate::surface::{HalfEdgeId, Surface, VertexId};
use crate::warning::Warning;

/// A surface cut open to a disk, perhaps with cut-outs.
#[derive(Debug, Clone, PartialEq)]
pub struct CutSurface {
    /// The disk, in mm. Its triangles are those of the surface in their order, split where a seam runs and where
    /// [`Finer`](super::Finer) splits them; a vertex cut in two keeps its index on one side.
    pub disk: Surface,
    /// What is sewn together again.
    pub seams: Vec<Seam>,
    /// Chains of vertices inside the disk along which the pattern is cut apart into pieces and sewn
    /// together again.
    pub splits: Vec<Vec<VertexId>>,
    /// The two ends of the limb, if the sewn surface is a tube.
    pub ends: Option<Ends>,
    /// What the designer should know.
    pub warnings: Vec<Warning>,
}

/// The two ends of a cut tube: the edges of the brace that go round the limb.
///
/// Each is a run of boundary vertices of the disk in the boundary's direction (the surface on the
/// left), from one copy of a seam's end to the other. Where another seam begins in between, both
/// copies of its end are listed.
#[derive(Debug, Clone, PartialEq)]
pub struct Ends {
    /// The end near the body: of the two longest edges the longer.
    pub proximal: Vec<VertexId>,
    /// The far end.
    pub distal: Vec<VertexId>,
    /// Girths of the proximal and the distal end, in mm.
    pub girths: [f64; 2],
}

impl CutSurface {
    /// The same cut with the end nearer to `marker` as the proximal one, and the seams in order
    /// from there.
    #[must_use]
    pub fn with_proximal_at(mut self, marker: DVec3) -> Self {
        let Some(ends) = &mut self.ends else { return self };
        let gap = |end: &[VertexId]| {
            end.iter().map(|&v| self.disk.point(v).distance(marker)).fold(f64::INFINITY, f64::min)
        };
        if gap(&ends.distal) < gap(&ends.proximal) {
            std::mem::swap(&mut ends.proximal, &mut ends.distal);
            ends.girths.reverse();
            self.seams = self.seams.into_iter().map(Seam::reversed).collect();
        }
        self
    }
}

/// Cuts the surface open: a disk is taken as it is unless there are `seams`; a tube is cut along
/// them, polylines of points in mm near the surface, or where there are none along its shortest
/// straight seam. The two longest edges of a tube are its ends, further ones stay as cut-outs.
///
/// Seams that split the surface are joined again for the fit, see [`CutSurface::splits`].
///
/// # Errors
/// If the surface is closed or has handles, if a seam's point is far from it, or if the seams do
/// not leave it open from end to end.
pub fn open_to_disk(surface: &Surface, seams: &[Vec<DVec3>]) -> Result<CutSurface, SeamError> {
    let shape = Shape::of(surface)?;
    let mut warnings = shape.warnings.clone();
    if seams.is_empty() && shape.tube.is_none() {
        return finish(surface.clone(), &shape, warnings);
    }
    let mut cutter = Cutter::new(surface, &shape);
    if let (true, Some(ends)) = (seams.is_empty(), shape.tube) {
        warnings.push(cutter.automatic(&shape, ends)?);
    }
    for (i, seam) in seams.iter().enumerate() {
        cutter.designed(i + 1, seam, &shape.sewn)?;
    }
    let Joined { disk, splits, warning } = join(cutter.cut()?)?;
    warnings.extend(warning);
    let cut = finish(disk, &shape, warnings)?;
    Ok(CutSurface { splits, ..cut })
}

/// Checks the cut surface and finds its seams and ends.
fn finish(disk: Surface, shape: &Shape, warnings: Vec<Warning>) -> Result<CutSurface, SeamError> {
    one_piece(&disk)?;
    let sewing = Sewing::new(&disk);
    let around = sewing.sewn_loops();
    // The loops of the sewn surface are those from before; every one has vertices from then.
    let old = |l: &[HalfEdgeId]| {
        l.iter().find_map(|&h| shape.loop_of.get(disk.from(h).index()).copied().flatten())
    };
    let find = |i: usize| around.iter().find(|l| old(l) == Some(i));
    let mut ends = None;
    if let Some([proximal, distal]) = shape.ends {
        let lost = || SeamError::Internal("an end of the tube is lost in the cut".to_owned());
        let (p, d) = (find(proximal).ok_or_else(lost)?, find(distal).ok_or_else(lost)?);
        if !same_edge(&disk, p[0], d[0]) {
            let middles = [proximal, distal].map(|i| shape.middle(disk.points(), i));
            let uncut = [p, d].map(|l| run(&disk, l).1);
            return Err(match uncut {
                [false, false] => {
                    SeamError::EndsNotJoined { proximal: middles[0], distal: middles[1] }
                }
                [true, _] => {
                    SeamError::EndNotReached { girth: shape.lengths[proximal], near: middles[0] }
                }
                [_, true] => {
                    SeamError::EndNotReached { girth: shape.lengths[distal], near: middles[1] }
                }
            });
        }
        ends = Some(Ends {
            proximal: run(&disk, p).0,
            distal: run(&disk, d).0,
            girths: [p, d].map(|l| l.iter().map(|&h| disk.length(h)).sum()),
        });
    }
    let seams = sewing.seams().into_iter().map(|seam| direct(&disk, seam, ends.as_ref())).collect();
    Ok(CutSurface { seams, splits: Vec::new(), ends, warnings, disk })
}

/// The vertices along a loop of the sewn surface, beginning where the disk's boundary leaves it;
/// and whether the disk's boundary never does.
fn run(disk: &Surface, around: &[HalfEdgeId]) -> (Vec<VertexId>, bool) {
    let count = around.len();
    let breaks = |i: usize| disk.to(around[(i + count - 1) % count]) != disk.from(around[i]);
    let start = (0..count).find(|&i| breaks(i));
    let mut vertices = Vec::with_capacity(count + 1);
    for i in 0..count {
        let i = (start.unwrap_or(0) + i) % count;
        if vertices.last() != Some(&disk.from(around[i])) {
            vertices.push(disk.from(around[i]));
        }
        vertices.push(disk.to(around[i]));
    }
    (vertices, start.is_none())
}

/// The seam from its proximal end; on a piece without ends from where it opens.
fn direct(disk: &Surface, seam: Seam, ends: Option<&Ends>) -> Seam {
    let (Some(&[first, one]), Some(&[last, other])) = (
        seam.left.first().zip(seam.right.first()).map(|(&a, &b)| [a, b]).as_ref(),
        seam.left.last().zip(seam.right.last()).map(|(&a, &b)| [a, b]).as_ref(),
    ) else {
        return seam;
    };
    let Some(ends) = ends else {
        return if first == one && last != other { seam.reversed() } else { seam };
    };
    let touches = |end: &[VertexId], a: VertexId, b: VertexId| end.contains(&a) || end.contains(&b);
    let backward = if touches(&ends.proximal, first, one) {
        false
    } else if touches(&ends.proximal, last, other) || touches(&ends.distal, first, one) {
        true
    } else if touches(&ends.distal, last, other) {
        false
    } else {
        let sum: DVec3 = ends.proximal.iter().map(|&v| disk.point(v)).sum();
        let middle = sum / ends.proximal.len() as f64;
        disk.point(last).distance(middle) < disk.point(first).distance(middle)
    };
    if backward { seam.reversed() } else { seam }
}

fn one_piece(disk: &Surface) -> Result<(), SeamError> {
    let (component, pieces) = disk.components();
    if pieces == 1 {
        return Ok(());
    }
    let mut area = vec![0.0; pieces];
    let mut middle = vec![DVec3::ZERO; pieces];
    for t in disk.triangle_ids() {
        let c = component[t.index()];
        area[c] += disk.area(t);
        middle[c] += disk.area(t) * disk.corners(t).iter().sum::<DVec3>() / 3.0;
    }
    let least = (0..pieces).fold(0, |best, c| if area[c] < area[best] { c } else { best });
    Err(SeamError::Split { pieces, area: area[least], near: middle[least] / area[least] })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use glam::{DMat3, DQuat};

    use super::super::fixtures::{
        Mesh, Noise, annulus, cylinder, cylinder_with_hole, frustum, round, slit_cylinder,
        smallest_corner, sphere, strip, torus, tube,
    };
    use super::super::region::clip;
    use super::*;
    use crate::design::RegionPlane;

    fn length(s: &Surface, chain: &[VertexId]) -> f64 {
        chain.windows(2).map(|w| s.point(w[0]).distance(s.point(w[1]))).sum()
    }

    /// What every cut must keep: pairs coincide in order, the area stays, the disk is planar.
    fn check(before: &Surface, cut: &CutSurface, loops: usize) {
        let disk = &cut.disk;
        assert_eq!(disk.components().1, 1);
        assert_eq!(disk.boundary_loops().len(), loops);
        assert_eq!(disk.euler_characteristic(), 2 - i64::try_from(loops).unwrap());
        assert!((disk.total_area() / before.total_area() - 1.0).abs() < 1e-3);
        assert!(smallest_corner(disk) > 0.25 * smallest_corner(before).min(0.35));
        let mut sewn = 0;
        for seam in &cut.seams {
            assert_eq!(seam.left.len(), seam.right.len());
            for (l, r) in seam.left.iter().zip(&seam.right) {
                assert_eq!(disk.point(*l), disk.point(*r));
            }
            for i in 1..seam.left.len() {
                // The surface lies to the left of `left` and to the right of `right`.
                let edge = |a: VertexId, b: VertexId| disk.outgoing(a).find(|&h| disk.to(h) == b);
                let left = edge(seam.left[i - 1], seam.left[i]).unwrap();
                let right = edge(seam.right[i], seam.right[i - 1]).unwrap();
                assert!(disk.twin(left).is_none() && disk.twin(right).is_none());
                sewn += 2;
            }
        }
        let sewing = Sewing::new(disk);
        assert_eq!(disk.half_edges().filter(|&h| sewing.partner(h).is_some()).count(), sewn);
    }

    /// Greatest distance, along the girth, of a seam from the generator through its start.
    fn aside(disk: &Surface, chain: &[VertexId]) -> f64 {
        let angle = |v: VertexId| disk.point(v).y.atan2(disk.point(v).x);
        let off = |v| (angle(v) - angle(chain[0]) + PI).rem_euclid(TAU) - PI;
        chain.iter().map(|&v| 40.0 * f64::abs(off(v))).fold(0.0, f64::max)
    }

    #[test]
    fn the_automatic_seam_of_a_cylinder_is_a_straight_generator_on_any_triangulation() {
        for mesh in Mesh::ALL {
            let s = cylinder(40.0, 200.0, mesh);
            let cut = open_to_disk(&s, &[]).unwrap();
            check(&s, &cut, 1);
            assert_eq!(cut.seams.len(), 1);
            assert_eq!(cut.warnings.len(), 1);
            assert_eq!(cut.warnings[0].code, "seam_automatic");
            let chain = &cut.seams[0].left;
            let long = length(&cut.disk, chain);
            assert!((long / 200.0 - 1.0).abs() < 2e-4, "{mesh:?} {long}");
            let aside = aside(&cut.disk, chain);
            assert!(aside < 0.2, "{mesh:?} {aside}");
            let ends = cut.ends.as_ref().unwrap();
            for (end, girth) in [&ends.proximal, &ends.distal].into_iter().zip(ends.girths) {
                assert!((length(&cut.disk, end) - girth).abs() < 1e-9);
                assert!((girth / (TAU * 40.0) - 1.0).abs() < 2e-3, "{girth}");
            }
        }
    }

    #[test]
    fn the_seam_runs_from_the_wide_end_with_its_left_side_on_the_left() {
        for mesh in Mesh::ALL {
            // Wide end on top: seen from outside, walking down, left is counter-clockwise.
            let s = frustum(35.0, 50.0, 200.0, mesh);
            let cut = open_to_disk(&s, &[]).unwrap();
            check(&s, &cut, 1);
            let seam = &cut.seams[0];
            let long = length(&cut.disk, &seam.left);
            let exact = f64::hypot(200.0, 15.0);
            assert!((long / exact - 1.0).abs() < 5e-4, "{mesh:?} {long} {exact}");
            assert!(cut.disk.point(seam.left[0]).z > 199.9);
            let v = seam.left[seam.left.len() / 2];
            let p = cut.disk.point(v);
            for w in cut.disk.neighbours(v) {
                let q = cut.disk.point(w);
                assert!(p.cross(q).z > -1.0, "{mesh:?} {p} {q}");
            }
            let girths = cut.ends.as_ref().unwrap().girths;
            assert!(girths[0] > girths[1]);
            let turned = cut.clone().with_proximal_at(DVec3::new(35.0, 0.0, 0.0));
            assert_eq!(turned.seams[0].left[0], *seam.right.last().unwrap());
            assert_eq!(turned.ends.as_ref().unwrap().girths, [girths[1], girths[0]]);
            check(&s, &turned, 1);
            assert_eq!(cut.clone().with_proximal_at(p.with_z(200.0)), cut);
        }
    }

    #[test]
    fn the_seam_keeps_away_from_a_cut_out_in_its_way() {
        for mesh in Mesh::ALL {
            // Shortest where the window is.
            let place = |u: f64, v: f64| {
                let reach = 1.3 - 0.3 * (TAU * (u - 0.5)).cos();
                round(40.0, u - 0.5, 100.0 + 200.0 * (v - 0.5) * reach)
            };
            let window = |i, j| (20..28).contains(&i) && (17..23).contains(&j);
            let s = tube(48, 40, mesh, place, window);
            let cut = open_to_disk(&s, &[]).unwrap();
            check(&s, &cut, 2);
            let rim = cut
                .disk
                .boundary_loops()
                .iter()
                .min_by(|a, b| cut.disk.loop_length(a).total_cmp(&cut.disk.loop_length(b)));
            let rim: Vec<DVec3> =
                cut.disk.loop_vertices(rim.unwrap()).map(|v| cut.disk.point(v)).collect();
            let chain = &cut.seams[0].left;
            let gap = |v: &VertexId| {
                rim.iter().map(|p| p.distance(cut.disk.point(*v))).fold(f64::INFINITY, f64::min)
            };
            let least = chain.iter().map(gap).fold(f64::INFINITY, f64::min);
            assert!((9.0..20.0).contains(&least), "{mesh:?} {least}");
        }
    }

    #[test]
    fn a_disk_is_taken_as_it_is_and_a_slit_tube_as_cut() {
        let s = strip(80.0, 300.0);
        let cut = open_to_disk(&s, &[]).unwrap();
        assert_eq!((&cut.disk, cut.seams.len(), &cut.ends), (&s, 0, &None));
        assert!(cut.warnings.is_empty());
        let s = slit_cylinder(40.0, 200.0);
        let cut = open_to_disk(&s, &[]).unwrap();
        assert_eq!(cut.disk, s);
        check(&s, &cut, 1);
        assert_eq!(cut.seams.len(), 1);
        assert_eq!(cut.seams[0].left.len(), 41);
        let ends = cut.ends.as_ref().unwrap();
        assert_eq!((ends.proximal.len(), ends.distal.len()), (49, 49));
        let first = cut.disk.point(cut.seams[0].left[0]).z;
        assert_eq!(first, cut.disk.point(ends.proximal[0]).z);
        // A flat ring is a piece with a cut-out, a steep one a tube.
        let flat = open_to_disk(&annulus(60.0, 120.0, 10.0), &[]).unwrap();
        assert_eq!((flat.seams.len(), flat.warnings[0].code), (0, "taken_as_patch"));
        let steep = open_to_disk(&annulus(60.0, 120.0, 60.0), &[]).unwrap();
        assert_eq!((steep.seams.len(), steep.warnings[0].code), (1, "seam_automatic"));
    }

    #[test]
    fn a_drawn_seam_goes_straight_from_point_to_point_and_is_extended_to_the_ends() {
        for mesh in Mesh::ALL {
            let s = cylinder(40.0, 200.0, mesh);
            // 3 mm outside, 6 mm short of both ends, bent at two thirds.
            let points = [round(43.0, 0.1, 6.0), round(38.0, 0.2, 130.0), round(41.0, 0.15, 194.0)];
            let cut = open_to_disk(&s, &[points.to_vec()]).unwrap();
            check(&s, &cut, 1);
            assert!(cut.warnings.is_empty());
            assert_eq!(cut.seams.len(), 1);
            let arc = TAU * 40.0;
            let exact = f64::hypot(124.0, 0.1 * arc) + f64::hypot(64.0, 0.05 * arc) + 12.0;
            let long = length(&cut.disk, &cut.seams[0].left);
            assert!((long / exact - 1.0).abs() < 4e-3, "{mesh:?} {long} {exact}");
            for p in [points[0], points[1], points[2]] {
                let on = round(40.0, p.y.atan2(p.x) / TAU, p.z);
                let gap = |v: &VertexId| cut.disk.point(*v).distance(on);
                let gap = cut.seams[0].left.iter().map(gap).fold(f64::INFINITY, f64::min);
                // Vertices of the seam are up to 7 mm apart; at the ends it is led straight on.
                assert!(gap < 3.0, "{mesh:?} {gap}");
            }
        }
    }

    #[test]
    fn seams_to_and_from_a_cut_out_open_the_tube_and_a_dart_ends_inside() {
        for mesh in Mesh::ALL {
            let s = cylinder_with_hole(mesh);
            let down = vec![round(40.0, 0.0, 0.0), round(40.0, 0.0, 84.0)];
            let up = vec![round(40.0, 0.01, 118.0), round(40.0, 0.0, 200.0)];
            let dart = vec![round(40.0, 0.5, 200.0), round(40.0, 0.52, 150.0)];
            let cut = open_to_disk(&s, &[down, up, dart]).unwrap();
            check(&s, &cut, 1);
            assert_eq!(cut.seams.len(), 3);
            let tips: Vec<&Seam> =
                cut.seams.iter().filter(|seam| seam.left.last() == seam.right.last()).collect();
            let starts = cut.seams.iter().filter(|m| m.left.first() == m.right.first()).count();
            // From the proximal end a dart at the far end comes tip first.
            assert_eq!(tips.len() + starts, 1, "{mesh:?}");
        }
        let s = strip(80.0, 300.0);
        let slit = vec![DVec3::new(40.0, 100.0, 0.0), DVec3::new(-3.0, 110.0, 0.0)];
        let cut = open_to_disk(&s, &[slit]).unwrap();
        check(&s, &cut, 1);
        let seam = &cut.seams[0];
        assert_eq!(seam.left.last(), seam.right.last());
        assert_ne!(seam.left.first(), seam.right.first());
        assert!((length(&cut.disk, &seam.left) - f64::hypot(40.0, 10.0)).abs() < 0.5);
    }

    #[test]
    fn a_second_seam_may_begin_on_the_first_and_cross_none() {
        let s = cylinder(40.0, 200.0, Mesh::Random(3));
        let main = vec![round(40.0, 0.0, 0.0), round(40.0, 0.0, 200.0)];
        let branch = vec![round(40.0, 0.01, 100.0), round(40.0, 0.2, 110.0)];
        let cut = open_to_disk(&s, &[main.clone(), branch]).unwrap();
        check(&s, &cut, 1);
        assert_eq!(cut.seams.len(), 3);
        let total: f64 = cut.seams.iter().map(|m| length(&cut.disk, &m.left)).sum();
        assert!((total - 200.0 - f64::hypot(0.2 * TAU * 40.0, 10.0)).abs() < 1.5, "{total}");
        let across =
            vec![round(40.0, -0.1, 200.0), round(40.0, 0.1, 100.0), round(40.0, -0.1, 0.0)];
        let cut = open_to_disk(&s, &[main, across]).unwrap();
        check(&s, &cut, 1);
        assert_eq!((cut.splits.len(), cut.warnings[0].code), (3, "cut_apart"));
    }

    #[test]
    fn two_seams_from_end_to_end_make_two_pieces_of_one_disk() {
        for mesh in Mesh::ALL {
            let s = cylinder(40.0, 200.0, mesh);
            let seam = |u: f64| vec![round(40.0, u, 200.0), round(40.0, u, 0.0)];
            let cut = open_to_disk(&s, &[seam(0.0), seam(0.3)]).unwrap();
            check(&s, &cut, 1);
            assert_eq!((cut.seams.len(), cut.splits.len()), (1, 1), "{mesh:?}");
            assert_eq!(cut.warnings[0].code, "cut_apart");
            let chain = &cut.splits[0];
            assert!((length(&cut.disk, chain) / 200.0 - 1.0).abs() < 1e-3);
            // Inside the disk but for its ends.
            for v in &chain[1..chain.len() - 1] {
                assert!(!cut.disk.is_boundary_vertex(*v));
            }
            // Vertices of the surface keep their place in the list; near a seam some are moved onto it.
            let near = |p: DVec3| {
                let turn = p.y.atan2(p.x) / TAU;
                [0.0, 0.3]
                    .into_iter()
                    .any(|u| (turn - u).rem_euclid(1.0).min((u - turn).rem_euclid(1.0)) < 0.04)
            };
            for v in s.vertex_ids().filter(|&v| !near(s.point(v))) {
                assert_eq!(s.point(v), cut.disk.point(v), "{mesh:?}");
            }
        }
    }

    #[test]
    fn a_ring_and_a_seam_along_make_an_upper_and_a_lower_piece() {
        let s = cylinder(40.0, 200.0, Mesh::Random(5));
        let along = vec![round(40.0, 0.0, 200.0), round(40.0, 0.0, 0.0)];
        let ring: Vec<DVec3> = (0..=8).map(|k| round(40.0, f64::from(k) / 8.0, 110.0)).collect();
        let cut = open_to_disk(&s, &[along, ring]).unwrap();
        check(&s, &cut, 1);
        assert_eq!(cut.splits.len(), 1);
        let chain = &cut.splits[0];
        let long = length(&cut.disk, chain);
        assert!((long / (TAU * 40.0) - 1.0).abs() < 0.02, "{long}");
    }

    #[test]
    fn what_cannot_be_cut_is_named_with_the_remedy() {
        let text =
            |s: &Surface, seams: &[Vec<DVec3>]| open_to_disk(s, seams).unwrap_err().to_string();
        assert!(text(&sphere(50.0), &[]).contains("give two region planes"));
        assert!(text(&torus(60.0, 20.0), &[]).contains("1 handle:"));
        let s = cylinder(40.0, 200.0, Mesh::Right);
        let far = text(&s, &[vec![round(40.0, 0.0, 0.0), round(55.0, 0.0, 100.0)]]);
        assert!(far.starts_with("point 2 of seam 1, (55.0, 0.0, 100.0), lies 15.0 mm"), "{far}");
        assert!(text(&s, &[vec![DVec3::NAN, DVec3::ZERO]]).starts_with("point 1 of seam 1"));
        assert!(text(&s, &[vec![DVec3::ZERO]]).starts_with("seam 1 has 1 point:"));
        let inside = text(&s, &[vec![round(40.0, 0.0, 50.0), round(40.0, 0.0, 100.0)]]);
        assert!(inside.contains("begins (40.0, 0.0, 50.0) and ends"), "{inside}");
        let short = text(&s, &[vec![round(40.0, 0.0, 200.0), round(40.0, 0.0, 50.0)]]);
        assert!(
            short.contains("no seam reaches the 251 mm long end near (0.0, 0.0, 0.0) within 10 mm"),
            "{short}"
        );
        let darts = |z: f64, w: f64| vec![round(40.0, 0.0, z), round(40.0, 0.0, w)];
        let apart = text(&s, &[darts(200.0, 150.0), darts(0.0, 50.0)]);
        assert!(apart.contains("do not meet"), "{apart}");
        let (p, t) = (s.points(), s.triangles());
        let n = p.len();
        let twice = p.iter().copied().chain(p.iter().map(|p| p + DVec3::X * 500.0)).collect();
        let shifted = t.iter().map(|c| c.map(|v| VertexId::new(v.index() + n)));
        let pair = Surface::new(twice, t.iter().copied().chain(shifted).collect()).unwrap();
        assert!(text(&pair, &[]).starts_with("internal fault"));
    }

    #[test]
    fn the_same_limb_is_cut_alike_again_and_turned_in_space() {
        for mesh in Mesh::ALL {
            let s = frustum(37.0, 50.0, 200.0, mesh);
            let cut = open_to_disk(&s, &[]).unwrap();
            assert_eq!(cut, open_to_disk(&s, &[]).unwrap());
            let turn = DMat3::from_quat(DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -1.1, 2.0));
            let moved = |p: &DVec3| turn * *p + DVec3::new(120.0, -40.0, 700.0);
            let t = s.with_points(s.points().iter().map(moved).collect());
            let other = open_to_disk(&t, &[]).unwrap();
            let parts = |c: &CutSurface| (c.disk.vertex_count(), c.seams[0].left.len());
            assert_eq!(parts(&other), parts(&cut), "{mesh:?}");
            assert!(other.disk.triangles() == cut.disk.triangles(), "{mesh:?}");
            assert_eq!(other.seams, cut.seams);
            for (p, q) in cut.disk.points().iter().zip(other.disk.points()) {
                assert!(moved(p).distance(*q) < 1e-5, "{mesh:?} {}", moved(p).distance(*q));
            }
        }
    }

    #[test]
    fn random_bent_limbs_are_clipped_and_cut_whole() {
        for seed in 0..40 {
            let mut noise = Noise(seed);
            let [bend, swell, oval] = [0.6, 8.0, 5.0].map(|most| most * noise.next());
            let place = |u: f64, v: f64| {
                let radius = 40.0 + swell * (6.0 * v).sin() + oval * v * (2.0 * TAU * u).cos();
                let (p, along) = (round(radius, u, 0.0), 200.0 * (v - 0.5));
                let (sin, cos) = (2.0 * bend * (v - 0.5)).sin_cos();
                DVec3::new(p.x * cos + along * sin, p.y, along * cos - p.x * sin)
            };
            let limb = tube(48, 40, Mesh::Random(seed), place, |_, _| false);
            let mut plane = |z: f64| RegionPlane {
                point: DVec3::new(0.0, 0.0, z + 10.0 * noise.next()),
                normal: DVec3::new(0.3 * noise.next(), 0.3 * noise.next(), -z.signum()),
            };
            let planes = [plane(-60.0), plane(60.0)];
            let s = clip(&limb, &planes).unwrap().surface;
            let cut = open_to_disk(&s, &[]).unwrap();
            check(&s, &cut, 1);
            let automatic = length(&cut.disk, &cut.seams[0].left);
            // A zigzag through vertices, 3 mm off the limb, is longer than the shortest way.
            let ends = cut.ends.as_ref().unwrap();
            let [top, bottom] = [&ends.proximal, &ends.distal].map(|end| cut.disk.point(end[9]));
            let between = |part: f64| {
                let p = top.lerp(bottom, part) + 20.0 * noise.next() * DVec3::Y;
                let near = |q: &&DVec3| q.distance(p);
                let all = s.points().iter();
                *all.min_by(|a, b| near(a).total_cmp(&near(b))).unwrap() + DVec3::X * 3.0
            };
            let [a, b] = [0.35, 0.7].map(between);
            let drawn = open_to_disk(&s, &[vec![top, a, b, bottom]]).unwrap();
            check(&s, &drawn, 1);
            assert_eq!(drawn.seams.len(), 1, "{seed}");
            assert!(length(&drawn.disk, &drawn.seams[0].left) > automatic - 0.5, "{seed}");
        }
    }
}
