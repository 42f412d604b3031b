//! Figures of merit: one file each, all computed from an [`crate::acceptance::Acceptance`].
