//! Jams of pairs whose jams are known.

use super::*;
use crate::design::read;
use std::path::Path;

fn problem(text: &str) -> Problem {
    Problem::of(read(text, Path::new("")).unwrap().design).unwrap()
}

fn v_face() -> Problem {
    problem("[connector]\nfamily = \"v-face\"\naspect_ratio = 1.0\n[alignment]\nrotation_length = 1.0\n")
}

fn found(problem: &Problem, motions: usize) -> Jams {
    run(problem, &Settings { motions: Some(motions), ..Settings::default() }, &Exec::new()).unwrap()
}

#[test]
fn a_tip_on_its_side_is_one_jam_at_two_places() {
    let found = found(&v_face(), 2000);
    assert_eq!(found.counts.iter().sum::<usize>(), 2000);
    assert_eq!(found.jammed(), found.counts[1], "every pose that jams is in one jam");
    eprintln!("{found:#?}");
    assert_eq!(found.jams[0].places, 2);
}
