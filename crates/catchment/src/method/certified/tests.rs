//! Bounds against exact poses, labels against exact motions.

use super::*;
use crate::problem::Problem;

fn problem(name: &str) -> Problem {
    Problem::open(format!("{}/../../designs/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

#[test]
fn trial() {
    let name = std::env::var("DESIGN").unwrap_or("v-face".into());
    let boxes = std::env::var("BOXES").ok().and_then(|b| b.parse().ok()).unwrap_or(50_000);
    let problem = problem(&name);
    let start = std::time::Instant::now();
    let found = certify(problem.pair(), &Settings { boxes, ..Settings::default() }, &Exec::new()).unwrap();
    println!("{name} {:?} {:?}", found.certificate, start.elapsed());
}
