//! Nodes by index (i, j) and the springs between them.

use glam::{DVec2, DVec3};

use crate::geometry::SurfacePoint;
use crate::surface::Surface;

/// Index of a woven node: `i` counts warp threads (rows) along weft, upward in the pattern, `j`
/// counts weft threads (columns) along warp. Both may be negative.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeIndex {
    /// Row: which warp thread.
    pub i: i32,
    /// Column: which weft thread.
    pub j: i32,
}

impl NodeIndex {
    /// The index `di` rows and `dj` columns on.
    #[must_use]
    pub fn offset(self, di: i32, dj: i32) -> Self {
        Self { i: self.i + di, j: self.j + dj }
    }
}

/// The three kinds of spring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpringKind {
    /// Along a row, round the limb.
    Warp,
    /// Along a column, along the limb.
    Weft,
    /// Across a cell: resistance to shear.
    Diagonal,
}

/// A spring between two nodes; `a` is the one in the lower row, then in the lower column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// Its kind.
    pub kind: SpringKind,
    /// One end.
    pub a: NodeIndex,
    /// The other end.
    pub b: NodeIndex,
    /// Its present length in space, in mm.
    pub length: f64,
}

/// The woven model: a rectangle of slots, some of which hold a node on the surface.
///
/// Slots keep one empty ring round the nodes, so that the eight neighbours of a node always have
/// slots of their own.
#[derive(Debug, Clone, PartialEq)]
pub struct WovenModel {
    spacing: f64,
    first: NodeIndex,
    rows: usize,
    columns: usize,
    points: Vec<Option<SurfacePoint>>,
    places: Vec<DVec3>,
}

impl WovenModel {
    /// An empty model with room for the nodes from `low` to `high`, both included.
    #[must_use]
    pub fn empty(spacing: f64, low: NodeIndex, high: NodeIndex) -> Self {
        let rows = usize::try_from(high.i - low.i).unwrap_or(0) + 3;
        let columns = usize::try_from(high.j - low.j).unwrap_or(0) + 3;
        Self {
            spacing,
            first: low.offset(-1, -1),
            rows,
            columns,
            points: vec![None; rows * columns],
            places: vec![DVec3::ZERO; rows * columns],
        }
    }

    /// Rest distance between neighbouring threads, L_warp = L_weft, in mm.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Rest position of a node in the plane: x = L_warp j, y = L_weft i, in mm.
    #[must_use]
    pub fn planar(&self, node: NodeIndex) -> DVec2 {
        DVec2::new(f64::from(node.j), f64::from(node.i)) * self.spacing
    }

    /// Number of slots.
    #[must_use]
    pub fn slot_count(&self) -> usize {
        self.points.len()
    }

    /// Slots from one row to the next.
    #[must_use]
    pub fn stride(&self) -> usize {
        self.columns
    }

    /// The slot of an index, if it lies in the rectangle.
    #[must_use]
    pub fn slot(&self, node: NodeIndex) -> Option<usize> {
        let row = usize::try_from(node.i - self.first.i).ok()?;
        let column = usize::try_from(node.j - self.first.j).ok()?;
        (row < self.rows && column < self.columns).then_some(row * self.columns + column)
    }

    /// The index of a slot.
    #[must_use]
    pub fn index(&self, slot: usize) -> NodeIndex {
        let count = |n: usize| i32::try_from(n).expect("a woven model has fewer than 2^31 rows");
        self.first.offset(count(slot / self.columns), count(slot % self.columns))
    }

    /// The node in a slot.
    #[must_use]
    pub fn point_in(&self, slot: usize) -> Option<SurfacePoint> {
        self.points[slot]
    }

    /// Where the node in a slot is, in mm; meaningless for an empty slot.
    #[must_use]
    pub fn place_in(&self, slot: usize) -> DVec3 {
        self.places[slot]
    }

    /// The node at an index.
    #[must_use]
    pub fn point(&self, node: NodeIndex) -> Option<SurfacePoint> {
        self.slot(node).and_then(|slot| self.points[slot])
    }

    /// Where the node at an index is, in mm.
    #[must_use]
    pub fn place(&self, node: NodeIndex) -> Option<DVec3> {
        let slot = self.slot(node)?;
        self.points[slot].map(|_| self.places[slot])
    }

    /// Number of nodes.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.points.iter().flatten().count()
    }

    /// The slots that hold a node, in order.
    pub fn filled(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.points.len()).filter(|&slot| self.points[slot].is_some())
    }

    /// The lowest and the highest row that hold a node.
    #[must_use]
    pub fn row_range(&self) -> Option<(i32, i32)> {
        let first = self.filled().next()?;
        let last = self.filled().last()?;
        Some((self.index(first).i, self.index(last).i))
    }

    /// Puts a node at an index; room is made where there is none.
    pub fn put(&mut self, node: NodeIndex, point: SurfacePoint, surface: &Surface) {
        let inner = |slot: usize, model: &Self| {
            let (row, column) = (slot / model.columns, slot % model.columns);
            row > 0 && row + 1 < model.rows && column > 0 && column + 1 < model.columns
        };
        let slot = match self.slot(node).filter(|&slot| inner(slot, self)) {
            Some(slot) => slot,
            None => {
                self.make_room(node);
                self.slot(node).expect("room was just made")
            }
        };
        self.points[slot] = Some(point);
        self.places[slot] = point.position(surface);
    }

    /// Removes the node in a slot, and with it its springs.
    pub fn remove(&mut self, slot: usize) {
        self.points[slot] = None;
        self.places[slot] = DVec3::ZERO;
    }

    /// The same slots with other nodes, as one diffusion step gives them.
    #[must_use]
    pub fn with_nodes(&self, nodes: Vec<Option<(SurfacePoint, DVec3)>>) -> Self {
        Self {
            points: nodes.iter().map(|node| node.map(|(point, _)| point)).collect(),
            places: nodes.iter().map(|node| node.map_or(DVec3::ZERO, |(_, p)| p)).collect(),
            ..*self
        }
    }

    fn make_room(&mut self, node: NodeIndex) {
        // Several slots at once: the fabric grows by a ring a pass.
        const RESERVE: i32 = 8;
        let last = self.index(self.points.len() - 1);
        let low = NodeIndex {
            i: self.first.i.min(node.i - RESERVE),
            j: self.first.j.min(node.j - RESERVE),
        };
        let high = NodeIndex { i: last.i.max(node.i + RESERVE), j: last.j.max(node.j + RESERVE) };
        let mut grown = Self::empty(self.spacing, low, high);
        for slot in self.filled() {
            let to = grown.slot(self.index(slot)).expect("the grown rectangle holds the old one");
            grown.points[to] = self.points[slot];
            grown.places[to] = self.places[slot];
        }
        *self = grown;
    }

    /// Whether the cell whose lowest corner is in `slot` has all four nodes.
    #[must_use]
    pub fn is_whole_cell(&self, slot: usize) -> bool {
        let above = slot + self.columns;
        above + 1 < self.points.len()
            && [slot, slot + 1, above, above + 1].iter().all(|&s| self.points[s].is_some())
    }

    /// Number of whole cells.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.filled().filter(|&slot| self.is_whole_cell(slot)).count()
    }

    /// Drops the nodes that no whole cell holds: they hang by single threads, carry no area and
    /// would fold over their neighbours. Returns how many.
    pub fn drop_loose_nodes(&mut self) -> usize {
        let mut held = vec![false; self.points.len()];
        for slot in self.filled().filter(|&slot| self.is_whole_cell(slot)) {
            for s in [slot, slot + 1, slot + self.columns, slot + self.columns + 1] {
                held[s] = true;
            }
        }
        let loose: Vec<usize> = self.filled().filter(|&slot| !held[slot]).collect();
        for &slot in &loose {
            self.remove(slot);
        }
        loose.len()
    }

    /// Strain of a whole thread of warp (a row) or weft (a column) springs, and their number.
    #[must_use]
    pub fn thread_strain(&self, kind: SpringKind, thread: i32) -> Option<(f64, usize)> {
        let on_it = |s: &Spring| {
            s.kind == kind && thread == if kind == SpringKind::Weft { s.a.j } else { s.a.i }
        };
        let (mut length, mut springs) = (0.0, 0);
        for spring in self.springs().filter(on_it) {
            length += spring.length;
            springs += 1;
        }
        (springs > 0).then(|| (length / (springs as f64 * self.spacing) - 1.0, springs))
    }

    /// Every spring, row by row.
    pub fn springs(&self) -> impl Iterator<Item = Spring> + '_ {
        let up = self.columns;
        self.filled().flat_map(move |slot| {
            [
                (SpringKind::Warp, slot, slot + 1),
                (SpringKind::Weft, slot, slot + up),
                (SpringKind::Diagonal, slot, slot + up + 1),
                (SpringKind::Diagonal, slot, slot + up - 1),
            ]
            .into_iter()
            .filter(|&(_, _, b)| self.points[b].is_some())
            .map(|(kind, a, b)| Spring {
                kind,
                a: self.index(a),
                b: self.index(b),
                length: self.places[a].distance(self.places[b]),
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::TriangleId;

    fn flat(size: f64) -> Surface {
        let points = vec![
            DVec3::ZERO,
            DVec3::new(size, 0.0, 0.0),
            DVec3::new(size, size, 0.0),
            DVec3::new(0.0, size, 0.0),
        ];
        let id = crate::surface::VertexId::new;
        Surface::new(points, vec![[id(0), id(1), id(2)], [id(0), id(2), id(3)]]).unwrap()
    }

    fn node(surface: &Surface, x: f64, y: f64) -> SurfacePoint {
        let triangle = TriangleId::new(usize::from(y > x));
        let size = surface.point(crate::surface::VertexId::new(2)).x;
        let barycentric = if y > x {
            DVec3::new(1.0 - y / size, x / size, (y - x) / size)
        } else {
            DVec3::new(1.0 - x / size, (x - y) / size, y / size)
        };
        SurfacePoint { triangle, barycentric }
    }

    #[test]
    fn a_full_square_has_the_springs_of_a_spring_mesh() {
        let surface = flat(10.0);
        let mut model = WovenModel::empty(1.0, NodeIndex { i: 0, j: 0 }, NodeIndex { i: 0, j: 0 });
        for i in 0..4 {
            for j in 0..5 {
                let p = node(&surface, f64::from(j) + 1.0, f64::from(i) + 1.0);
                model.put(NodeIndex { i, j }, p, &surface);
            }
        }
        assert_eq!((model.node_count(), model.cell_count()), (20, 12));
        let count = |kind| model.springs().filter(|s| s.kind == kind).count();
        assert_eq!(count(SpringKind::Warp), 16);
        assert_eq!(count(SpringKind::Weft), 15);
        assert_eq!(count(SpringKind::Diagonal), 24);
        for spring in model.springs() {
            let expected = if spring.kind == SpringKind::Diagonal { 2f64.sqrt() } else { 1.0 };
            assert!((spring.length - expected).abs() < 1e-12, "{spring:?}");
        }
        assert_eq!(model.row_range(), Some((0, 3)));
    }

    #[test]
    fn a_node_by_a_single_thread_is_dropped() {
        let surface = flat(10.0);
        let mut model = WovenModel::empty(1.0, NodeIndex { i: 0, j: 0 }, NodeIndex { i: 1, j: 1 });
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1), (1, 2)] {
            let p = node(&surface, f64::from(j) + 1.0, f64::from(i) + 1.0);
            model.put(NodeIndex { i, j }, p, &surface);
        }
        assert_eq!(model.drop_loose_nodes(), 1);
        assert_eq!(model.place(NodeIndex { i: 1, j: 2 }), None);
        assert_eq!(model.node_count(), 4);
    }
}
