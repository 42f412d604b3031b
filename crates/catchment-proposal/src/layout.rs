//! Facing and approach directions of parts, and relative orientations of two parts.

use catchment_core::connector::turn_between;
use catchment_core::pose::Mount;
use glam::{DMat3, DVec3};
use std::fmt;
use std::str::FromStr;

/// A direction along an axis of a file, or half way between two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxisDirection(u8);

/// Names and vectors of all directions, each followed by its opposite: six along axes, then twelve half way between two.
const WAYS: [(&str, [f64; 3]); 18] = [
    ("+x", [1.0, 0.0, 0.0]),
    ("-x", [-1.0, 0.0, 0.0]),
    ("+y", [0.0, 1.0, 0.0]),
    ("-y", [0.0, -1.0, 0.0]),
    ("+z", [0.0, 0.0, 1.0]),
    ("-z", [0.0, 0.0, -1.0]),
    ("+x+y", [1.0, 1.0, 0.0]),
    ("-x-y", [-1.0, -1.0, 0.0]),
    ("+x-y", [1.0, -1.0, 0.0]),
    ("-x+y", [-1.0, 1.0, 0.0]),
    ("+y+z", [0.0, 1.0, 1.0]),
    ("-y-z", [0.0, -1.0, -1.0]),
    ("+y-z", [0.0, 1.0, -1.0]),
    ("-y+z", [0.0, -1.0, 1.0]),
    ("+x+z", [1.0, 0.0, 1.0]),
    ("-x-z", [-1.0, 0.0, -1.0]),
    ("+x-z", [1.0, 0.0, -1.0]),
    ("-x+z", [-1.0, 0.0, 1.0]),
];
const AXES: u8 = 6;

impl AxisDirection {
    /// The six along axes.
    pub const ALL: [Self; 6] = [Self(0), Self(1), Self(2), Self(3), Self(4), Self(5)];

    /// The twelve half way between two axes.
    pub(super) fn diagonals() -> impl Iterator<Item = Self> {
        (AXES..WAYS.len() as u8).map(Self)
    }

    /// `+x`, or `+y+z` for half way between two axes.
    pub const fn name(self) -> &'static str {
        WAYS[self.0 as usize].0
    }

    /// As a design writes it.
    pub(super) fn written(self) -> String {
        if self.0 < AXES {
            return format!("\"{}\"", self.name());
        }
        let [x, y, z] = WAYS[usize::from(self.0)].1;
        format!("[{x}, {y}, {z}]")
    }

    /// The opposite direction.
    pub(super) const fn opposite(self) -> Self {
        Self(self.0 ^ 1)
    }

    /// Unit vector.
    pub fn vector(self) -> DVec3 {
        DVec3::from_array(WAYS[usize::from(self.0)].1).normalize()
    }
}

impl fmt::Display for AxisDirection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for AxisDirection {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let plain = |name: &str| name == text || name.trim_start_matches('+') == text;
        Self::ALL.into_iter().chain(Self::diagonals()).find(|way| plain(way.name())).ok_or_else(|| {
            format!(
                "`{}` is not a direction; use one of {}, or two together, such as +y+z for half way between them",
                catchment_core::design::shortened(text),
                Self::ALL.map(Self::name).join(", ")
            )
        })
    }
}

/// How the two parts may lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PartLayout {
    /// Docked as drawn, in a common frame.
    Assembled {
        /// The direction in which the moving half comes.
        approach: AxisDirection,
    },
    /// Each in its own frame.
    Facing {
        /// Facing direction of the fixed half.
        fixed: AxisDirection,
        /// Facing direction of the moving half.
        moving: AxisDirection,
        /// Quarter turns of the moving half about the direction in which it faces.
        turned: u8,
    },
}

impl PartLayout {
    /// Each in its own frame, rotated to the orientation of a common drawing: for parts with equal frames but
    /// unrelated positions.
    pub(super) fn as_drawn(approach: AxisDirection) -> Self {
        let [fixed, moving] = [approach.opposite(), approach];
        let lie = |turned: u8| Self::Facing { fixed, moving, turned };
        let is_one = |lie: &Self| {
            let [fixed, moving] = lie.turns();
            fixed.abs_diff_eq(moving, 1e-9)
        };
        (0..4).map(lie).find(is_one).unwrap_or_else(|| lie(0))
    }

    /// Rotations of both parts into the frame of the fixed half, with the moving half face down above it.
    pub(super) fn turns(self) -> [DMat3; 2] {
        match self {
            Self::Assembled { approach } => {
                let down = turn_between(approach.vector(), DVec3::NEG_Z);
                [down, down]
            }
            Self::Facing { fixed, moving, turned } => {
                let mount =
                    DMat3::from_cols_array_2d(&DVec3::AXES.map(|axis| Mount::X.apply(axis).to_array()));
                let quarter = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
                let k = usize::from(turned % 4);
                let turn = DMat3::from_cols(quarter[k], quarter[(k + 1) % 4], DVec3::Z);
                [
                    turn_between(fixed.vector(), DVec3::Z),
                    mount * turn * turn_between(moving.vector(), DVec3::Z),
                ]
            }
        }
    }

    /// Whether two are the same but for a turn about the approach.
    pub(super) fn is_turned(self, other: Self) -> bool {
        match (self, other) {
            (Self::Facing { fixed, moving, .. }, Self::Facing { fixed: f, moving: m, .. }) => {
                (fixed, moving) == (f, m)
            }
            (Self::Assembled { .. }, _) | (_, Self::Assembled { .. }) => false,
        }
    }
}

impl fmt::Display for PartLayout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Assembled { approach } => write!(f, "docked as drawn, approach {approach}"),
            Self::Facing { fixed, moving, turned } => {
                write!(
                    f,
                    "the fixed half's face looks along {fixed}, the moving half's along {moving}, each in its file"
                )?;
                if *turned > 0 { write!(f, ", turned by {} deg", u32::from(*turned) * 90) } else { Ok(()) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_are_read_as_they_are_written() {
        for way in AxisDirection::ALL.into_iter().chain(AxisDirection::diagonals()) {
            assert_eq!(way.name().parse(), Ok(way));
            assert!((way.vector().length() - 1.0).abs() < 1e-15);
            assert_eq!(way.opposite().vector(), -way.vector());
        }
        assert_eq!("y-z".parse::<AxisDirection>().map(AxisDirection::written), Ok("[0, 1, -1]".to_owned()));
        assert_eq!(AxisDirection(1).written(), "\"-x\"");
        assert_eq!("y".parse::<AxisDirection>().map(AxisDirection::name), Ok("+y"));
        assert!("up".parse::<AxisDirection>().unwrap_err().contains("+x, -x"));
    }

    #[test]
    fn parts_may_lie_as_they_are_drawn() {
        for approach in AxisDirection::ALL.into_iter().chain(AxisDirection::diagonals()) {
            let [fixed, moving] = PartLayout::as_drawn(approach).turns();
            assert!(fixed.abs_diff_eq(moving, 1e-12));
            assert!((moving * approach.vector()).abs_diff_eq(DVec3::NEG_Z, 1e-12));
        }
    }

    #[test]
    fn all_lies_are_rotations_that_face_each_other() {
        for (fixed, moving) in
            AxisDirection::ALL.iter().flat_map(|f| AxisDirection::ALL.iter().map(move |m| (*f, *m)))
        {
            for turned in 0..4 {
                let [f, m] = PartLayout::Facing { fixed, moving, turned }.turns();
                assert_eq!((f * fixed.vector(), m * moving.vector()), (DVec3::Z, DVec3::NEG_Z));
                assert_eq!((f.determinant(), m.determinant()), (1.0, 1.0));
            }
        }
    }
}
