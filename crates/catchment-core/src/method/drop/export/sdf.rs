//! A trial as an SDF world, for Gazebo: the world and the STL files of the pieces, which SDF cannot embed.
//!
//! If all errors are free the moving half floats; if not, it hangs on a chain of sliders and hinges at the
//! COR, with nearly massless intermediate links. Damping is given as the decay of the velocity per step
//! (`velocity_decay`), as in the dissertation.

use super::super::settings::Push;
use super::{Scene, attribute, triple};
use crate::connector::stl::{StlEncoding, write as write_stl};
use crate::connector::{Half, Surface};
use crate::pose::{Dof, euler_angles};
use glam::DVec3;
use std::fmt::Write;
use std::io;

/// Weight of a link between two joints, as a share of the moving half's.
const LIGHT: f64 = 1e-3;
/// Name of the folder of the meshes, beside the world.
pub const MESHES: &str = "meshes";

/// A world and the files that it names.
#[derive(Debug, Clone, PartialEq)]
pub struct World {
    /// The SDF.
    pub text: String,
    /// Name and content of each file of the folder [`MESHES`] beside it.
    pub meshes: Vec<(String, Vec<u8>)>,
}

/// The world and its meshes: relative paths, with their content.
///
/// # Errors
/// Never in practice: meshes are written into memory.
pub fn write(scene: &Scene) -> io::Result<World> {
    let mut files = Vec::new();
    for (name, pieces) in [("fixed", &scene.fixed), ("moving", &scene.moving)] {
        for (k, piece) in pieces.iter().enumerate() {
            let mut bytes = Vec::new();
            write_stl(&Half::of(vec![Surface::clone(piece)]), StlEncoding::Binary, &mut bytes)?;
            files.push((format!("{name}-{k}.stl"), bytes));
        }
    }
    let mut text = String::new();
    // Writing into a string does not fail.
    let _ = compose(scene, &mut text);
    Ok(World { text, meshes: files })
}

fn compose(scene: &Scene, out: &mut String) -> std::fmt::Result {
    let Scene { settings: s, body, cor, rotation, turning, pair, .. } = scene;
    let centered = body.center.length() == 0.0;
    // SDF has no constant force. Gravity replaces it if the centre of mass is the COR; if not, a plugin
    // applies the force.
    let (gravity, wrench) = match s.push {
        Push::Gravity(gravity) => (gravity, None),
        Push::Force(force) if centered => (force / body.weight, None),
        Push::Force(force) => (0.0, Some(force)),
    };
    writeln!(
        out,
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<!--\n{}-->",
        scene.heading("Gazebo (SDF 1.9)")
    )?;
    writeln!(out, "<sdf version=\"1.9\">\n  <world name=\"{}\">", attribute(scene.name))?;
    writeln!(
        out,
        "    <physics name=\"drop\" type=\"ode\">\n      <max_step_size>{}</max_step_size>\n    </physics>",
        s.timestep
    )?;
    writeln!(out, "    <gravity>0 0 {}</gravity>", 0.0 - gravity)?;
    writeln!(out, "    <plugin filename=\"gz-sim-physics-system\" name=\"gz::sim::systems::Physics\"/>")?;
    if let Some(force) = wrench {
        writeln!(
            out,
            "    <plugin filename=\"gz-sim-apply-link-wrench-system\" name=\"gz::sim::systems::ApplyLinkWrench\">\n      \
             <persistent><entity_name>moving::half</entity_name><entity_type>link</entity_type>\
             <force>0 0 {}</force></persistent>\n    </plugin>",
            -force
        )?;
    }
    writeln!(out, "    <model name=\"fixed\">\n      <static>true</static>\n      <link name=\"half\">")?;
    geometry(out, "fixed", scene.fixed.len(), scene)?;
    let (roll, pitch, yaw) = euler_angles(rotation);
    writeln!(out, "      </link>\n    </model>\n    <model name=\"moving\">")?;
    writeln!(out, "      <pose>{} {roll} {pitch} {yaw}</pose>\n      <link name=\"half\">", triple(*cor))?;
    let i = body.inertia;
    writeln!(
        out,
        "        <inertial><pose>{} 0 0 0</pose><mass>{}</mass><inertia><ixx>{}</ixx><iyy>{}</iyy><izz>{}</izz>\
         <ixy>{}</ixy><ixz>{}</ixz><iyz>{}</iyz></inertia></inertial>",
        triple(body.center),
        body.weight,
        i.x_axis.x,
        i.y_axis.y,
        i.z_axis.z,
        i.y_axis.x,
        i.z_axis.x,
        i.z_axis.y
    )?;
    let decay = |rate: f64| 1.0 - 1.0 / (1.0 + s.timestep * rate);
    // The decay rate of the rotation is its damping divided by its inertia, the same about all axes with ρ as
    // radius of gyration.
    let inertia = (i.x_axis.x + i.y_axis.y + i.z_axis.z) / 3.0;
    writeln!(
        out,
        "        <velocity_decay><linear>{}</linear><angular>{}</angular></velocity_decay>",
        decay(s.damping),
        decay(scene.turning_damping() / inertia)
    )?;
    geometry(out, "moving", scene.moving.len(), scene)?;
    writeln!(out, "      </link>")?;
    let free = pair.alignment.free;
    if !(turning.is_spherical() && free.contains(Dof::X) && free.contains(Dof::Y)) {
        let mut chain = vec![("z", "prismatic", DVec3::Z)];
        chain.extend(
            [(Dof::X, DVec3::X), (Dof::Y, DVec3::Y)]
                .into_iter()
                .filter(|(dof, _)| free.contains(*dof))
                .map(|(dof, axis)| (dof.name(), "prismatic", axis)),
        );
        let angles = turning.angles(rotation);
        chain.extend(turning.hinges(angles).into_iter().map(|(dof, axis)| (dof.name(), "revolute", axis)));
        joints(out, scene, &chain)?;
    }
    writeln!(out, "    </model>\n  </world>\n</sdf>")
}

/// The collisions of a half.
fn geometry(out: &mut String, name: &str, count: usize, scene: &Scene) -> std::fmt::Result {
    let (mu, bounce) = (scene.settings.friction, scene.settings.restitution);
    for k in 0..count {
        let mesh = format!("<geometry><mesh><uri>{MESHES}/{name}-{k}.stl</uri></mesh></geometry>");
        writeln!(
            out,
            "        <visual name=\"v{k}\">{mesh}</visual>\n        <collision name=\"c{k}\">{mesh}"
        )?;
        writeln!(
            out,
            "          <surface><friction><ode><mu>{mu}</mu><mu2>{mu}</mu2></ode></friction>\
             <bounce><restitution_coefficient>{bounce}</restitution_coefficient></bounce></surface>\n        </collision>"
        )?;
    }
    Ok(())
}

/// A chain of joints from the world to the half, all at the COR, with light links in between.
fn joints(out: &mut String, scene: &Scene, chain: &[(&str, &str, DVec3)]) -> std::fmt::Result {
    let (mass, inertia) = (LIGHT * scene.body.weight, LIGHT * scene.body.inertia.x_axis.x);
    // Axes are given in the model, which starts turned.
    let local = |axis: DVec3| triple(scene.rotation.transpose() * axis);
    let mut parent = "world".to_owned();
    for (k, (name, kind, axis)) in chain.iter().enumerate() {
        let child = if k + 1 == chain.len() { "half".to_owned() } else { format!("carrier_{name}") };
        if k + 1 < chain.len() {
            writeln!(
                out,
                "      <link name=\"{child}\"><inertial><mass>{mass}</mass><inertia><ixx>{inertia}</ixx><iyy>{inertia}</iyy>\
                 <izz>{inertia}</izz></inertia></inertial></link>"
            )?;
        }
        writeln!(
            out,
            "      <joint name=\"{name}\" type=\"{kind}\"><parent>{parent}</parent><child>{child}</child>\
             <axis><xyz>{}</xyz></axis></joint>",
            local(*axis)
        )?;
        parent = child;
    }
    Ok(())
}
