//! A trial as MJCF, for MuJoCo.
//!
//! The moving body has its origin at the COR. Its joints are slides along x, y, z and a ball, or nested
//! hinges about z, y, x, depending on the free errors; their positions are the COR in the world and the
//! rotation, so any pose can be set. The keyframe `start` holds the start of the trial.

use super::super::settings::Push;
use super::{Scene, attribute, triple};
use crate::connector::Surface;
use crate::pose::Dof;
use glam::{DQuat, DVec3};
use std::fmt::{self, Write};

/// Contact springs of two time steps, the stiffest that the engine holds stable, critically damped.
const STIFFEST: f64 = 2.0;

/// The whole file.
pub fn write(scene: &Scene) -> String {
    let mut text = String::new();
    // Writing into a string does not fail.
    let _ = compose(scene, &mut text);
    text
}

fn compose(scene: &Scene, out: &mut String) -> fmt::Result {
    options(scene, out)?;
    writeln!(out, "  <asset>")?;
    for (name, pieces) in [("fixed", &scene.fixed), ("moving", &scene.moving)] {
        for (k, piece) in pieces.iter().enumerate() {
            writeln!(
                out,
                "    <mesh name=\"{name}-{k}\" inertia=\"exact\" vertex=\"{}\"/>",
                vertices(piece)
            )?;
        }
    }
    writeln!(out, "  </asset>\n  <worldbody>\n    <light pos=\"0 0 4\"/>\n    <body name=\"fixed\">")?;
    for k in 0..scene.fixed.len() {
        writeln!(out, "      <geom mesh=\"fixed-{k}\" rgba=\"0.5 0.6 0.7 1\"/>")?;
    }
    writeln!(
        out,
        "      <site name=\"fixed_face\" size=\"0.01\"/>\n    </body>\n    <body name=\"moving\">"
    )?;
    let start = joints(scene, out)?;
    let (body, i) = (&scene.body, scene.body.inertia);
    writeln!(
        out,
        "      <inertial pos=\"{}\" mass=\"{}\" fullinertia=\"{} {} {} {} {} {}\"/>",
        triple(body.center),
        body.weight,
        i.x_axis.x,
        i.y_axis.y,
        i.z_axis.z,
        i.y_axis.x,
        i.z_axis.x,
        i.z_axis.y
    )?;
    for k in 0..scene.moving.len() {
        writeln!(out, "      <geom mesh=\"moving-{k}\" rgba=\"0.8 0.6 0.4 1\"/>")?;
    }
    let face = triple(DVec3::Z * scene.pair.alignment.center_of_rotation);
    writeln!(
        out,
        "      <site name=\"moving_face\" pos=\"{face}\" size=\"0.01\"/>\n    </body>\n  </worldbody>"
    )?;
    if let Push::Force(force) = scene.settings.push {
        writeln!(out, "  <actuator>")?;
        writeln!(
            out,
            "    <general name=\"push\" joint=\"z\" gainprm=\"0\" biastype=\"affine\" biasprm=\"{} 0 0\"/>",
            -force
        )?;
        writeln!(out, "  </actuator>")?;
    }
    let start: Vec<String> = start.iter().map(ToString::to_string).collect();
    writeln!(out, "  <keyframe>\n    <key name=\"start\" qpos=\"{}\"/>", start.join(" "))?;
    writeln!(out, "  </keyframe>\n</mujoco>")
}

/// The comment at the head, and all that is not a body.
fn options(scene: &Scene, out: &mut String) -> fmt::Result {
    let s = scene.settings;
    let (gravity, acceleration) = match s.push {
        Push::Gravity(gravity) => (gravity, gravity),
        Push::Force(force) => (0.0, force / scene.body.weight),
    };
    let spring = STIFFEST * s.timestep;
    writeln!(
        out,
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<!--\n{}\n  \
         The start is keyframe 0: mj_resetDataKeyframe(model, data, 0). qpos are the free of x, y, z of the COR in the\n  \
         world, then the rotation. Restitution is not carried over: contacts here are critically damped springs.\n  \
         They give way by about {:.1e} D under load; a smaller force and damping, or time step, makes that less.\n-->",
        scene.heading("MuJoCo"),
        acceleration * spring * spring
    )?;
    writeln!(
        out,
        "<mujoco model=\"{}\">\n  <compiler angle=\"radian\" autolimits=\"true\"/>",
        attribute(scene.name)
    )?;
    writeln!(
        out,
        "  <option timestep=\"{}\" gravity=\"0 0 {}\" integrator=\"implicitfast\" cone=\"elliptic\"/>",
        s.timestep,
        0.0 - gravity
    )?;
    let contact = if s.friction > 0.0 {
        format!("condim=\"3\" friction=\"{} 0 0\"", s.friction)
    } else {
        "condim=\"1\" friction=\"0 0 0\"".to_owned()
    };
    writeln!(
        out,
        "  <default>\n    <geom type=\"mesh\" mass=\"0\" {contact} solref=\"{spring} 1\" solimp=\"0.99 0.999 0.001\"/>\n  \
         </default>"
    )
}

/// The joints of the moving body, and their initial values.
fn joints(scene: &Scene, out: &mut String) -> Result<Vec<f64>, fmt::Error> {
    let Scene { cor, rotation, turning, pair, .. } = scene;
    let free = pair.alignment.free;
    let mut start = Vec::new();
    for (name, is_free, axis) in [
        ("x", free.contains(Dof::X), DVec3::X),
        ("y", free.contains(Dof::Y), DVec3::Y),
        ("z", true, DVec3::Z),
    ] {
        if is_free {
            let (along, damping) = (triple(axis), scene.linear_damping());
            writeln!(
                out,
                "      <joint name=\"{name}\" type=\"slide\" axis=\"{along}\" damping=\"{damping}\"/>"
            )?;
            start.push(cor.dot(axis));
        }
    }
    let damping = scene.turning_damping();
    if turning.is_spherical() {
        writeln!(out, "      <joint name=\"rotation\" type=\"ball\" damping=\"{damping}\"/>")?;
        let q = DQuat::from_mat3(rotation);
        start.extend([q.w, q.x, q.y, q.z]);
        return Ok(start);
    }
    let angles = turning.angles(rotation);
    for (dof, _) in turning.hinges(angles) {
        let (axis, angle) = match dof {
            Dof::Roll => (DVec3::X, angles[0]),
            Dof::Pitch => (DVec3::Y, angles[1]),
            _ => (DVec3::Z, angles[2]),
        };
        let (name, axis) = (dof.name(), triple(axis));
        writeln!(out, "      <joint name=\"{name}\" type=\"hinge\" axis=\"{axis}\" damping=\"{damping}\"/>")?;
        start.push(angle);
    }
    Ok(start)
}

/// All corners of a piece, each once: the engine takes their convex hull.
fn vertices(piece: &Surface) -> String {
    let list: Vec<String> = piece.vertices.iter().map(|v| triple(*v)).collect();
    list.join("  ")
}
