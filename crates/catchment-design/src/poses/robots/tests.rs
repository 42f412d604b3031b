use super::*;
use crate::design::{Design, SourceText};
use std::path::Path;

fn design() -> Design {
    let text = "[connector]\nfamily = \"pyramid\"\nwidth = 50\nunit = \"mm\"\n[alignment]\n\
                free = [\"x\", \"y\", \"yaw\"]\n";
    crate::design::read(text, Path::new("")).unwrap().design
}

fn read(text: &str) -> Result<Vec<Robot>, Diagnostics> {
    let table = |path: &str| match path {
        "good.csv" => Ok(SourceText::new(path, "x_mm,yaw_deg\n1,0\n-1,2\n3,1\n")),
        "bad.csv" => Ok(SourceText::new(path, "x_mm,yaw_deg\n1,0\n-1\n?,1\n")),
        "short.csv" => Ok(SourceText::new(path, "x_mm\n1\n")),
        _ => Err(format!("cannot read {path}")),
    };
    read_robots(&SourceText::new("r.toml", text), &design(), &mut { table })
}

/// The places and messages of the errors.
fn wrong(text: &str) -> Vec<(String, String)> {
    let refused = read(text).unwrap_err();
    assert_eq!(refused.path(), Some(Path::new("r.toml")));
    let place = |span: Option<std::ops::Range<usize>>| text[span.unwrap_or(0..0)].to_owned();
    refused.list.into_iter().map(|diagnostic| (place(diagnostic.span), diagnostic.message)).collect()
}

fn one(body: &str) -> Vec<(String, String)> {
    wrong(&format!("[[robot]]\n{body}\n"))
}

#[test]
fn every_kind_is_read_in_its_units() {
    let text = "[[robot]]\nname = \"A\"\nsigma = { x = \"1 mm\", yaw = \"2 deg\" }\nmean = { y = \"-5 mm\" }\n\
        [[robot]]\nname = \"B\"\nsigma = { x = 0.02, yaw = \"2 deg\" }\n\
        correlation = { axes = [\"yaw\", \"x\"], matrix = [[1, 0.6], [0.6, 1]] }\n\
        [[robot]]\ncovariance = { axes = [\"x\", \"yaw\"], units = [\"mm\", \"deg\"], matrix = [[1, 1.2], [1.2, 4]] }\n\
        [[robot]]\nuniform = { x = \"2 mm\" }\n[[robot]]\nmeasured = \"good.csv\"\n";
    let robots = read(text).unwrap();
    let names: Vec<&str> = robots.iter().map(|robot| robot.name.as_str()).collect();
    assert_eq!(names, ["A", "B", "robot 3", "robot 4", "robot 5"]);
    let Spread::Normal { mean, sigma, correlation } = &robots[0].errors else { panic!() };
    assert!((mean.y + 0.1).abs() < 1e-15 && (sigma.x - 0.02).abs() < 1e-15 && *correlation == IDENTITY);
    // Correlations and an equivalent covariance.
    let Spread::Normal { sigma: b, correlation: by_b, .. } = &robots[1].errors else { panic!() };
    let Spread::Normal { sigma: c, correlation: by_c, .. } = &robots[2].errors else { panic!() };
    for (p, q) in b.to_array().iter().zip(c.to_array()) {
        assert!((p - q).abs() < 1e-15);
    }
    assert!((by_b[0][4] - 0.6).abs() < 1e-15 && (by_c[0][4] - 0.6).abs() < 1e-12 && by_c[4][0] == by_c[0][4]);
    let Spread::Measured { poses, .. } = &robots[4].errors else { panic!() };
    assert_eq!(poses.len(), 3);
    let moments = robots[4].errors.moments();
    // 1, −1, 3 mm: mean 1, standard deviation 2; 0, 2, 1 degrees: 1 and 1; their covariance (−1 + 0 − 1)/2·… = −1.
    assert!((moments.mean.x - 0.02).abs() < 1e-15 && (moments.sigma.x - 0.04).abs() < 1e-15);
    assert!((moments.sigma.yaw - 1f64.to_radians()).abs() < 1e-15);
    assert!((moments.correlation[0][4] + 0.5).abs() < 1e-12);
    assert_eq!(robots[4].errors.occurring().map(Dof::name).collect::<Vec<_>>(), ["x", "yaw"]);
    let Moments { sigma, .. } = robots[3].errors.moments();
    assert!((sigma.x - 0.04 / 3f64.sqrt()).abs() < 1e-15);
}

#[test]
fn all_problems_come_at_once_in_their_places() {
    let text = "[[robot]]\nname = \"\"\nsigma = { x = \"-1 mm\", ptich = 1, yaw = \"2 mm\", roll = 1 }\n\
        [[robot]]\nsigma = { x = 1 }\nuniform = { x = 1 }\n[[robot]]\nnmae = \"x\"\n[[robot]]\nmeasured = \"no.csv\"\n";
    let result = wrong(text);
    let places: Vec<&str> = result.iter().map(|(place, _)| place.as_str()).collect();
    assert_eq!(places[..5], ["\"\"", "\"-1 mm\"", "ptich", "\"2 mm\"", "1"], "{result:?}");
    let expect = |piece: &str| {
        assert!(result.iter().any(|(_, message)| message.contains(piece)), "{piece}: {result:?}");
    };
    expect("did you mean pitch");
    expect("this design locks it");
    expect("spread in 2 ways: sigma, uniform");
    expect("unknown key `nmae`");
    expect("does not say how its errors spread");
    expect("cannot read no.csv");
}

#[test]
fn invalid_covariances_are_reported_with_details() {
    let with = |matrix: &str| one(&format!("covariance = {{ axes = [\"x\", \"yaw\"], matrix = {matrix} }}"));
    assert_eq!(with("[[1, 0.5], [0.4, 1]]")[0].0, "0.4");
    assert!(with("[[1, 0.5], [0.4, 1]]")[0].1.contains("yaw with x is 0.4, and x with yaw is 0.5"));
    let beyond = with("[[1, 1.5], [1.5, 1]]");
    assert!(beyond[0].1.contains("an eigenvalue is -0.5000, along +0.71 x -0.71 yaw"), "{beyond:?}");
    assert!(with("[[-1, 0], [0, 1]]")[0].1.contains("the variance of x is -1"));
    assert!(with("[[0, 0.1], [0.1, 1]]")[0].1.contains("one of them has no variance"));
    assert!(with("[[1, 0]]")[0].1.contains("1 rows for 2 axes"));
    assert!(with("[[1, 0], [0]]")[0].1.contains("a row has 2 numbers"));
    assert!(with("[[1, \"a\"], [0, 1]]")[0].1.contains("no finite number"));
    assert!(with("[[1, inf], [inf, 1]]")[0].1.contains("no finite number"));
    assert!(with("[[0, 0], [0, 0]]")[0].1.contains("no error occurs"));
    let correlation = |axes: &str, matrix: &str| {
        one(&format!("sigma = {{ x = 1, yaw = 1 }}\ncorrelation = {{ axes = {axes}, matrix = {matrix} }}"))
    };
    assert!(correlation("[\"x\", \"y\"]", "[[1, 0], [0, 1]]")[0].1.contains("y has a correlation and no"));
    assert!(correlation("[\"x\", \"yaw\"]", "[[2, 0], [0, 1]]")[0].1.contains("x with x is 2"));
    assert!(correlation("[\"x\", \"yaw\"]", "[[1, 1.2], [1.2, 1]]")[0].1.contains("is 1.2"));
    assert!(correlation("[\"x\", \"x\"]", "[[1, 0], [0, 1]]")[0].1.contains("named twice"));
}

#[test]
fn fully_correlated_errors_are_errors() {
    let robots = read(
        "[[robot]]\nsigma = { x = 1, yaw = 1 }\ncorrelation = { axes = [\"x\", \"yaw\"], matrix = [[1, 1], [1, 1]] }\n",
    );
    let Spread::Normal { correlation, .. } = &robots.unwrap()[0].errors else { panic!() };
    assert!(covariance::cholesky(correlation).is_ok());
}

#[test]
fn tables_are_refused_in_their_own_places() {
    let refused = read("[[robot]]\nmeasured = \"bad.csv\"\n").unwrap_err();
    assert_eq!(refused.path(), Some(Path::new("bad.csv")));
    assert_eq!(refused.list.len(), 2);
    let refused = read("[[robot]]\nmeasured = \"short.csv\"\n").unwrap_err();
    assert!(refused.to_string().contains("1 row says nothing"), "{refused}");
}

#[test]
fn texts_that_are_no_files_of_robots_are_refused() {
    assert!(wrong("")[0].1.contains("names no robot"));
    assert!(wrong("robot = 3\n")[0].1.contains("no list of tables"));
    assert!(wrong("robot = [1]\n")[0].1.contains("a robot is a table"));
    assert!(!wrong("[[robot]\nsigma = { x = 1 }\n").is_empty());
    let many = "[[robot]]\nsigma = { x = 1 }\n".repeat(MOST_ROBOTS + 1);
    assert!(wrong(&many)[0].1.contains("too many"));
    let twice = "[[robot]]\nname = \"A\"\nsigma = { x = 1 }\n".repeat(2);
    assert!(wrong(&twice)[0].1.contains("a second robot is called `A`"));
}
