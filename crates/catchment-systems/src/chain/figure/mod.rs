//! Pictures of a chain.
//!
//! ```text
//!   folding   the chain after every step, its joint angles over time, the errors at its docking
//!   errors    the errors of a straight chain's last face, and which of them dock
//!   lengths   error and probability over the number of modules
//! ```

mod cloud;
mod lengths;
mod steps;

use super::report::ChainReport;
use super::study::Study;
use catchment::report::figure::Picture;
use catchment::report::figure::draw::layout::Layout;

/// The picture of a study: its table if present, else its folding, else the errors of its last face.
pub fn draw(report: &ChainReport, study: &Study) -> Picture {
    if !report.lengths.is_empty() {
        return lengths::draw(report);
    }
    if report.folding.is_some() {
        return steps::draw(report, study);
    }
    let colours = if report.connector.is_some() { ": blue docks, orange does not" } else { "" };
    let story = format!("straight chain of {} modules{colours}", report.modules);
    let panel = cloud::panel([740.0, 330.0], report, &report.straight);
    let (mut svg, frames) = headed(report, story).row([panel]).open();
    for rect in frames {
        cloud::draw(&mut svg, rect, report, &report.straight);
    }
    Picture::of(svg)
}

/// The page of a chain: its name over a line about the study.
fn headed(report: &ChainReport, story: String) -> Layout {
    Layout::titled(&report.name).story(story)
}

/// `−95.7°`, to a tenth of a degree.
fn degrees(radians: f64) -> String {
    let text = format!("{:.1}°", radians.to_degrees());
    let text = text.replace("-0.0°", "0.0°");
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::super::file::ChainFile;
    use super::super::report::report;
    use super::super::study::{ChainSettings, run};
    use super::*;
    use catchment::design::SourceText;
    use catchment::exec::Exec;

    #[test]
    fn every_kind_of_study_has_its_picture() {
        let picture = |text: &str, modules: Vec<usize>| {
            let file = ChainFile::read(SourceText::new("c.toml", text)).unwrap();
            let study =
                run(&file, &ChainSettings { chains: 60, modules, ..ChainSettings::default() }, &Exec::new())
                    .unwrap();
            draw(&report(&study, &[], None), &study)
        };
        let folded =
            picture("name = 'a<b'\n[chain]\njoint_sigma = '1 deg'\n[sequence]\nname = 'P'", Vec::new());
        assert!(folded.svg().contains("a&lt;b") && folded.svg().contains("t = 3 s"));
        assert!(folded.svg().contains("joint angles") && !folded.svg().contains("NaN"));
        let straight = picture("[chain]\njoint_sigma = '1 deg'", Vec::new());
        assert!(straight.svg().contains("pitch [deg]") && !straight.svg().contains("NaN"));
        let exact = picture("name = 'no error at all'", Vec::new());
        assert!(!exact.svg().contains("NaN") && !exact.svg().contains("inf"));
        let table = picture("[chain]\njoint_sigma = '1 deg'", vec![2, 3, 4]);
        assert!(table.svg().contains("modules") && !table.svg().contains("NaN"));
        assert!(folded.png(1.0).unwrap().starts_with(b"\x89PNG"));
    }
}
