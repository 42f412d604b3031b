//! System limits and oversized or recursive input: a message and exit code 2, never an abort.

#![cfg(target_os = "linux")]

use crate::{catchment, designs, home, starter};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Runs the program under a limit; it must end with exit code 2 and print all these pieces of text.
fn is_refused(home: &Path, limit: &str, args: &str, says: &[&str]) {
    let output = limited(home, limit, args);
    let printout = printed(&output);
    assert_eq!(output.status.code(), Some(5), "{args}: {printout}");
    assert!(says.iter().all(|text| printout.contains(text)), "{args}: {printout}");
}

/// Runs the program in a shell that first sets limits, such as `ulimit -v 400000`.
fn limited(folder: &Path, limits: &str, args: &str) -> Output {
    let shell = format!("{limits}; exec \"$0\" {args}");
    starter("bash")
        .args(["-c", &shell, env!("CARGO_BIN_EXE_catchment")])
        .current_dir(folder)
        .stdin(Stdio::null())
        .env("NO_COLOR", "1")
        .output()
        .unwrap()
}

fn printed(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_small_address_space_ends_with_an_answer_or_a_message() {
    let home = home();
    let dir = home.path();
    let design = designs().join("pyramid.toml");
    fs::copy(&design, dir.join("p.toml")).unwrap();
    fs::write(dir.join("q.csv"), "x\n".to_owned() + &"0.01\n".repeat(2000)).unwrap();
    let commands = [
        "check p.toml",
        "run v.toml --resolution 200 --samples 50",
        "run p.toml --free x,y,yaw --resolution 30 --method flood",
        "run p.toml --free x,y --resolution 12 --samples 50 -o out",
        "slices v.toml --resolution 100",
        "outcome p.toml --poses q.csv",
        "trace v.toml --pose x=0.1 -o t.png --force",
    ];
    for kib in [1_500_000, 400_000, 200_000, 100_000] {
        for args in commands {
            let output = limited(dir, &format!("ulimit -v {kib}"), args);
            let printout = printed(&output);
            let refused = output.status.code() == Some(5)
                && !printout.is_empty()
                && !printout.contains("a bug of the program");
            assert!(output.status.success() || refused, "{args} in {kib} KiB: {}: {printout}", output.status);
        }
    }
}

#[test]
fn the_budget_knows_the_limit_of_the_address_space() {
    let home = home();
    let args = "run v.toml --resolution 20000 --memory '1 TiB'";
    is_refused(home.path(), "ulimit -v 1500000", args, &["of memory, more than the 1."]);
}

#[test]
fn a_limit_on_files_is_a_failure_that_leaves_nothing() {
    let home = home();
    for args in [
        "run v.toml --resolution 6 -o out",
        "run v.toml --resolution 60 -o out.zarr",
        "schema -o s.json",
        "schema > s",
    ] {
        is_refused(home.path(), "ulimit -f 1", args, &["cannot write"]);
    }
    fs::remove_file(home.path().join("s")).unwrap();
    assert_eq!(crate::entries(home.path()), ["v.toml"]);
}

/// The maps of a grid of 4 million cells take more memory than the grid; the program refuses before any
/// computation.
#[test]
fn the_budget_counts_pictures() {
    let home = home();
    let started = Instant::now();
    for args in [
        "run v.toml --method flood --resolution 2000 --memory 100MB -o out",
        "run v.toml --method flood --resolution 2000 --memory 100MB --figures out",
        "slices v.toml --resolution 100 --memory 30MB -o out",
        "compare v.toml --methods flood,meyer --resolution 1000 --memory 40MB -o out",
        "zraa v.toml --memory 1MB -o out.svg",
    ] {
        is_refused(home.path(), "true", args, &["drawing the pictures needs"]);
    }
    assert!(started.elapsed() < Duration::from_secs(10), "{:?}", started.elapsed());
    let output = limited(home.path(), "true", "run v.toml --method flood --resolution 2000 --memory 100MB");
    assert!(output.status.success(), "{}", printed(&output));
}

#[test]
fn a_process_limit_changes_no_result() {
    let home = home();
    let dir = home.path();
    let args = "run v.toml --method flood --resolution 30 --json";
    let free = limited(dir, "true", args);
    let body = |output: &Output| {
        let mut report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        report["timing"].take();
        report
    };
    // Limits do not bind the superuser: the program then runs as the user `nobody`.
    let is_root = Command::new("id").arg("-u").output().is_ok_and(|id| id.stdout == b"0\n");
    fs::set_permissions(dir, std::os::unix::fs::PermissionsExt::from_mode(0o755)).unwrap();
    for processes in 1..8 {
        let limit = format!("ulimit -u {processes}");
        let bound = if is_root {
            starter("setpriv")
                .args(["--reuid", "65534", "--clear-groups", "bash", "-c"])
                .args([&format!("{limit}; exec \"$0\" {args}"), env!("CARGO_BIN_EXE_catchment")])
                .current_dir(dir)
                .output()
                .unwrap()
        } else {
            limited(dir, &limit, args)
        };
        let printout = printed(&bound);
        match bound.status.code() {
            Some(0) => assert_eq!(body(&bound), body(&free)),
            // The user `nobody` may lack the permission to run this binary.
            Some(126) => assert!(!printout.is_empty(), "{printout}"),
            _ => panic!("{processes} processes: {}: {printout}", bound.status),
        }
    }
}

#[test]
fn threads_that_cannot_be_had_are_named() {
    let home = home();
    let output = limited(home.path(), "ulimit -v 400000", "run v.toml --threads 1024");
    let printout = printed(&output);
    assert_eq!(output.status.code(), Some(5), "{printout}");
    assert!(printout.contains("the system does not start 1024 threads"), "{printout}");
}

/// A thousand million threads, as a typing error may request.
#[test]
fn invalid_thread_counts_in_the_environment_are_refused() {
    let home = home();
    let run = |value: &str, args: &[&str]| {
        let output = catchment(home.path()).env("RAYON_NUM_THREADS", value).args(args).output().unwrap();
        (output.status.code(), printed(&output).split_whitespace().collect::<Vec<_>>().join(" "))
    };
    let fast = ["run", "v.toml", "--method", "flood", "--resolution", "6"];
    for value in ["1000000000", "1025", "-3", "many"] {
        let (code, printout) = run(value, &fast);
        assert_eq!(code, Some(2), "{printout}");
        assert!(printout.contains(&format!("RAYON_NUM_THREADS is \"{value}\"")), "{printout}");
        assert!(printout.contains("from 0 to 1024") && printout.contains("unset it"), "{printout}");
    }
    for value in ["3", ""] {
        let (code, printout) = run(value, &fast);
        assert_eq!(code, Some(0), "{value}: {printout}");
    }
    let (code, printout) = run("1000000000", &[&fast[..], &["--threads", "2"]].concat());
    assert_eq!(code, Some(0), "{printout}");
}

/// Files that can no longer be opened are removed nevertheless.
#[test]
fn a_process_without_descriptors_leaves_nothing_behind() {
    let home = home();
    let mut refused = 0;
    for most in 5..16 {
        for args in [
            "run v.toml --free x --method flood --resolution 6 --samples 0 -o out",
            "export v.toml --pose x=0.1 -o trial",
            "schema -o s.json --force",
        ] {
            let output = limited(home.path(), &format!("ulimit -n {most}"), args);
            let printout = printed(&output);
            assert!(
                matches!(output.status.code(), Some(0 | 3 | 5)),
                "{most}, {args}: {}: {printout}",
                output.status
            );
            refused +=
                usize::from(output.status.code() == Some(5) && printout.contains("too many open files"));
            let mut left = crate::entries(home.path());
            left.retain(|name| !["out", "trial", "s.json", "v.toml"].contains(&name.as_str()));
            assert!(left.is_empty(), "{most}, {args}: {left:?} left behind: {printout}");
        }
    }
    assert!(refused > 0);
}

#[test]
fn a_failed_write_to_stdout_is_reported() {
    let home = home();
    for args in ["--help", "--version", "run --help", "check v.toml", "schema", "completions bash", "man"] {
        let output = limited(home.path(), "true", &format!("{args} > /dev/full"));
        let printout = printed(&output);
        assert_eq!(output.status.code(), Some(5), "{args}: {printout}");
        assert!(printout.contains("cannot write to stdout"), "{args}: {printout}");
    }
}

/// A text STL of tetrahedra that all intersect each other.
fn tangle(tetrahedra: usize) -> String {
    let mut text = String::from("solid tangle\n");
    for k in 0..tetrahedra {
        let by = k as f64 * 1e-4;
        let corners = [[by, 0.0, 0.0], [1.0 + by, 0.1, 0.0], [0.3, 1.0 + by, 0.0], [0.4, 0.3, 1.0 + by]];
        for face in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in face.map(|corner: usize| corners[corner]) {
                writeln!(text, "vertex {x} {y} {z}").unwrap();
            }
            text += "endloop\nendfacet\n";
        }
    }
    text + "endsolid tangle\n"
}

#[test]
fn a_mesh_in_which_everything_crosses_is_refused_at_its_first_crossings() {
    let home = home();
    let dir = home.path();
    fs::write(dir.join("m.stl"), tangle(5000)).unwrap();
    let half = "mesh = \"m.stl\"";
    let design = format!(
        "[connector]\nwidth = 1.0\nface_height = 0.0\n[connector.fixed]\n{half}\n[connector.moving]\n{half}\n"
    );
    fs::write(dir.join("d.toml"), design).unwrap();
    let started = Instant::now();
    let output = limited(dir, "ulimit -v 1000000", "check d.toml");
    let printout = printed(&output).split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(output.status.code(), Some(4), "{printout}");
    assert!(
        printout.contains("cross near") && printout.contains("triangles were not looked at"),
        "{printout}"
    );
    assert!(started.elapsed() < Duration::from_secs(10) && printout.len() < 4000, "{:?}", started.elapsed());
}

#[test]
fn a_header_of_a_million_names_is_refused_in_linear_time() {
    let home = home();
    let mut names = String::new();
    for k in 0..1_000_000 {
        write!(names, "column{k},").unwrap();
    }
    fs::write(home.path().join("q.csv"), names + "x\n").unwrap();
    let started = Instant::now();
    let output = catchment(home.path()).args(["outcome", "v.toml", "--poses", "q.csv"]).output().unwrap();
    let printout = printed(&output);
    assert_eq!(output.status.code(), Some(4), "{printout}");
    assert!(printout.contains("q.csv, line 1, column 1: 1000001 columns"), "{printout}");
    assert!(started.elapsed() < Duration::from_secs(10), "{:?}", started.elapsed());
}

/// The cost of a message about a text is bounded by the excerpt it shows.
#[test]
fn inputs_full_of_errors_are_refused_quickly_in_little_memory() {
    let home = home();
    let put = |name: &str, text: String| fs::write(home.path().join(name), text).unwrap();
    let many = |count: usize, line: &dyn Fn(usize) -> String| (0..count).map(line).collect::<String>();
    put("heights.csv", "x,y,height\n".to_owned() + &"a,b,c\n".repeat(300_000));
    put("few.csv", "x,y,height\n".to_owned() + &"0,0,0\n".repeat(300_000));
    put("rings.csv", "x,y,ring\n".to_owned() + &many(60_000, &|k| format!("{k},{k},r{k}\n")));
    put("bad.csv", "x,y\n".to_owned() + &"q,q\n".repeat(5000));
    // Every two sides of it cross.
    let star = |k: usize| {
        let angle = std::f64::consts::TAU * (k * 500 % 1001) as f64 / 1001.0;
        format!("{},{}\n", 100.0 * angle.cos(), 100.0 * angle.sin())
    };
    put("star.csv", "x,y\n".to_owned() + &many(1001, &star));
    put(
        "keys.toml",
        "[connector]\nfamily = \"cone\"\n".to_owned() + &many(100_000, &|k| format!("wid{k} = 1\n")),
    );
    let deep =
        |outline: &str| format!("<svg>{}{outline}{}</svg>", "<g>\n".repeat(20_000), "</g>".repeat(20_000));
    put("deep.svg", deep("<path d='M0 0L1 0L1 1z'/>"));
    let part = "parts = [{ profile = \"deep.svg\", height = 0.5 }]";
    put(
        "deep.toml",
        format!(
            "[connector]\nwidth = 1.0\nface_height = 0.0\n[connector.fixed]\n{part}\n[connector.moving]\n{part}\n"
        ),
    );
    for (args, says) in [
        (
            "invert v.toml --heights heights.csv",
            "300000 problems in heights.csv, of which the first 20 are shown",
        ),
        ("invert v.toml --heights few.csv", "the grid has 300000 places"),
        ("compose rings.csv rings.csv", "more than 10000 corners"),
        ("compose bad.csv bad.csv", "10000 problems in bad.csv, of which the first 20 are shown"),
        ("compose star.csv star.csv", "problems in star.csv, of which the first 20 are shown"),
        ("check keys.toml", "100000 problems in keys.toml, of which the first 20 are shown"),
        ("check deep.toml", "more than 256 elements within each other"),
        ("compose deep.svg deep.svg", "more than 256 elements within each other"),
    ] {
        let started = Instant::now();
        let output = limited(home.path(), "ulimit -v 500000", args);
        let printout =
            printed(&output).split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
        assert_eq!(output.status.code(), Some(4), "{args}: {printout}");
        assert!(printout.contains(says) && printout.len() < 20_000, "{args}: {printout}");
        assert!(started.elapsed() < Duration::from_secs(10), "{args}: {:?}", started.elapsed());
    }
}

/// A pipe in place of a file may be intended (`<(…)`), and it may never receive a writer.
#[test]
fn a_signal_ends_the_wait_for_a_pipe() {
    let home = home();
    let dir = home.path();
    for name in ["pipe.stl", "pipe.csv", "pipe.toml"] {
        assert!(Command::new("mkfifo").arg(dir.join(name)).status().unwrap().success());
    }
    let half = "mesh = \"pipe.stl\"";
    let design = format!(
        "[connector]\nwidth = 1.0\nface_height = 0.0\n[connector.fixed]\n{half}\n[connector.moving]\n{half}\n"
    );
    fs::write(dir.join("m.toml"), design).unwrap();
    for args in [
        &["check", "m.toml"][..],
        &["run", "m.toml"],
        &["sweep", "m.toml", "--over", "cor=0,1"],
        &["sweep", "m.toml", "--over", "cor=0,1", "-o", "out"],
        &["invert", "v.toml", "--heights", "pipe.csv"],
        &["invert", "v.toml", "--heights", "m.toml"],
        &["compose", "pipe.csv", "pipe.csv"],
        &["place", "pipe.stl", "pipe.stl", "--unit", "mm"],
        &["latch", "pipe.toml"],
        &["chain", "pipe.toml"],
        &["outcome", "v.toml", "--poses", "pipe.csv"],
    ] {
        let mut child =
            catchment(dir).args(args).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(100));
        let requested = Instant::now();
        Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
        while child.try_wait().unwrap().is_none() {
            if requested.elapsed() > Duration::from_secs(10) {
                child.kill().unwrap();
                panic!("{args:?} does not hear");
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        // Without a handler the signal itself ends the process.
        let code = child.wait().unwrap().code();
        assert!(matches!(code, None | Some(143)), "{args:?}: {code:?}");
    }
    let output = limited(dir, "true", "check <(cat v.toml)");
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
}

#[test]
fn column_names_repeated_in_json_count_in_the_budget() {
    let home = home();
    // A megabyte of commas, and a gigabyte of names as JSON.
    let mut names = String::new();
    for k in 0..900 {
        write!(names, ",{k:n>180}").unwrap();
    }
    let row = "3".to_owned() + &",".repeat(900) + "\n";
    fs::write(home.path().join("q.csv"), format!("x{names}\n") + &row.repeat(5000)).unwrap();
    let output = limited(home.path(), "ulimit -v 1500000", "outcome v.toml --poses q.csv --json");
    let printout = printed(&output);
    assert_eq!(output.status.code(), Some(5), "{printout}");
    assert!(
        printout.contains("the answer for every pose needs") && printout.contains("try fewer poses"),
        "{printout}"
    );
}

#[test]
fn pipes_and_huge_files_in_a_stored_grid_are_refused() {
    let home = home();
    let dir = home.path();
    fs::create_dir(dir.join("e.zarr")).unwrap();
    let made = Command::new("mkfifo").arg(dir.join("e.zarr/zarr.json")).status().unwrap();
    assert!(made.success());
    let output = limited(dir, "true", "compare e.zarr v.toml");
    let printout = printed(&output);
    assert_eq!(output.status.code(), Some(4), "{printout}");
    assert!(printout.contains("it is no regular file"), "{printout}");
    // Longer than any report, and without a single byte on the disk.
    fs::remove_file(dir.join("e.zarr/zarr.json")).unwrap();
    fs::File::create(dir.join("e.zarr/zarr.json")).unwrap().set_len(3 << 30).unwrap();
    let output = limited(dir, "ulimit -v 1000000", "compare e.zarr v.toml");
    let printout = printed(&output);
    assert_eq!(output.status.code(), Some(4), "{printout}");
    assert!(printout.contains("longer than"), "{printout}");
}

#[test]
fn extreme_alignments_end_within_a_minute() {
    let home = home();
    let far = fs::read_to_string(home.path().join("v.toml")).unwrap()
        + "[errors]\nx = 100.0\npitch = \"180 deg\"\n";
    fs::write(home.path().join("far.toml"), far).unwrap();
    for args in [
        "check far.toml --cor 100",
        "check far.toml --rotation-length 0.001",
        "run v.toml --cor 100 --resolution 4 --samples 50",
        "run v.toml --cor=-100 --rotation-length 0.1 --resolution 10 --samples 50",
        "run far.toml --rotation-length 1000 --resolution 10 --samples 50",
    ] {
        let started = Instant::now();
        let output = limited(home.path(), "true", args);
        let printout = printed(&output);
        assert!(matches!(output.status.code(), Some(0 | 4)), "{args}: {}: {printout}", output.status);
        assert!(started.elapsed() < Duration::from_mins(1), "{args}: {:?}", started.elapsed());
    }
}
