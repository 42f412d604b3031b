//! From cells to watersheds: every part of a cell drains to a single part below it, so the parts form a
//! forest, and the root of each tree is a rest, or the outside.
//!
//! ```text
//!       ┌────┬────┐        A cell whose gates all lead to the same watershed belongs to it entirely. If not, the
//!       │ a  │ b  │        parts below its gates are swept back up along the cell's motion (the split along steepest
//!       │    │    │        ascent): each part then drains to exactly one watershed.
//!       └─╱──┴──╲─┘
//!     ┌──╱─┐  ┌──╲─┐
//!     │ a  │  │ b  │
//! ```
//!
//! Cells are processed from below: strongly connected components of "drains into" in topological order. Most
//! have a single cell. Within a larger component parts are swept up one by one until no new part appears; the
//! remaining set circles around a rest (a loop of more than two facets, a *base watershed*), which
//! [`super::fall`] finds.
//!
//! Cells are split only along the borders of watersheds, which keeps the number of parts near that of the
//! cells; the original split at every meeting of two neighbours.

use super::cells::{Cells, Gate, GateTarget, facing};
use super::oracle::{self, MotionEnd};
use super::pieces;
use crate::acceptance::Outcome;
use crate::exec::{Cancelled, Exec};
use crate::polytope::{Polytope, PolytopePoint};
use petgraph::algo::tarjan_scc;
use petgraph::graph::{DiGraph, NodeIndex};

/// The watersheds of a cell.
#[derive(Debug, Clone)]
pub(super) enum Parts {
    /// A single outcome.
    Whole(Outcome),
    /// Disjoint parts.
    Cut(Vec<(Polytope, Outcome)>),
}

/// Destinations of the parts of cells.
#[derive(Debug)]
pub(super) struct Watersheds {
    /// In the order of the cells.
    pub(super) parts: Vec<Parts>,
    /// Rests to which ravines and circling motion lead.
    pub(super) rests: Vec<PolytopePoint>,
    /// Whether some motion leaves through the last slice of a rotation; it counts as jammed.
    pub(super) cut_off: bool,
}

/// Rests closer than this are equal, in D and radians: far above rounding, far below a cell.
const SAME_PLACE: f64 = 1e-6;

/// Largest number of parts within a component, per cell of it, after which the remainder is decided by the
/// motion of its middle.
const MOST_PARTS: usize = 64;

/// A part smaller than this share of its cell is rounding.
const ROUNDING: f64 = 1e-9;

struct Draining<'a, F> {
    cells: &'a Cells,
    /// Whether a rest is the mated pose.
    is_aligned: F,
    /// For each cell and gate: its outcome, unless it leads into a cell.
    labels: Vec<Vec<Option<Outcome>>>,
    parts: Vec<Option<Parts>>,
    rests: Vec<(PolytopePoint, Outcome)>,
    cut_off: bool,
}

/// Drains every cell.
pub(super) fn drain(
    cells: &Cells,
    is_aligned: impl Fn(&PolytopePoint) -> bool,
    exec: &Exec,
) -> Result<Watersheds, Cancelled> {
    let count = cells.all.len();
    let fates = exec.map(count, |k| gate_fates(cells, k))?;
    let mut draining = Draining {
        cells,
        is_aligned,
        labels: Vec::new(),
        parts: vec![None; count],
        rests: Vec::new(),
        cut_off: false,
    };
    draining.labels = fates
        .into_iter()
        .map(|gates| gates.into_iter().map(|fate| fate.map(|fate| draining.label(fate))).collect())
        .collect();
    let mut graph: DiGraph<(), (), usize> = DiGraph::with_capacity(count, count);
    for _ in 0..count {
        graph.add_node(());
    }
    for (k, cell) in cells.all.iter().enumerate() {
        for gate in &cell.gates {
            if let GateTarget::Cell(to) = gate.to {
                graph.add_edge(NodeIndex::new(k), NodeIndex::new(to), ());
            }
        }
    }
    for (done, component) in tarjan_scc(&graph).into_iter().enumerate() {
        if done.is_multiple_of(256) {
            exec.check()?;
            exec.report(done as f64 / count as f64, "watersheds");
        }
        let mut members: Vec<usize> = component.into_iter().map(NodeIndex::index).collect();
        members.sort_unstable();
        match members[..] {
            [k] => {
                let parts = draining.through_gates(k);
                draining.settle(k, parts);
            }
            _ => draining.settle_together(&members, exec)?,
        }
    }
    let parts = draining.parts.into_iter().map(|parts| parts.unwrap_or(Parts::Cut(Vec::new()))).collect();
    let rests = draining.rests.into_iter().map(|(place, _)| place).collect();
    Ok(Watersheds { parts, rests, cut_off: draining.cut_off })
}

/// Ends of the motions through the gates that do not lead into a cell.
fn gate_fates(cells: &Cells, k: usize) -> Vec<Option<MotionEnd>> {
    let cell = &cells.all[k];
    cell.gates
        .iter()
        .map(|gate| match gate.to {
            GateTarget::Cell(_) => None,
            GateTarget::Nothing => Some(MotionEnd::Lost),
            GateTarget::Border => Some(MotionEnd::Left),
            GateTarget::Ravine => Some(if let Some(place) = oracle::level(cells, k, gate) {
                MotionEnd::Rest(place)
            } else {
                let (height, bottom) = oracle::lowest(cells, k, gate);
                oracle::fate_from(cells, &bottom, height)
            }),
        })
        .collect()
}

impl<F: Fn(&PolytopePoint) -> bool> Draining<'_, F> {
    fn label(&mut self, fate: MotionEnd) -> Outcome {
        let place = match fate {
            MotionEnd::Lost => return Outcome::Missed,
            MotionEnd::Left => {
                self.cut_off = true;
                return Outcome::Jammed;
            }
            MotionEnd::Rest(place) => place,
        };
        let near = |other: &PolytopePoint| place.iter().zip(other).all(|(a, b)| (a - b).abs() <= SAME_PLACE);
        if let Some((_, outcome)) = self.rests.iter().find(|(other, _)| near(other)) {
            return *outcome;
        }
        let outcome = if (self.is_aligned)(&place) { Outcome::Aligned } else { Outcome::Jammed };
        self.rests.push((place, outcome));
        outcome
    }

    /// The parts of a cell above those of its gates that are known.
    fn through_gates(&self, k: usize) -> Vec<(Option<Polytope>, Outcome)> {
        let cell = &self.cells.all[k];
        let mut parts = Vec::new();
        for (gate, label) in cell.gates.iter().zip(&self.labels[k]) {
            let whole = match (gate.to, label) {
                (_, Some(label)) => Some(*label),
                (GateTarget::Cell(to), None) => match &self.parts[to] {
                    Some(Parts::Whole(label)) => Some(*label),
                    _ => None,
                },
                _ => None,
            };
            if let Some(label) = whole {
                parts.push((cell.upstream(gate.facet, gate.dropped, &gate.region), label));
            } else if let GateTarget::Cell(to) = gate.to
                && let Some(Parts::Cut(below)) = &self.parts[to]
            {
                parts.extend(self.above(k, gate, below));
            }
        }
        parts
    }

    /// The parts of a cell above the parts below one of its gates. The portions of the gate that they share
    /// are merged first.
    fn above(
        &self,
        k: usize,
        gate: &Gate,
        below: &[(Polytope, Outcome)],
    ) -> Vec<(Option<Polytope>, Outcome)> {
        let cell = &self.cells.all[k];
        let mut parts = Vec::new();
        for outcome in [Outcome::Aligned, Outcome::Jammed, Outcome::Missed] {
            let sides = below.iter().filter(|(_, other)| *other == outcome);
            let sides: Vec<Polytope> = sides.filter_map(|(part, _)| self.side(k, gate, part)).collect();
            let shared: f64 = sides.iter().map(Polytope::volume).sum();
            if shared >= gate.region.volume() * (1.0 - ROUNDING) {
                return vec![(cell.upstream(gate.facet, gate.dropped, &gate.region), outcome)];
            }
            let sides = pieces::joined(sides);
            parts.extend(sides.iter().map(|side| (cell.upstream(gate.facet, gate.dropped, side), outcome)));
        }
        parts
    }

    /// The portion of a gate that leads into a part of the cell below.
    fn side(&self, k: usize, gate: &Gate, part: &Polytope) -> Option<Polytope> {
        let plane = &self.cells.all[k].region.facets()[gate.facet];
        gate.region.intersection(&part.facet_projected(facing(part, plane)?, gate.dropped)?)
    }

    /// The portion of a cell that drains through a gate into a part of the cell below.
    fn through(&self, k: usize, gate: &Gate, part: &Polytope) -> Option<Polytope> {
        self.cells.all[k].upstream(gate.facet, gate.dropped, &self.side(k, gate, part)?)
    }

    /// Gives a cell its parts: a single label if they all agree.
    fn settle(&mut self, k: usize, parts: Vec<(Option<Polytope>, Outcome)>) {
        let parts: Vec<(Polytope, Outcome)> =
            parts.into_iter().filter_map(|(part, label)| Some((part?, label))).collect();
        let whole = match parts.first() {
            Some((_, first)) if parts.iter().all(|(_, label)| label == first) => Some(*first),
            Some(_) => None,
            // Level ground.
            None => Some(self.of_middle(&self.cells.all[k].region)),
        };
        self.parts[k] = Some(whole.map_or(Parts::Cut(parts), Parts::Whole));
    }

    fn of_middle(&mut self, region: &Polytope) -> Outcome {
        self.label(oracle::fate(self.cells, &region.centroid()))
    }

    /// Cells that drain into each other.
    fn settle_together(&mut self, members: &[usize], exec: &Exec) -> Result<(), Cancelled> {
        let place = |cell: usize| members.binary_search(&cell).ok();
        // Which gates of which members lead into each member.
        let mut above: Vec<Vec<(usize, usize)>> = vec![Vec::new(); members.len()];
        for &k in members {
            for (g, gate) in self.cells.all[k].gates.iter().enumerate() {
                if let GateTarget::Cell(to) = gate.to
                    && let Some(to) = place(to)
                {
                    above[to].push((k, g));
                }
            }
        }
        let mut parts: Vec<Vec<(Polytope, Outcome)>> = members
            .iter()
            .map(|k| {
                let known = self.through_gates(*k);
                known.into_iter().filter_map(|(part, label)| Some((part?, label))).collect()
            })
            .collect();
        let mut waiting: Vec<(usize, usize)> =
            (0..members.len()).flat_map(|m| (0..parts[m].len()).map(move |p| (m, p))).collect();
        let mut made = waiting.len();
        while let Some((m, p)) = waiting.pop() {
            exec.check()?;
            for &(k, g) in &above[m] {
                let (part, label) = &parts[m][p];
                let label = *label;
                let Some(swept) = self.through(k, &self.cells.all[k].gates[g], part) else { continue };
                let Some(to) = place(k) else { continue };
                parts[to].push((swept, label));
                waiting.push((to, parts[to].len() - 1));
                made += 1;
            }
            if made > MOST_PARTS * members.len() {
                break;
            }
        }
        for (&k, mut parts) in members.iter().zip(parts) {
            let region = &self.cells.all[k].region;
            let known: f64 = parts.iter().map(|(part, _)| part.volume()).sum();
            if known < region.volume() * (1.0 - ROUNDING) {
                let mut rest = vec![region.clone()];
                for (part, _) in &parts {
                    rest = rest.iter().flat_map(|left| left.difference(part)).collect();
                }
                for left in rest {
                    let label = self.of_middle(&left);
                    parts.push((left, label));
                }
            }
            self.settle(k, parts.into_iter().map(|(part, label)| (Some(part), label)).collect());
        }
        Ok(())
    }
}
