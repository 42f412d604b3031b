//! Text and table form of the comparison of all methods.

use super::{Agreement, PairAgreement};
use catchment_core::design::Design;
use catchment_core::document::{Cell, Column, ColumnFormat, Document, Subject, Table, grouped, significant};

impl Subject for Agreement {
    const KIND: &'static str = "methods";

    fn setup(&self, _: &Design, document: &mut Document) {
        let cells: Vec<String> = self.cells.iter().map(ToString::to_string).collect();
        let total = grouped(self.cells.iter().product());
        document.row("methods", format!("all that apply, on {} = {total} cells", cells.join(" × ")));
    }

    fn document(&self, _: &Design) -> Document {
        let mut document = Document::default();
        document.table(self.table());
        if self.agreement.len() > 1 {
            document
                .section("agreement: share of the cells that both accept or both reject, in %")
                .table(self.matrix(|pair| ColumnFormat::Fixed(2).of(100.0 * pair.agreement)));
            document
                .section("Jaccard: accepted by both, of all that one accepts")
                .table(self.matrix(|pair| ColumnFormat::Fixed(4).of(pair.jaccard)));
        }
        let left_out = self.methods.iter().filter_map(|decided| Some((decided, decided.left_out.as_ref()?)));
        for (k, (decided, reason)) in left_out.enumerate() {
            if k == 0 {
                document.section(None);
            }
            document.paragraph(format!("without {}: {reason}", decided.method));
        }
        document
    }
}

impl Agreement {
    fn names(&self) -> impl Iterator<Item = &'static str> {
        self.results().map(|(name, _)| name)
    }

    /// A row per method that came to a result. For programs its numbers have no exponents.
    fn table(&self) -> Table {
        let mut columns = vec![
            Column::new("method").left().key("method"),
            Column::new(format!("Sum [{}]", self.unit)).key("sum_grid"),
            Column::data("sum"),
            Column::new("with random poses").left(),
            Column::data("sum_lo"),
            Column::data("sum_hi"),
            Column::new("ONAA edge").key("onaa_edge"),
            Column::new("seconds").key("seconds"),
        ];
        for figure in ["agreement", "jaccard"] {
            columns.extend(self.names().map(|name| Column::data(format!("{figure}_{name}"))));
        }
        let mut table = Table::new(columns);
        let plain = |value: f64| Cell::from(value.to_string());
        for (k, ((name, result), pairs)) in self.results().zip(&self.agreement).enumerate() {
            let interval =
                result.sum_ci95.map(|[lo, hi]| format!("{} … {}", significant(lo), significant(hi)));
            let edge = result.onaa_edge.map_or_else(
                || Cell::shown("–", Cell::Empty),
                |edge| Cell::shown(ColumnFormat::Fixed(4).of(edge), plain(edge)),
            );
            let first = [
                Cell::shown(numbered(k, name), name),
                Cell::shown(significant(result.sum_grid), plain(result.sum_grid)),
                plain(result.sum),
                interval.into(),
                result.sum_ci95.map(|[lo, _]| plain(lo)).unwrap_or_default(),
                result.sum_ci95.map(|[_, hi]| plain(hi)).unwrap_or_default(),
                edge,
                Cell::shown(ColumnFormat::Fixed(2).of(result.seconds), plain(result.seconds)),
            ];
            let agreements = pairs.iter().map(|pair| plain(pair.agreement));
            let overlaps = pairs.iter().map(|pair| plain(pair.jaccard));
            table.push(first.into_iter().chain(agreements).chain(overlaps));
        }
        table
    }

    /// A number of each two methods: a row for every method but the first, a column for every method but the last.
    fn matrix(&self, number: fn(&PairAgreement) -> String) -> Table {
        let last = self.agreement.len().saturating_sub(1);
        let columns = (1..=last).map(|k| Column::new(k.to_string()));
        let mut table = Table::new(std::iter::once(Column::new("").left()).chain(columns));
        for (k, (name, pairs)) in self.names().zip(&self.agreement).enumerate().skip(1) {
            let number = |j: usize| if j < k { number(&pairs[j]).into() } else { Cell::Empty };
            table.push(std::iter::once(numbered(k, name).into()).chain((0..last).map(number)));
        }
        table
    }
}

fn numbered(k: usize, name: &str) -> String {
    format!("{} {name}", k + 1)
}
