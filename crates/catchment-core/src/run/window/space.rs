//! The family of boxes in which a window is sought: given half-widths, and others that grow with a scale.

use super::{WindowError, WindowSettings};
use crate::pose::{Dof, PoseError};
use crate::problem::Problem;

/// Shares of the half-widths, in the order of [`Dof::ALL`].
pub(super) type Direction = [f64; 5];

/// The boxes among which the window is sought.
#[derive(Debug, Clone)]
pub(super) struct Space {
    /// Half-widths of errors that are given.
    fixed: [f64; 5],
    /// Half-widths of the others at scale 1.
    growing: [f64; 5],
    /// The scale at which the first of them meets the error box.
    border: f64,
    /// The middle of the boxes.
    center: [f64; 5],
}

impl Space {
    pub(super) fn of(problem: &Problem, settings: &WindowSettings) -> Result<Self, WindowError> {
        let alignment = problem.alignment();
        let proportions = settings.proportions.map(PoseError::to_array);
        let (mut fixed, mut growing) = ([0.0; 5], [0.0; 5]);
        for axis in Dof::ALL {
            let (k, most) = (axis.index(), alignment.half_range(axis));
            let message = settings.fixed[k].or(proportions.map(|p| p[k]));
            if let Some(value) = message.filter(|value| !(value.is_finite() && *value >= 0.0)) {
                return Err(WindowError::NoSize { axis, value });
            }
            if !alignment.free.contains(axis) {
                match message {
                    Some(value) if value != 0.0 => return Err(WindowError::Locked { axis }),
                    _ => continue,
                }
            }
            match settings.fixed[k] {
                Some(half_width) if half_width > most * (1.0 + 1e-12) => {
                    return Err(WindowError::BeyondBox { axis, half_width, most });
                }
                Some(half_width) => fixed[k] = half_width,
                None => growing[k] = proportions.map_or(most, |p| p[k]),
            }
        }
        let grows = |axis: &Dof| growing[axis.index()] > 0.0;
        let ends = |axis: Dof| alignment.half_range(axis) / growing[axis.index()];
        let border = Dof::ALL.into_iter().filter(grows).map(ends).fold(f64::INFINITY, f64::min);
        let center = [0.0; 5];
        if border.is_finite() {
            Ok(Self { fixed, growing, border, center })
        } else {
            Err(WindowError::Nothing)
        }
    }

    /// All free errors grow about a place, in the proportions of the error box: at scale 1 as large as that.
    pub(super) fn about(problem: &Problem, center: [f64; 5]) -> Self {
        let alignment = problem.alignment();
        let (mut growing, mut border) = ([0.0; 5], 1.0f64);
        for axis in alignment.free.iter() {
            let most = alignment.half_range(axis);
            growing[axis.index()] = most;
            border = border.min(1.0 - center[axis.index()].abs() / most);
        }
        Self { fixed: [0.0; 5], growing, border, center }
    }

    /// A space in which a single error grows, and the others are within these half-widths.
    pub(super) fn along(problem: &Problem, axis: Dof, others: [f64; 5]) -> Self {
        let mut growing = [0.0; 5];
        growing[axis.index()] = 1.0;
        let mut fixed = others;
        fixed[axis.index()] = 0.0;
        Self { fixed, growing, border: problem.alignment().half_range(axis), center: [0.0; 5] }
    }

    pub(super) const fn border(&self) -> f64 {
        self.border
    }

    pub(super) fn half_widths(&self, scale: f64) -> [f64; 5] {
        std::array::from_fn(|k| self.fixed[k] + scale * self.growing[k])
    }

    pub(super) fn pose(&self, u: &Direction, scale: f64) -> PoseError {
        self.within(u, &self.half_widths(scale))
    }

    /// The pose at shares of these half-widths.
    pub(super) fn within(&self, shares: &Direction, widths: &[f64; 5]) -> PoseError {
        PoseError::from_array(std::array::from_fn(|k| self.center[k] + shares[k] * widths[k]))
    }

    pub(super) fn grows(&self, k: usize) -> bool {
        self.growing[k] > 0.0
    }

    pub(super) fn occurs(&self, k: usize) -> bool {
        self.growing[k] > 0.0 || self.fixed[k] > 0.0
    }

    /// The largest growing part.
    pub(super) fn largest(&self, u: &Direction) -> f64 {
        (0..5).filter(|k| self.grows(*k)).map(|k| u[k].abs()).fold(0.0, f64::max)
    }

    /// The direction scaled so that its largest growing component is 1 or −1; `None` if no error grows.
    pub(super) fn onto_surface(&self, mut u: Direction) -> Option<Direction> {
        let largest = self.largest(&u);
        for (k, part) in u.iter_mut().enumerate() {
            let scaled = if self.grows(k) { *part / largest } else { part.clamp(-1.0, 1.0) };
            *part = if self.occurs(k) { scaled } else { 0.0 };
        }
        (largest > 0.0).then_some(u)
    }

    /// All of {−1, 0, 1}ⁿ that grow.
    pub(super) fn all(&self) -> Vec<Direction> {
        let mut all = vec![[0.0; 5]];
        for k in (0..5).filter(|k| self.occurs(*k)) {
            let parts = |u: Direction| {
                [-1.0, 0.0, 1.0].map(|part| {
                    let mut u = u;
                    u[k] = part;
                    u
                })
            };
            all = all.into_iter().flat_map(parts).collect();
        }
        all.into_iter().filter_map(|u| self.onto_surface(u)).collect()
    }
}
