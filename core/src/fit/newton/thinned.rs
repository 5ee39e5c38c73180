//! A surface with fewer vertices, laid out over the same plane.
//!
//! Some of the surface's vertices, evenly spread over its parameterization, with the constrained Delaunay
//! triangulation (the crate spade) of their places there; chords of the boundary bound it. Vertices that are
//! sewn together are taken together.

use glam::{DVec2, DVec3};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use crate::geometry::Grading;
use crate::seams::Seam;
use crate::surface::{HalfEdgeId, Surface, TriangleId, VertexId};

/// Typical edges of a maximal set of points that keep a distance are longer than that by this.
const SPREAD: f64 = 1.3;

/// Share of that distance which is kept from the boundary's chords.
const FROM_EDGE: f64 = 0.6;

/// A thinned surface.
pub struct Thinned {
    /// The surface.
    pub disk: Surface,
    /// Its seams.
    pub seams: Vec<Seam>,
    /// The vertex of the given surface that each of its vertices is.
    pub origin: Vec<usize>,
    /// Of every vertex of the given surface the triangle that it lies in, or next to where it lies outside, and
    /// its barycentric coordinates there.
    pub places: Vec<(TriangleId, DVec3)>,
}

impl Thinned {
    /// A surface with edges longer by `factor`, or as short as `grading` wants them; `None` where no triangulation of
    /// fewer vertices has its shape.
    pub fn new(
        disk: &Surface,
        seams: &[Seam],
        omega: &[DVec2],
        factor: f64,
        grading: &Grading,
    ) -> Option<Self> {
        let longest = factor * disk.mean_edge_length();
        let lengths: Vec<f64> = disk.points().iter().map(|&p| grading.length(p, longest)).collect();
        let taken = boundary_vertices(disk, seams, &lengths);
        let mut chords = Vec::new();
        for boundary in disk.boundary_loops() {
            let kept: Vec<usize> =
                disk.loop_vertices(boundary).map(VertexId::index).filter(|&v| taken[v]).collect();
            if kept.len() < 3 {
                return None;
            }
            chords.extend((0..kept.len()).map(|k| [kept[k], kept[(k + 1) % kept.len()]]));
        }
        let vertices = spread(disk, omega, &taken, &lengths)?;
        let triangles = triangulated(&vertices, &chords, omega)?;

        let mut became = vec![usize::MAX; disk.vertex_count()];
        triangles.iter().flatten().for_each(|&v| became[v] = 0);
        let origin: Vec<usize> = vertices.into_iter().filter(|&v| became[v] == 0).collect();
        origin.iter().enumerate().for_each(|(k, &v)| became[v] = k);
        let points = origin.iter().map(|&v| disk.points()[v]).collect();
        let triangles = triangles.iter().map(|t| t.map(|v| VertexId::new(became[v]))).collect();
        let thin = Surface::new(points, triangles).ok()?;
        let alike = thin.euler_characteristic() == disk.euler_characteristic()
            && thin.boundary_loops().len() == disk.boundary_loops().len()
            && thin.components().1 == disk.components().1;
        if !alike {
            return None;
        }
        let seams = seams
            .iter()
            .map(|seam| {
                let kept = |side: &[VertexId]| -> Vec<VertexId> {
                    let kept = side.iter().filter(|v| taken[v.index()]);
                    kept.map(|v| VertexId::new(became[v.index()])).collect()
                };
                Seam { left: kept(&seam.left), right: kept(&seam.right) }
            })
            .collect();
        let own: Vec<DVec2> = origin.iter().map(|&v| omega[v]).collect();
        let places = places(disk, omega, &thin, &own, &became)?;
        Some(Self { disk: thin, seams, origin, places })
    }

    /// Lengths of the triangles' edges over the given surface, in mm: those of arcs that leave their ends along
    /// the surface, c (1 + (e·Δn)² / 24) for a chord c along e between normals that differ by Δn.
    pub fn lengths(&self, given: &Surface) -> Vec<[f64; 3]> {
        let thin = &self.disk;
        let mut normals = vec![DVec3::ZERO; thin.vertex_count()];
        for (normal, (triangle, weights)) in given.vertex_normals().iter().zip(&self.places) {
            for (v, weight) in thin.triangle(*triangle).iter().zip(weights.to_array()) {
                normals[v.index()] += weight.max(0.0) * normal;
            }
        }
        let normals: Vec<DVec3> = normals.into_iter().map(DVec3::normalize_or_zero).collect();
        let arc = |h: HalfEdgeId| {
            let (a, b) = (thin.from(h), thin.to(h));
            let chord = thin.point(b) - thin.point(a);
            let turn = chord.normalize_or_zero().dot(normals[b.index()] - normals[a.index()]);
            chord.length() * (1.0 + turn * turn / 24.0)
        };
        thin.triangle_ids().map(|t| std::array::from_fn(|k| arc(HalfEdgeId::of(t, k)))).collect()
    }
}

/// The boundary vertices to take: ends of seams, what is sewn together both or not at all, and others as far apart as
/// edges are to be long there.
fn boundary_vertices(disk: &Surface, seams: &[Seam], lengths: &[f64]) -> Vec<bool> {
    let mut taken = vec![false; disk.vertex_count()];
    let mut sewn = taken.clone();
    for seam in seams {
        for side in [&seam.left, &seam.right] {
            side.iter().for_each(|v| sewn[v.index()] = true);
            side.first().into_iter().chain(side.last()).for_each(|v| taken[v.index()] = true);
        }
    }
    for seam in seams {
        let mut along = 0.0;
        // In edges of the lengths wanted.
        let mut left = seam
            .left
            .windows(2)
            .map(|e| disk.point(e[0]).distance(disk.point(e[1])) / lengths[e[0].index()]);
        let whole: f64 = left.clone().sum();
        let even = whole / whole.round().max(1.0);
        for (l, r) in seam.left.iter().zip(&seam.right) {
            if along >= even {
                (taken[l.index()], taken[r.index()]) = (true, true);
                along -= even;
            }
            along += left.next().unwrap_or(0.0);
        }
    }
    // Seams that meet along their course take what the others take.
    let mut changed = true;
    while changed {
        changed = false;
        for (l, r) in seams.iter().flat_map(|seam| seam.left.iter().zip(&seam.right)) {
            let both = taken[l.index()] || taken[r.index()];
            changed |= both && !(taken[l.index()] && taken[r.index()]);
            (taken[l.index()], taken[r.index()]) = (both, both);
        }
    }
    for boundary in disk.boundary_loops() {
        let edges = &boundary.half_edges;
        // From a vertex that is taken, if there is one.
        let first = edges.iter().position(|&h| taken[disk.from(h).index()]).unwrap_or(0);
        let mut along = 1.0;
        for k in 0..edges.len() {
            let h: HalfEdgeId = edges[(first + k) % edges.len()];
            let v = disk.from(h).index();
            taken[v] |= along >= 1.0 && !sewn[v];
            if taken[v] {
                along = 0.0;
            }
            along += disk.length(h) / lengths[v];
        }
    }
    taken
}

/// The taken vertices and as many others as keep their distance in the plane from each other, for edges of these
/// lengths, in ascending order; `None` in a plane far emptier than a limb's.
fn spread(disk: &Surface, omega: &[DVec2], taken: &[bool], lengths: &[f64]) -> Option<Vec<usize>> {
    /// Cells of the grid for every vertex: a map that draws some places a hundred times too large has more.
    const MOST_CELLS: usize = 100;
    let apart = |v: usize| lengths[v] / SPREAD;
    let farthest = lengths.iter().copied().fold(0.0, f64::max) / SPREAD;
    let low = omega.iter().copied().reduce(DVec2::min).unwrap_or_default();
    let high = omega.iter().copied().reduce(DVec2::max).unwrap_or_default();
    let cells =
        ((high - low) / farthest).floor().as_usizevec2().saturating_add(glam::USizeVec2::ONE);
    if cells.x.saturating_mul(cells.y) > MOST_CELLS * omega.len() {
        return None;
    }
    let cell = |p: DVec2| ((p - low) / farthest).floor().as_usizevec2();
    // What keeps others away, and how far.
    let mut grid: Vec<Vec<(DVec2, f64)>> = vec![Vec::new(); cells.x * cells.y];
    let add = |grid: &mut Vec<Vec<(DVec2, f64)>>, p: DVec2, away: f64| {
        let c = cell(p);
        grid[c.y * cells.x + c.x].push((p, away));
    };
    let mut vertices = Vec::new();
    for v in disk.vertex_ids().filter(|&v| disk.is_boundary_vertex(v)) {
        let v = v.index();
        add(&mut grid, omega[v], if taken[v] { apart(v) } else { FROM_EDGE * apart(v) });
        if taken[v] {
            vertices.push(v);
        }
    }
    for v in disk.vertex_ids().filter(|&v| !disk.is_boundary_vertex(v)) {
        let p = omega[v.index()];
        let c = cell(p);
        let free = (c.y.saturating_sub(1)..(c.y + 2).min(cells.y)).all(|y| {
            (c.x.saturating_sub(1)..(c.x + 2).min(cells.x)).all(|x| {
                let near = &grid[y * cells.x + x];
                near.iter().all(|&(q, away)| p.distance_squared(q) >= away * away)
            })
        });
        if free {
            add(&mut grid, p, apart(v.index()));
            vertices.push(v.index());
        }
    }
    vertices.sort_unstable();
    Some(vertices)
}

/// The triangles of a constrained Delaunay triangulation on the left of the chords; `None` if chords cross.
fn triangulated(
    vertices: &[usize],
    chords: &[[usize; 2]],
    omega: &[DVec2],
) -> Option<Vec<[usize; 3]>> {
    let number = |v: usize| vertices.binary_search(&v).ok();
    let places = vertices.iter().map(|&v| Point2::new(omega[v].x, omega[v].y)).collect();
    let edges: Vec<[usize; 2]> =
        chords.iter().map(|&[a, b]| Some([number(a)?, number(b)?])).collect::<Option<_>>()?;
    let mut crossing = false;
    let triangulation = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(
        places,
        edges.clone(),
        |_| crossing = true,
    )
    .ok()?;
    let whole = triangulation.num_vertices() == vertices.len()
        && triangulation.num_constraints() == edges.len();
    if crossing || !whole {
        return None;
    }
    // From the chords inwards.
    let handle = spade::handles::FixedVertexHandle::from_index;
    let mut inside = vec![false; triangulation.num_all_faces()];
    let mut next = Vec::new();
    for &[a, b] in &edges {
        let edge = triangulation.get_edge_from_neighbors(handle(a), handle(b))?;
        next.push(edge.face());
    }
    while let Some(face) = next.pop() {
        // The outer face is on the wrong side.
        let inner = face.as_inner()?;
        if std::mem::replace(&mut inside[face.index()], true) {
            continue;
        }
        for edge in inner.adjacent_edges() {
            if !edge.is_constraint_edge() {
                next.push(edge.rev().face());
            }
        }
    }
    let faces = triangulation.inner_faces().filter(|face| inside[face.index()]);
    Some(faces.map(|face| face.vertices().map(|v| vertices[v.index()])).collect())
}

/// Of every vertex of the given surface its place on the thinned one.
fn places(
    disk: &Surface,
    omega: &[DVec2],
    thin: &Surface,
    own: &[DVec2],
    became: &[usize],
) -> Option<Vec<(TriangleId, DVec3)>> {
    let first = became.iter().position(|&k| k != usize::MAX)?;
    let start = thin.outgoing(VertexId::new(became[first])).next()?.triangle();
    let mut places = vec![None; disk.vertex_count()];
    places[first] = Some(walk(thin, own, omega[first], start));
    // From neighbour to neighbour the way is short.
    let mut next = std::collections::VecDeque::from([VertexId::new(first)]);
    while let Some(v) = next.pop_front() {
        let (near, _) = places[v.index()]?;
        for n in disk.neighbours(v) {
            if places[n.index()].is_none() {
                places[n.index()] = Some(walk(thin, own, omega[n.index()], near));
                next.push_back(n);
            }
        }
    }
    places.into_iter().collect()
}

/// The triangle of a triangulation of the plane in which a point lies, or beside which it lies outside, and its
/// barycentric coordinates there.
pub fn walk(
    surface: &Surface,
    plane: &[DVec2],
    at: DVec2,
    near: TriangleId,
) -> (TriangleId, DVec3) {
    let mut here = near;
    let mut came = None;
    for _ in 0..surface.triangle_count() {
        let weights = barycentric(surface.triangle(here).map(|v| plane[v.index()]), at);
        // Across the edge that it lies farthest beyond.
        let mut edges = [0, 1, 2];
        edges.sort_by(|&a, &b| weights[(a + 2) % 3].total_cmp(&weights[(b + 2) % 3]));
        let beyond = edges.into_iter().filter(|&k| weights[(k + 2) % 3] < 0.0);
        let across = |k: usize| surface.twin(HalfEdgeId::new(3 * here.index() + k));
        let way = beyond.filter_map(across).map(HalfEdgeId::triangle).find(|&t| Some(t) != came);
        match way {
            Some(there) => (came, here) = (Some(here), there),
            None => return (here, weights),
        }
    }
    (here, barycentric(surface.triangle(here).map(|v| plane[v.index()]), at))
}

/// Barycentric coordinates of a point of the plane.
fn barycentric([a, b, c]: [DVec2; 3], p: DVec2) -> DVec3 {
    let whole = (b - a).perp_dot(c - a);
    let (u, v) = ((c - b).perp_dot(p - b) / whole, (a - c).perp_dot(p - c) / whole);
    DVec3::new(u, v, 1.0 - u - v)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::geometry::SurfacePoint;

    /// A tube round z, wider at its lower end, cut open along its seam; its development over the plane.
    fn tube(around: usize, rows: usize) -> (Surface, Seam, Vec<DVec2>) {
        let (mut points, mut omega) = (Vec::new(), Vec::new());
        for i in 0..=rows {
            for j in 0..=around {
                let (s, t) = (j as f64 / around as f64, i as f64 / rows as f64);
                let (r, z) = (45.0 - 8.0 * t * t, 140.0 * t);
                points.push(DVec3::new(r * (TAU * s).cos(), r * (TAU * s).sin(), z));
                omega.push(DVec2::new(r * TAU * (s - 0.5), z));
            }
        }
        let id = |i: usize, j: usize| VertexId::new(i * (around + 1) + j);
        let mut triangles = Vec::new();
        for i in 0..rows {
            for j in 0..around {
                triangles.push([id(i, j), id(i, j + 1), id(i + 1, j + 1)]);
                triangles.push([id(i, j), id(i + 1, j + 1), id(i + 1, j)]);
            }
        }
        let side = |j: usize| (0..=rows).rev().map(|i| id(i, j)).collect();
        let seam = Seam { left: side(0), right: side(around) };
        (Surface::new(points, triangles).unwrap(), seam, omega)
    }

    #[test]
    fn a_tube_keeps_its_shape_and_its_seam_with_an_eighth_of_the_triangles() {
        let (disk, seam, omega) = tube(96, 48);
        let thin =
            Thinned::new(&disk, std::slice::from_ref(&seam), &omega, 3.0, &Grading::default())
                .unwrap();
        let share = thin.disk.triangle_count() as f64 / disk.triangle_count() as f64;
        assert!((0.08..0.2).contains(&share), "{share}");
        let area = thin.disk.total_area() / disk.total_area();
        assert!((0.98..1.0).contains(&area), "{area}");
        // Sewn vertices stay sewn: one by one in the same place, from end to end.
        let [sewn] = &thin.seams[..] else { panic!("{} seams", thin.seams.len()) };
        assert_eq!(sewn.left.len(), sewn.right.len());
        assert!((8..30).contains(&sewn.left.len()), "{}", sewn.left.len());
        for (l, r) in sewn.left.iter().zip(&sewn.right) {
            assert!(thin.disk.point(*l).distance(thin.disk.point(*r)) < 1e-9);
        }
        for (ends, of) in [(&sewn.left, &seam.left), (&sewn.right, &seam.right)] {
            assert_eq!(thin.origin[ends[0].index()], of[0].index());
            assert_eq!(thin.origin[ends[ends.len() - 1].index()], of[of.len() - 1].index());
        }
        // Each of its edges is one of the boundary, so that it can be sewn.
        for edge in [&sewn.left, &sewn.right].into_iter().flat_map(|side| side.windows(2)) {
            let joined = thin.disk.neighbours(edge[0]).any(|v| v == edge[1]);
            assert!(joined && edge.iter().all(|&v| thin.disk.is_boundary_vertex(v)));
        }
    }

    #[test]
    fn it_stays_as_fine_as_wanted_at_a_place() {
        let (disk, seam, omega) = tube(96, 48);
        let place = disk.point(seam.left[20]);
        let thin = Thinned::new(
            &disk,
            std::slice::from_ref(&seam),
            &omega,
            4.0,
            &Grading::new(vec![place]),
        )
        .unwrap();
        let edges = |from: f64, to: f64| -> Vec<f64> {
            let all = thin.disk.half_edges().map(|h| {
                let middle =
                    0.5 * (thin.disk.point(thin.disk.from(h)) + thin.disk.point(thin.disk.to(h)));
                (middle.distance(place), thin.disk.length(h))
            });
            all.filter(|(far, _)| (from..to).contains(far)).map(|(_, length)| length).collect()
        };
        let mean = |edges: &[f64]| edges.iter().sum::<f64>() / edges.len() as f64;
        let (near, far) = (edges(0.0, 8.0), edges(60.0, 200.0));
        assert!(near.len() > 20 && far.len() > 200, "{} {}", near.len(), far.len());
        let given = disk.mean_edge_length();
        assert!(mean(&near) < 1.3 * given, "{} of {given}", mean(&near));
        assert!(mean(&far) > 3.0 * given, "{} of {given}", mean(&far));
        // On both sides of the seam.
        let [sewn] = &thin.seams[..] else { panic!("{} seams", thin.seams.len()) };
        for (l, r) in sewn.left.iter().zip(&sewn.right) {
            assert!(thin.disk.point(*l).distance(thin.disk.point(*r)) < 1e-9);
        }
    }

    #[test]
    fn every_vertex_knows_its_place_on_it() {
        let (disk, seam, omega) = tube(80, 40);
        let thin = Thinned::new(&disk, &[seam], &omega, 3.0, &Grading::default()).unwrap();
        let own: Vec<DVec2> = thin.origin.iter().map(|&v| omega[v]).collect();
        let mut outside = 0;
        for (v, (triangle, weights)) in thin.places.iter().enumerate() {
            let place = SurfacePoint { triangle: *triangle, barycentric: *weights };
            assert!(place.interpolate(&thin.disk, &own).distance(omega[v]) < 1e-9, "{v}");
            let least = weights.min_element();
            outside += usize::from(least < -1e-9);
            // Beside the boundary's chords, and not far.
            assert!(least > -0.2, "{v}: {weights}");
            assert!(least > -1e-9 || place.position(&thin.disk).distance(disk.points()[v]) < 3.0);
        }
        assert!(outside < thin.places.len() / 20, "{outside}");
        // From anywhere on the way to anywhere.
        let last = TriangleId::new(thin.disk.triangle_count() - 1);
        for v in 0..omega.len() {
            let (triangle, weights) = walk(&thin.disk, &own, omega[v], last);
            let place = SurfacePoint { triangle, barycentric: weights };
            assert!(place.interpolate(&thin.disk, &own).distance(omega[v]) < 1e-9, "{v}");
        }
    }

    #[test]
    fn edges_have_the_lengths_of_arcs() {
        let (disk, seam, omega) = tube(96, 48);
        let thin = Thinned::new(&disk, &[seam], &omega, 4.0, &Grading::default()).unwrap();
        let lengths = thin.lengths(&disk);
        let (mut chords, mut arcs, mut count) = (0.0, 0.0, 0);
        for (triangle, lengths) in thin.disk.triangles().iter().zip(lengths) {
            for k in 0..3 {
                let [a, b] = [k, (k + 1) % 3].map(|k| thin.disk.point(triangle[k]));
                let [a_plane, b_plane] =
                    [k, (k + 1) % 3].map(|k| omega[thin.origin[triangle[k].index()]]);
                // Along warp on the widest rows, away from the seam's one-sided normals.
                let along_warp = (a.z - b.z).abs() < 1e-9 && a.z < 30.0 && a.z > 5.0;
                if along_warp && a_plane.x.abs().max(b_plane.x.abs()) < 100.0 {
                    let arc = a_plane.distance(b_plane);
                    chords += (1.0 - a.distance(b) / arc).abs();
                    arcs += (1.0 - lengths[k] / arc).abs();
                    count += 1;
                }
            }
        }
        assert!(count > 4 && arcs < 0.2 * chords, "{count}: {arcs} against {chords}");
    }

    #[test]
    fn a_slit_whose_sides_lie_on_each_other_in_the_plane_is_not_thinned() {
        let (disk, seam, mut omega) = tube(48, 24);
        // The same with its sides brought together: chords on each other.
        for (l, r) in seam.left.iter().zip(&seam.right) {
            omega[r.index()] = omega[l.index()];
        }
        assert!(Thinned::new(&disk, &[seam], &omega, 3.0, &Grading::default()).is_none());
    }

    #[test]
    fn a_plane_drawn_without_measure_asks_for_no_memory_without_bound() {
        let (disk, seam, mut omega) = tube(48, 24);
        omega[0] = DVec2::splat(-1e9);
        assert!(Thinned::new(&disk, &[seam], &omega, 3.0, &Grading::default()).is_none());
    }

    #[test]
    fn a_dart_and_a_hole_stay() {
        // A sheet with a square hole, and a dart from its lower edge that is open by a little.
        let n = 60;
        let id = |i: usize, j: usize| i * (n + 1) + j;
        let mut points: Vec<DVec3> = (0..(n + 1) * (n + 1))
            .map(|k| DVec3::new((k % (n + 1)) as f64, (k / (n + 1)) as f64, 0.0))
            .collect();
        let (middle, tip) = (n / 4, n / 3);
        // The other side of the dart, below its tip.
        let first = points.len();
        points.extend((0..tip).map(|i| DVec3::new(middle as f64, i as f64, 0.0)));
        let hole = |i: usize, j: usize| (35..45).contains(&i) && (30..45).contains(&j);
        let mut triangles = Vec::new();
        for i in 0..n {
            for j in (0..n).filter(|&j| !hole(i, j)) {
                let right = |i: usize, j: usize| {
                    VertexId::new(if j == middle && i < tip { first + i } else { id(i, j) })
                };
                let left = |i: usize, j: usize| VertexId::new(id(i, j));
                let corner = |i, k| if j == middle { right(i, k) } else { left(i, k) };
                let [a, b, c, d] =
                    [corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        let mut became = vec![usize::MAX; points.len()];
        triangles.iter().flatten().for_each(|v: &VertexId| became[v.index()] = 0);
        let mut kept = Vec::new();
        for (v, to) in became.iter_mut().enumerate().filter(|(_, to)| **to == 0) {
            *to = kept.len();
            kept.push(points[v]);
        }
        let triangles = triangles.iter().map(|t| t.map(|v| VertexId::new(became[v.index()])));
        let disk = Surface::new(kept, triangles.collect()).unwrap();
        let side = |of: &dyn Fn(usize) -> usize| -> Vec<VertexId> {
            (0..=tip).rev().map(|i| VertexId::new(became[of(i)])).collect()
        };
        let seam = Seam {
            left: side(&|i| id(i, middle)),
            right: side(&|i| if i < tip { first + i } else { id(i, middle) }),
        };
        let mut omega: Vec<DVec2> = disk.points().iter().map(|p| p.truncate()).collect();
        for (k, v) in seam.right.iter().enumerate() {
            omega[v.index()].x += 0.05 * k as f64;
        }
        let thin = Thinned::new(&disk, &[seam], &omega, 3.0, &Grading::default()).unwrap();
        assert_eq!(thin.disk.boundary_loops().len(), 2);
        assert_eq!(thin.seams[0].left[0], thin.seams[0].right[0]);
        assert!(thin.seams[0].left.len() > 4);
        assert!((thin.disk.total_area() / disk.total_area() - 1.0).abs() < 0.01);
    }
}
