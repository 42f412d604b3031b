//! Text form of jams.

use super::descriptions::{FACES, RestDescriptions, contact_in_words};
use super::{Examined, Jam, Jams, NamedFeature};
use crate::acceptance::Outcome;
use crate::design::Design;
use crate::diagnostic::{Diagnostic, Warning};
use crate::document::{
    Cell, Column, ColumnFormat, Document, Share, Subject, Table, exact_motions, grouped, tenths,
    tenths_between,
};
use crate::method::descent::HARDLY;

/// Jams and pairs of features that are shown.
const SHOWN: usize = 6;

impl Subject for Jams {
    const KIND: &'static str = "jams";

    fn warnings(&self) -> Vec<Diagnostic> {
        let undecided = |of: &std::collections::BTreeMap<Outcome, Share>| {
            of.get(&Outcome::Undecided).map_or(0, |share| share.count)
        };
        let cells = undecided(&self.outcomes) + self.expected.as_ref().map_or(0, undecided);
        let open = (cells > 0).then(|| Warning::Undecided { cells }.into());
        open.into_iter()
            .chain(self.barely_stuck().map(|text| Diagnostic::warning("barely-stuck", text)))
            .collect()
    }

    fn setup(&self, _: &Design, document: &mut Document) {
        let poses = format!("{} random poses", grouped(self.motions));
        document.row("method", exact_motions(&poses, self.settings.friction));
    }

    fn document(&self, design: &Design) -> Document {
        let mut document = Document::default();
        document.table(self.outcome_table());
        document.paragraph(format!(
            "jammed: at rest elsewhere; missed: no contact, or slid off; undecided: still moving after the largest number of simulated steps. A jam is a \
             group of neighbouring rests on the same features; symmetric copies are mapped onto one, also in its range. {FACES}"
        ));
        let places = RestDescriptions::of(design, self.settings.friction);
        for (number, jam) in (1..).zip(self.jams.iter().take(SHOWN)) {
            document.section(None);
            self.describe(&mut document, places, number, jam);
        }
        if self.jams.len() > SHOWN {
            let poses: usize = self.jams[SHOWN..].iter().map(|jam| jam.of_box.count).sum();
            let (more, share) = (self.jams.len() - SHOWN, Share::of(poses, self.motions).share);
            document.section(None).paragraph(format!(
                "and {} more jams, {} of the error box together",
                grouped(more),
                tenths(share)
            ));
        }
        self.describe_pairs(&mut document);
        document.section(None).table(self.jam_table());
        document
    }
}

impl Jams {
    fn outcome_table(&self) -> Table {
        let expected = self
            .expected
            .as_ref()
            .map(|_| Column::new("share of the expected errors").format(ColumnFormat::Tenths));
        let columns = [
            Column::new("outcome").left(),
            Column::new("share of the error box (95 % CI)").format(ColumnFormat::Tenths),
        ];
        let mut table = Table::new(columns.into_iter().chain(expected));
        for (outcome, share) in &self.outcomes {
            let expected = self.expected.as_ref().map(|of| Cell::from(of.get(outcome).copied()));
            table.push([outcome.word().into(), (*share).into()].into_iter().chain(expected));
        }
        table
    }

    fn describe(&self, document: &mut Document, places: RestDescriptions<'_>, number: usize, jam: &Jam) {
        let images = match jam.places {
            0 | 1 => String::new(),
            n => format!(", at {n} symmetric places"),
        };
        let expected = jam
            .expected
            .map_or_else(String::new, |share| format!(", {} of the expected errors", tenths(share.share)));
        document.row(
            format!("jam {number}"),
            format!(
                "{} of the error box, {} of jams, {} of failures{expected}{images}",
                tenths_between(jam.of_box.share, jam.of_box.ci95),
                tenths(jam.of_jams),
                tenths(jam.of_failures)
            ),
        );
        places.pose(document, &jam.pose, jam.above_mated_d, &jam.extent);
        if let Some(symmetry) = jam.docked_with_symmetry {
            let turned = "the mated pose, turned by a symmetry of the halves:";
            document.row(
                "  turned",
                format!("{turned} write symmetry = {symmetry} in the design to count it as docked"),
            );
        }
        if let Some(examined) = &jam.examined {
            RestDescriptions::order(document, examined);
            // Friction stops a half just before all contacts of the mated pose close: how it would be held there means nothing.
            if self.settings.friction == 0.0 || jam.docked_with_symmetry.is_none() {
                places.held(document, examined);
            }
            document.row("  escape height", escape(places, examined));
        }
        let wanted = [self.settings.certified && jam.examined.is_some(), self.settings.resolution.is_some()];
        places.depths(document, wanted, jam.depth_at_least_d, jam.depth_on_grid_d);
        places.contacts(document, &jam.contacts);
    }

    fn describe_pairs(&self, document: &mut Document) {
        if self.features.is_empty() {
            return;
        }
        let mut table = Table::new([
            Column::new("of jams").format(ColumnFormat::Tenths),
            Column::new("of failures").format(ColumnFormat::Tenths),
            Column::new("contact that jams").left(),
        ]);
        for pair in self.features.iter().take(SHOWN) {
            let words = contact_in_words(&pair.fixed, &pair.moving);
            table.push([pair.of_jams.into(), pair.of_failures.into(), words.into()]);
        }
        document.section(None).table(table);
        match self.features.len().saturating_sub(SHOWN) {
            0 => {}
            1 => {
                document.paragraph("and 1 pair more");
            }
            more => {
                document.paragraph(format!("and {} pairs more", grouped(more)));
            }
        }
    }

    /// Jams for programs, a row for every contact; D and radians.
    fn jam_table(&self) -> Table {
        let mut table = Table::data(
            "jam count share share_lo share_hi of_jams of_failures expected x y roll pitch yaw height above_mated order \
             slope_lo slope_hi curvature stability rise_at_most holds_from slips_until wedges_from symmetry climb_at_most depth_at_least \
             depth_on_grid leads_to fixed_kind fixed_name fixed_part fixed_x fixed_y fixed_z moving_kind moving_name moving_part moving_x \
             moving_y moving_z",
        );
        for (number, jam) in (1usize..).zip(&self.jams) {
            let examined = jam.examined.as_ref();
            let held = examined.and_then(|examined| examined.immobility);
            let sticks = examined.and_then(|examined| examined.sticks);
            let way = examined.and_then(|examined| examined.escape_path);
            let mut row: Vec<Cell> = vec![number.into(), jam.of_box.count.into()];
            row.extend([jam.of_box.share, jam.of_box.ci95[0], jam.of_box.ci95[1]].map(Cell::from));
            row.extend([jam.of_jams, jam.of_failures].map(Cell::from));
            row.push(jam.expected.map(|share| share.share).into());
            row.extend(jam.pose.to_array().map(Cell::from));
            row.extend([jam.height_d, jam.above_mated_d].map(Cell::from));
            row.push(held.map(|held| held.order.name()).into());
            row.extend([0, 1].map(|k| Cell::from(held.map(|held| held.slope[k]))));
            row.push(held.and_then(|held| held.curvature).into());
            row.push(examined.map(|examined| examined.stability.name()).into());
            row.push(examined.and_then(|examined| examined.rise_at_most_d).into());
            row.push(sticks.and_then(|sticks| sticks.holds_from).into());
            row.push(sticks.and_then(|sticks| sticks.slips_until).into());
            row.push(sticks.and_then(|sticks| sticks.wedges_from).into());
            row.push(jam.docked_with_symmetry.map(|order| order as usize).into());
            row.push(way.map(|way| way.climb).into());
            row.extend([jam.depth_at_least_d, jam.depth_on_grid_d].map(Cell::from));
            row.push(way.map(|way| way.to.name()).into());
            let contacts = jam.contacts.iter().map(|contact| {
                feature(&contact.fixed).into_iter().chain(feature(&contact.moving)).collect::<Vec<_>>()
            });
            let none = jam.contacts.is_empty().then(Vec::new);
            for contact in contacts.chain(none) {
                let mut row: Vec<Cell> = row.iter().cloned().chain(contact).collect();
                row.resize(table.columns.len(), Cell::Empty);
                table.push(row);
            }
        }
        table
    }

    /// Which jams are held by hardly more friction than they slip at, as a sentence: there rigid halves and those of engines part.
    fn barely_stuck(&self) -> Option<String> {
        let friction = self.settings.friction;
        let is_hardly_held = |jam: &Jam| {
            let examined = jam.examined.as_ref().filter(|examined| examined.is_held_by_friction(friction));
            let slips_until = examined.and_then(|examined| examined.sticks?.slips_until);
            slips_until.is_some_and(|until| friction < HARDLY * until)
        };
        let numbered = (1..).zip(&self.jams).filter(|(_, jam)| is_hardly_held(jam));
        let jams: Vec<String> = numbered.map(|(number, _): (usize, _)| number.to_string()).collect();
        let which = match jams.as_slice() {
            [] => return None,
            [one] => format!("jam {one} is"),
            [most @ .., last] => format!("jams {} and {last} are", most.join(", ")),
        };
        Some(format!(
            "{which} held by little more friction than would let it slip: rigid halves stick there; compliant halves, as in physics engines, may slip"
        ))
    }
}

fn escape(places: RestDescriptions<'_>, examined: &Examined) -> String {
    let Some(way) = &examined.escape_path else { return "no escape path was found".to_owned() };
    let to = match way.to {
        Outcome::Aligned => "docks",
        Outcome::Missed => "slides off",
        Outcome::Jammed | Outcome::Undecided => "reaches a lower rest",
    };
    places.escape(way.climb, to)
}

fn feature(feature: &NamedFeature) -> Vec<Cell> {
    let named = [feature.kind.name().into(), feature.name.clone().into(), feature.part.into()];
    named.into_iter().chain(feature.drawn_d.map(Cell::from)).collect()
}
