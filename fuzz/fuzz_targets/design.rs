//! Any bytes: a design file gives a design that obeys its own rules, or problems whose places lie in the text.
//!
//! `cargo +nightly fuzz run design -- -rss_limit_mb=1024 -dict=fuzz/design.dict`

#![no_main]

use catchment::design::{Problems, keys, read};
use libfuzzer_sys::fuzz_target;
use std::path::Path;

fuzz_target!(|text: &str| {
    match read(text, Path::new("no-such-folder")) {
        Ok(file) => {
            let design = file.design;
            assert!(design.width > 0.0 && design.width.is_finite());
            assert!(!design.alignment.free.is_empty());
            for (half_range, key) in design.alignment.half_ranges.iter().zip(&keys::ERROR_KEYS) {
                let (keys::Kind::Length(range) | keys::Kind::Angle(range)) = key.kind else {
                    panic!("an error is a length or an angle")
                };
                assert!(range.contains(*half_range));
            }
            let free = design.alignment.free;
            let again = design.clone().with_free(free).expect("what the file allows, an override allows");
            assert_eq!(again, design);
        }
        Err(problems) => {
            assert!(!problems.list.is_empty() && problems.list.len() <= Problems::MOST);
            for problem in &problems.list {
                assert!(problem.line >= 1 && problem.column >= 1);
                assert!(text.get(problem.span.clone()).is_some(), "{problem:?} is not a piece of the text");
                assert!(!problem.complaint.to_string().is_empty());
                assert!(problem.complaint.help().is_none_or(|help| !help.is_empty()));
            }
        }
    }
});
