//! Report of the first contact in the kinematic method.

use catchment_core::acceptance::Outcome;
use catchment_core::design::Design;
use catchment_core::document::{Column, ColumnFormat, Document, Subject, Table, fixed};
use catchment_core::method::kinematic::stepping::Halt;
use catchment_core::method::kinematic::{KinematicSettings, Lever, LeverBody, LeverPose};
use catchment_core::pose::PoseError;
use serde::Serialize;

/// A first contact, as a method of planar faces computes it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FirstContact {
    /// Name of the method.
    pub method: &'static str,
    /// Its settings.
    pub settings: KinematicSettings,
    /// The pose error, in D and radians.
    pub start: PoseError,
    /// Its outcome by this method.
    pub outcome: Outcome,
    /// End of the stepping of an X-Face; null for other faces, which are not stepped.
    pub halt: Option<Halt>,
    /// The contact; null if nothing touches, or if a corner meets a corner.
    pub contact: Option<CornerContact>,
}

/// A contact of a corner with an edge. Positions are x and z in the world frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CornerContact {
    /// The body of the corner.
    pub corner_of: LeverBody,
    /// Rotation point of the moving half, `P_M`, in D.
    pub moving_pivot_d: [f64; 2],
    /// Rotation point of the base half, `P_B`, in D.
    pub base_pivot_d: [f64; 2],
    /// Contact point, `P_C`, in D.
    pub contact_d: [f64; 2],
    /// Unit normal of the edge, out of its body.
    pub normal: [f64; 2],
    /// l, from the corner's rotation point to the contact, in D.
    pub lever_d: f64,
    /// d, from the edge's rotation point to the line of the edge, in D.
    pub distance_d: f64,
    /// q₁, along the edge to the contact, in D.
    pub along_d: f64,
    /// `β_p` from the vertical to the lever, in radians.
    pub beta_p: f64,
    /// `α_e` from the normal to the vertical, in radians.
    pub alpha_e: f64,
    /// θ₁ from the lateral direction to the normal, in radians.
    pub theta_1: f64,
    /// θ₂ from the normal to the lever, in radians.
    pub theta_2: f64,
    /// θ₂ of the aligned halves, in radians.
    pub theta_2_aligned: f64,
}

impl From<&Lever> for CornerContact {
    fn from(lever: &Lever) -> Self {
        let (own, other) = (lever.corner_pivot.to_array(), lever.edge_pivot.to_array());
        let [moving, base] = if lever.corner == LeverBody::Moving { [own, other] } else { [other, own] };
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

impl From<&LeverPose> for FirstContact {
    fn from(start: &LeverPose) -> Self {
        Self {
            method: "kinematic",
            settings: start.settings,
            start: start.error,
            outcome: start.outcome,
            halt: start.halt,
            contact: start.lever.as_ref().map(CornerContact::from),
        }
    }
}

impl Subject for FirstContact {
    const KIND: &'static str = "kinematic-contact";

    fn document(&self, _: &Design) -> Document {
        let mut document = Document::default();
        let halt =
            self.halt.map_or_else(String::new, |halt| format!(" (the stepping halts: {})", halt.name()));
        document.row("outcome", format!("{}{halt}, by the kinematic method", self.outcome.word()));
        match &self.contact {
            None => {
                document.row("first contact", "no corner touches an edge");
            }
            Some(contact) => contact.describe(&mut document),
        }
        document.table(self.quantities());
        document
    }
}

impl FirstContact {
    /// A row per quantity, in D and radians.
    fn quantities(&self) -> Table {
        let mut table = Table::data("quantity value");
        let Some(contact) = &self.contact else { return table };
        let mut add = |name: &str, value: f64| table.push([name.into(), value.into()]);
        for (name, [x, z]) in [
            ("moving_pivot", contact.moving_pivot_d),
            ("base_pivot", contact.base_pivot_d),
            ("contact", contact.contact_d),
            ("normal", contact.normal),
        ] {
            add(&format!("{name}_x"), x);
            add(&format!("{name}_z"), z);
        }
        for (name, value) in [
            ("lever", contact.lever_d),
            ("distance", contact.distance_d),
            ("along", contact.along_d),
            ("beta_p", contact.beta_p),
            ("alpha_e", contact.alpha_e),
            ("theta_1", contact.theta_1),
            ("theta_2", contact.theta_2),
            ("theta_2_aligned", contact.theta_2_aligned),
        ] {
            add(name, value);
        }
        table
    }
}

impl CornerContact {
    fn describe(&self, document: &mut Document) {
        let words = match self.corner_of {
            LeverBody::Moving => "a corner of the moving half on an edge of the base",
            LeverBody::Base => "a corner of the base on an edge of the moving half",
        };
        document.row("first contact", words);
        if self.theta_2 < 0.0 {
            document.more("theta_2 is negative: the corner's body turns away, a failed mate");
        }
        let value = |title: &str| Column::new(title).format(ColumnFormat::Fixed(4));
        let mut places = Table::new([Column::new("place").left(), value("x [D]"), value("z [D]")]);
        for (name, [x, z]) in [
            ("P_M  rotation point, moving half", self.moving_pivot_d),
            ("P_B  rotation point, base", self.base_pivot_d),
            ("P_C  contact", self.contact_d),
            ("N    normal of the edge (of length 1)", self.normal),
        ] {
            places.push([name.into(), x.into(), z.into()]);
        }
        let mut levers = Table::new([Column::new("length or angle").left(), Column::new("value")]);
        for (name, value) in [
            ("l    lever of the corner", self.lever_d),
            ("d    rotation point to edge", self.distance_d),
            ("q_1  along the edge", self.along_d),
        ] {
            levers.push([name.into(), format!("{} D", fixed(value, 4)).into()]);
        }
        for (name, value) in [
            ("beta_p   vertical to lever", self.beta_p),
            ("alpha_e  normal to vertical", self.alpha_e),
            ("theta_1  lateral to normal (ours)", self.theta_1),
            ("theta_2  normal to lever", self.theta_2),
            ("beta_p + alpha_e  theta_2 aligned", self.theta_2_aligned),
        ] {
            levers.push([name.into(), format!("{} deg", fixed(value.to_degrees(), 3)).into()]);
        }
        document.section(None).table(places).section(None).table(levers);
    }
}
