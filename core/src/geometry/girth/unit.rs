//! Whether a limb has the size of a limb, and which unit its file is probably in.

use super::Measures;
use crate::units::LengthUnit;
use crate::warning::Warning;

/// Girths of limbs, in mm: from an infant's wrist with room to a large trunk.
const LIMB_GIRTHS_MM: std::ops::RangeInclusive<f64> = 60.0..=1500.0;

/// Of several units that give a limb, the one whose girth is nearest to this one is the likely
/// one: a forearm or an ankle, in mm.
const TYPICAL_GIRTH_MM: f64 = 250.0;

/// A surface that is not of the size of a limb.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("girths of {} mm{} are not a limb's (60 to 1500 mm): {}", figure(*.girth_mm),
    if *.unit == LengthUnit::Millimetre { String::new() }
    else { format!(", reading the coordinates in {},", .unit.symbol()) },
    remedy(*.likely))]
pub struct UnitError {
    /// The median girth, in mm, with the coordinates read in `unit`.
    pub girth_mm: f64,
    /// The unit in which the coordinates were read.
    pub unit: LengthUnit,
    /// The unit that makes it a limb, if one does.
    pub likely: Option<LengthUnit>,
}

/// Two significant digits, or whole millimetres.
fn figure(mm: f64) -> String {
    if !(mm > 0.0 && mm < 10.0) {
        return format!("{mm:.0}");
    }
    let digits = (1.0 - mm.log10().floor()).clamp(0.0, 12.0) as usize;
    format!("{mm:.digits$}")
}

fn remedy(likely: Option<LengthUnit>) -> String {
    match likely {
        Some(unit) => {
            format!("the coordinates are probably in {0}; set `units` to `{0}`", unit.symbol())
        }
        None => "no unit makes it one; if the surface is right, set `units` to its unit, for example `mm`"
            .to_owned(),
    }
}

/// Judges by its median girth whether a surface read in `unit` has the size of a limb. Says
/// nothing if so; warns (`unlikely_size`) if not and the unit was `given` by the designer.
///
/// # Errors
/// If it is not the size of a limb and nobody gave the unit; the likely one is named.
pub fn guard_unit(
    measures: &Measures,
    unit: LengthUnit,
    given: bool,
) -> Result<Option<Warning>, UnitError> {
    let girth_mm = measures.median_girth_mm();
    if LIMB_GIRTHS_MM.contains(&girth_mm) {
        return Ok(None);
    }
    let raw = girth_mm / unit.millimetres();
    let off = |u: &LengthUnit| (raw * u.millimetres() / TYPICAL_GIRTH_MM).ln().abs();
    let likely = LengthUnit::ALL
        .into_iter()
        .filter(|u| LIMB_GIRTHS_MM.contains(&(raw * u.millimetres())))
        .min_by(|a, b| off(a).total_cmp(&off(b)));
    let error = UnitError { girth_mm, unit, likely };
    if given { Ok(Some(Warning::new("unlikely_size", error.to_string()))) } else { Err(error) }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::super::shapes::cylinder;
    use super::super::measure;
    use super::*;

    #[test]
    fn the_likely_unit_is_named() {
        let limb = cylinder(40.0, 200.0, 6.0);
        let read = |scale: f64, unit: LengthUnit| {
            let s = limb.with_points(limb.points().iter().map(|p| *p * scale).collect());
            guard_unit(&measure(&s, 20.0), unit, false)
        };
        use LengthUnit::{Centimetre, Inch, Metre, Millimetre};
        assert_eq!(read(1.0, Millimetre), Ok(None));
        for (scale, unit) in [(1e-3, Metre), (0.1, Centimetre), (1.0 / 25.4, Inch)] {
            let error = read(scale, Millimetre).unwrap_err();
            let likely = error.likely.unwrap();
            let girth = |u: LengthUnit| u.millimetres() * scale * 251.0;
            assert!((60.0..1500.0).contains(&girth(likely)), "{unit:?} {likely:?}");
            if unit != Inch {
                assert_eq!(likely, unit);
            }
        }
        let message = read(1e-3, Millimetre).unwrap_err().to_string();
        assert_eq!(
            message,
            "girths of 0.25 mm are not a limb's (60 to 1500 mm): the coordinates are probably in m; \
             set `units` to `m`"
        );
        // Millimetres read as metres.
        assert_eq!(read(1000.0, Metre).unwrap_err().likely, Some(Millimetre));
    }

    #[test]
    fn a_given_unit_is_believed_with_a_warning() {
        let m = Measures {
            length_mm: 0.0,
            girths: Vec::new(),
            size_mm: DVec3::new(1.0, 3.0, 9.0),
            area_mm2: 1.0,
        };
        let warning = guard_unit(&m, LengthUnit::Millimetre, true).unwrap().unwrap();
        assert_eq!(warning.code, "unlikely_size");
        assert!(warning.message.starts_with("girths of 9.4 mm"), "{}", warning.message);
        assert!(guard_unit(&m, LengthUnit::Millimetre, false).is_err());
    }
}
