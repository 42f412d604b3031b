//! The trajectory of a pose from first contact to its end: as versioned JSON, text, and tables for programs.

use super::document::Printed;
use super::envelope::{ReportBody, ReportEnvelope};
use catchment_core::acceptance::{FailureReason, Outcome};
use catchment_core::design::Design;
#[cfg(any(feature = "drop", test))]
use catchment_core::diagnostic::Diagnostic;
use catchment_core::document::{Cell, Column, ColumnFormat, Document, Table, decimals, grouped, rounded};
use catchment_core::method::descent::{DescentSettings, Touch, Trajectory, Waypoint};
#[cfg(feature = "drop")]
use catchment_core::method::drop;
use catchment_core::pose::{Dof, PoseError, face_from_cor};
use catchment_core::problem::Problem;
use catchment_core::tolerance::COINCIDENT;
use glam::{DMat3, DVec3};
use serde::Serialize;
use serde_json::{Value, json};
use std::borrow::Cow;

/// Lines of the text, about.
const LINES: usize = 24;

/// A path, with its head.
pub type TraceReport = ReportEnvelope<TraceBody>;

/// A trajectory.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TraceBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// Name of the method that followed the pose.
    pub method: &'static str,
    /// Its settings.
    pub settings: Value,
    /// The pose error at the start.
    pub start: PoseError,
    /// Outcome of the motion.
    pub outcome: Outcome,
    /// Reason for the failure to dock; null if it is not known.
    pub reason: Option<FailureReason>,
    /// The last pose error; null if the halves never meet.
    pub end: Option<PoseError>,
    /// Waypoints from first contact on; for a drop test from the release on.
    pub waypoints: Vec<WaypointReport>,
}

/// A waypoint of a motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WaypointReport {
    /// Path length since the first waypoint, in the ρ-metric, in D.
    pub travelled_d: f64,
    /// Time since release, in s; null for quasi-static motions, which have no time.
    pub time_s: Option<f64>,
    /// The pose error.
    pub error: PoseError,
    /// z of the COR in the world frame, in D.
    pub height_d: f64,
    /// Contacts.
    pub touches: Vec<Touch>,
}

impl ReportBody for TraceBody {
    const KIND: &'static str = "trace";
}

impl From<&Waypoint> for WaypointReport {
    fn from(w: &Waypoint) -> Self {
        let touches = w.touches.clone();
        Self { travelled_d: w.travelled, time_s: None, error: w.error, height_d: w.height, touches }
    }
}

impl WaypointReport {
    /// Rotation of the moving half, and the position of its face centre in the world frame, in D; `cor` is that of the design.
    pub fn frame(&self, cor: f64) -> (DMat3, DVec3) {
        let rotation = self.error.rotation();
        let face = face_from_cor(&rotation, cor);
        (rotation, DVec3::new(self.error.x, self.error.y, self.height_d + face.z))
    }
}

impl TraceReport {
    /// Of a path that [`Problem::trace`] followed from `start` with `settings`, with the reason why it did not dock.
    pub fn new(
        problem: &Problem,
        settings: &DescentSettings,
        start: PoseError,
        path: &Trajectory,
        reason: Option<FailureReason>,
    ) -> Self {
        let waypoints: Vec<WaypointReport> = path.waypoints.iter().map(WaypointReport::from).collect();
        let body = TraceBody {
            design: problem.design().clone(),
            method: "descent",
            settings: json!(settings),
            start,
            outcome: path.outcome,
            reason,
            end: waypoints.last().map(|w| w.error),
            waypoints,
        };
        let warnings = problem.warnings();
        Self::of(body, warnings, None)
    }

    /// Report of a drop test with `settings`.
    #[cfg(feature = "drop")]
    pub fn of_drop(
        design: &Design,
        settings: &drop::DropSettings,
        start: PoseError,
        path: &drop::Path,
        warnings: Vec<Diagnostic>,
    ) -> Self {
        let waypoint = |moment: &drop::DropMoment| WaypointReport {
            time_s: Some(moment.time),
            ..WaypointReport::from(&moment.waypoint)
        };
        let waypoints: Vec<WaypointReport> = path.moments.iter().map(waypoint).collect();
        let body = TraceBody {
            design: design.clone(),
            method: "drop",
            settings: json!(settings),
            start,
            outcome: path.outcome,
            reason: None,
            end: waypoints.last().map(|w| w.error),
            waypoints,
        };
        Self::of(body, warnings, None)
    }
}

impl Printed for TraceBody {
    fn title(&self) -> Cow<'_, str> {
        (&self.design.name).into()
    }

    /// Waypoints spread over the path: lengths in the design's unit, or D; degrees.
    fn document(&self) -> Document {
        let mut document = Document::default();
        let reason = self.reason.map_or_else(String::new, |reason| format!(" ({})", reason.name()));
        let friction = self.settings["friction"].as_f64().filter(|friction| *friction > 0.0);
        let contact = friction.map_or_else(
            || "without friction".to_owned(),
            |friction| format!("with friction μ = {friction}"),
        );
        document.row("outcome", format!("{}{reason}", self.outcome.word()));
        document.row(
            "method",
            match self.method {
                "descent" => format!("exact quasi-static motion, {contact}"),
                other => other.to_owned(),
            },
        );
        document.section(None);
        if self.waypoints.is_empty() {
            document.paragraph("The halves never meet.");
        } else {
            let shown = self.waypoint_table();
            let poses = match (shown.rows.len(), self.waypoints.len()) {
                (_, 1) => "the motion ends where it begins".to_owned(),
                (some, all) if some == all => format!("all {} poses of the motion", grouped(all)),
                (some, all) => format!("{} of {} poses of the motion", grouped(some), grouped(all)),
            };
            document.table(shown);
            document.paragraph(format!(
                "{poses}; path: length of the way in x, y and angles, of each step √(Δx² + Δy² + (ρ Δangle)²), ρ = {} D; height: of the COR above the face centre of the fixed half",
                rounded(self.design.alignment.rotation_length)
            ));
        }
        document.section(None).table(self.contact_table());
        document
    }
}

impl TraceBody {
    fn is_timed(&self) -> bool {
        self.waypoints.iter().any(|w| w.time_s.is_some())
    }

    fn waypoint_table(&self) -> Table {
        let design = &self.design;
        let (width, symbol) = design.unit.map_or((1.0, "D"), |unit| (design.width, unit.symbol()));
        // A digit more than figures of merit have: neighbouring waypoints are to differ.
        let length = ColumnFormat::Fixed(decimals(width) + 1);
        let moves = |dof: &Dof| {
            design.alignment.free.contains(*dof)
                || self.waypoints.iter().any(|w| w.error.to_array()[dof.index()].abs() > COINCIDENT)
        };
        let dofs: Vec<Dof> = Dof::ALL.into_iter().filter(moves).collect();
        let timed = self.is_timed();
        let mut columns = vec![Column::new("path [D]").format(ColumnFormat::Fixed(4))];
        columns.extend(timed.then(|| Column::new("time [s]").format(ColumnFormat::Fixed(4))));
        columns.extend(dofs.iter().map(|dof| {
            let unit = if dof.is_rotation() { "deg" } else { symbol };
            let format = if dof.is_rotation() { ColumnFormat::Fixed(3) } else { length };
            Column::new(format!("{} [{unit}]", dof.name())).format(format)
        }));
        columns.extend([
            Column::new(format!("height [{symbol}]")).format(length),
            Column::new("contact points"),
        ]);
        let mut table = Table::new(columns);
        for w in spread(&self.waypoints) {
            let mut row: Vec<Cell> = vec![w.travelled_d.into()];
            row.extend(timed.then(|| w.time_s.into()));
            row.extend(dofs.iter().map(|dof| {
                let value = w.error.to_array()[dof.index()];
                Cell::from(if dof.is_rotation() { value.to_degrees() } else { value * width })
            }));
            row.extend([Cell::from(w.height_d * width), w.touches.len().into()]);
            table.push(row);
        }
        table
    }

    /// A row per contact point for programs, in D and radians; a waypoint without contact has a row without a
    /// point.
    fn contact_table(&self) -> Table {
        let timed = self.is_timed();
        let mut table = Table::data(if timed {
            "waypoint travelled time x y roll pitch yaw height point_x point_y point_z normal_x normal_y normal_z"
        } else {
            "waypoint travelled x y roll pitch yaw height point_x point_y point_z normal_x normal_y normal_z"
        });
        for (number, w) in self.waypoints.iter().enumerate() {
            let mut row: Vec<Cell> = vec![number.into(), w.travelled_d.into()];
            row.extend(timed.then(|| w.time_s.into()));
            row.extend(w.error.to_array().map(Cell::from));
            row.push(w.height_d.into());
            let points = w.touches.iter().map(|touch| {
                touch.point.to_array().into_iter().chain(touch.normal.to_array()).map(Cell::from).collect()
            });
            let nowhere = w.touches.is_empty().then(|| vec![Cell::Empty; 6]);
            for point in points.chain(nowhere) {
                let point: Vec<Cell> = point;
                table.push(row.iter().cloned().chain(point));
            }
        }
        table
    }
}

/// Waypoints spread evenly over the path, the first and the last among them.
fn spread(waypoints: &[WaypointReport]) -> Vec<&WaypointReport> {
    let total = waypoints.last().map_or(0.0, |w| w.travelled_d);
    let mut chosen: Vec<usize> = (0..LINES)
        .map(|k| total * k as f64 / (LINES - 1) as f64)
        .map(|s| waypoints.partition_point(|w| w.travelled_d < s))
        .chain(waypoints.len().checked_sub(1))
        .collect();
    // The last share of a path may round to beyond its end, which is chosen anyhow.
    chosen.retain(|k| *k < waypoints.len());
    chosen.dedup();
    chosen.into_iter().filter_map(|k| waypoints.get(k)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::schema::testing::design;
    use super::*;
    use catchment_core::pose::DofSet;

    fn report(waypoints: Vec<Waypoint>) -> TraceReport {
        let mut design = design([Dof::X, Dof::Pitch].into_iter().collect::<DofSet>());
        design.name = "a\u{1b}[2Jb".to_owned();
        let path = Trajectory { waypoints, outcome: Outcome::Aligned };
        let problem = Problem::of(design).unwrap();
        let (start, settings) = (PoseError::default(), DescentSettings::default());
        let mut report = TraceReport::new(&problem, &settings, start, &path, None);
        report.warnings.push(Diagnostic::warning("shallow", "shallow"));
        report
    }

    #[test]
    fn a_path_is_reported_to_people_and_programs() {
        let touch = Touch { point: DVec3::X, normal: DVec3::Z };
        let waypoint = |x: f64, touches: Vec<Touch>| {
            let error = PoseError { x, ..PoseError::default() };
            Waypoint { error, height: 0.25, travelled: 0.5 - x, touches }
        };
        let traced = report(vec![waypoint(0.5, vec![touch, touch]), waypoint(0.0, Vec::new())]);
        let text = traced.table();
        assert!(text.starts_with("a?[2Jb\n") && text.contains("  outcome        docked\n"), "{text}");
        assert!(text.contains("    0.0000  25.0000        0.000      12.5000               2\n"), "{text}");
        let records = traced.records();
        assert_eq!(records.len(), 1 + 2 + 1);
        assert!(records.iter().all(|record| record.len() == 14));
        let json: serde_json::Value = serde_json::from_str(&traced.to_json().unwrap()).unwrap();
        assert_eq!(json["waypoints"][0]["touches"][1]["normal"][2], 1.0);
        assert_eq!(json["warnings"][0]["message"], "shallow");
    }

    #[test]
    fn halves_that_never_meet_have_no_path() {
        let traced = report(Vec::new());
        assert!(traced.table().contains("\n  The halves never meet.\n"), "{}", traced.table());
        assert!(traced.end.is_none() && traced.records().len() == 1);
    }
}
