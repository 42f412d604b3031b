//! Text and table form of a chain: millimetres and degrees; in tables for programs radians.

use super::{ChainBody, FoldingReport};
use crate::chain::accumulation::{heading_sigma, lateral_sigma};
use crate::chain::fold::State;
use crate::chain::sequence::Command;
use crate::chain::study::ArrivalErrors;
use catchment::document::{Cell, Column, ColumnFormat, Document, Table, percent, rounded};
use catchment::report::document::Printed;
use std::borrow::Cow;

/// Text for an unknown value.
const NOTHING: &str = "–";

/// `1.00°`.
fn degrees(radians: f64) -> String {
    let text = format!("{:.2}°", radians.to_degrees());
    if text == "-0.00°" { "0.00°".to_owned() } else { text }
}

fn with_interval(probability: f64, [low, high]: [f64; 2]) -> String {
    format!("{} ({} to {})", percent(probability), percent(low), percent(high))
}

fn list(numbers: &[usize]) -> String {
    numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

impl Printed for ChainBody {
    fn title(&self) -> Cow<'_, str> {
        Cow::Borrowed(&self.name)
    }

    /// Programs read the table over numbers of modules, if there is one; else the positions of all modules
    /// after every step, if the chain folds; else every random chain.
    fn document(&self) -> Document {
        let mut document = Document::default();
        self.describe_head(&mut document);
        self.describe_straight(&mut document);
        if let Some(folding) = &self.folding {
            folding.describe(&mut document, self.body.face);
        }
        self.describe_corners(&mut document);
        self.describe_lengths(&mut document);
        if self.lengths.is_empty() {
            document
                .table(self.folding.as_ref().map_or_else(|| self.straight.chains(), FoldingReport::poses));
        }
        document
    }
}

impl ChainBody {
    fn describe_head(&self, document: &mut Document) {
        document.row(
            "modules",
            format!(
                "{}, pitch {} mm, face D = {} mm, joint error {}",
                self.modules,
                rounded(self.body.pitch),
                rounded(self.body.face),
                degrees(self.errors.joint_sigma)
            ),
        );
        if let Some(connector) = &self.connector {
            let cor = connector.center_of_rotation_d;
            let side = if cor < 0.0 { "behind" } else { "in front of" };
            let rho = rounded(connector.rotation_length_d);
            document
                .row("connector", format!("{}, ρ {rho} D", connector.name))
                .more(format!("COR {} D {side} the face: the last rotor", rounded(cor.abs())));
        }
        if let (Some(probability), Some(ci95)) = (self.probability, self.ci95) {
            document
                .row("docks", with_interval(probability, ci95))
                .more(format!("of {} random chains, 95 % interval", self.chains));
        }
    }

    fn describe_straight(&self, document: &mut Document) {
        document.titled(Some(format!("last face of the straight chain of {}", self.modules)));
        self.straight.describe(document);
        let sigma = self.errors.joint_sigma;
        if sigma > 0.0 {
            let lateral = lateral_sigma(&self.body, self.modules, sigma) / self.body.face;
            let heading = degrees(heading_sigma(self.modules, sigma));
            document.paragraph(format!(
                "joint errors alone: {lateral:.4} D, {heading}. They grow like n^1.5 and n^0.5, not exponentially as the source says (p. 2)."
            ));
        }
    }

    fn describe_corners(&self, document: &mut Document) {
        if self.corners.is_empty() {
            return;
        }
        let column = |title: &str, decimals| Column::new(title).format(ColumnFormat::Fixed(decimals));
        let mut table = Table::new([
            Column::new("corners").left(),
            Column::new("error"),
            column("across", 2),
            column("gap", 2),
            Column::new("angle"),
            column("corr.", 2),
            Column::new("force"),
            column("push", 1),
            column("press", 1),
        ]);
        for c in &self.corners {
            table.push([
                list(&c.corners).into(),
                c.rank_by_error.into(),
                c.lateral_sigma_mm.into(),
                c.normal_sigma_mm.into(),
                degrees(c.angle_sigma_rad).into(),
                c.correlation.into(),
                c.rank_by_force.into(),
                c.push_n.into(),
                c.press_n.into(),
            ]);
        }
        document
            .section("choices of corners")
            .table(table)
            .paragraph("error, force: rank by the error across the face and by the pushing force")
            .paragraph("across, gap: standard deviations, in mm; corr.: correlation of offset and angle")
            .paragraph(
                "push: torque over the distance of the nearest corner from the face, in N; press: along the normal, what all joints can hold, in N",
            );
    }

    fn describe_lengths(&self, document: &mut Document) {
        if self.lengths.is_empty() {
            return;
        }
        document
            .section(None)
            .table(self.length_table())
            .paragraph("offset: the lateral offset alone is corrected without rotation");
        for reach in &self.reach {
            let up_to = match reach.modules {
                Some(modules) => {
                    let surely = match reach.surely {
                        Some(surely) if surely == modules => String::new(),
                        Some(surely) => format!(", surely up to {surely}"),
                        None => ", surely for none".to_owned(),
                    };
                    format!("up to {modules} modules{surely}")
                }
                None => "for none of the table".to_owned(),
            };
            let sigma = degrees(reach.joint_sigma_rad);
            document.paragraph(format!("joint error {sigma}: {} {up_to}", reach.requirement));
        }
    }

    fn length_table(&self) -> Table {
        let docks = Column {
            keys: ["probability", "ci95_low", "ci95_high"].map(str::to_owned).to_vec(),
            ..Column::new("docks (95 % CI)").format(ColumnFormat::Percent)
        };
        let mut table = Table::new([
            Column::new("joint").key("joint_sigma_rad"),
            Column::new("modules").key("modules"),
            Column::new("across").key("lateral_sigma_d"),
            Column::new("heading").key("heading_sigma_rad"),
            docks,
            Column::new("offset").key("offset_probability").format(ColumnFormat::Percent),
        ]);
        let known = |cell: Option<Cell>| cell.unwrap_or_else(|| Cell::shown(NOTHING, Cell::Empty));
        for row in &self.lengths {
            table.push([
                Cell::shown(degrees(row.joint_sigma_rad), row.joint_sigma_rad),
                row.modules.into(),
                Cell::shown(format!("{:.4} D", row.lateral_sigma_d), row.lateral_sigma_d),
                Cell::shown(degrees(row.heading_sigma_rad), row.heading_sigma_rad),
                known(row.docking.map(|docking| Cell::Interval(docking.probability, docking.ci95))),
                known(row.offset_probability.map(Cell::Number)),
            ]);
        }
        table
    }
}

impl ArrivalErrors {
    fn describe(&self, document: &mut Document) {
        document
            .row(
                "error (sigma)",
                format!(
                    "{:.2} mm = {:.4} D across, {:.2} mm of gap, {} of angle",
                    self.lateral_sigma_mm,
                    self.lateral_sigma_d,
                    self.normal_sigma_mm,
                    degrees(self.angle_sigma_rad)
                ),
            )
            .row("correlation", format!("{:.3} of offset and angle", self.correlation));
        if let Some(docking) = self.docking {
            document.row("docks", with_interval(docking.probability, docking.ci95));
        }
        if let Some(alone) = self.offset_probability {
            document.row("offset alone", format!("{} corrected without rotation", percent(alone)));
        }
    }

    /// Every random chain for programs: its errors, and whether it docks.
    fn chains(&self) -> Table {
        let mut table = Table::data("chain lateral_mm normal_mm angle_rad docks");
        for (k, [lateral, normal, angle]) in self.cloud.iter().enumerate() {
            let docks = self.docked.as_ref().map(|docked| docked[k]);
            table.push([k.into(), (*lateral).into(), (*normal).into(), (*angle).into(), docks.into()]);
        }
        table
    }
}

impl FoldingReport {
    fn describe(&self, document: &mut Document, face: f64) {
        let name = self.shape.map_or("own sequence", |shape| shape.name());
        document.titled(Some(format!("{name}: joints {} turn", list(&self.turned))));
        if !self.reading.is_empty() {
            document.row("shape", &*self.reading);
        }
        document.row("commands", &*self.commands_from).table(self.step_table());
        if !self.events.is_empty() {
            document.table(self.event_table(face));
        }
        document.row(
            "in the end",
            format!(
                "{}; {:.3} mm and {} off the lattice",
                if self.latched { "every pair latched" } else { "not every pair latched" },
                self.off_lattice_mm,
                degrees(self.off_lattice_rad)
            ),
        );
        for arrival in &self.latches {
            let Some(pair) = arrival.latch else { continue };
            document.titled(Some(format!("docking {}", pair.name()))).row(
                "faces",
                format!(
                    "{} of {} meets {} of {}",
                    pair.to_side.name(),
                    pair.to,
                    pair.from_side.name(),
                    pair.from
                ),
            );
            document.row("wrong may be", format!("joints {}", list(&arrival.joints)));
            arrival.describe(document);
            document.row("presses", format!("{:.1} N at most along the normal", arrival.press_n));
        }
    }

    /// Joints that get another command in a step, and their final angles.
    fn step_table(&self) -> Table {
        let mut table = Table::new([Column::new("t"), Column::new("joint: command → angle").left()]);
        let mut before: Vec<Option<f64>> = Vec::new();
        for step in &self.steps {
            let moved = step
                .modules
                .iter()
                .enumerate()
                .filter(|(k, m)| before.get(*k).copied().unwrap_or(Some(0.0)) != m.command_rad);
            let moved: Vec<String> = moved
                .map(|(_, m)| {
                    let command = m.command_rad.map_or(Command::Slack.text(), degrees);
                    format!("{}:{command}→{}", m.module, degrees(m.angle_rad))
                })
                .collect();
            let moved = if moved.is_empty() { "straight".to_owned() } else { moved.join(", ") };
            table.push([format!("{} s", rounded(step.time_s)).into(), moved.into()]);
            before = step.modules.iter().map(|m| m.command_rad).collect();
        }
        table
    }

    fn event_table(&self, face: f64) -> Table {
        let mut table = Table::new([Column::new("t"), Column::new("layers that latch").left()]);
        for event in &self.events {
            let layers = if event.layers == 1 { "first layer" } else { "both layers hold" };
            let latched = format!(
                "{}–{} {layers}: {:.1} N, {:.2} mm = {:.3} D off-centre, {}",
                event.from,
                event.to,
                event.force_n,
                event.lateral_mm.abs(),
                event.lateral_mm.abs() / face,
                degrees(event.angle_rad),
            );
            table.push([format!("{:.2} s", event.time_s).into(), latched.into()]);
        }
        table
    }

    /// The positions of all modules after every step, for programs.
    fn poses(&self) -> Table {
        let mut table = Table::data("t module x y heading command state");
        for step in &self.steps {
            for m in &step.modules {
                let state = match m.state {
                    State::Holding => "holding",
                    State::Stalled => "stalled",
                    State::Slack => "slack",
                };
                table.push([
                    step.time_s.into(),
                    m.module.into(),
                    m.x_mm.into(),
                    m.y_mm.into(),
                    m.heading_rad.into(),
                    m.command_rad.map_or_else(|| "slack".into(), Cell::Number),
                    state.into(),
                ]);
            }
        }
        table
    }
}
