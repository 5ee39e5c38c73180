//! HPGL of a sheet, for plotters and cutters: 40 steps to the millimetre, a pen for each layer.
//!
//! What is drawn comes first and what is cut last, while the cloth is still held. Pens: 1 cut line and
//! cut-outs, 2 sew line, 3 notches, 4 grain and stretch arrows, 5 marks, 6 scale boxes and words
//! (as lines: cutters have no letters).

use std::fmt::Write as _;

use glam::DVec2;

use super::strokes::strokes;
use crate::sheet::{Layer, Shape, Sheet};

/// Steps in a millimetre.
const STEPS: f64 = 40.0;

/// Sides of a circle.
const SIDES: u32 = 32;

/// Pens with their layers, in the order in which they are used.
const PENS: [(u8, &[Layer]); 6] = [
    (6, &[Layer::Text, Layer::Scale]),
    (5, &[Layer::Mark]),
    (4, &[Layer::Grain, Layer::Stretch]),
    (2, &[Layer::Sew]),
    (3, &[Layer::Notch]),
    (1, &[Layer::CutOut, Layer::Cut]),
];

/// A sheet as HPGL.
#[must_use]
pub fn pattern_hpgl(sheet: &Sheet<'_>) -> String {
    let mut text = String::from("IN;DF;PA;\n");
    for (pen, layers) in PENS {
        let mut lines: Vec<Vec<DVec2>> = Vec::new();
        for layer in layers {
            for item in sheet.all().filter(|item| item.layer == *layer) {
                lines.extend(lines_of(&item.shape));
            }
        }
        if lines.is_empty() {
            continue;
        }
        // Writing to a string cannot fail.
        let _ = writeln!(text, "SP{pen};");
        for line in lines {
            let steps = line.iter().map(|p| (STEPS * *p).round().as_i64vec2());
            for (i, p) in steps.enumerate() {
                let _ = match i {
                    0 => write!(text, "PU{},{};PD", p.x, p.y),
                    1 => write!(text, "{},{}", p.x, p.y),
                    _ => write!(text, ",{},{}", p.x, p.y),
                };
            }
            text.push_str(";\n");
        }
    }
    text.push_str("PU;SP0;\n");
    text
}

/// A shape as lines.
pub(super) fn lines_of(shape: &Shape) -> Vec<Vec<DVec2>> {
    match shape {
        Shape::Line { points, closed } => {
            let first = points.first().filter(|_| *closed);
            vec![points.iter().chain(first).copied().collect()]
        }
        Shape::Circle { centre, radius } => {
            let turn = std::f64::consts::TAU / f64::from(SIDES);
            let around = (0..=SIDES).map(|i| DVec2::from_angle(turn * f64::from(i)));
            vec![around.map(|d| *centre + *radius * d).collect()]
        }
        Shape::Words { at, size, angle, from_start, text } => {
            strokes(text, *at, *size, *angle, *from_start)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::{Heading, Item, SheetUnit};

    #[test]
    fn a_square_in_steps_is_drawn_after_its_sew_line() {
        let item = |layer, points: &[(f64, f64)], closed| Item {
            layer,
            id: String::new(),
            shape: Shape::Line { points: points.iter().map(|p| DVec2::from(*p)).collect(), closed },
        };
        let sheet = Sheet {
            size: DVec2::splat(20.0),
            unit: SheetUnit::Inch,
            heading: Heading::default(),
            pieces: Vec::new(),
            items: vec![
                item(Layer::Cut, &[(0.0, 0.0), (10.0, 0.0), (10.0, 10.01)], true),
                item(Layer::Sew, &[(1.0, 1.0), (2.5, 1.0)], false),
            ],
        };
        // 40 steps to the millimetre, whatever the words' unit.
        let wanted =
            "IN;DF;PA;\nSP2;\nPU40,40;PD100,40;\nSP1;\nPU0,0;PD400,0,400,400,0,0;\nPU;SP0;\n";
        assert_eq!(pattern_hpgl(&sheet), wanted);
    }
}
