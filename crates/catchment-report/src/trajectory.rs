//! The way of one pose from first contact to its end: as versioned JSON, as text, as a table for programs.

use super::envelope::{Body, Envelope};
use super::schema::WarningReport;
use super::text::{decimals, fixed, line, number};
use catchment_core::acceptance::{Outcome, Reason};
use catchment_core::design::Design;
use catchment_core::method::descent::{Settings, Touch, Trajectory, Waypoint};
#[cfg(feature = "drop")]
use catchment_core::method::drop;
use catchment_core::pose::{Dof, PoseError, face_from_cor};
use catchment_core::problem::Problem;
use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// Lines of the text, about.
const LINES: usize = 24;
/// Errors below this, in D or rad, are rounding: the axis does not move.
const STILL: f64 = 1e-9;

/// A path, with its head.
pub type TraceReport = Envelope<TraceBody>;

/// A path.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TraceBody {
    /// The design, resolved: lengths in D, angles in radians.
    pub design: Design,
    /// Name of the method that followed the pose.
    pub method: &'static str,
    /// Its settings.
    pub settings: Value,
    /// The pose error that the path starts from.
    pub start: PoseError,
    /// How it ends.
    pub outcome: Outcome,
    /// Why it does not dock; null where that cannot be told.
    pub reason: Option<Reason>,
    /// The last pose error; null if the halves never meet.
    pub end: Option<PoseError>,
    /// From first contact on; of a drop test from where it was let go.
    pub waypoints: Vec<WaypointReport>,
}

/// One moment of a motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WaypointReport {
    /// Path length since the first of them, in the ρ-metric, in D.
    pub travelled_d: f64,
    /// Since it was let go, in s; null of quasi-static motions, which take no time.
    pub time_s: Option<f64>,
    /// The pose error.
    pub error: PoseError,
    /// z of the COR in the world frame, in D.
    pub height_d: f64,
    /// Where the halves touch.
    pub touches: Vec<TouchReport>,
}

/// A point where the halves touch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TouchReport {
    /// Where, in the world frame, in D.
    pub point_d: [f64; 3],
    /// Unit normal, from the fixed half to the moving one.
    pub normal: [f64; 3],
}

impl Body for TraceBody {
    const KIND: &'static str = "trace";
}

impl From<&Waypoint> for WaypointReport {
    fn from(w: &Waypoint) -> Self {
        let touch = |t: &Touch| TouchReport { point_d: t.point.to_array(), normal: t.normal.to_array() };
        let touches = w.touches.iter().map(touch).collect();
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
        settings: &Settings,
        start: PoseError,
        path: &Trajectory,
        reason: Option<Reason>,
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
        let warnings = problem.objections().iter().map(WarningReport::note).collect();
        Self::of(body, warnings, None)
    }

    /// Of one drop test with `settings`.
    #[cfg(feature = "drop")]
    pub fn of_drop(
        design: &Design,
        settings: &drop::Settings,
        start: PoseError,
        path: &drop::Path,
        warnings: Vec<WarningReport>,
    ) -> Self {
        let told = |moment: &drop::Moment| WaypointReport {
            time_s: Some(moment.time),
            ..WaypointReport::from(&moment.waypoint)
        };
        let waypoints: Vec<WaypointReport> = path.moments.iter().map(told).collect();
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

    /// Waypoints spread over the path for a person: lengths in the design's unit, or D; degrees.
    pub fn table(&self) -> String {
        let design = &self.design;
        let (width, symbol) = design.unit.map_or((1.0, "D"), |unit| (design.width, unit.symbol()));
        // A digit more than figures of merit have: neighbouring waypoints are to differ.
        let decimals = decimals(width) + 1;
        let length = |value: f64| fixed(value * width, decimals);
        let moves = |dof: &Dof| {
            design.alignment.free.contains(*dof)
                || self.waypoints.iter().any(|w| w.error.to_array()[dof.index()].abs() > STILL)
        };
        let dofs: Vec<Dof> = Dof::ALL.into_iter().filter(moves).collect();
        let timed = self.waypoints.iter().any(|w| w.time_s.is_some());
        let mut lines = vec![vec!["path [D]".to_owned()]];
        lines[0].extend(timed.then(|| "time [s]".to_owned()));
        lines[0].extend(
            dofs.iter().map(|d| format!("{} [{}]", d.name(), if d.is_rotation() { "deg" } else { symbol })),
        );
        lines[0].extend([format!("height [{symbol}]"), "contacts".to_owned()]);
        for w in spread(&self.waypoints) {
            let mut cells = vec![format!("{:.4}", w.travelled_d)];
            cells.extend(w.time_s.map(|time| format!("{time:.4}")));
            cells.extend(dofs.iter().map(|dof| {
                let value = w.error.to_array()[dof.index()];
                if dof.is_rotation() { fixed(value.to_degrees(), 3) } else { length(value) }
            }));
            cells.extend([length(w.height_d), w.touches.len().to_string()]);
            lines.push(cells);
        }
        let widths: Vec<usize> = (0..lines[0].len())
            .map(|c| lines.iter().map(|line| line[c].chars().count()).max().unwrap_or(0))
            .collect();
        let mut text = String::new();
        line(&mut text, &design.name);
        if self.waypoints.is_empty() {
            line(&mut text, "the halves never meet");
        } else {
            for cells in &lines {
                let cells: Vec<String> = cells.iter().zip(&widths).map(|(c, w)| format!("{c:>w$}")).collect();
                line(&mut text, &format!("  {}", cells.join("  ")));
            }
            let (shown, all) = (lines.len() - 1, self.waypoints.len());
            let words = format!("{shown} of {all} waypoints; height is that of the centre of rotation");
            line(&mut text, &words);
        }
        let reason = self.reason.map_or_else(String::new, |reason| format!(" ({})", reason.name()));
        line(&mut text, &format!("outcome: {}{reason}", self.outcome.name()));
        text
    }

    /// A record per contact point for programs, the names of the columns first, in D and radians; a waypoint that
    /// touches nowhere has one record without a point.
    pub fn records(&self) -> Vec<Vec<String>> {
        let head =
            "waypoint travelled x y roll pitch yaw height point_x point_y point_z normal_x normal_y normal_z";
        let mut records = vec![head.split(' ').map(str::to_owned).collect::<Vec<_>>()];
        let timed = self.waypoints.iter().any(|w| w.time_s.is_some());
        if timed {
            records[0].insert(TIME, "time".to_owned());
        }
        for (k, w) in self.waypoints.iter().enumerate() {
            let mut record = vec![k.to_string(), number(w.travelled_d)];
            record.extend(w.error.to_array().map(number));
            record.push(number(w.height_d));
            if timed {
                record.insert(TIME, w.time_s.map_or_else(String::new, number));
            }
            for touch in &w.touches {
                let contact = touch.point_d.into_iter().chain(touch.normal).map(number);
                records.push(record.iter().cloned().chain(contact).collect());
            }
            if w.touches.is_empty() {
                record.extend(std::iter::repeat_n(String::new(), 6));
                records.push(record);
            }
        }
        records
    }
}

/// Column of the time, where there is one.
const TIME: usize = 2;

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
        let (start, settings) = (PoseError::default(), Settings::default());
        let mut report = TraceReport::new(&problem, &settings, start, &path, None);
        report.warnings.push(WarningReport::note("shallow"));
        report
    }

    #[test]
    fn a_path_is_told_to_people_and_programs() {
        let touch = Touch { point: DVec3::X, normal: DVec3::Z };
        let waypoint = |x: f64, touches: Vec<Touch>| {
            let error = PoseError { x, ..PoseError::default() };
            Waypoint { error, height: 0.25, travelled: 0.5 - x, touches }
        };
        let told = report(vec![waypoint(0.5, vec![touch, touch]), waypoint(0.0, Vec::new())]);
        let text = told.table();
        assert!(text.starts_with("a?[2Jb\n") && text.ends_with("outcome: aligned\n"), "{text}");
        assert!(text.contains("  0.0000  25.0000        0.000      12.5000         2\n"), "{text}");
        let records = told.records();
        assert_eq!(records.len(), 1 + 2 + 1);
        assert!(records.iter().all(|record| record.len() == 14));
        let json: serde_json::Value = serde_json::from_str(&told.to_json().unwrap()).unwrap();
        assert_eq!(json["waypoints"][0]["touches"][1]["normal"][2], 1.0);
        assert_eq!(json["warnings"][0]["message"], "shallow");
    }

    #[test]
    fn halves_that_never_meet_have_no_path() {
        let told = report(Vec::new());
        assert_eq!(told.table(), "a?[2Jb\nthe halves never meet\noutcome: aligned\n");
        assert!(told.end.is_none() && told.records().len() == 1);
    }
}
