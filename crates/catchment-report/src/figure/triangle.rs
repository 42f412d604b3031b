//! Plots over pairs of errors, with shared axes.
//!
//! ```text
//!      y │▒▒▒│
//!   roll │▒▒▒│▒▒▒│        a column for each first error, a row for each second;
//!  pitch │▒▒▒│▒▒▒│▒▒▒│    an axis stands at the first plot of a row and at the lowest of a column
//!          x   y  roll
//! ```

use super::draw::axis::PlotFrame;
use super::draw::layout::{Layout, Panel};
use super::draw::svg::{Rect, Svg};
use catchment_core::pose::Dof;

/// Pairs of errors, each with its column and row.
pub(super) struct Triangle {
    pairs: Vec<[Dof; 2]>,
    columns: Vec<Dof>,
    rows: Vec<Dof>,
    /// Of a plot, in SVG units.
    pub(super) side: f64,
}

impl Triangle {
    /// Of these pairs: plots are smaller if there are more in a row.
    pub(super) fn of(pairs: impl IntoIterator<Item = [Dof; 2]>) -> Self {
        const SIDES: [f64; 4] = [400.0, 280.0, 230.0, 196.0];
        let pairs: Vec<[Dof; 2]> = pairs.into_iter().collect();
        let axes = |k: usize| -> Vec<Dof> {
            Dof::ALL.into_iter().filter(|dof| pairs.iter().any(|pair| pair[k] == *dof)).collect()
        };
        let (columns, rows) = (axes(0), axes(1));
        let side = SIDES[columns.len().max(rows.len()).clamp(1, SIDES.len()) - 1];
        Self { pairs, columns, rows, side }
    }

    /// How many errors are beside each other and below each other.
    pub(super) const fn size(&self) -> [usize; 2] {
        [self.columns.len(), self.rows.len()]
    }

    /// Opens a page with a plot for each pair, with so much room above each: the frames are in the order of the pairs.
    pub(super) fn open(&self, layout: Layout, above: f64) -> (Svg, Vec<Rect>) {
        let panel = |pair: [Dof; 2]| {
            if !self.pairs.contains(&pair) {
                return Panel::default();
            }
            let panel = Panel::of([self.side; 2]).with_room([0.0, above, 0.0, 0.0]);
            let panel = if self.is_first(pair) { panel.beside() } else { panel };
            if self.is_lowest(pair) { panel.below() } else { panel }
        };
        let row =
            |layout: Layout, row: &Dof| layout.row(self.columns.iter().map(|column| panel([*column, *row])));
        let (svg, frames) = self.rows.iter().fold(layout, row).open();
        let place = |axes: &[Dof], dof: Dof| axes.iter().position(|axis| *axis == dof).unwrap_or(0);
        let frame =
            |[x, y]: &[Dof; 2]| frames[place(&self.rows, *y) * self.columns.len() + place(&self.columns, *x)];
        (svg, self.pairs.iter().map(frame).collect())
    }

    /// The outline of a plot and the axes that stand at it.
    pub(super) fn draw(&self, svg: &mut Svg, pair: [Dof; 2], frame: &PlotFrame) {
        frame.outline(svg);
        if self.is_lowest(pair) {
            frame.below(svg);
        }
        if self.is_first(pair) {
            frame.beside(svg);
        }
    }

    fn is_first(&self, [x, y]: [Dof; 2]) -> bool {
        !self.pairs.iter().any(|pair| pair[1] == y && pair[0] < x)
    }

    fn is_lowest(&self, [x, y]: [Dof; 2]) -> bool {
        !self.pairs.iter().any(|pair| pair[0] == x && pair[1] > y)
    }
}
