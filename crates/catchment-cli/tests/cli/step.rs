//! STEP files: refused with advice on packages to install if Python cannot mesh them, and accepted from any
//! program that can.
//!
//! `tests/step_meshes.py` tests the conversion itself, where the package is installed.

use super::{catchment, designs, run};
use std::fs;
use std::path::{Path, PathBuf};
#[cfg(unix)]
use std::process::Command;

/// A real part, drawn by `tests/step/make.py`.
fn peg() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/step/peg.step")
}

const DESIGN: &str = "[connector]\nwidth = 50\nunit = \"mm\"\n\
                      fixed = { mesh = \"socket.stp\", deflection = \"0.02 mm\" }\nmoving = { mesh = \"plug.step\" }\n";

/// A design of two real STEP files.
fn folder() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("design.toml"), DESIGN).unwrap();
    for part in ["socket.stp", "plug.step"] {
        fs::copy(peg(), dir.path().join(part)).unwrap();
    }
    dir
}

/// The printed text, with line breaks and frames as spaces.
fn words(report: &str) -> String {
    report.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
}

#[test]
fn missing_python_is_reported_with_install_advice() {
    let dir = folder();
    let commands: [&[&str]; 4] = [
        &["check", "design.toml", "-o", "pair.svg"],
        &["run", "design.toml", "-o", "out"],
        &["place", "plug.step", "socket.stp", "-o", "placed.toml"],
        &["zraa", "design.toml", "-o", "out.svg"],
    ];
    for command in commands {
        let report = run(dir.path(), command);
        assert!(report.starts_with("exit 4\n--- stdout\n--- stderr\n"), "{report}");
        let printout = words(&report);
        assert!(printout.contains("`no/python3` cannot be started"), "{printout}");
        assert!(printout.contains("python3 -m pip install cadquery-ocp-novtk"), "{printout}");
        assert!(printout.contains("CATCHMENT_PYTHON"), "{printout}");
    }
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 3);
}

/// The mesher's answer for a STEP file with the content of an STL file.
#[cfg(unix)]
fn answer(stl: &Path) -> Vec<u8> {
    const HEADER: usize = 84;
    const TRIANGLE: usize = 50;
    let bytes = fs::read(stl).unwrap();
    let numbers: Vec<f64> = if bytes.starts_with(b"solid") {
        let text = String::from_utf8(bytes).unwrap();
        let corners = text.lines().filter_map(|line| line.trim().strip_prefix("vertex"));
        corners.flat_map(str::split_whitespace).map(|number| number.parse().unwrap()).collect()
    } else {
        let triangles =
            bytes[HEADER..].chunks_exact(TRIANGLE).flat_map(|triangle| triangle[12..48].chunks_exact(4));
        triangles.map(|number| f64::from(f32::from_le_bytes(number.try_into().unwrap()))).collect()
    };
    let count = u32::try_from(numbers.len() / 9).unwrap();
    let corners: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    let triangles: Vec<u8> = (0..3 * count).flat_map(u32::to_le_bytes).collect();
    let head = format!(
        "{{\"bodies\": [[{}, {count}]], \"deflection\": 0.02, \"reached\": 0.0125, \"by\": \"OCP of a test\"}}\n",
        3 * count
    );
    [head.into_bytes(), corners, triangles].concat()
}

/// A program in place of Python, which answers with a file beside the design, whatever its input.
#[cfg(unix)]
fn python(folder: &Path, script: &str) -> PathBuf {
    use std::os::unix::fs::PermissionsExt;
    let path = folder.join("python");
    fs::write(&path, format!("#!/bin/sh\n{script}\n")).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    path
}

#[cfg(unix)]
#[test]
fn externally_meshed_halves_give_the_same_results() {
    let dir = folder();
    let meshes = designs().join("meshes");
    for (name, stl) in [("socket", "socket.stl"), ("plug", "plug.stl")] {
        fs::write(dir.path().join(name), answer(&meshes.join(stl))).unwrap();
    }
    // The design sets a deflection for the socket; 0 stands for the default from the size of the part.
    let script =
        "cat > /dev/null\ncd \"$(dirname \"$0\")\"\nif [ \"$4\" = 0 ]; then cat plug; else cat socket; fi";
    let path = python(dir.path(), script);
    let output =
        catchment(dir.path()).env("CATCHMENT_PYTHON", &path).args(["check", "design.toml"]).output().unwrap();
    let (stdout, stderr) =
        (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    let stdout = stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        stdout.contains("triangles, off by at most 0.02 mm (deflection, as written), by OCP of a test"),
        "{stdout}"
    );
    assert!(
        stdout.contains("off by at most 0.02 mm (deflection, 0.0002 of its size), by OCP of a test"),
        "{stdout}"
    );
    // The same numbers as for the meshes themselves.
    let run = |design: &str, python: &Path| {
        let output = catchment(dir.path())
            .env("CATCHMENT_PYTHON", python)
            .args(["zraa", design, "--json"])
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()
    };
    for stl in ["socket.stl", "plug.stl"] {
        fs::copy(meshes.join(stl), dir.path().join(stl)).unwrap();
    }
    let of_meshes = "[connector]\nwidth = 50\nunit = \"mm\"\n\
                     fixed = { mesh = \"socket.stl\", unit = \"mm\" }\nmoving = { mesh = \"plug.stl\", unit = \"mm\" }\n";
    fs::write(dir.path().join("meshes.toml"), of_meshes).unwrap();
    let (step, mesh) = (run("design.toml", &path), run("meshes.toml", Path::new("no/python3")));
    assert_eq!(step["area_d2"], mesh["area_d2"]);
    assert!(mesh["area_d2"].as_f64().unwrap() > 0.0);
    // The output names the mesher with the design.
    let printed = &step["design"]["connector"]["own"]["moving"]["mesh"]["content"]["meshed"];
    assert_eq!((&printed["by"], &printed["reached"]), (&"OCP of a test".into(), &(0.0125 / 50.0).into()));
}

#[cfg(unix)]
#[test]
fn every_failure_of_the_mesher_is_reported() {
    let dir = folder();
    let cases = [
        (
            r#"echo '{"error": "package", "message": "No module named OCP"}'"#,
            "has none (No module named OCP)",
        ),
        (r#"echo '{"error": "empty", "message": "nothing in it has faces"}'"#, "the file holds no solid"),
        (
            r#"echo '{"error": "many", "message": "300000"}'"#,
            "make 300000 triangles or more, and a half may have 200000: let `deflection` be larger",
        ),
        ("echo lost >&2; exit 7", "exit status: 7; lost"),
        ("kill -9 $$", "signal: 9"),
        ("echo hello", "its answer is broken"),
        (
            r#"echo '{"bodies": [[4, 4]], "deflection": 1, "reached": 1, "by": "x"}'; head -c 100 /dev/zero"#,
            "its answer is broken",
        ),
        (r#"echo '{"bodies": [], "deflection": 1, "reached": 1, "by": "x"}'"#, "the file holds no triangles"),
        ("exec sleep 0.1 < /dev/null", "it printed nothing"),
    ];
    for (script, printout) in cases {
        let path = python(dir.path(), script);
        let output = catchment(dir.path())
            .env("CATCHMENT_PYTHON", &path)
            .args(["check", "design.toml"])
            .output()
            .unwrap();
        let stderr = words(&String::from_utf8_lossy(&output.stderr));
        assert_eq!(output.status.code(), Some(4), "{script}: {stderr}");
        assert!(stderr.contains(printout), "{script}: {stderr}");
        assert!(output.stdout.is_empty(), "{script}");
    }
}

#[cfg(unix)]
#[test]
fn a_signal_ends_the_command_and_its_mesher() {
    use std::process::Stdio;
    use std::time::{Duration, Instant};
    let dir = folder();
    let path = python(dir.path(), "echo $$ > \"$(dirname \"$0\")/started\"\nexec sleep 60");
    let commands: [(&[&str], &str, i32); 3] = [
        (&["check", "design.toml", "-o", "pair.svg"], "-INT", 130),
        (&["check", "design.toml"], "-TERM", 143),
        (&["place", "socket.stp", "plug.step", "-o", "placed.toml"], "-INT", 130),
    ];
    for (arguments, signal, code) in commands {
        let child = catchment(dir.path())
            .env("CATCHMENT_PYTHON", &path)
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let started = dir.path().join("started");
        let waiting = Instant::now();
        while !fs::read_to_string(&started).is_ok_and(|pid| pid.ends_with('\n')) {
            assert!(waiting.elapsed() < Duration::from_secs(30), "{arguments:?}");
            std::thread::sleep(Duration::from_millis(10));
        }
        let requested = Instant::now();
        assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
        let output = child.wait_with_output().unwrap();
        assert!(requested.elapsed() < Duration::from_secs(5), "{arguments:?}: {:?}", requested.elapsed());
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        assert_eq!(String::from_utf8_lossy(&output.stderr), "interrupted; nothing was written\n");
        let meshing = fs::read_to_string(&started).unwrap();
        let lives = Command::new("kill").args(["-0", meshing.trim()]).stderr(Stdio::null()).status().unwrap();
        assert!(!lives.success(), "{arguments:?}: it goes on");
        fs::remove_file(started).unwrap();
    }
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 4);
}

/// A real Python, if installed; the tests below concern how it starts.
#[cfg(unix)]
fn real_python() -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    std::env::split_paths(&folders).map(|folder| folder.join("python3")).find(|path| path.is_file())
}

/// Python does not run code in a folder of another owner: neither from the current folder nor from relative entries of `PYTHONPATH`; an empty entry
/// is relative as well.
#[cfg(unix)]
#[test]
fn python_files_beside_a_design_are_never_run() {
    let Some(python) = real_python() else { return };
    let dir = folder();
    let ran = dir.path().join("ran");
    let code = format!("open({:?}, 'w').write('x')\n", ran.to_str().unwrap());
    fs::create_dir_all(dir.path().join("lib/OCP")).unwrap();
    for place in [
        "sitecustomize.py",
        "usercustomize.py",
        "json.py",
        "signal.py",
        "lib/sitecustomize.py",
        "lib/OCP/__init__.py",
        "site.py",
    ] {
        fs::write(dir.path().join(place), &code).unwrap();
    }
    fs::create_dir(dir.path().join("OCP")).unwrap();
    fs::write(dir.path().join("OCP/__init__.py"), &code).unwrap();
    for paths in ["/opt/mine:", ":", ".", "lib", "./lib:/opt/mine", "../x:lib"] {
        let output = catchment(dir.path())
            .env("CATCHMENT_PYTHON", &python)
            .env("PYTHONPATH", paths)
            .args(["check", "design.toml"])
            .output()
            .unwrap();
        assert!(output.status.code().is_some());
        assert!(!ran.exists(), "PYTHONPATH={paths}: {}", String::from_utf8_lossy(&output.stderr));
    }
}

/// Python finds modules that the user installed for every folder: an absolute entry of `PYTHONPATH`, and packages of the user.
#[cfg(unix)]
#[test]
fn python_packages_of_the_user_are_imported() {
    let Some(python) = real_python() else { return };
    let dir = folder();
    // A stand-in for OpenCASCADE that reports its import.
    let package = |folder: &Path, says: &str| {
        fs::create_dir_all(folder.join("OCP")).unwrap();
        fs::write(folder.join("OCP/__init__.py"), format!("raise ImportError('{says}')\n")).unwrap();
    };
    package(&dir.path().join("mine"), "seen by PYTHONPATH");
    let requested = Command::new(&python)
        .args([
            "-c",
            "import site, sys; print(site.getusersitepackages() if sys.prefix == sys.base_prefix else '')",
        ])
        .env("HOME", dir.path())
        .env_remove("PYTHONUSERBASE")
        .output()
        .unwrap();
    let of_user = String::from_utf8(requested.stdout).unwrap();
    let says = |home: &str, paths: &str| {
        let output = catchment(dir.path())
            .env("CATCHMENT_PYTHON", &python)
            .env("HOME", home)
            .env("PYTHONPATH", paths)
            .args(["check", "design.toml"])
            .output()
            .unwrap();
        words(&String::from_utf8_lossy(&output.stderr))
    };
    let mine = dir.path().join("mine");
    // An installed OpenCASCADE takes precedence.
    let is_installed =
        Command::new(&python).args(["-I", "-c", "import OCP"]).output().unwrap().status.success();
    if is_installed {
        return;
    }
    let printout = says("/nowhere", &format!("relative:{}", mine.display()));
    assert!(printout.contains("has none (seen by PYTHONPATH)"), "{printout}");
    if !of_user.trim().is_empty() {
        package(Path::new(of_user.trim()), "seen for the user");
        let printout = says(dir.path().to_str().unwrap(), "");
        assert!(printout.contains("has none (seen for the user)"), "{printout}");
    }
}

/// A path of an interpreter is relative to the user's folder, although the interpreter starts in another.
#[cfg(unix)]
#[test]
fn an_interpreter_may_have_a_relative_path() {
    let dir = folder();
    python(dir.path(), r#"echo '{"error": "empty", "message": "pwd is '"$(ls -A | wc -l)"' files"}'"#);
    let output = catchment(dir.path())
        .env("CATCHMENT_PYTHON", "./python")
        .args(["check", "design.toml"])
        .output()
        .unwrap();
    let printout = words(&String::from_utf8_lossy(&output.stderr));
    assert!(printout.contains("the file holds no solid (pwd is 0 files)"), "{printout}");
}
