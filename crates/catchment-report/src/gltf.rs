//! A docking motion as an animation: glTF 2.0 in one binary file (`.glb`), for browsers, Blender, slides.
//!
//! ```text
//!   scene ── docking, z of glTF's y ─┬─ fixed half      mesh
//!                                    ├─ moving half     mesh, moved by the animation from first contact to its end
//!                                    ├─ way             line: the path of the moving half's face centre
//!                                    └─ contacts        contact points at the end
//! ```
//!
//! Lengths are in metres, as glTF requires; for a design without a unit, D is one metre. Quasi-static motions
//! have no time: they are shown within [`SECONDS`], with path length (ρ-metric) in place of time; a drop test
//! is shown in real time. The viewer interpolates between waypoints. Positions are in single precision: the
//! last frame is the last pose to 1e-6 D.

use super::TraceReport;
use catchment_core::connector::{Connector, Half};
use glam::{DQuat, DVec3};
use serde_json::{Value, json};

/// How long a quasi-static motion is shown.
pub const SECONDS: f64 = 4.0;

const FIXED: [f64; 4] = [0.46, 0.53, 0.60, 1.0];
const MOVING: [f64; 4] = [0.90, 0.62, 0.0, 1.0];
const CONTACT: [f64; 4] = [0.80, 0.20, 0.18, 1.0];

/// Codes of glTF.
const FLOAT: u32 = 5126;
const ARRAY_BUFFER: u32 = 34962;
const POINTS: u32 = 0;
const LINE_STRIP: u32 = 3;
const TRIANGLES: u32 = 4;

/// A motion as a `.glb` file; `None` if the halves never met, so that there is nothing to show.
pub fn glb(trace: &TraceReport, connector: &Connector) -> Option<Vec<u8>> {
    let last = trace.waypoints.last()?;
    let (design, cor) = (&trace.design, trace.design.alignment.center_of_rotation);
    let metres = design.unit.map_or(1.0, |unit| unit.metres() * design.width);
    let mut file = File::default();
    let fixed = file.half(&connector.fixed, metres, "fixed half", 0);
    let moving = file.half(&connector.moving, metres, "moving half", 1);
    let way: Vec<DVec3> = trace.waypoints.iter().map(|waypoint| waypoint.frame(cor).1 * metres).collect();
    let touching: Vec<DVec3> = last.touches.iter().map(|touch| touch.point * metres).collect();
    let mut nodes = vec![json!({ "name": "fixed half", "mesh": fixed }), Value::Null];
    if way.len() > 1 {
        let mesh = file.marks(&way, "way", LINE_STRIP);
        nodes.push(json!({ "name": "way of the face centre", "mesh": mesh }));
    }
    if !touching.is_empty() {
        let mesh = file.marks(&touching, "contacts at the end", POINTS);
        nodes.push(json!({ "name": "contacts at the end", "mesh": mesh }));
    }
    let frames = frames(trace, metres);
    // Who does not play the animation sees the halves at their end.
    let end = frames.last()?;
    nodes[1] =
        json!({ "name": "moving half", "mesh": moving, "translation": end.place, "rotation": end.rotation });
    let times = file.accessor(&frames.iter().map(|f| [f.time]).collect::<Vec<_>>(), "SCALAR", None, true);
    let places = file.accessor(&frames.iter().map(|f| f.place).collect::<Vec<_>>(), "VEC3", None, false);
    let turns = file.accessor(&frames.iter().map(|f| f.rotation).collect::<Vec<_>>(), "VEC4", None, false);
    let sampler = |output: usize| json!({ "input": times, "output": output, "interpolation": "LINEAR" });
    let channel =
        |sampler: usize, path: &str| json!({ "sampler": sampler, "target": { "node": 1, "path": path } });
    let children: Vec<usize> = (0..nodes.len()).collect();
    // From z up to y up.
    let half = std::f64::consts::FRAC_1_SQRT_2;
    nodes.push(json!({ "name": "docking", "rotation": [-half, 0.0, 0.0, half], "children": children }));
    let material = |name: &str, colour: [f64; 4]| {
        json!({ "name": name, "pbrMetallicRoughness":
            { "baseColorFactor": colour, "metallicFactor": 0.1, "roughnessFactor": 0.7 } })
    };
    let head = json!({
        "asset": { "version": "2.0", "generator": concat!("catchment ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "name": design.name, "nodes": [nodes.len() - 1] }],
        "nodes": nodes,
        "meshes": file.meshes,
        "materials": [material("fixed", FIXED), material("moving", MOVING), material("contact", CONTACT)],
        "animations": [{
            "name": format!("docking: {}", trace.outcome.name()),
            "samplers": [sampler(places), sampler(turns)],
            "channels": [channel(0, "translation"), channel(1, "rotation")],
            "extras": { "outcome": trace.outcome, "start": trace.start, "end": trace.end, "metres_per_d": metres },
        }],
        "accessors": file.accessors,
        "bufferViews": file.views,
        "buffers": [{ "byteLength": file.bytes.len() }],
    });
    Some(packed(&head.to_string(), file.bytes))
}

/// A moment of the animation.
struct Frame {
    time: f32,
    place: [f32; 3],
    rotation: [f32; 4],
}

/// Waypoints at strictly increasing times; of several at the same time the last counts.
fn frames(trace: &TraceReport, metres: f64) -> Vec<Frame> {
    let cor = trace.design.alignment.center_of_rotation;
    let travelled = trace.waypoints.last().map_or(0.0, |last| last.travelled_d);
    let pace = if travelled > 0.0 { SECONDS / travelled } else { 0.0 };
    let mut frames: Vec<Frame> = Vec::with_capacity(trace.waypoints.len());
    let mut before = DQuat::IDENTITY;
    for waypoint in &trace.waypoints {
        let (rotation, place) = waypoint.frame(cor);
        let turn = DQuat::from_mat3(&rotation).normalize();
        // Both signs represent the same rotation; the sign nearer to the previous quaternion gives the
        // shorter path.
        let turn = if turn.dot(before) < 0.0 { -turn } else { turn };
        before = turn;
        let time = waypoint.time_s.unwrap_or(waypoint.travelled_d * pace) as f32;
        if frames.last().is_some_and(|last| last.time >= time) {
            frames.pop();
        }
        frames.push(Frame {
            time,
            place: (place * metres).to_array().map(|v| v as f32),
            rotation: turn.to_array().map(|v| v as f32),
        });
    }
    frames
}

#[derive(Default)]
struct File {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
}

impl File {
    /// Adds tuples of numbers; for `bounded` tuples also the minimum and maximum.
    fn accessor<const N: usize>(
        &mut self,
        values: &[[f32; N]],
        kind: &str,
        target: Option<u32>,
        bounded: bool,
    ) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend(values.iter().flatten().flat_map(|value| value.to_le_bytes()));
        let mut view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": self.bytes.len() - offset });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.views.push(view);
        let mut accessor = json!({
            "bufferView": self.views.len() - 1,
            "componentType": FLOAT,
            "count": values.len(),
            "type": kind,
        });
        if bounded {
            let over = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
                (0..N).filter_map(|k| values.iter().map(|v| v[k]).reduce(pick)).collect()
            };
            accessor["min"] = json!(over(f32::min));
            accessor["max"] = json!(over(f32::max));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// A half as triangles, each with the normal of its facet: edges stay sharp.
    fn half(&mut self, half: &Half, metres: f64, name: &str, material: usize) -> usize {
        let (mut places, mut normals) = (Vec::new(), Vec::new());
        for surface in &half.surfaces {
            for facet in &surface.facets {
                let normal = facet.normal.to_array().map(|v| v as f32);
                let corner = |k: usize| {
                    (surface.vertices[facet.corners[k] as usize] * metres).to_array().map(|v| v as f32)
                };
                for k in 2..facet.corners.len() {
                    places.extend([corner(0), corner(k - 1), corner(k)]);
                    normals.extend([normal; 3]);
                }
            }
        }
        let position = self.accessor(&places, "VEC3", Some(ARRAY_BUFFER), true);
        let normal = self.accessor(&normals, "VEC3", Some(ARRAY_BUFFER), false);
        self.mesh(name, &json!({ "POSITION": position, "NORMAL": normal }), TRIANGLES, material)
    }

    /// Points, or the line through them.
    fn marks(&mut self, places: &[DVec3], name: &str, mode: u32) -> usize {
        let places: Vec<[f32; 3]> = places.iter().map(|place| place.to_array().map(|v| v as f32)).collect();
        let position = self.accessor(&places, "VEC3", Some(ARRAY_BUFFER), true);
        self.mesh(name, &json!({ "POSITION": position }), mode, 2)
    }

    fn mesh(&mut self, name: &str, attributes: &Value, mode: u32, material: usize) -> usize {
        let primitive = json!({ "attributes": attributes, "mode": mode, "material": material });
        self.meshes.push(json!({ "name": name, "primitives": [primitive] }));
        self.meshes.len() - 1
    }
}

/// The binary container: a head of twelve bytes, the JSON filled up with spaces, the numbers.
fn packed(json: &str, numbers: Vec<u8>) -> Vec<u8> {
    const MAGIC: u32 = 0x4654_6C67;
    const VERSION: u32 = 2;
    const JSON: u32 = 0x4E4F_534A;
    const BIN: u32 = 0x004E_4942;
    let mut text = json.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + text.len() + 8 + numbers.len();
    let mut file = Vec::with_capacity(length);
    let word = |file: &mut Vec<u8>, value: u32| file.extend_from_slice(&value.to_le_bytes());
    for value in [MAGIC, VERSION, length as u32] {
        word(&mut file, value);
    }
    for (kind, bytes) in [(JSON, text), (BIN, numbers)] {
        word(&mut file, bytes.len() as u32);
        word(&mut file, kind);
        file.extend_from_slice(&bytes);
    }
    file
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment_core::acceptance::Outcome;
    use catchment_core::design::{Alignment, ConnectorSpec, Design, Family, FamilySpec, LengthUnit};
    use catchment_core::method::descent::DescentSettings;
    use catchment_core::pose::PoseError;
    use catchment_core::problem::Problem;

    fn traced(x: f64) -> (Problem, TraceReport) {
        let alignment = Alignment::default_for(Some(Family::VFace));
        let connector = ConnectorSpec::Family(FamilySpec::new(Family::VFace));
        let name = "a \"V\" --> b".to_owned();
        let design = Design { name, connector, width: 40.0, unit: Some(LengthUnit::Mm), alignment };
        let problem = Problem::of(design).unwrap();
        let (start, settings) =
            (PoseError { x, pitch: 0.1, ..PoseError::default() }, DescentSettings::default());
        let (path, reason) = problem.trace(&start, &settings);
        let trace = TraceReport::new(&problem, &settings, start, &path, reason);
        (problem, trace)
    }

    /// The JSON and the numbers of a file, its head and its padding checked.
    fn unpacked(file: &[u8]) -> (Value, &[u8]) {
        let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&file[..4], word(4), word(8)), (&b"glTF"[..], 2, file.len()));
        let json = word(12);
        assert_eq!((json % 4, &file[16..20], &file[24 + json..28 + json]), (0, &b"JSON"[..], &b"BIN\0"[..]));
        assert_eq!((word(20 + json) % 4, 28 + json + word(20 + json)), (0, file.len()));
        (serde_json::from_slice(&file[20..20 + json]).unwrap(), &file[28 + json..])
    }

    #[test]
    fn the_animation_ends_at_the_mated_pose_and_times_grow() {
        let (problem, trace) = traced(0.2);
        assert_eq!(trace.outcome, Outcome::Aligned);
        let file = glb(&trace, problem.connector()).unwrap();
        let (head, bytes) = unpacked(&file);
        let numbers = |accessor: &Value| -> Vec<f32> {
            let accessor = &head["accessors"][accessor.as_u64().unwrap() as usize];
            let view = &head["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
            let [at, length] = ["byteOffset", "byteLength"].map(|name| view[name].as_u64().unwrap() as usize);
            let words = bytes[at..at + length].chunks(4);
            words.map(|word| f32::from_le_bytes(word.try_into().unwrap())).collect()
        };
        let samplers = &head["animations"][0]["samplers"];
        let times = numbers(&samplers[0]["input"]);
        assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{times:?}");
        assert_eq!((times[0], f64::from(*times.last().unwrap())), (0.0, SECONDS));
        let places = numbers(&samplers[0]["output"]);
        // Docked within the tolerance of a sharp seat, 0.002 D of 40 mm; the start is 0.2 D off.
        assert!(places[places.len() - 3..].iter().all(|v| v.abs() < 0.002 * 0.04), "{places:?}");
        assert!((f64::from(places[0]) - 0.2 * 0.04).abs() < 1e-8);
        let turns = numbers(&samplers[1]["output"]);
        assert!((turns[turns.len() - 1].abs() - 1.0).abs() < 1e-5);
        assert!(turns.chunks(4).all(|q| (q.iter().map(|v| v * v).sum::<f32>() - 1.0).abs() < 1e-5));
        assert_eq!(head["scenes"][0]["name"], "a \"V\" --> b");
        // Every triangle of the moving half, 9 numbers each.
        let corners: usize = problem
            .connector()
            .moving
            .surfaces
            .iter()
            .flat_map(|s| &s.facets)
            .map(|f| f.corners.len() - 2)
            .sum();
        assert_eq!(numbers(&head["meshes"][1]["primitives"][0]["attributes"]["POSITION"]).len(), 9 * corners);
    }

    #[test]
    fn a_miss_shows_nothing() {
        let (problem, mut trace) = traced(0.2);
        trace.waypoints.clear();
        assert!(glb(&trace, problem.connector()).is_none());
    }
}
