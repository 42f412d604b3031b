//! Text form of a window.

use super::{ToleranceWindow, WindowAxis, WindowCertificate, WindowDetails};
use crate::acceptance::Outcome;
use crate::design::Design;
use crate::document::{Cell, Column, DesignUnits, Document, Subject, Table, exact_motions, grouped};
use crate::pose::DofSet;
use glam::DVec3;

/// Contacts of the worst pose that are shown.
const MOST_TOUCHES: usize = 4;
/// Contacts within this are at one place, in D: less than tables show.
const ONE_PLACE: f64 = 1e-3;
/// An error that may grow by less than this share while the others stay in the window limits it.
const LIMITING: f64 = 0.01;

impl Subject for ToleranceWindow {
    const KIND: &'static str = "window";

    fn setup(&self, _: &Design, document: &mut Document) {
        document.row(
            "method",
            exact_motions(&format!("{} poses", grouped(self.motions)), self.settings.friction),
        );
    }

    fn document(&self, design: &Design) -> Document {
        let mut document = Document::default();
        self.describe(&mut document, design);
        document.section(None);
        self.describe_worst(&mut document, design);
        document
    }
}

impl WindowDetails {
    /// The window and its certificate, without the worst pose.
    pub fn describe(&self, document: &mut Document, design: &Design) {
        document.table(self.table(design));
        document.paragraph(
            "tolerance window: all errors at once; the error box shrunk in proportion until all poses sampled in it dock. single-axis limit: this error, all others zero. limit, \
             others in window: the largest value of this error that docks whatever the others are inside the window.",
        );
        if self.sides.iter().any(|side| side.alone_reaches_border || side.beside_reaches_border) {
            document.paragraph("* the error box ends here: the limit may be larger");
        }
        document.section(None);
        let limiting = self.limiting();
        if !limiting.is_empty() {
            document.row(
                "limited by",
                format!(
                    "{limiting}: with any of these 1 % larger and the others inside the window, poses fail"
                ),
            );
        }
        let WindowCertificate { motions, failing_at_most, redrawn } = self.certificate;
        if motions == 0 {
            document.row("certificate", "none: no random poses were sampled");
            return;
        }
        let one_in = grouped((1.0 / failing_at_most).floor() as usize);
        document.row(
            "certificate",
            format!(
                "0 failures in {} poses sampled in the window: failure rate below 1 in {one_in} (95 % confidence)",
                grouped(motions)
            ),
        );
        if redrawn > 0 {
            document.more(format!("{redrawn} larger windows failed this test before"));
        }
    }

    /// The errors that may hardly grow while the others stay in the window.
    pub(super) fn limiting(&self) -> DofSet {
        let is_limit = |side: &&WindowAxis| {
            Some(side.axis) == self.tightest
                || (!side.beside_reaches_border && side.beside <= (1.0 + LIMITING) * side.half_width)
        };
        self.sides.iter().filter(is_limit).map(|side| side.axis).collect()
    }

    fn table(&self, design: &Design) -> Table {
        let units = DesignUnits::of(design);
        let mut table = Table::new([
            Column::new("error").key("axis").left(),
            Column::new("tolerance window").key("half_width"),
            Column::data("given"),
            Column::new("single-axis limit").key("alone"),
            Column::data("alone_reaches_border"),
            Column::new("limit, others in window").key("beside"),
            Column::data("beside_reaches_border"),
        ]);
        for side in &self.sides {
            let reach = |to: f64, is_border: bool| {
                let star = if is_border { "*" } else { "" };
                Cell::shown(format!("{}{star}", units.half_width(side.axis, to)), to)
            };
            let given = if side.given { " (given)" } else { "" };
            table.push([
                Cell::shown(format!("{}{given}", side.axis), side.axis.name()),
                reach(side.half_width, false),
                side.given.into(),
                reach(side.alone, side.alone_reaches_border),
                side.alone_reaches_border.into(),
                reach(side.beside, side.beside_reaches_border),
                side.beside_reaches_border.into(),
            ]);
        }
        table
    }

    fn describe_worst(&self, document: &mut Document, design: &Design) {
        let units = DesignUnits::of(design);
        let Some(worst) = &self.worst else {
            document.row("nearest failure", "not found: the window ends at the error box");
            return;
        };
        document.row("nearest failure", format!("{}: {}", units.pose(&worst.error), worst.outcome.word()));
        document.more("the failure nearest to the window, just outside it");
        if worst.outcome == Outcome::Jammed && worst.end != worst.error {
            document.more(format!("rests at {}", units.pose(&worst.end)));
        }
        // Corners, edges and facets that meet at a point are listed as a single place.
        let mut places: Vec<DVec3> = Vec::new();
        for touch in &worst.touches {
            if places.iter().all(|place| place.distance(touch.point) > ONE_PLACE) {
                places.push(touch.point);
            }
        }
        for place in places.iter().take(MOST_TOUCHES) {
            let place = units.point(place.to_array());
            document.more(format!("contact at {place} from the face centre of the fixed half"));
        }
        match places.len().saturating_sub(MOST_TOUCHES) {
            0 => {}
            1 => {
                document.more("and at 1 place more");
            }
            more => {
                document.more(format!("and at {more} places more"));
            }
        }
    }
}
