//! Single poses, followed exactly: what becomes of one, of many, and along which way.

use crate::acceptance::Domain;
use crate::exec::{Cancelled, Exec};
use crate::method::descent::{self, End, Trajectory};
use crate::pose::PoseError;
use crate::problem::Problem;

impl Problem {
    /// Where one pose ends, by exact quasi-static motion.
    pub fn follow(&self, pose: &PoseError) -> End {
        descent::outcome(self.pair(), pose, &descent::Settings::default())
    }

    /// Where every pose ends, in their order, on all threads of `exec`.
    ///
    /// # Errors
    /// It was asked to stop.
    pub fn follow_many(&self, poses: &[PoseError], exec: &Exec) -> Result<Vec<End>, Cancelled> {
        let domain = Domain::Poses(poses.to_vec());
        Ok(descent::run(self.pair(), domain, &descent::Settings::default(), exec)?.1)
    }

    /// The way of one pose, from first contact to its end.
    pub fn trace(&self, pose: &PoseError) -> Trajectory {
        descent::trace(self.pair(), pose, &descent::Settings::default())
    }
}
