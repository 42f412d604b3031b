//! The window, the label of a box of poses and the shares of labels, from a tree.

use super::BoxCertificate;
use super::interval::Interval;
use super::placed::PoseBox;
use super::tree::{Label, Tree};

/// How often a window is halved.
const WINDOW_HALVINGS: usize = 24;

impl Tree {
    /// Share of the error box without a label.
    pub(super) fn undecided(&self) -> f64 {
        let open = self.leaves().filter(|(_, cell)| cell.label.is_none() && self.is_in_error_box(cell));
        open.map(|(_, cell)| self.share(cell)).sum()
    }

    /// The label that holds all over a box of poses.
    pub(super) fn label_over(&self, poses: &PoseBox) -> Option<Label> {
        self.common_label(&self.inner_places(poses)?)
    }

    /// The error box, smaller by a factor.
    fn window_of(&self, scale: f64) -> PoseBox {
        self.error_box.map(|errors| {
            if errors.up > 0.0 { Interval::new(-scale * errors.up, scale * errors.up) } else { errors }
        })
    }

    /// Whether a box lies in the error box made smaller by a factor.
    pub(super) fn is_within(&self, poses: &PoseBox, scale: f64) -> bool {
        let window = self.window_of(scale);
        self.axes.iter().all(|dof| {
            let (own, whole) = (poses[dof.index()], window[dof.index()]);
            whole.lo <= own.lo && own.up <= whole.up
        })
    }

    /// By which factor the error box may be made smaller, at least, to hold but boxes that dock.
    pub(super) fn window(&self) -> f64 {
        let docks = |scale: f64| self.label_over(&self.window_of(scale)) == Some(Label::Yes);
        if docks(1.0) {
            return 1.0;
        }
        let (mut yes, mut no) = (0.0, 1.0);
        for _ in 0..WINDOW_HALVINGS {
            let scale = f64::midpoint(yes, no);
            if docks(scale) { yes = scale } else { no = scale }
        }
        yes
    }

    /// The shares of labels, of a tree and a window; the seat is not spoken of.
    pub(super) fn certificate(&self, window: f64) -> BoxCertificate {
        let [mut yes, mut no] = [0.0; 2];
        for (_, cell) in self.leaves().filter(|(_, cell)| self.is_in_error_box(cell)) {
            match cell.label {
                Some(Label::Yes) => yes += self.share(cell),
                Some(Label::Jams | Label::Leaves) => no += self.share(cell),
                None => {}
            }
        }
        // Boxes may be larger than a window that is certain by itself.
        yes = yes.max(self.axes.iter().map(|_| window).product());
        let undecided = (1.0 - yes - no).max(0.0);
        let measure: f64 = self.axes.iter().map(|dof| self.error_box[dof.index()].width()).product();
        BoxCertificate {
            yes,
            no,
            undecided,
            measures: [yes, no, undecided].map(|share| share * measure),
            window,
            boxes: self.cells.len(),
            ..BoxCertificate::default()
        }
    }
}
