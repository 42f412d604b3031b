//! The shells of a mesh: what hangs together by shared edges, each closed by itself.
//!
//! ```text
//!    ┌──────┐            two shells that cross: a body each, and the half is their union
//!    │   ┌──┼───┐
//!    │   │  │   │        ┌─────────┐
//!    └───┼──┘   │        │  ┌───┐  │   a shell turned inward is a cavity: it goes with the
//!        └──────┘        │  └───┘  │   smallest shell around it
//!                        └─────────┘
//! ```
//!
//! Not promised: shells that share an edge are no shells here, four triangles meet there. Of more than [`MOST`] shells nothing is taken apart.

use super::check::{Sides, corners};
use glam::DVec3;

/// Most shells that are told apart, as many as a half may have pieces: every two bodies of both halves are compared.
const MOST: usize = 256;
/// Share of all directions in which a point sees a shell from inside above which it counts as inside: on the shell it is half.
const INSIDE: f64 = 0.25;

/// The shells of a mesh.
pub(super) struct Shells {
    /// Of every triangle, the number of its shell.
    pub(super) of: Vec<usize>,
    /// Of every shell, its triangles.
    triangles: Vec<Vec<usize>>,
    /// Of every shell, its volume; negative where it is turned inward.
    volumes: Vec<f64>,
    /// Of every shell that is turned inward, the one around it.
    around: Vec<Option<usize>>,
}

impl Shells {
    /// Of a mesh in which two triangles meet along every edge.
    pub(super) fn of(vertices: &[DVec3], indexed: &[[u32; 3]], sides: &Sides) -> Self {
        let mut leader: Vec<usize> = (0..indexed.len()).collect();
        for owners in sides.values() {
            for pair in owners.windows(2) {
                let (a, b) = (find(&mut leader, pair[0].0), find(&mut leader, pair[1].0));
                leader[a.max(b)] = a.min(b);
            }
        }
        let mut number = vec![usize::MAX; indexed.len()];
        let mut triangles: Vec<Vec<usize>> = Vec::new();
        let mut of = Vec::with_capacity(indexed.len());
        for k in 0..indexed.len() {
            let first = find(&mut leader, k);
            if number[first] == usize::MAX {
                number[first] = triangles.len();
                triangles.push(Vec::new());
            }
            of.push(number[first]);
            triangles[number[first]].push(k);
        }
        if triangles.len() > MOST {
            of.fill(0);
            triangles = vec![(0..indexed.len()).collect()];
        }
        let at = |k: usize| corners(vertices, indexed[k]);
        // Seen from one of its own corners: far from the origin the sum would lose its digits.
        let volume = |shell: &Vec<usize>| {
            let origin = at(shell[0])[0];
            let six = |k: &usize| {
                let [a, b, c] = at(*k).map(|p| p - origin);
                a.dot(b.cross(c))
            };
            shell.iter().map(six).sum::<f64>() / 6.0
        };
        let volumes: Vec<f64> = triangles.iter().map(volume).collect();
        let around = |inner: usize| {
            let [a, b, c] = at(triangles[inner][0]);
            let point = (a + b + c) / 3.0;
            let holds = |outer: &usize| {
                let angle: f64 = triangles[*outer].iter().map(|k| solid_angle(at(*k), point)).sum();
                volumes[*outer] > 0.0 && angle / (4.0 * std::f64::consts::PI) > INSIDE
            };
            (0..triangles.len()).filter(holds).min_by(|a, b| volumes[*a].total_cmp(&volumes[*b]))
        };
        let around = (0..triangles.len()).map(|k| if volumes[k] > 0.0 { None } else { around(k) }).collect();
        Self { of, triangles, volumes, around }
    }

    /// The triangles of every body, which is a shell and its cavities; `None` where a shell is turned inward and lies in no other.
    pub(super) fn bodies(&self) -> Option<Vec<Vec<usize>>> {
        let mut bodies: Vec<Vec<usize>> = Vec::new();
        let mut body_of = vec![usize::MAX; self.triangles.len()];
        for (k, shell) in self.triangles.iter().enumerate().filter(|(k, _)| self.volumes[*k] > 0.0) {
            body_of[k] = bodies.len();
            bodies.push(shell.clone());
        }
        for (k, shell) in self.triangles.iter().enumerate().filter(|(k, _)| self.volumes[*k] <= 0.0) {
            bodies[body_of[self.around[k]?]].extend(shell);
        }
        Some(bodies)
    }
}

fn find(leader: &mut [usize], mut k: usize) -> usize {
    while leader[k] != k {
        leader[k] = leader[leader[k]];
        k = leader[k];
    }
    k
}

/// The solid angle under which a point sees a triangle, positive from behind (van Oosterom and Strackee 1983).
fn solid_angle(corners: [DVec3; 3], point: DVec3) -> f64 {
    let [a, b, c] = corners.map(|p| p - point);
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let across = a.dot(b.cross(c));
    let along = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * across.atan2(along)
}
