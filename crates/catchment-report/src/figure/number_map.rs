//! Tables of numbers as maps: every cell shows its number, in the colour for that number.
//!
//! ```text
//!            a     b                      a     b
//!         ┌─────┬─────┐                ┌─────┬─────┐
//!   row 1 │ 0.5 │ 1.2 │          row 1 │  1  │ 0.9 │      maps side by side, cells of equal size
//!   row 2 │ 0.7 │     │          row 2 │ 1.1 │     │      NaN leaves a cell empty
//!         └─────┴─────┘                └─────┴─────┘
//! ```

use super::Picture;
use super::draw::axis::short;
use super::draw::colour::{Rgb, hex, mix, sequential};
use super::draw::layout::{Layout, Panel};
use super::draw::svg::{Anchor, INK, Rect, SOFT, Svg, TICK, width_of};

/// How a number becomes a colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Colouring {
    /// Dark to bright (viridis) from the first number to the second.
    Sequential([f64; 2]),
    /// From orange, at the first number and below, to white at the second: how much is missing.
    Deficit([f64; 2]),
    /// White at 1, blue below, orange above; full colour at this factor and at its inverse.
    Ratio {
        /// The factor, above 1.
        full: f64,
    },
}

/// How a number is written into its cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Digits {
    /// Two decimals below 10, one decimal below 100, integers above; no trailing zeros.
    Short,
    /// Always so many decimals.
    Decimals(usize),
}

/// A table to draw.
#[derive(Debug, Clone)]
pub struct NumberMap<'a> {
    /// Its title.
    pub title: &'a str,
    /// Names of the rows.
    pub rows: &'a [String],
    /// Names of the columns.
    pub columns: &'a [String],
    /// Row by row; NaN leaves a cell empty.
    pub values: Vec<Vec<f64>>,
    /// How the numbers are written.
    pub digits: Digits,
    /// Their colours.
    pub colouring: Colouring,
    /// Row and column of cells that stand out, and their marks.
    pub marks: Vec<([usize; 2], &'a str)>,
}

/// Between the names of rows and their cells, and above the cells for the names of columns, in SVG units.
const BESIDE: f64 = 8.0;
const NAMES: f64 = 14.0;

/// Draws maps side by side below a head, with cells of this width and height in units of the drawing.
pub fn number_maps(head: Layout, cell: [f64; 2], maps: &[NumberMap]) -> Picture {
    let [w, h] = cell;
    let panel = |map: &NumberMap<'_>| {
        let names = map.rows.iter().map(|name| width_of(name, TICK)).fold(0.0, f64::max);
        Panel::of([map.columns.len() as f64 * w, map.rows.len() as f64 * h])
            .with_room([names + BESIDE, NAMES, 0.0, 0.0])
            .over(map.title)
    };
    let (mut svg, frames) = head.row(maps.iter().map(panel)).open();
    for (map, rect) in maps.iter().zip(frames) {
        map.draw(&mut svg, rect, cell);
    }
    Picture::of(svg)
}

impl NumberMap<'_> {
    /// Draws it with its cells in a rectangle; `cell` is their size.
    fn draw(&self, svg: &mut Svg, Rect { x, y, .. }: Rect, [w, h]: [f64; 2]) {
        for (k, name) in self.columns.iter().enumerate() {
            svg.text([x + (k as f64 + 0.5) * w, y - 7.0], TICK, Anchor::Middle, SOFT, name);
        }
        for (j, (name, row)) in self.rows.iter().zip(&self.values).enumerate() {
            let top = y + j as f64 * h;
            svg.text([x - BESIDE, top + 0.5 * h + 3.8], TICK, Anchor::End, SOFT, name);
            for (k, value) in row.iter().enumerate().filter(|(_, value)| value.is_finite()) {
                let fill = self.colouring.of(*value);
                let rect = Rect { x: x + k as f64 * w, y: top, w, h };
                svg.rect(rect, &format!(r##"fill="{}" stroke="#ffffff" stroke-width="1""##, hex(fill)));
                let ink = if is_dark(fill) { "#ffffff" } else { INK };
                let place = [rect.x + 0.5 * w, rect.y + 0.5 * h + 3.6];
                svg.text(place, TICK - 1.0, Anchor::Middle, ink, &self.digits.write(*value));
                for (_, mark) in self.marks.iter().filter(|(cell, _)| *cell == [j, k]) {
                    svg.text([rect.x + w - 4.0, rect.y + 11.0], TICK - 1.0, Anchor::End, ink, mark);
                }
            }
        }
    }
}

impl Colouring {
    fn of(self, value: f64) -> Rgb {
        const ORANGE: Rgb = [0xd5, 0x5e, 0x00];
        const BLUE: Rgb = [0x00, 0x72, 0xb2];
        match self {
            Self::Sequential([low, high]) => sequential((value - low) / (high - low).max(f64::MIN_POSITIVE)),
            Self::Deficit([low, high]) => {
                mix(ORANGE, [0xf2, 0xf6, 0xfa], ((value - low) / (high - low)).clamp(0.0, 1.0))
            }
            Self::Ratio { full } => {
                let share = (value.max(1e-9).ln() / full.ln()).clamp(-1.0, 1.0);
                mix([0xf7, 0xf7, 0xf7], if share < 0.0 { BLUE } else { ORANGE }, share.abs())
            }
        }
    }
}

impl Digits {
    fn write(self, value: f64) -> String {
        match self {
            Self::Short => short(value),
            Self::Decimals(digits) => format!("{value:.digits$}"),
        }
    }
}

/// Whether white reads better on a colour than ink (relative luminance, Rec. 709).
fn is_dark([r, g, b]: Rgb) -> bool {
    0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b) < 130.0
}

#[cfg(test)]
mod tests {
    use super::super::testing::look;
    use super::*;

    #[test]
    fn every_number_has_a_cell_and_nan_is_left_blank() {
        let names = ["a", "b"].map(str::to_owned);
        let map = |colouring| NumberMap {
            marks: vec![([0, 0], "▲")],
            title: "numbers",
            rows: &names,
            columns: &names,
            values: vec![vec![0.5, 2.0], vec![f64::NAN, 1.0]],
            digits: Digits::Short,
            colouring,
        };
        let maps = [
            map(Colouring::Sequential([0.5, 2.0])),
            map(Colouring::Deficit([0.5, 1.0])),
            map(Colouring::Ratio { full: 2.0 }),
        ];
        let head = Layout::titled("Maps").story("two lines").story("of words");
        let picture = number_maps(head, [56.0, 26.0], &maps);
        look("number-maps", &picture);
        assert_eq!(picture.svg().matches(r##"stroke="#ffffff""##).count(), 9);
        assert!(!picture.svg().contains("NaN"));
    }

    #[test]
    fn a_ratio_of_one_is_white_and_the_ends_are_full() {
        let of = |value| Colouring::Ratio { full: 2.0 }.of(value);
        assert_eq!(
            [of(1.0), of(0.5), of(0.1), of(2.0)],
            [[0xf7, 0xf7, 0xf7], [0x00, 0x72, 0xb2], [0x00, 0x72, 0xb2], [0xd5, 0x5e, 0x00]]
        );
    }
}
