//! A chain's report for people: millimetres and degrees, 80 columns.

use super::{ArrivalReport, ChainBody, ChainReport, FoldingReport};
use crate::chain::accumulation::{heading_sigma, lateral_sigma};
use crate::chain::sequence::Command;
use catchment::report::text::{COLUMNS, line, percent, rounded, row, wrapped};

/// `1.00°`.
fn degrees(radians: f64) -> String {
    let text = format!("{:.2}°", radians.to_degrees());
    if text == "-0.00°" { "0.00°".to_owned() } else { text }
}

fn with_interval(probability: f64, [low, high]: [f64; 2]) -> String {
    format!("{} ({} to {})", percent(probability), percent(low), percent(high))
}

/// The report for a person.
pub fn table(report: &ChainReport) -> String {
    let mut text = String::new();
    let (t, body) = (&mut text, &report.body);
    body.head(t);
    body.straight_lines(t);
    if let Some(folding) = &body.folding {
        folded(t, folding, body.body.face);
    }
    body.corner_lines(t);
    body.length_lines(t);
    for doubt in &report.warnings {
        wrapped(t, "  note: ", &doubt.message);
    }
    text
}

impl ChainBody {
    fn head(&self, t: &mut String) {
        line(t, &self.name);
        let dims = format!(
            "{}, pitch {} mm, face D = {} mm, joint error {}",
            self.modules,
            rounded(self.body.pitch),
            rounded(self.body.face),
            degrees(self.errors.joint_sigma)
        );
        row(t, "modules", &dims);
        if let Some(connector) = &self.connector {
            let cor = rounded(connector.center_of_rotation_d);
            let rho = rounded(connector.rotation_length_d);
            row(t, "connector", &format!("{}, rho {rho} D", connector.name));
            row(t, "", &format!("COR {cor} D in front of the face: the last rotor"));
        }
        if let (Some(probability), Some(ci95)) = (self.probability, self.ci95) {
            row(t, "docks", &with_interval(probability, ci95));
            row(t, "", &format!("of {} random chains, 95 % interval", self.chains));
        }
    }

    fn straight_lines(&self, t: &mut String) {
        line(t, "");
        line(t, &format!("last face of the straight chain of {}", self.modules));
        arrival(t, &self.straight);
        let (lateral, heading) = growth(self);
        if self.errors.joint_sigma > 0.0 {
            let text = format!(
                "joint errors alone: {lateral:.4} D, {}. They grow like n^1.5 and n^0.5, not exponentially as the source says (p. 2).",
                degrees(heading)
            );
            wrapped(t, "  ", &text);
        }
    }

    fn corner_lines(&self, t: &mut String) {
        if self.corners.is_empty() {
            return;
        }
        line(t, "");
        line(t, "choices of corners          across     gap  angle  corr.   push  rank  press");
        for c in &self.corners {
            let names = c.corners.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
            line(
                t,
                &format!(
                    "  {names:<15} error {:>2}  {:>6.2} mm {:>7.2} {:>6} {:>6.2} {:>6.1} {:>4} {:>6.1} N",
                    c.rank_by_error,
                    c.lateral_sigma_mm,
                    c.normal_sigma_mm,
                    degrees(c.angle_sigma_rad),
                    c.correlation,
                    c.push_n,
                    c.rank_by_force,
                    c.press_n,
                ),
            );
        }
        wrapped(
            t,
            "  ",
            "push: torque over the distance of the nearest corner from the face; press: along the normal, what all joints can hold",
        );
    }

    fn length_lines(&self, t: &mut String) {
        if self.lengths.is_empty() {
            return;
        }
        line(t, "");
        line(t, "  joint  modules  across    heading   docks     95 % interval      offset alone");
        for row in &self.lengths {
            let docks = row.docking.map_or_else(
                || format!("{:<29}", "–"),
                |d| {
                    format!(
                        "{:<9} {:<19}",
                        percent(d.probability),
                        format!("{} to {}", percent(d.ci95[0]), percent(d.ci95[1]))
                    )
                },
            );
            let alone = row.offset_probability.map_or_else(|| "–".to_owned(), percent);
            line(
                t,
                &format!(
                    "  {:<6} {:>5}   {:.4} D  {:>7}   {docks} {alone}",
                    degrees(row.joint_sigma_rad),
                    row.modules,
                    row.lateral_sigma_d,
                    degrees(row.heading_sigma_rad),
                ),
            );
        }
        for reach in &self.reach {
            let who = format!("joint error {}: ", degrees(reach.joint_sigma_rad));
            let said = match reach.modules {
                Some(modules) => {
                    let surely = match reach.surely {
                        Some(surely) if surely == modules => String::new(),
                        Some(surely) => format!(", surely up to {surely}"),
                        None => ", surely for none".to_owned(),
                    };
                    format!("{} up to {modules} modules{surely}", reach.requirement)
                }
                None => format!("{} for none of the table", reach.requirement),
            };
            line(t, &format!("  {who}{said}"));
        }
    }
}

/// Lateral deviation in D and heading in radians that the closed forms give a straight chain, for the story of growth.
fn growth(body: &ChainBody) -> (f64, f64) {
    let sigma = body.errors.joint_sigma;
    (lateral_sigma(&body.body, body.modules, sigma) / body.body.face, heading_sigma(body.modules, sigma))
}

fn arrival(t: &mut String, a: &ArrivalReport) {
    let across = format!(
        "{:.2} mm = {:.4} D across, {:.2} mm of gap, {} of angle",
        a.lateral_sigma_mm,
        a.lateral_sigma_d,
        a.normal_sigma_mm,
        degrees(a.angle_sigma_rad)
    );
    row(t, "error (sigma)", &across);
    row(t, "correlation", &format!("{:.3} of offset and angle", a.correlation));
    if let Some(docking) = a.docking {
        row(t, "docks", &with_interval(docking.probability, docking.ci95));
    }
    if let Some(alone) = a.offset_probability {
        row(t, "offset alone", &format!("{} corrected without rotation", percent(alone)));
    }
}

fn folded(t: &mut String, folding: &FoldingReport, face: f64) {
    let turned = folding.turned.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    line(t, "");
    let name = folding.shape.map_or("own sequence", |shape| shape.name());
    line(t, &format!("{name}: joints {turned} turn"));
    if !folding.reading.is_empty() {
        wrapped(t, "  shape          ", &folding.reading);
    }
    wrapped(t, "  commands       ", &folding.commands_from);
    line(t, "   t     joint:command→angle");
    let mut before: Vec<Option<f64>> = Vec::new();
    for step in &folding.steps {
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
        let said = if moved.is_empty() { "straight".to_owned() } else { moved.join(", ") };
        wrapped(t, &format!("  {:>3} s  ", rounded(step.time_s)), &said);
        before = step.modules.iter().map(|m| m.command_rad).collect();
    }
    for event in &folding.events {
        let layers = if event.layers == 1 { "first layer" } else { "both layers hold" };
        line(
            t,
            &format!(
                "  {:>5.2} s  {}–{} {layers}: {:.1} N, {:.2} mm = {:.3} D off-centre, {}",
                event.time_s,
                event.from,
                event.to,
                event.force_n,
                event.lateral_mm.abs(),
                event.lateral_mm.abs() / face,
                degrees(event.angle_rad),
            ),
        );
    }
    let end = format!(
        "{}; {:.3} mm and {} off the lattice",
        if folding.latched { "every pair latched" } else { "not every pair latched" },
        folding.off_lattice_mm,
        degrees(folding.off_lattice_rad)
    );
    row(t, "in the end", &end);
    for latch in &folding.latches {
        let Some(pair) = latch.latch else { continue };
        let joints = latch.joints.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        line(t, "");
        let head = format!(
            "docking {}: {} of {} meets {} of {}; wrong may be joints {joints}",
            pair.name(),
            pair.to_side.name(),
            pair.to,
            pair.from_side.name(),
            pair.from
        );
        let fits = head.chars().count() <= COLUMNS;
        if fits {
            line(t, &head);
        } else {
            wrapped(t, "", &head);
        }
        arrival(t, latch);
        row(t, "presses", &format!("{:.1} N at most along the normal", latch.press_n));
    }
}
