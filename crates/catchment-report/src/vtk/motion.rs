//! A motion as VTK's `PolyData`: the path of the face centre, the contacts along it, both halves.
//!
//! | `part` of a cell | content |
//! |---|---|
//! | 0 | a contact point of a waypoint; its normal points from the fixed half to the moving one |
//! | 1 | the path of the moving half's face centre, as one line |
//! | 2, 3, 4 | the fixed half; the moving half at first contact, and at the end |
//!
//! Every point carries its `waypoint` (−1 for the halves), the pose error there (`x`, `y` in D, `roll`,
//! `pitch`, `yaw` in rad), the path length `travelled` (D, in the ρ-metric) and the `normal` of a contact, 0
//! elsewhere; every cell the `outcome` of the motion.

use super::xml::File;
use crate::TraceReport;
use crate::trajectory::WaypointReport;
use catchment_core::connector::{Connector, Half};
use catchment_core::pose::{Dof, PoseError};
use glam::DVec3;

/// A motion as a `.vtp` file; `None` if the halves never met, so that there is no path.
pub fn motion(trace: &TraceReport, connector: &Connector) -> Option<Vec<u8>> {
    let (first, last) = trace.waypoints.first().zip(trace.waypoints.last())?;
    let mut file = Motion::default();
    for (k, waypoint) in trace.waypoints.iter().enumerate() {
        for touch in &waypoint.touches {
            let point = file.point(touch.point, Some((k, waypoint)), touch.normal.to_array());
            file.verts.push(vec![point]);
        }
    }
    let cor = trace.design.alignment.center_of_rotation;
    let way = trace.waypoints.iter().enumerate();
    let way =
        way.map(|(k, waypoint)| file.point(waypoint.frame(cor).1, Some((k, waypoint)), [0.0; 3])).collect();
    file.lines.push(way);
    file.half(&connector.fixed, FIXED, |v| v);
    for (waypoint, part) in [(first, FIXED + 1), (last, FIXED + 2)] {
        let (rotation, place) = waypoint.frame(cor);
        file.half(&connector.moving, part, |v| rotation * v + place);
    }
    let heading = format!(
        "catchment {}: a motion, {}; lengths in D, z along the approach",
        env!("CARGO_PKG_VERSION"),
        trace.outcome.name()
    );
    Some(file.finish(&heading, trace.outcome as u8))
}

/// The number of the fixed half among the parts.
const FIXED: u8 = 2;

#[derive(Default)]
struct Motion {
    places: Vec<[f64; 3]>,
    waypoints: Vec<i64>,
    errors: Vec<PoseError>,
    travelled: Vec<f64>,
    normals: Vec<[f64; 3]>,
    verts: Vec<Vec<usize>>,
    lines: Vec<Vec<usize>>,
    polys: Vec<(u8, Vec<usize>)>,
}

impl Motion {
    fn point(&mut self, place: DVec3, of: Option<(usize, &WaypointReport)>, normal: [f64; 3]) -> usize {
        self.places.push(place.to_array());
        self.waypoints.push(of.map_or(-1, |(k, _)| i64::try_from(k).unwrap_or(i64::MAX)));
        self.errors.push(of.map_or_else(PoseError::default, |(_, waypoint)| waypoint.error));
        self.travelled.push(of.map_or(0.0, |(_, waypoint)| waypoint.travelled_d));
        self.normals.push(normal);
        self.places.len() - 1
    }

    fn half(&mut self, half: &Half, part: u8, place: impl Fn(DVec3) -> DVec3) {
        for surface in &half.surfaces {
            let first = self.places.len();
            for vertex in &surface.vertices {
                self.point(place(*vertex), None, [0.0; 3]);
            }
            let facets = surface.facets.iter();
            let corners = facets.map(|f| f.corners.iter().map(|c| first + *c as usize).collect());
            self.polys.extend(corners.map(|corners| (part, corners)));
        }
    }

    fn finish(self, heading: &str, outcome: u8) -> Vec<u8> {
        let mut file = File::new("PolyData", heading);
        let counts = [self.verts.len(), self.lines.len(), self.polys.len()];
        file.tag(&format!(
            "<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" \
             NumberOfPolys=\"{}\">\n<PointData>",
            self.places.len(),
            counts[0],
            counts[1],
            counts[2]
        ));
        file.array("waypoint", self.waypoints.iter().map(|k| [*k]));
        for dof in Dof::ALL {
            file.array(dof.name(), self.errors.iter().map(|error| [error.to_array()[dof.index()]]));
        }
        file.array("travelled", self.travelled.iter().map(|d| [*d]));
        file.array("normal", self.normals.iter().copied());
        file.tag("</PointData>\n<CellData Scalars=\"part\">");
        // Cells come as points, lines, polygons.
        let ahead = std::iter::repeat_n(0, counts[0]).chain(std::iter::repeat_n(1, counts[1]));
        file.array("part", ahead.chain(self.polys.iter().map(|(part, _)| *part)).map(|part| [part]));
        file.array("outcome", std::iter::repeat_n([outcome], counts.iter().sum()));
        file.tag("</CellData>\n<Points>");
        file.array("places", self.places.iter().copied());
        file.tag("</Points>");
        let polys = self.polys.into_iter().map(|(_, corners)| corners).collect();
        for (name, cells) in [("Verts", self.verts), ("Lines", self.lines), ("Polys", polys)] {
            let ends = cells.iter().scan(0, |end, cell| {
                *end += cell.len();
                Some([*end])
            });
            let ends: Vec<[usize; 1]> = ends.collect();
            file.tag(&format!("<{name}>"));
            file.array("connectivity", cells.into_iter().flatten().map(|corner| [corner]));
            file.array("offsets", ends);
            file.tag(&format!("</{name}>"));
        }
        file.tag("</Piece>");
        file.finish()
    }
}
