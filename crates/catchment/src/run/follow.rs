//! Single poses, followed exactly: what becomes of one, of many, and along which way.

use crate::acceptance::{Acceptance, Domain};
use crate::exec::{Cancelled, Exec};
use crate::method::descent::{self, End, Follower, Trajectory};
use crate::method::{DecideError, Method};
use crate::pose::PoseError;
use crate::problem::Problem;

impl Problem {
    /// Where one pose comes to rest, by exact quasi-static motion.
    pub fn follow(&self, pose: &PoseError) -> End {
        Follower::new(self.pair(), &descent::Settings::default()).rest(pose)
    }

    /// Where every pose comes to rest, in their order, on all threads of `exec`.
    ///
    /// # Errors
    /// It was asked to stop.
    pub fn follow_many(&self, poses: &[PoseError], exec: &Exec) -> Result<Vec<End>, Cancelled> {
        let domain = Domain::Poses(poses.to_vec());
        Ok(descent::rests(self.pair(), domain, &descent::Settings::default(), exec)?.1)
    }

    /// Where every pose comes to rest by a method of one's choice, and their outcomes.
    ///
    /// # Errors
    /// The method decides cells from one another, gave up, or was asked to stop.
    pub fn follow_by(
        &self,
        method: &Method,
        poses: &[PoseError],
        exec: &Exec,
    ) -> Result<(Acceptance, Vec<End>), DecideError> {
        let follow = method.follows().ok_or(DecideError::NeedsGrid { method: method.name() })?;
        follow.rest(self, Domain::Poses(poses.to_vec()), exec)
    }

    /// The way of one pose, from first contact to where it rests.
    pub fn trace(&self, pose: &PoseError) -> Trajectory {
        descent::trace(self.pair(), pose, &descent::Settings::default())
    }
}
