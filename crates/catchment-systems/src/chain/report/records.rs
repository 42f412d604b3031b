//! A chain's report as records for programs: millimetres, radians, the names of the columns first.

use super::{ChainBody, number};
use crate::chain::fold::State;
use crate::chain::study::Study;

impl ChainBody {
    /// The table over numbers of modules, if there is one; else where every module is after every step, if the chain folds; else every
    /// random chain.
    pub fn records(&self, study: &Study) -> Vec<Vec<String>> {
        if !self.lengths.is_empty() {
            return self.lengths_records();
        }
        match &self.folding {
            Some(_) => self.poses(),
            None => chains(study),
        }
    }

    fn lengths_records(&self) -> Vec<Vec<String>> {
        let names = [
            "joint_sigma_rad",
            "modules",
            "lateral_sigma_d",
            "heading_sigma_rad",
            "probability",
            "ci95_low",
            "ci95_high",
            "offset_probability",
        ];
        let maybe = |value: Option<f64>| value.map_or_else(String::new, number);
        let row = |row: &super::LengthReport| {
            vec![
                number(row.joint_sigma_rad),
                row.modules.to_string(),
                number(row.lateral_sigma_d),
                number(row.heading_sigma_rad),
                maybe(row.docking.map(|d| d.probability)),
                maybe(row.docking.map(|d| d.ci95[0])),
                maybe(row.docking.map(|d| d.ci95[1])),
                maybe(row.offset_probability),
            ]
        };
        headed(&names, self.lengths.iter().map(row))
    }

    fn poses(&self) -> Vec<Vec<String>> {
        let names = ["t", "module", "x", "y", "heading", "command", "state"];
        let steps = self.folding.iter().flat_map(|folding| &folding.steps);
        let rows = steps.flat_map(|step| {
            step.modules.iter().map(|m| {
                let state = match m.state {
                    State::Holding => "holding",
                    State::Stalled => "stalled",
                    State::Slack => "slack",
                };
                vec![
                    number(step.time_s),
                    m.module.to_string(),
                    number(m.x_mm),
                    number(m.y_mm),
                    number(m.heading_rad),
                    m.command_rad.map_or_else(|| "slack".to_owned(), number),
                    state.to_owned(),
                ]
            })
        });
        headed(&names, rows)
    }
}

/// Every random chain: its errors, and whether it docks.
fn chains(study: &Study) -> Vec<Vec<String>> {
    let names = ["chain", "lateral_mm", "normal_mm", "angle_rad", "docks"];
    let straight = &study.straight;
    let docks = |k: usize| match &straight.docked {
        Some(docked) => docked[k].to_string(),
        None => String::new(),
    };
    let rows = straight.cloud.iter().enumerate().map(|(k, [lateral, normal, angle])| {
        vec![k.to_string(), number(*lateral), number(*normal), number(*angle), docks(k)]
    });
    headed(&names, rows)
}

fn headed(names: &[&str], rows: impl Iterator<Item = Vec<String>>) -> Vec<Vec<String>> {
    let names = names.iter().map(|name| (*name).to_owned()).collect();
    std::iter::once(names).chain(rows).collect()
}
