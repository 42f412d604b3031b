//! Text form of rests.

use super::super::jams::descriptions::{FACES, RestDescriptions};
use super::super::jams::{contacts_in_words, escape_height};
use super::{RestPlace, Rests};
use crate::acceptance::Outcome;
use crate::design::Design;
use crate::diagnostic::{Diagnostic, Warning};
use crate::document::{
    Cell, Document, Share, Subject, Table, exact_motions, grouped, tenths, tenths_between,
};

/// Rests that are shown.
const SHOWN: usize = 6;

impl Subject for Rests {
    const KIND: &'static str = "rests";

    fn warnings(&self) -> Vec<Diagnostic> {
        let undecided = self.outcomes.get(&Outcome::Undecided).filter(|share| share.count > 0);
        undecided.map(|share| Warning::Undecided { cells: share.count }.into()).into_iter().collect()
    }

    fn setup(&self, _: &Design, document: &mut Document) {
        document.row("load", "along -z, through the COR");
        document.row("method", exact_motions(&format!("{} random poses", grouped(self.motions)), 0.0));
    }

    fn document(&self, design: &Design) -> Document {
        let mut document = Document::default();
        let off = self.outcomes.iter().filter(|(outcome, share)| {
            matches!(outcome, Outcome::Missed | Outcome::Undecided) && share.count > 0
        });
        let off: Vec<String> = off
            .map(|(outcome, share)| {
                format!("{} {} of the error box", outcome.word(), tenths_between(share.share, share.ci95))
            })
            .collect();
        if !off.is_empty() {
            document.row("without rest", off.join(", "));
        }
        for (number, rest) in (1..).zip(self.rests.iter().take(SHOWN)) {
            document.section(None);
            self.describe(&mut document, design, number, rest);
        }
        if self.rests.is_empty() {
            document.section(None).paragraph("No pose comes to rest.");
        }
        if self.rests.len() > SHOWN {
            let poses: usize = self.rests[SHOWN..].iter().map(|rest| rest.of_box.count).sum();
            let (more, share) = (self.rests.len() - SHOWN, Share::of(poses, self.motions).share);
            document.section(None).paragraph(format!(
                "and {} more rests, {} of the error box together",
                grouped(more),
                tenths(share)
            ));
        }
        if !self.rests.is_empty() {
            document.section(None).paragraph(FACES);
        }
        document.table(self.table());
        document
    }
}

impl Rests {
    fn describe(&self, document: &mut Document, design: &Design, number: usize, rest: &RestPlace) {
        let places = RestDescriptions::of(design, 0.0);
        let images = match rest.places {
            0 | 1 => String::new(),
            n => format!(", at {n} symmetric places"),
        };
        let docked = if rest.is_docked() { ", docked" } else { ", jammed" };
        let share = tenths_between(rest.of_box.share, rest.of_box.ci95);
        document
            .row(format!("rest {number}"), format!("reached from {share} of the error box{docked}{images}"));
        places.pose(document, &rest.pose, rest.above_mated_d, &rest.extent);
        if let Some(examined) = &rest.examined {
            RestDescriptions::order(document, examined);
            places.held(document, examined);
            document.row("  escape height", self.escape(design, rest));
        }
        let wanted = [self.settings.certified && rest.examined.is_some(), self.settings.resolution.is_some()];
        places.depths(document, wanted, rest.depth_at_least_d, rest.depth_on_grid_d);
        places.contacts(document, &rest.contacts);
    }

    /// The escape height and the end of the escape path, in words.
    fn escape(&self, design: &Design, rest: &RestPlace) -> String {
        let Some(depth) = rest.depth_at_most_d else { return "no escape path was found".to_owned() };
        RestDescriptions::of(design, 0.0).escape(depth, &self.leads_to(rest))
    }

    /// The same for pictures: `escape height at most 1.2 mm; then it slides off`.
    pub fn escape_path(&self, design: &Design, rest: &RestPlace) -> String {
        let Some(depth) = rest.depth_at_most_d else { return "no escape path was found".to_owned() };
        format!("{}; then it {}", escape_height(design, depth), self.leads_to(rest))
    }

    fn leads_to(&self, rest: &RestPlace) -> String {
        let way = rest.examined.and_then(|examined| examined.escape_path);
        match (way.map(|way| way.to), rest.leads_to) {
            (Some(Outcome::Missed), _) => "slides off".to_owned(),
            (_, Some(k)) if self.rests.get(k).is_some_and(|to| std::ptr::eq(to, rest)) => {
                "settles in a symmetric copy of this rest".to_owned()
            }
            (_, Some(k)) => format!("settles in rest {}", k + 1),
            _ => "settles in another rest".to_owned(),
        }
    }

    /// Rests for programs; D and radians.
    fn table(&self) -> Table {
        let mut table = Table::data(
            "rest count share share_lo share_hi docked x y roll pitch yaw height above_mated order slope_lo slope_hi free curvature \
             stability holds_from slips_until wedges_from depth_at_most depth_at_least depth_on_grid leads_to touching",
        );
        for (number, rest) in (1usize..).zip(&self.rests) {
            let held = rest.examined.and_then(|examined| examined.immobility);
            let sticks = rest.examined.and_then(|examined| examined.sticks);
            let mut row: Vec<Cell> = vec![number.into(), rest.of_box.count.into()];
            row.extend([rest.of_box.share, rest.of_box.ci95[0], rest.of_box.ci95[1]].map(Cell::from));
            row.push(rest.docked.into());
            row.extend(rest.pose.to_array().map(Cell::from));
            row.extend([rest.height_d, rest.above_mated_d].map(Cell::from));
            row.push(held.map(|held| held.order.name()).into());
            row.extend([0, 1].map(|k| Cell::from(held.map(|held| held.slope[k]))));
            row.push(held.map(|held| held.free).into());
            row.push(held.and_then(|held| held.curvature).into());
            row.push(rest.examined.map(|examined| examined.stability.name()).into());
            row.push(sticks.and_then(|sticks| sticks.holds_from).into());
            row.push(sticks.and_then(|sticks| sticks.slips_until).into());
            row.push(sticks.and_then(|sticks| sticks.wedges_from).into());
            row.extend([rest.depth_at_most_d, rest.depth_at_least_d, rest.depth_on_grid_d].map(Cell::from));
            row.push(rest.leads_to.map(|to| to + 1).into());
            row.push(contacts_in_words(&rest.contacts).join("; ").into());
            table.push(row);
        }
        table
    }
}
