//! Test whether motions with friction pass states in which Coulomb's law also permits stiction.

use catchment_core::method::descent::{self, Follower};
use catchment_core::method::{Method, PoseMethod};
use catchment_core::pose::PoseError;
use catchment_core::problem::Problem;
use std::sync::OnceLock;

/// Of listed poses with friction: each is followed once more when its answer is first needed.
#[derive(Debug)]
pub struct MayStick<'a> {
    problem: &'a Problem,
    poses: &'a [PoseError],
    settings: descent::DescentSettings,
    known: Vec<OnceLock<bool>>,
}

impl<'a> MayStick<'a> {
    /// Of poses that a method decides; `None` of methods without exact motions, and without friction.
    pub fn of(problem: &'a Problem, method: &Method, poses: &'a [PoseError]) -> Option<Self> {
        let is_descent = method.follows().is_some_and(PoseMethod::is_descent);
        let settings = is_descent.then(|| method.motions())?;
        let known = vec![OnceLock::new(); poses.len()];
        (settings.friction > 0.0).then_some(Self { problem, poses, settings, known })
    }

    /// Whether a pose of the list slips through a state in which some contact force could hold it ([`Follower::follow_doubting`]).
    pub fn may_stick(&self, number: usize) -> bool {
        let (Some(pose), Some(known)) = (self.poses.get(number), self.known.get(number)) else {
            return false;
        };
        *known.get_or_init(|| {
            Follower::new(self.problem.pair(), &self.settings).follow_doubting(pose).1.may_stick
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment_core::design::read;
    use serde_json::json;

    /// In the valley of a pyramid of AR ½ a half may stick from 0.577 on and slips until 0.612.
    #[test]
    fn between_the_two_thresholds_of_a_valley_it_may_stick() {
        let text = "[connector]\nfamily = \"pyramid\"\naspect_ratio = 0.5\n[alignment]\nfree = [\"x\", \"y\", \"roll\", \"pitch\", \"yaw\"]\n\
                    center_of_rotation = 0.5\nrotation_length = 0.5\n";
        let problem = Problem::of(read(text, ".".as_ref()).unwrap().design).unwrap();
        let poses = [PoseError { x: 0.2, y: 0.2, ..PoseError::default() }];
        let at = |friction: f64| {
            let changes = json!({ "friction": friction });
            let method: Method = "descent".parse().unwrap();
            method.with(changes.as_object().unwrap()).unwrap()
        };
        assert!(MayStick::of(&problem, &at(0.59), &poses).unwrap().may_stick(0));
        assert!(!MayStick::of(&problem, &at(0.5), &poses).unwrap().may_stick(0));
        assert!(MayStick::of(&problem, &at(0.0), &poses).is_none());
        assert!(MayStick::of(&problem, &"drop".parse().unwrap(), &poses).is_none());
    }
}
