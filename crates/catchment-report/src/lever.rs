//! The first contact as the kinematic method sees it: versioned JSON, text, a table for programs.

use super::envelope::{Body as Kind, Envelope};
use super::text::{line, number};
use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::method::kinematic::stepping::Halt;
use catchment_core::method::kinematic::{Body, Lever, Settings, Start};
use catchment_core::pose::PoseError;
use serde::Serialize;

/// A first contact, with its head.
pub type LeverReport = Envelope<LeverBody>;

/// A first contact.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LeverBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// Name of the method.
    pub method: &'static str,
    /// Its settings.
    pub settings: Settings,
    /// The pose error.
    pub start: PoseError,
    /// What becomes of it by this method.
    pub outcome: Outcome,
    /// How the stepping of an X-Face halts; null for the others, which are not stepped.
    pub halt: Option<Halt>,
    /// The contact; null where nothing touches, or corner meets corner.
    pub contact: Option<LeverFound>,
}

/// A contact of a corner with an edge. Places are x and z in the world frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LeverFound {
    /// Whose corner it is.
    pub corner_of: Body,
    /// Rotation point of the moving half, `P_M`.
    pub moving_pivot_d: [f64; 2],
    /// Rotation point of the base half, `P_B`.
    pub base_pivot_d: [f64; 2],
    /// Where they touch, `P_C`.
    pub contact_d: [f64; 2],
    /// Unit normal of the edge, out of its body.
    pub normal: [f64; 2],
    /// l, from the corner's rotation point to the contact.
    pub lever_d: f64,
    /// d, from the edge's rotation point to the line of the edge.
    pub distance_d: f64,
    /// q₁, along the edge to the contact.
    pub along_d: f64,
    /// `β_p`, radians.
    pub beta_p: f64,
    /// `α_e`, radians.
    pub alpha_e: f64,
    /// θ₁, radians.
    pub theta_1: f64,
    /// θ₂, radians.
    pub theta_2: f64,
    /// θ₂ where the halves are aligned, radians.
    pub theta_2_aligned: f64,
}

impl Kind for LeverBody {
    const KIND: &'static str = "kinematic-contact";
}

impl From<&Lever> for LeverFound {
    fn from(lever: &Lever) -> Self {
        let (own, other) = (lever.corner_pivot.to_array(), lever.edge_pivot.to_array());
        let [moving, base] = if lever.corner == Body::Moving { [own, other] } else { [other, own] };
        Self {
            corner_of: lever.corner,
            moving_pivot_d: moving,
            base_pivot_d: base,
            contact_d: lever.contact.to_array(),
            normal: lever.normal.to_array(),
            lever_d: lever.length,
            distance_d: lever.distance,
            along_d: lever.along,
            beta_p: lever.beta_p,
            alpha_e: lever.alpha_e,
            theta_1: lever.theta_1,
            theta_2: lever.theta_2,
            theta_2_aligned: lever.aligned(),
        }
    }
}

impl LeverReport {
    /// Of a pose.
    pub fn new(design: &Design, start: &Start) -> Self {
        let body = LeverBody {
            design: design.clone(),
            method: "kinematic",
            settings: start.settings,
            start: start.error,
            outcome: start.outcome,
            halt: start.halt,
            contact: start.lever.as_ref().map(LeverFound::from),
        };
        Self::of(body, Vec::new(), None)
    }

    /// The contact for a person: lengths in D, degrees.
    pub fn table(&self) -> String {
        let mut text = String::new();
        line(&mut text, &self.design.name);
        match &self.contact {
            None => line(&mut text, "no corner touches an edge"),
            Some(found) => {
                let words = match found.corner_of {
                    Body::Moving => "first contact: a corner of the moving half on an edge of the base",
                    Body::Base => "first contact: a corner of the base on an edge of the moving half",
                };
                line(&mut text, words);
                for (name, [x, z]) in [
                    ("P_M  rotation point, moving half", found.moving_pivot_d),
                    ("P_B  rotation point, base", found.base_pivot_d),
                    ("P_C  contact", found.contact_d),
                ] {
                    line(&mut text, &format!("  {name:<34}  x {:8.4} D    z {:8.4} D", tidy(x), tidy(z)));
                }
                let [x, z] = found.normal.map(tidy);
                line(&mut text, &format!("  {:<34}  x {x:8.4}      z {z:8.4}", "N    normal of the edge"));
                for (name, value) in found.lengths() {
                    line(&mut text, &format!("  {name:<34}    {:8.4} D", tidy(value)));
                }
                for (name, value) in found.angles() {
                    line(&mut text, &format!("  {name:<34}    {:8.3} deg", tidy(value.to_degrees())));
                }
                if found.theta_2 < 0.0 {
                    line(&mut text, "  theta_2 is negative: the corner's body turns away, a failed mate");
                }
            }
        }
        let halt =
            self.halt.map_or_else(String::new, |halt| format!(" (the stepping halts: {})", halt.name()));
        line(&mut text, &format!("outcome by this method: {}{halt}", self.outcome.name()));
        text
    }

    /// A record per quantity for programs, the names of the columns first, in D and radians.
    pub fn records(&self) -> Vec<Vec<String>> {
        let mut records = vec![["quantity", "value"].map(str::to_owned).to_vec()];
        let mut add = |name: &str, value: f64| records.push(vec![name.to_owned(), number(value)]);
        if let Some(found) = &self.contact {
            for (name, [x, z]) in [
                ("moving_pivot", found.moving_pivot_d),
                ("base_pivot", found.base_pivot_d),
                ("contact", found.contact_d),
                ("normal", found.normal),
            ] {
                add(&format!("{name}_x"), x);
                add(&format!("{name}_z"), z);
            }
            for (name, value) in [
                ("lever", found.lever_d),
                ("distance", found.distance_d),
                ("along", found.along_d),
                ("beta_p", found.beta_p),
                ("alpha_e", found.alpha_e),
                ("theta_1", found.theta_1),
                ("theta_2", found.theta_2),
                ("theta_2_aligned", found.theta_2_aligned),
            ] {
                add(name, value);
            }
        }
        records
    }
}

impl LeverFound {
    /// Lengths with their names.
    const fn lengths(&self) -> [(&'static str, f64); 3] {
        [
            ("l    lever of the corner", self.lever_d),
            ("d    rotation point to edge", self.distance_d),
            ("q_1  along the edge", self.along_d),
        ]
    }

    /// Angles with their names, radians.
    const fn angles(&self) -> [(&'static str, f64); 5] {
        [
            ("beta_p   vertical to lever", self.beta_p),
            ("alpha_e  normal to vertical", self.alpha_e),
            ("theta_1  lateral to normal (ours)", self.theta_1),
            ("theta_2  normal to lever", self.theta_2),
            ("beta_p + alpha_e  theta_2 aligned", self.theta_2_aligned),
        ]
    }
}

/// Rounding does not print as −0.0000.
fn tidy(value: f64) -> f64 {
    if value.abs() < 5e-5 { 0.0 } else { value }
}
