//! A trial in the engine: the moving half is released above the fixed half and falls until it is docked, at
//! rest, lost, or out of time.
//!
//! Every trial has its own world, so trials are independent. The engine (rapier) moves a body with the mass
//! of [`Mass::damped`]; between steps the velocity is corrected to the momentum of the true body.

use super::DropError;
use super::mass::Mass;
use super::pieces::{Part, parts};
use super::settings::{DropSettings, Launch, Push};
use super::turning::Turning;
use crate::acceptance::Outcome;
use crate::connector::Half;
use crate::contact::{Pair, Seat};
use crate::exec::{Cancelled, Exec};
use crate::method::descent::{self, End, Touch};
use crate::pose::{CorPose, Dof, DofSet, PoseError, face_from_cor, rotation};
use crate::tolerance::COINCIDENT;
use glam::{DMat3, DQuat, DVec2, DVec3};
use rapier3d_f64::parry::mass_properties::MassProperties;
use rapier3d_f64::parry::shape::TriMeshFlags;
use rapier3d_f64::prelude::{
    ColliderBuilder, ContactPair, FrictionModel, IntegrationParameters, PhysicsWorld, Pose, RigidBodyBuilder,
    RigidBodyHandle, SharedShape, SpringCoefficients,
};

/// The halves as the engine takes them: the same for any settings.
pub(super) struct Shapes {
    fixed: Vec<SharedShape>,
    moving: Vec<SharedShape>,
}

impl Shapes {
    pub(super) fn of(pair: &Pair) -> Result<Self, DropError> {
        let of = |half: &Half| parts(half).iter().map(shape).collect::<Result<_, _>>();
        Ok(Self { fixed: of(&pair.fixed)?, moving: of(&pair.moving)? })
    }
}

/// A pair with settings.
pub(super) struct Engine<'a> {
    pair: &'a Pair,
    settings: &'a DropSettings,
    shapes: &'a Shapes,
    /// z of the ground, in D.
    ground: Option<f64>,
    /// The moving half as it is.
    body: Mass,
    /// The moving half as an implicit step moves it.
    damped: Mass,
    turning: Turning,
}

/// Steps between two checks of the cancel flag and of the state of rest.
const WINDOW: usize = 64;
/// Windows in a row in which a half at rest does not move.
const WINDOWS: u32 = 2;
/// Steps in a row for which an aligned half stays aligned.
const SETTLED: u32 = 10;
/// Springs give way by so much, in D, as they do in the seat.
pub(super) const SUNK: f64 = 2e-3;

/// Parameters of the contact solver. Contacts are springs that remove a part of an overlap per step: this
/// setting, in steps per cycle and critically damped, leaves 10⁻³ D if the half pushes by 0.005 D per step,
/// and does not oscillate.
const STEPS_PER_CYCLE: f64 = 4.0;
const CONTACT_DAMPING: f64 = 2.0;
/// Sweeps over all contacts per step, with and without the push that takes overlaps away.
const SWEEPS: usize = 8;
const RELAXATIONS: usize = 2;

impl<'a> Engine<'a> {
    pub(super) fn new(
        pair: &'a Pair,
        shapes: &'a Shapes,
        settings: &'a DropSettings,
    ) -> Result<Self, DropError> {
        settings.check()?;
        let alignment = &pair.alignment;
        let body = Mass::of(&pair.moving, settings, alignment);
        let turning = Turning::new(alignment.free);
        if !stays_locked(&body.center, alignment.free) {
            return Err(DropError::OffCenter { center: body.center });
        }
        Ok(Self {
            pair,
            settings,
            shapes,
            ground: settings.ground.map(|below| lowest(&pair.fixed, &DMat3::IDENTITY) - below),
            body,
            damped: body.damped(settings, alignment.rotation_length),
            turning,
        })
    }

    /// Lets the half go with this error and follows it to its end.
    pub(super) fn fall(&self, error: &PoseError, exec: &Exec) -> Result<End, Cancelled> {
        self.watch(error, exec, &mut |_, _| {})
    }

    /// The same; `seen` receives the state of the half at its release, as step 0, and after every step.
    pub(super) fn watch(
        &self,
        error: &PoseError,
        exec: &Exec,
        seen: &mut dyn FnMut(usize, &Fall<'_>),
    ) -> Result<End, Cancelled> {
        exec.check()?;
        let alignment = &self.pair.alignment;
        let start = CorPose::from_error(error, alignment.center_of_rotation, alignment.free);
        let Some(height) = self.pair.height(&start) else {
            // Nothing below it: it falls past.
            return Ok(End::missed(*error));
        };
        // A part that extends beyond the fixed half may hit the ground first.
        let on_ground = self.ground.map(|ground| ground - lowest(&self.pair.moving, &start.rotation));
        let height = on_ground.map_or(height, |on_ground| height.max(on_ground));
        let cor = start.lateral.extend(height + self.settings.drop_height);
        let mut fall = Fall::new(self, cor, start.rotation);
        let lost = self.apart(cor.with_z(height), &start.rotation) + self.settings.lost_beyond;
        let mut seat = Seat::new(self.pair);
        let all_count = descent::all_count(self.pair);
        let mut seated = false;
        let mut settled = 0;
        let mut quiet = 0;
        let mut before = fall.place();
        seen(0, &fall);
        for step in 1..=self.settings.steps() {
            fall.step();
            let (cor, rotation) = fall.place();
            if !(cor.is_finite() && rotation.is_finite()) {
                return Ok(End { outcome: Outcome::Undecided, error: *error, height: None });
            }
            seen(step, &fall);
            let apart = self.apart(cor, &rotation);
            let energy = self.pair.energy(&CorPose { lateral: cor.truncate(), rotation }, cor.z);
            // The path into the seat is searched only once: a half deep enough stays in its connected part.
            seated = (seat.floor() - SUNK..=seat.level()).contains(&energy)
                && (seated || seat.holds(&self.end(Outcome::Aligned, cor, &rotation).error, cor.z));
            settled = if seated { settled + 1 } else { 0 };
            if settled >= SETTLED && all_count {
                return Ok(self.end(Outcome::Aligned, cor, &rotation));
            }
            if apart > lost {
                return Ok(self.end(Outcome::Missed, cor, &rotation));
            }
            if step.is_multiple_of(WINDOW) {
                exec.check()?;
                let time = WINDOW as f64 * self.settings.timestep;
                let moved = (cor - before.0).length() + self.turn(&before.1, &rotation);
                let rests = moved <= self.settings.rest_speed * time && fall.touches();
                quiet = if rests { quiet + 1 } else { 0 };
                if quiet >= WINDOWS {
                    let end = self.end(Outcome::Aligned, cor, &rotation);
                    let docked = seated && seat.allows(&end.error, cor.z);
                    return Ok(if docked { end } else { End { outcome: Outcome::Jammed, ..end } });
                }
                before = (cor, rotation);
            }
        }
        let (cor, rotation) = fall.place();
        Ok(self.end(if quiet > 0 { Outcome::Jammed } else { Outcome::Undecided }, cor, &rotation))
    }

    /// Distance between the face centres, in D.
    fn apart(&self, cor: DVec3, rotation: &DMat3) -> f64 {
        (cor + face_from_cor(rotation, self.pair.alignment.center_of_rotation)).length()
    }

    /// When a step ends, in s.
    pub(super) fn time(&self, step: usize) -> f64 {
        step as f64 * self.settings.timestep
    }

    /// ρ times the angle between two rotations near each other, in D.
    pub(super) fn turn(&self, from: &DMat3, to: &DMat3) -> f64 {
        crate::pose::rotation_angle(&(*to * from.transpose())) * self.pair.alignment.rotation_length
    }

    pub(super) fn end(&self, outcome: Outcome, cor: DVec3, rotation: &DMat3) -> End {
        let pose = CorPose { lateral: DVec2::new(cor.x, cor.y), rotation: *rotation };
        let mut error = pose.to_error(self.pair.alignment.center_of_rotation);
        [error.roll, error.pitch, error.yaw] = self.turning.angles(rotation);
        let height = (outcome != Outcome::Missed).then_some(cor.z);
        End { outcome, error, height }
    }
}

/// Whether a translation locked at the centre of mass, as in the engine, is also locked at the COR: no free
/// rotation may move the two relative to each other along it.
pub(super) fn stays_locked(center: &DVec3, free: DofSet) -> bool {
    let turns: Vec<Dof> = free.iter().filter(|dof| dof.is_rotation()).collect();
    let beside = center.truncate().length() > COINCIDENT;
    let holds = |locked: Dof, axis: Dof| {
        free.contains(locked)
            || match turns[..] {
                [] => true,
                [turn] => turn == axis || turn == Dof::Yaw && !beside,
                _ => false,
            }
    };
    center.length() <= COINCIDENT || holds(Dof::X, Dof::Roll) && holds(Dof::Y, Dof::Pitch)
}

/// z of the lowest corner of a turned half, in D.
fn lowest(half: &Half, rotation: &DMat3) -> f64 {
    let corners = half.surfaces.iter().flat_map(|surface| &surface.vertices);
    corners.map(|corner| (*rotation * *corner).z).fold(f64::INFINITY, f64::min)
}

/// A part as the engine's shape.
fn shape(part: &Part) -> Result<SharedShape, DropError> {
    match part {
        Part::Convex(surface) => SharedShape::convex_mesh(surface.vertices.clone(), &surface.triangles())
            .or_else(|| SharedShape::convex_hull(&surface.vertices))
            .ok_or(DropError::Shape { reason: "a convex piece is too thin for it".to_owned() }),
        Part::Mesh(surface) => {
            // These flags require a closed, outward-wound surface, which `Surface` guarantees.
            let flags = TriMeshFlags::ORIENTED | TriMeshFlags::FIX_INTERNAL_EDGES;
            SharedShape::trimesh_with_flags(surface.vertices.clone(), surface.triangles(), flags)
                .map_err(|error| DropError::Shape { reason: error.to_string() })
        }
    }
}

/// A world with a falling half.
pub(super) struct Fall<'a> {
    engine: &'a Engine<'a>,
    world: PhysicsWorld,
    half: RigidBodyHandle,
    /// The fixed half, if it must be held.
    held: Option<RigidBodyHandle>,
}

/// Weight of a held fixed half, as a multiple of that of the moving half.
const HEAVY: f64 = 1e6;

impl<'a> Fall<'a> {
    fn new(engine: &'a Engine<'a>, cor: DVec3, rotation: DMat3) -> Self {
        let settings = engine.settings;
        let softness = SpringCoefficients {
            natural_frequency: 1.0 / (STEPS_PER_CYCLE * settings.timestep),
            damping_ratio: CONTACT_DAMPING,
        };
        let mut world = PhysicsWorld::new();
        world.gravity = DVec3::ZERO;
        world.integration_parameters = IntegrationParameters {
            dt: settings.timestep,
            contact_softness: softness,
            static_contact_softness: softness,
            num_solver_iterations: 1,
            num_internal_pgs_iterations: SWEEPS,
            num_internal_stabilization_iterations: RELAXATIONS,
            // Contacts are found anew in every step.
            contact_recycling: false,
            // Friction must hold before the half has moved on.
            friction_in_bias_pass: true,
            // The simplified model is the same without friction, and faster.
            friction_model: if settings.friction > 0.0 {
                FrictionModel::Coulomb
            } else {
                FrictionModel::Simplified
            },
            ..IntegrationParameters::default()
        };
        let free = |dof| engine.pair.alignment.free.contains(dof);
        // The engine solves friction along two tangents at once, and drops it altogether if nothing can move
        // along either of them. In that case the fixed half is heavy instead of fixed, and is put back after
        // every step.
        let held = settings.friction > 0.0 && !(free(Dof::X) && free(Dof::Y));
        let fixed = world.insert_body(if held {
            let heavy = MassProperties::new(DVec3::ZERO, HEAVY * engine.damped.weight, DVec3::ZERO);
            RigidBodyBuilder::dynamic()
                .additional_mass_properties(heavy)
                .gyroscopic_forces_enabled(false)
                .can_sleep(false)
        } else {
            RigidBodyBuilder::fixed()
        });
        let (velocity, spin) = engine.launch(&rotation);
        let half = RigidBodyBuilder::dynamic()
            .pose(Pose::from_parts(cor, DQuat::from_mat3(&rotation)))
            .linvel(velocity)
            .angvel(spin)
            .additional_mass_properties(engine.mass_properties(&rotation))
            .enabled_translations(free(Dof::X), free(Dof::Y), true)
            .gyroscopic_forces_enabled(engine.turning.is_spherical())
            .can_sleep(false);
        let half = world.insert_body(half);
        for (body, shapes) in [(fixed, &engine.shapes.fixed), (half, &engine.shapes.moving)] {
            for shape in shapes {
                let collider = ColliderBuilder::new(shape.clone())
                    .density(0.0)
                    .friction(settings.friction)
                    .restitution(settings.restitution);
                world.insert_collider(collider, Some(body));
            }
        }
        if let Some(z) = engine.ground {
            let ground = ColliderBuilder::new(SharedShape::halfspace(DVec3::Z))
                .translation(DVec3::Z * z)
                .density(0.0)
                .friction(settings.friction)
                .restitution(settings.restitution);
            world.insert_collider(ground, Some(fixed));
        }
        Self { engine, world, half, held: held.then_some(fixed) }
    }

    /// The COR and the rotation.
    pub(super) fn place(&self) -> (DVec3, DMat3) {
        let pose = self.world.bodies[self.half].position();
        (pose.translation, DMat3::from_quat(pose.rotation))
    }

    /// Whether anything touches.
    pub(super) fn touches(&self) -> bool {
        self.world.narrow_phase.contact_pairs().any(ContactPair::has_any_active_contact)
    }

    /// The contacts, in the world, with unit normals towards the moving half; the ground counts as fixed.
    pub(super) fn contacts(&self) -> Vec<Touch> {
        let mut result: Vec<Touch> = Vec::new();
        for pair in self.world.narrow_phase.contact_pairs() {
            let Some(first) = self.world.colliders.get(pair.collider1) else { continue };
            let towards = if first.parent() == Some(self.half) { -1.0 } else { 1.0 };
            for manifold in pair.manifolds() {
                let place =
                    manifold.subshape_pos1().map_or(*first.position(), |part| *first.position() * part);
                let pushes = manifold.points.iter().filter(|contact| contact.data.impulse > 0.0);
                for contact in pushes {
                    let touch =
                        Touch { point: place * contact.local_p1, normal: manifold.data.normal * towards };
                    // Several pieces of a half that meet at a point report the same contact.
                    let is_known = |known: &Touch| {
                        known.point.distance(touch.point) < COINCIDENT && known.normal.dot(touch.normal) > 0.5
                    };
                    if !result.iter().any(is_known) {
                        result.push(touch);
                    }
                }
            }
        }
        result
    }

    fn step(&mut self) {
        let Engine { settings, body, damped, turning, .. } = self.engine;
        let (_, rotation) = self.place();
        let half = &mut self.world.bodies[self.half];
        // The same momentum, about the centre of the damped body.
        let arm = rotation * (body.center - damped.center);
        let (v, spin) = (half.linvel(), half.angvel());
        let linear = (v + spin.cross(arm)) * body.weight;
        let angular = rotation * (body.inertia * (rotation.transpose() * spin)) + arm.cross(linear);
        half.set_linvel(linear / damped.weight, true);
        half.set_angvel(turning.inverse_inertia(&damped.inertia, &rotation) * angular, true);
        let (force, at) = match settings.push {
            Push::Force(force) => (force, -(rotation * damped.center)),
            Push::Gravity(gravity) => (body.weight * gravity, arm),
        };
        let force = -DVec3::Z * force;
        half.reset_forces(true);
        half.reset_torques(true);
        half.add_force(force, true);
        half.add_torque(at.cross(force), true);
        self.world.step();
        if let Some(fixed) = self.held {
            let fixed = &mut self.world.bodies[fixed];
            fixed.set_position(Pose::IDENTITY, true);
            fixed.set_linvel(DVec3::ZERO, true);
        }
        if turning.hinges_move() {
            self.realign();
        }
    }

    /// Takes away the turn beside the hinges, and moves the locked axes along with them.
    fn realign(&mut self) {
        let (_, turned) = self.place();
        let [roll, pitch, yaw] = self.engine.turning.angles(&turned);
        let rotation = rotation(roll, pitch, yaw);
        let half = &mut self.world.bodies[self.half];
        half.set_rotation(DQuat::from_mat3(&rotation), true);
        half.set_additional_mass_properties(self.engine.mass_properties(&rotation), true);
    }
}

impl Engine<'_> {
    /// Velocity of the centre of the damped body and its rate of rotation, at the release of the half with
    /// this rotation: from those of the COR and of the free hinges.
    fn launch(&self, rotation: &DMat3) -> (DVec3, DVec3) {
        let Launch { speed, drift: [x, y], spin } = self.settings.launch;
        let free = |dof, rate: f64| if self.pair.alignment.free.contains(dof) { rate } else { 0.0 };
        let hinges = self.turning.hinges(self.turning.angles(rotation));
        let rate = |dof: Dof| spin[dof.index() - Dof::Roll.index()];
        let turning: DVec3 = hinges.into_iter().map(|(dof, axis)| axis * rate(dof)).sum();
        let cor = DVec3::new(free(Dof::X, x), free(Dof::Y, y), -speed);
        (cor + turning.cross(*rotation * self.damped.center), turning)
    }

    /// Mass properties for the engine at this rotation.
    fn mass_properties(&self, rotation: &DMat3) -> MassProperties {
        let damped = &self.damped;
        if self.turning.is_spherical() {
            return MassProperties::with_inertia_matrix(damped.center, damped.weight, damped.inertia);
        }
        let inverse = self.turning.inverse_inertia(&damped.inertia, rotation);
        let local = rotation.transpose() * inverse * *rotation;
        // As for an inertia, but its principal values are inverse already: 0 is a locked axis.
        let mut properties = MassProperties::with_inertia_matrix(damped.center, damped.weight, local);
        properties.inv_principal_inertia = properties.principal_inertia();
        properties
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Surface;
    use crate::design::Family;
    use crate::method::drop::tests::pair;
    use crate::pose::DofSet;

    #[test]
    fn a_half_at_rest_overlaps_by_a_thousandth_and_settles_mated() {
        let (pair, settings) = (pair(Family::Pyramid, DofSet::ALL), DropSettings::default());
        let shapes = Shapes::of(&pair).unwrap();
        let engine = Engine::new(&pair, &shapes, &settings).unwrap();
        let cor = pair.alignment.center_of_rotation;
        let mut fall = Fall::new(&engine, DVec3::new(0.02, 0.0, 0.01 - cor), DMat3::IDENTITY);
        for _ in 0..400 {
            fall.step();
        }
        let (at, rotation) = fall.place();
        let face = at + face_from_cor(&rotation, cor);
        assert!(fall.touches());
        assert!(face.z < 0.0 && face.z > -2e-3 && face.truncate().length() < 1e-4, "{face}");
    }

    #[test]
    fn triangles_hold_like_pieces() {
        let (pair, settings) = (pair(Family::Pyramid, DofSet::ALL), DropSettings::default());
        let mut shapes = Shapes::of(&pair).unwrap();
        let mut outcomes = Vec::new();
        for meshes in [false, true] {
            if meshes {
                let mesh = |surface: &Surface| shape(&Part::Mesh(surface.clone())).unwrap();
                shapes.fixed = pair.fixed.surfaces.iter().map(mesh).collect();
            }
            let engine = Engine::new(&pair, &shapes, &settings).unwrap();
            let fall = |k: u32| {
                let [x, yaw] = [0.02, 0.05].map(|step| step * f64::from(k));
                engine
                    .fall(&PoseError { x, yaw, pitch: 0.1, ..PoseError::default() }, &Exec::new())
                    .unwrap()
                    .outcome
            };
            outcomes.push((0..8).map(fall).collect::<Vec<_>>());
        }
        assert_eq!(outcomes[0], outcomes[1]);
        assert!(outcomes[0].contains(&Outcome::Aligned));
    }
}
