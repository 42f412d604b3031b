//! State of a cell, in a byte: its outcome, and how it was decided.

use crate::acceptance::Outcome;

/// State of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Label(u8);

impl Label {
    pub(super) const UNKNOWN: Self = Self(0);
    /// The bits of the outcome's code.
    const OUTCOME: u8 = 7;
    /// Set if a cell inherited its label.
    const JOINED: u8 = 8;
    /// Set if it inherited its label beyond the border of the box.
    const BEYOND: u8 = 16;

    /// As its own motion shows.
    pub(super) const fn own(outcome: Outcome) -> Self {
        Self(outcome as u8)
    }

    /// Inherited from the centres around the motion, or from the nearest ones if it has left the box.
    pub(super) const fn inherited(outcome: Outcome, is_beyond: bool) -> Self {
        Self(outcome as u8 | Self::JOINED | if is_beyond { Self::BEYOND } else { 0 })
    }

    pub(super) const fn is_known(self) -> bool {
        self.0 != 0
    }

    pub(super) const fn has_inherited(self) -> bool {
        self.0 & Self::JOINED != 0
    }

    pub(super) const fn has_joined_beyond(self) -> bool {
        self.0 & Self::BEYOND != 0
    }

    /// Undecided if unknown.
    pub(super) const fn outcome(self) -> Outcome {
        match self.0 & Self::OUTCOME {
            1 => Outcome::Aligned,
            2 => Outcome::Jammed,
            3 => Outcome::Missed,
            _ => Outcome::Undecided,
        }
    }

    pub(super) fn jams(self) -> bool {
        self.outcome() == Outcome::Jammed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_keeps_its_outcome_however_it_is_known() {
        assert!(!Label::UNKNOWN.is_known());
        for outcome in Outcome::ALL {
            let labels =
                [Label::own(outcome), Label::inherited(outcome, false), Label::inherited(outcome, true)];
            for (label, [inherited, beyond]) in labels.into_iter().zip([[false; 2], [true, false], [true; 2]])
            {
                assert!(label.is_known() && label.outcome() == outcome);
                assert_eq!([label.has_inherited(), label.has_joined_beyond()], [inherited, beyond]);
            }
        }
    }
}
