use super::*;
use catchment_design::design::MeshPreparation;

fn answer(head: &str, doubles: &[f64], corners: &[u32]) -> Vec<u8> {
    let mut bytes = format!("{head}\n").into_bytes();
    bytes.extend(doubles.iter().flat_map(|number| number.to_le_bytes()));
    bytes.extend(corners.iter().flat_map(|number| number.to_le_bytes()));
    bytes
}

const HEAD: &str = r#"{"bodies": [[3, 1]], "deflection": 0.01, "reached": 0.009, "by": "OCP 8"}"#;
const POINTS: [f64; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.5];

fn read_answer(bytes: &[u8]) -> Result<FileContent, Vec<MeshProblem>> {
    reply::read(bytes, "python3", MeshPreparation::DEFAULT)
}

#[test]
fn only_a_complete_reply_is_read() {
    let whole = answer(HEAD, &POINTS, &[0, 1, 2]);
    let held = read_answer(&whole).unwrap();
    assert_eq!((held.bodies.len(), held.bodies[0].len(), held.metres), (1, 1, Some(1e-3)));
    assert_eq!(held.bodies[0][0].corners[2].to_array(), [0.0, 1.0, 0.5]);
    let curves = held.curves.unwrap();
    assert_eq!((curves.deflection, curves.reached, curves.by.as_str()), (0.01, 0.009, "OCP 8"));
    // Broken replies: truncated at any byte, trailing bytes, a corner index out of range, invalid numbers.
    let broken = |bytes: &[u8]| {
        let problems = read_answer(bytes).unwrap_err();
        assert_eq!(problems[0].to_string(), "`python3` did not mesh it: its answer is broken");
    };
    (0..whole.len()).for_each(|end| broken(&whole[..end]));
    broken(&[&whole[..], &[0]].concat());
    broken(&answer(HEAD, &POINTS, &[0, 1, 3]));
    broken(&answer(&HEAD.replace("0.01", "0"), &POINTS, &[0, 1, 2]));
    broken(&answer(&HEAD.replace("3, 1", "3000000000000000000, 1"), &POINTS, &[0, 1, 2]));
    broken(b"Python 3.11\n");
}

#[test]
fn refusals_are_reported_with_advice() {
    let error_of = |kind: &str, message: &str| {
        let head = serde_json::json!({ "error": kind, "message": message }).to_string();
        read_answer(&answer(&head, &[], &[])).unwrap_err()[0].to_string()
    };
    assert!(
        error_of("package", "No module named 'OCP'").contains("`python3 -m pip install cadquery-ocp-novtk`")
    );
    assert_eq!(error_of("unreadable", "a\u{1b}[2Jb"), "cannot be read as STEP: a[2Jb");
    assert!(
        error_of("empty", "of 3 faces, none of which bounds a solid")
            .starts_with("the file holds no solid (of 3")
    );
    assert!(
        error_of("many", "250000")
            .contains("make 250000 triangles or more, and a half may have 200000: let `deflection`")
    );
    assert!(error_of("memory", "").contains("more memory than there is"));
    assert!(error_of("unmeshed", "one of its faces").contains("repair the part"));
}

#[test]
fn only_files_with_a_step_header_are_meshed() {
    let spec = FileSpec::new("part.step", 1.0);
    let refused = |bytes: &[u8], spec: &FileSpec| {
        read(&FileBytes::whole(bytes.to_vec()), spec, &Exec::new()).unwrap_err()[0].to_string()
    };
    assert!(refused(b"solid x", &spec).contains("begins with ISO-10303-21"));
    let in_inches = FileSpec { unit: FileUnit::Stated(LengthUnit::In), ..spec };
    assert!(refused(b"ISO-10303-21;", &in_inches).contains("read in mm; the design says in"));
}

/// A shell script in place of Python.
#[cfg(unix)]
fn shell(script: &str, input: Vec<u8>, most_time: Duration, exec: &Exec) -> Result<Vec<u8>, StepProblem> {
    let arguments = ["-c".to_owned(), script.to_owned()];
    let job = child::Job { program: "sh".into(), arguments: &arguments, most_reply: 1 << 20, most_time };
    child::run(job, input, &Stopwatch::start(), exec)
}

#[cfg(unix)]
#[test]
fn a_child_process_is_read_and_ended() {
    let exec = Exec::new();
    let long = Duration::from_mins(1);
    // More than a pipe holds, both ways.
    let input = vec![b'x'; 300_000];
    assert_eq!(shell("cat", input.clone(), long, &exec), Ok(input.clone()));
    let died = shell("echo one >&2; echo two >&2; exit 3", input.clone(), long, &exec).unwrap_err();
    assert!(died.to_string().contains("exit status: 3; two"), "{died}");
    let silent = shell("exit 0", Vec::new(), long, &exec).unwrap_err();
    assert!(silent.to_string().contains("it printed nothing"), "{silent}");
    let watch = Stopwatch::start();
    // The sleeper that the shell starts holds its pipes.
    let late = shell("sleep 30; true", input.clone(), Duration::from_millis(50), &exec);
    assert_eq!(late, Err(StepProblem::TooLong { seconds: 0 }));
    exec.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
    assert_eq!(shell("sleep 30; true", input, long, &exec), Err(StepProblem::Cancelled));
    assert!(watch.seconds() < 10.0);
}

#[test]
fn a_missing_program_is_reported() {
    let job = child::Job {
        program: "no/such/python".into(),
        arguments: &[],
        most_reply: 1,
        most_time: Duration::from_secs(1),
    };
    let refused = child::run(job, Vec::new(), &Stopwatch::start(), &Exec::new()).unwrap_err().to_string();
    assert!(refused.contains("`no/such/python` cannot be started"), "{refused}");
    assert!(refused.contains("CATCHMENT_PYTHON"), "{refused}");
}
