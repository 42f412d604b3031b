use super::*;
use crate::schema::testing::{blob, design};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use catchment_core::connector::Half;
use catchment_core::pose::Dof;
use catchment_core::problem::Problem;

fn page(name: &str) -> String {
    let mut design = design([Dof::X, Dof::Y, Dof::Yaw].into_iter().collect());
    name.clone_into(&mut design.name);
    let acceptance = blob(&design, 9);
    let timing = Some(crate::schema::Timing { total_s: 1.25, threads: 2 });
    let report = Report::new(&design, &acceptance, Value::Null, timing, &Exec::new()).unwrap();
    let problem = Problem::of(design).unwrap();
    let halves = Some(problem.connector());
    let notes = Vec::new();
    let page = Page {
        report: &report,
        acceptance: &acceptance,
        planes: &[],
        halves,
        jams: None,
        window: None,
        notes,
        is_served: false,
    };
    page.html(&Exec::new()).unwrap()
}

fn between<'a>(page: &'a str, id: &str) -> &'a str {
    let start = page.split_once(&format!("id=\"{id}\">")).unwrap().1;
    start.split_once("</script>").unwrap().0
}

#[test]
fn a_page_holds_the_report_and_the_halves() {
    let page = page("a page");
    let data: Value = serde_json::from_str(between(&page, "data")).unwrap();
    assert_eq!(data["report"]["kind"], "run");
    assert_eq!(data["report"]["timing"], Value::Null);
    assert_eq!((&data["chunks"], &data["chunk_cells"]), (&json!(1), &json!(729)));
    let read: Report = serde_json::from_value(data["report"].clone()).unwrap();
    let problem = Problem::of(read.design.clone()).unwrap();
    let packed = STANDARD.decode(between(&page, "moving")).unwrap();
    let mut bytes = Vec::new();
    std::io::Read::read_to_end(&mut flate2::read::ZlibDecoder::new(&packed[..]), &mut bytes).unwrap();
    assert_eq!(Half::from_bytes(&bytes).unwrap(), problem.connector().moving);
}

#[test]
fn no_name_ends_the_script_that_it_stands_in() {
    let hostile = "</script><script>alert(1)</script><!-- & \u{1b}[2J";
    let page = page(hostile);
    let data: Value = serde_json::from_str(between(&page, "data")).unwrap();
    assert_eq!(data["report"]["design"]["name"], hostile);
    // JSON escapes control characters, and the title replaces them.
    for raw in ["<script>alert", "<!-- & ", "\u{1b}"] {
        assert!(!page.contains(raw), "{raw:?}");
    }
    assert!(page.contains("&lt;/script&gt;"));
    // As many scripts end as begin.
    assert_eq!(page.matches("<script").count(), page.matches("</script>").count());
}

/// The hash in the policy is that of the text which the browser finds: from tag to tag.
#[test]
fn the_policy_names_the_scripts_and_styles_that_stand_in_the_page() {
    let page = page("a page");
    let script = page.rsplit_once("<script>").unwrap().1.split_once("</script>").unwrap().0;
    let style = page.split_once("<style>").unwrap().1.split_once("</style>").unwrap().0;
    let policy = policy(&[script], &[style], false).replace('\'', "&#39;");
    assert!(page.contains(&format!("http-equiv=\"Content-Security-Policy\" content=\"{policy}\"")));
    assert!(!page.contains("unsafe-inline"));
    // No style and no handler stands in an attribute, which a policy of hashes forbids.
    let head = page.split_once("id=\"data\"").unwrap().0;
    assert!(!head.contains(" style=") && !head.contains(" on"));
}

#[test]
fn the_same_result_gives_the_same_bytes_and_names_no_other_place() {
    let a = page("a");
    assert_eq!(a, page("a"));
    for attribute in ["src=", "href="] {
        let head = a.split_once("<body>").unwrap().0;
        assert!(!head.contains(attribute), "{attribute}");
    }
}

#[test]
fn no_part_of_the_viewer_ends_the_script_that_it_stands_in() {
    for part in [VIEWER, WORKER, PAINTER, STYLE] {
        let part = part.to_lowercase();
        for end in ["</script", "<script", "<!--", "</style"] {
            assert!(!part.contains(end), "{end}");
        }
    }
}
