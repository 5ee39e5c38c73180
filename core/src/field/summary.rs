//! The field in few figures.
//!
//! Areas are areas on the limb, each vertex with a third of its triangles'; percentiles are shares
//! of that area.

use glam::{DVec2, DVec3};

use super::{Field, Unreadable};
use crate::surface::Surface;

/// Strain below which fabric counts as compressed: half a per cent less than its length is eased
/// in by hand and lies flat; a wanted strain of zero is met to a thousandth either way.
pub const COMPRESSED_BELOW: f64 = -0.005;

/// Pressure below which fabric counts as lifting off, in kPa: tensions that pull no harder than
/// this are those of a fabric that only lies there.
pub const LIFTING_BELOW_KPA: f64 = -0.01;

/// Friction of fabric on dry skin, the upper end of the textbooks' 0.3 to 0.5.
pub const SKIN_FRICTION: f64 = 0.5;

/// A largest value and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// The value.
    pub value: f64,
    /// The place on the limb, in mm.
    pub at: DVec3,
}

/// Mean pressure on a band across the limb.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowMean {
    /// The middle of the band in the pattern along weft, in mm.
    pub y: f64,
    /// Mean pressure by area on the limb, in kPa.
    pub kpa: f64,
    /// Area of the band on the limb, in mm².
    pub area: f64,
}

/// The figures of a field.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Largest pressure over the curvature radius, in kPa.
    pub max_kpa: Peak,
    /// Largest pressure over 5 mm, in kPa, or why none is stated.
    pub max_fine_kpa: Result<Peak, Unreadable>,
    /// Share of the area where pressure over 5 mm could be stated.
    pub fine_share: f64,
    /// Pressure that 95 % of the area do not exceed, in kPa.
    pub p95_kpa: f64,
    /// Area where pressure, over the radius or over 5 mm, is above the limit, in mm².
    pub area_over_limit: f64,
    /// Area where the fabric would lift off, in mm².
    pub area_lifting: f64,
    /// Area where warp is compressed, in mm².
    pub area_warp_compressed: f64,
    /// Area where weft is compressed, in mm².
    pub area_weft_compressed: f64,
    /// Area where either is, in mm².
    pub area_compressed: f64,
    /// Largest strain, of warp or weft.
    pub max_strain: Peak,
    /// Area where a strain is more than the fabric bears, in mm².
    pub area_over_strain: f64,
    /// Largest friction coefficient needed, where one can be stated.
    pub max_friction: Option<Peak>,
    /// Friction coefficient that is enough for 95 % of that area.
    pub p95_friction: Option<f64>,
    /// That area, in mm².
    pub friction_area: f64,
    /// Area where more than [`SKIN_FRICTION`] is needed, in mm²: the fabric creeps there.
    pub area_over_friction: f64,
    /// Mean pressures from the far end to the end near the body.
    pub rows: Vec<RowMean>,
    /// How much the line through the row means rises from the far end to the end near the body,
    /// in kPa.
    pub rise_kpa: f64,
    /// Mean pressure on the whole brace, in kPa.
    pub mean_kpa: f64,
}

impl Field {
    /// The figures of the field on its disk with its pattern coordinates in mm, against a limit in
    /// kPa and the fabric's largest strain.
    #[must_use]
    pub fn summary(
        &self,
        disk: &Surface,
        coordinates: &[DVec2],
        limit_kpa: f64,
        max_strain: f64,
    ) -> Summary {
        let area_where = |is: &dyn Fn(usize) -> bool| -> f64 {
            // From zero: the sum of nothing would be −0.
            (0..self.area_mm2.len()).filter(|&i| is(i)).fold(0.0, |sum, i| sum + self.area_mm2[i])
        };
        let peak = |of: &dyn Fn(usize) -> Option<f64>| {
            let known = disk.vertex_ids().filter_map(|v| Some((v, of(v.index())?)));
            known
                .reduce(|best, next| if next.1 > best.1 { next } else { best })
                .map(|(v, value)| Peak { value, at: disk.point(v) })
        };
        let nowhere = Peak { value: 0.0, at: DVec3::ZERO };
        let strain = |i: usize| self.warp_strain[i].max(self.weft_strain[i]);
        let warp_compressed = |i: usize| self.warp_strain[i] < COMPRESSED_BELOW;
        let weft_compressed = |i: usize| self.weft_strain[i] < COMPRESSED_BELOW;
        let total = area_where(&|_| true);
        let rows = self.rows(coordinates);
        let pressures = || (0..self.area_mm2.len()).map(|i| (self.pressure_kpa[i], i));
        let frictions = || {
            (0..self.area_mm2.len()).filter_map(|i| self.friction[i].map(|friction| (friction, i)))
        };
        Summary {
            max_kpa: peak(&|i| Some(self.pressure_kpa[i])).unwrap_or(nowhere),
            max_fine_kpa: peak(&|i| self.fine_pressure_kpa[i])
                .ok_or(self.fine_unreadable.unwrap_or(Unreadable::Slack)),
            fine_share: area_where(&|i| self.fine_pressure_kpa[i].is_some())
                / total.max(f64::MIN_POSITIVE),
            p95_kpa: self.percentile(pressures().collect(), 0.95).unwrap_or(0.0),
            area_over_limit: area_where(&|i| self.highest_kpa(i) > limit_kpa),
            area_lifting: area_where(&|i| self.pressure_kpa[i] < LIFTING_BELOW_KPA),
            area_warp_compressed: area_where(&warp_compressed),
            area_weft_compressed: area_where(&weft_compressed),
            area_compressed: area_where(&|i| warp_compressed(i) || weft_compressed(i)),
            max_strain: peak(&|i| Some(strain(i))).unwrap_or(nowhere),
            area_over_strain: area_where(&|i| strain(i) > max_strain),
            max_friction: peak(&|i| self.friction[i]),
            p95_friction: self.percentile(frictions().collect(), 0.95),
            friction_area: area_where(&|i| self.friction[i].is_some()),
            area_over_friction: area_where(&|i| {
                self.friction[i].is_some_and(|friction| friction > SKIN_FRICTION)
            }),
            rise_kpa: rise(&rows),
            mean_kpa: mean(&rows),
            rows,
        }
    }

    /// The larger of the pressures over the radius and over 5 mm at a vertex, in kPa.
    #[must_use]
    pub fn highest_kpa(&self, vertex: usize) -> f64 {
        let coarse = self.pressure_kpa[vertex];
        self.fine_pressure_kpa[vertex].map_or(coarse, |fine| fine.max(coarse))
    }

    /// The value that a share of the area does not exceed.
    fn percentile(&self, mut values: Vec<(f64, usize)>, share: f64) -> Option<f64> {
        values.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let total: f64 = values.iter().map(|&(_, i)| self.area_mm2[i]).sum();
        let mut below = 0.0;
        for &(value, i) in &values {
            below += self.area_mm2[i];
            if below >= share * total {
                return Some(value);
            }
        }
        values.last().map(|&(value, _)| value)
    }

    /// Mean pressures on bands as wide as the curvature radius.
    fn rows(&self, coordinates: &[DVec2]) -> Vec<RowMean> {
        let low = coordinates.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let high = coordinates.iter().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let count = ((high - low) / self.radius_mm).ceil().clamp(1.0, 1e4) as usize;
        let width = (high - low) / count as f64;
        let mut sums = vec![(0.0, 0.0); count];
        for (p, (&kpa, &area)) in
            coordinates.iter().zip(self.pressure_kpa.iter().zip(&self.area_mm2))
        {
            let row = (((p.y - low) / width) as usize).min(count - 1);
            sums[row].0 += area * kpa;
            sums[row].1 += area;
        }
        sums.into_iter()
            .enumerate()
            .filter(|(_, (_, area))| *area > 0.0)
            .map(|(row, (force, area))| RowMean {
                y: low + (row as f64 + 0.5) * width,
                kpa: force / area,
                area,
            })
            .collect()
    }
}

fn mean(rows: &[RowMean]) -> f64 {
    let area: f64 = rows.iter().map(|row| row.area).sum();
    let force: f64 = rows.iter().map(|row| row.area * row.kpa).sum();
    if area > 0.0 { force / area } else { 0.0 }
}

/// The rise of the line through the rows (least squares, by area) from the first to the last.
fn rise(rows: &[RowMean]) -> f64 {
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return 0.0 };
    let area: f64 = rows.iter().map(|row| row.area).sum();
    let middle = rows.iter().map(|row| row.area * row.y).sum::<f64>() / area;
    let mean = mean(rows);
    let (mut up, mut along) = (0.0, 0.0);
    for row in rows {
        up += row.area * (row.y - middle) * (row.kpa - mean);
        along += row.area * (row.y - middle).powi(2);
    }
    if along > 0.0 { up / along * (last.y - first.y) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rise_of_rows_by_hand() {
        let row = |y: f64, kpa: f64| RowMean { y, kpa, area: 10.0 };
        assert!((rise(&[row(0.0, 1.0), row(10.0, 1.5), row(20.0, 2.0)]) - 1.0).abs() < 1e-12);
        assert!((rise(&[row(0.0, 2.0), row(10.0, 0.0), row(20.0, 2.0)])).abs() < 1e-12);
        assert_eq!(rise(&[row(5.0, 2.0)]), 0.0);
        // A row of no weight decides nothing.
        let light = RowMean { area: 1e-9, ..row(30.0, 99.0) };
        assert!((rise(&[row(0.0, 1.0), row(10.0, 1.0), light])).abs() < 1e-3);
    }
}
