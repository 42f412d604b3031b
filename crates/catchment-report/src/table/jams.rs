//! Where motions rest that do not dock, in short: what the report of jams alone tells at length.

use crate::JamsFound;
use crate::resting::{Told, said, words};
use crate::text::{grouped, row, tenths};
use catchment_core::design::Design;

/// Jams that are told.
const SHOWN: usize = 3;

pub(super) fn lines(text: &mut String, found: &JamsFound, design: &Design) {
    let count = found.jams.len();
    let places = match count {
        0 => "none".to_owned(),
        1 => "one place".to_owned(),
        count => format!("{} places", grouped(count)),
    };
    row(text, "jams", &format!("{places}, of {} random poses followed exactly", grouped(found.motions)));
    let told = Told::of(design);
    for (k, jam) in found.jams.iter().take(SHOWN).enumerate() {
        let touching = words(&jam.contacts).join("; ");
        let shares = [jam.of_box.share, jam.of_failures].map(tenths);
        let [of_box, of_failures] = shares;
        let place = told.place(&jam.pose);
        let what = format!("{of_box} of the box, {of_failures} of failures, at {place}: {touching}");
        said(text, &format!("jam {}", k + 1), &what);
    }
    if count > SHOWN {
        let poses: usize = found.jams[SHOWN..].iter().map(|jam| jam.of_box.count).sum();
        let share = tenths(poses as f64 / found.motions as f64);
        row(text, "", &format!("and {} more, {share} of the box together", grouped(count - SHOWN)));
    }
}
