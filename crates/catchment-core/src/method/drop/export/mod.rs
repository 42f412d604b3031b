//! A trial for other engines: world files that can be run again in MuJoCo or Gazebo.
//!
//! ```text
//!   Scene ──▶ mjcf::write   one XML file: convex pieces as vertex lists inside
//!     │  └──▶ sdf::write    an SDF world, and the STL files that it names
//!     └ pieces, mass, inertia, damping, friction, force, start, free errors: the values of `run` for its first trial,
//!       unperturbed
//! ```
//!
//! Pieces remain as drawn, as a user of the other program expects; `run` uses the columns of the combined
//! solid if it has them. Both engines accept only convex pieces; a mesh that is not a union of columns is
//! rejected, not approximated.

pub mod mjcf;
pub mod sdf;

use super::engine::stays_locked;
use super::mass::Mass;
use super::pieces::{Part, parts};
use super::settings::{DropSettings, Launch, Push, SettingError};
use super::turning::Turning;
use crate::connector::{Half, Surface};
use crate::contact::Pair;
use crate::pose::{CorPose, PoseError};
use glam::{DMat3, DVec3};

/// A trial, ready to be written.
#[derive(Debug, Clone)]
pub struct Scene<'a> {
    /// Name of the design, for the file's heading.
    pub name: &'a str,
    pair: &'a Pair,
    settings: &'a DropSettings,
    error: PoseError,
    cor: DVec3,
    rotation: DMat3,
    body: Mass,
    fixed: Vec<Surface>,
    moving: Vec<Surface>,
    turning: Turning,
}

/// Why a trial cannot be written for other engines.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExportError {
    /// A setting that no trial can be made with.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// A surface that is neither convex nor a union of columns.
    #[error(
        "surface {surface} of the {half} half has undercuts, and other engines take convex pieces only: give the half as \
         convex pieces (connector.{half}.pieces)"
    )]
    NotConvex {
        /// `fixed` or `moving`.
        half: &'static str,
        /// Which surface, from 0.
        surface: usize,
    },
    /// A ground plane, which the files do not support.
    #[error("a ground plane is not exported: leave it out here, and add one to the file")]
    Ground,
    /// A half that moves at its release, which the files do not support.
    #[error(
        "a half that is let go in motion is not exported: leave its speed, drift and spin out here, and add them to the file"
    )]
    Launch,
    /// The halves pass each other by.
    #[error("with this error the halves pass each other by: there is nothing to drop onto")]
    NoContact,
    /// A translation is locked at the COR, but the centre of mass swings about it.
    #[error(transparent)]
    OffCenter(super::DropError),
}

impl<'a> Scene<'a> {
    /// The trial that starts with `error`.
    ///
    /// # Errors
    /// See [`ExportError`].
    pub fn new(
        name: &'a str,
        pair: &'a Pair,
        settings: &'a DropSettings,
        error: &PoseError,
    ) -> Result<Self, ExportError> {
        settings.check()?;
        if settings.ground.is_some() {
            return Err(ExportError::Ground);
        }
        if settings.launch != Launch::default() {
            return Err(ExportError::Launch);
        }
        let alignment = &pair.alignment;
        let body = Mass::of(&pair.moving, settings, alignment);
        if !stays_locked(&body.center, alignment.free) {
            return Err(ExportError::OffCenter(super::DropError::OffCenter { center: body.center }));
        }
        let start = CorPose::from_error(error, alignment.center_of_rotation, alignment.free);
        let height = pair.height(&start).ok_or(ExportError::NoContact)?;
        Ok(Self {
            name,
            pair,
            settings,
            error: *error,
            cor: start.lateral.extend(height + settings.drop_height),
            rotation: start.rotation,
            body,
            fixed: convex(&pair.fixed, "fixed")?,
            moving: convex(&pair.moving, "moving")?,
            turning: Turning::new(alignment.free),
        })
    }

    /// The lines of the comment at the head of a file.
    fn heading(&self, engine: &str) -> String {
        let alignment = &self.pair.alignment;
        let angles = [self.error.roll, self.error.pitch, self.error.yaw];
        let names = |free: bool| {
            let dofs = crate::pose::Dof::ALL.into_iter().filter(|dof| alignment.free.contains(*dof) == free);
            let names: Vec<_> = dofs.map(crate::pose::Dof::name).collect();
            if names.is_empty() { "none".to_owned() } else { names.join(" ") }
        };
        let push = match self.settings.push {
            Push::Force(force) => format!("force {force} kg·D/s² along -z through the centre of rotation"),
            Push::Gravity(gravity) => format!("gravity {gravity} D/s² along -z"),
        };
        let s = self.settings;
        format!(
            "  A drop test of \"{}\", written by catchment {} for {engine}.\n  \
             Units: lengths in D (the connector's width), s, kg, radians. z is the approach axis, the origin the face centre of the\n  \
             fixed half. The moving half is given from its centre of rotation (COR), {} D in front of its face centre.\n  \
             Free: {}; locked at the COR: {}.\n  \
             Start: x {} y {} D, roll {} pitch {} yaw {} rad of the face centre, {} D above first contact, at rest.\n  \
             Driven by {push}.\n  \
             Damping: force -{} v at the COR, torque -{} ω. Friction {}, restitution {}.\n  \
             Docked: the COR at z <= {:.6} D, and connected with the mated pose below that; missed: farther apart than at first\n  \
             contact by {} D; jammed: at rest elsewhere; give up after {} s.\n",
            comment(self.name),
            env!("CARGO_PKG_VERSION"),
            alignment.center_of_rotation,
            names(true),
            names(false),
            self.error.x,
            self.error.y,
            angles[0],
            angles[1],
            angles[2],
            s.drop_height,
            self.linear_damping(),
            self.turning_damping(),
            s.friction,
            s.restitution,
            self.pair.mated_height() + alignment.docked.depth,
            s.lost_beyond,
            s.timeout,
        )
    }

    /// c, in kg/s.
    fn linear_damping(&self) -> f64 {
        self.body.weight * self.settings.damping
    }

    /// c·ρ² of turning, in kg·D²/s.
    fn turning_damping(&self) -> f64 {
        let turning = self.settings.angular_damping * self.settings.inertia_factor;
        self.body.weight * turning * self.pair.alignment.rotation_length.powi(2)
    }
}

/// The convex pieces of a half.
fn convex(half: &Half, name: &'static str) -> Result<Vec<Surface>, ExportError> {
    let mut pieces = Vec::new();
    for (surface, whole) in half.solids().iter().enumerate() {
        for part in parts(&Half::of(vec![whole.clone()])) {
            match part {
                Part::Convex(piece) => pieces.push(piece),
                Part::Mesh(_) => return Err(ExportError::NotConvex { half: name, surface }),
            }
        }
    }
    Ok(pieces)
}

/// A name that may stand in an XML comment.
fn comment(name: &str) -> String {
    name.chars().map(|c| if c.is_control() || c == '-' { ' ' } else { c }).collect()
}

/// A name that may stand in an XML attribute.
fn attribute(name: &str) -> String {
    let mut text = String::with_capacity(name.len());
    for c in name.chars() {
        match c {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '"' => text.push_str("&quot;"),
            c if c.is_control() => text.push(' '),
            c => text.push(c),
        }
    }
    text
}

/// Three numbers with all their digits.
fn triple(v: DVec3) -> String {
    format!("{} {} {}", v.x, v.y, v.z)
}
