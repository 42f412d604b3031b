//! Limits on the resources that an input may use. Bytes, elements, corners and steps of work are charged to a
//! budget before they are used, so that a small file cannot request gigabytes or hours.
//!
//! ```text
//! CORNERS = Limit { most: 2000, of: "corners", remedy: "simplify the drawing" }
//! Budget::new(CORNERS) ──spend(n)──▶ Ok, while the sum is at most 2000
//!                              └───▶ Overspent: "more than 2000 corners: simplify the drawing"
//! ```
//!
//! Every reader uses this type, keeps its limits as constants beside it, and adds the place to the message: a
//! line, a byte, or a part of an archive. Steps are counted, not measured: the same input is accepted or
//! rejected on every machine.

use std::fmt;

/// Limit on a resource of an input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limit {
    /// How many it may have.
    pub most: u64,
    /// Name of the resource: a plural noun.
    pub of: &'static str,
    /// Advice for the author of the input.
    pub remedy: &'static str,
}

impl Limit {
    /// Accepts a count that is within the limit.
    ///
    /// # Errors
    /// [`Overspent`] if `count` is larger.
    pub const fn allows(self, count: u64) -> Result<(), Overspent> {
        if count > self.most { Err(Overspent { limit: self }) } else { Ok(()) }
    }
}

/// A sum that stays within a limit.
#[derive(Debug, Clone)]
pub struct Budget {
    limit: Limit,
    spent: u64,
}

impl Budget {
    /// With nothing spent.
    pub const fn new(limit: Limit) -> Self {
        Self { limit, spent: 0 }
    }

    /// Charges `count` more; a sum beyond 64 bits is beyond every limit.
    ///
    /// # Errors
    /// [`Overspent`] if the sum would exceed the limit. Nothing is charged then.
    pub const fn spend(&mut self, count: u64) -> Result<(), Overspent> {
        let sum = self.spent.saturating_add(count);
        match self.limit.allows(sum) {
            Ok(()) => {
                self.spent = sum;
                Ok(())
            }
            Err(overspent) => Err(overspent),
        }
    }

    /// How much may still be spent.
    pub const fn left(&self) -> u64 {
        self.limit.most - self.spent
    }
}

/// An input exceeds a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Overspent {
    /// The limit.
    pub limit: Limit,
}

impl fmt::Display for Overspent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Limit { most, of, remedy } = self.limit;
        write!(f, "more than {most} {of}: {remedy}")
    }
}

impl std::error::Error for Overspent {}

#[cfg(test)]
mod tests {
    use super::*;

    const THREE: Limit = Limit { most: 3, of: "corners", remedy: "leave some out" };

    #[test]
    fn a_sum_stays_within_its_limit() {
        let mut budget = Budget::new(THREE);
        assert_eq!(budget.spend(2), Ok(()));
        let overspent = budget.spend(2).unwrap_err();
        assert_eq!(overspent.to_string(), "more than 3 corners: leave some out");
        // A refused charge is not kept.
        assert_eq!((budget.left(), budget.spend(1), budget.left()), (1, Ok(()), 0));
        assert_eq!(budget.spend(0), Ok(()));
        assert!(budget.spend(u64::MAX).is_err());
    }

    #[test]
    fn a_limit_is_inclusive() {
        assert!(THREE.allows(3).is_ok() && THREE.allows(4).is_err());
    }
}
