use super::*;
use crate::acceptance::Domain;
use crate::design::Family;
use crate::exec::Exec;
use crate::pose::DofSet;
use crate::problem::testing::problem;

fn free(dofs: &[Dof]) -> DofSet {
    dofs.iter().copied().collect()
}

fn quick() -> WindowSettings {
    WindowSettings { motions: Some(4000), ..WindowSettings::default() }
}

/// V-Face, x alone: D/2 to either side, closed form.
#[test]
fn the_window_of_one_offset_has_its_closed_form() {
    let result = run(&problem(Family::VFace, free(&[Dof::X])), &quick(), &Exec::new()).unwrap();
    let [side] = &result.sides[..] else { panic!("{result:?}") };
    assert!((side.half_width - 0.5).abs() < 1e-3 && side.half_width < 0.5, "{side:?}");
    assert!((0.4998..=0.5).contains(&side.alone) && !side.alone_reaches_border);
    assert_eq!(result.tightest, Some(Dof::X));
    let worst = result.worst.clone().unwrap();
    assert!(worst.outcome != Outcome::Aligned && (worst.error.x.abs() - 0.5).abs() < 2e-4);
}

/// A design of the gallery.
fn of_gallery(name: &str) -> Problem {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/gallery");
    Problem::open(folder.join(name)).unwrap()
}

/// For any given half-widths, and for halves with play, at least 999 in 1000 poses of the window dock, and a
/// box 2 % larger along its tight error contains a failure.
#[test]
fn poses_of_the_window_dock_and_a_larger_window_fails() {
    const POSES: u64 = 1000;
    let exec = Exec::new();
    let all = DofSet::ALL;
    let given = [None, None, Some(0.05), Some(0.05), None];
    let fixed = WindowSettings { fixed: given, ..quick() };
    let cases = [
        (problem(Family::VFace, free(&[Dof::X, Dof::Pitch])), quick()),
        (problem(Family::Pyramid, free(&[Dof::X, Dof::Y, Dof::Yaw])), quick()),
        (problem(Family::Pyramid, all), quick()),
        (problem(Family::Pyramid, all), fixed),
        (problem(Family::XFace3d, all), quick()),
        (of_gallery("usb-a.toml"), WindowSettings { motions: Some(2000), ..quick() }),
        (of_gallery("charging-dock.toml"), quick()),
    ];
    for (problem, settings) in cases {
        let result = run(&problem, &settings, &exec).unwrap();
        let widths: Vec<f64> = result.sides.iter().map(|side| side.half_width).collect();
        let stream = crate::acceptance::Stream::new(77);
        let inside = |k: u64| {
            let mut error = [0.0; 5];
            for (j, side) in result.sides.iter().enumerate() {
                error[side.axis.index()] = side.half_width * (2.0 * stream.uniform(5 * k + j as u64) - 1.0);
            }
            PoseError::from_array(error)
        };
        let drawn = Domain::Poses((0..POSES).map(inside).collect());
        let (motions, _) =
            descent::run(problem.pair(), drawn, &descent::DescentSettings::default(), &exec).unwrap();
        let docked = motions.outcomes.iter().filter(|outcome| **outcome == Outcome::Aligned).count();
        assert!(1000 * docked as u64 >= 999 * POSES, "{docked} of {POSES} in ±{widths:?}");
        let tight = result.sides.iter().find(|side| Some(side.axis) == result.tightest).unwrap();
        assert!(tight.beside <= 1.02 * tight.half_width, "{result:?}");
        for side in &result.sides {
            assert!(side.half_width <= side.beside + 1e-12 && side.beside <= side.alone + 1e-12);
            assert_eq!(side.given, settings.fixed[side.axis.index()].is_some());
        }
        let worst = result.worst.clone().unwrap();
        assert_ne!(problem.follow(&worst.error).outcome, Outcome::Aligned);
        for (one, side) in result.sides.iter().enumerate() {
            let fails = |k: u64| {
                let mut error = [0.0; 5];
                for (j, other) in result.sides.iter().enumerate() {
                    let most = if j == one { side.beside } else { other.half_width };
                    error[other.axis.index()] = most * (2.0 * stream.uniform(5 * k + j as u64) - 1.0);
                }
                problem.follow(&PoseError::from_array(error)).outcome != Outcome::Aligned
            };
            let failed = (0..300).filter(|k| fails(*k)).count();
            // The search left no failure among the 2000 poses that it sampled beyond the window.
            assert!(failed <= 1, "{failed} of 300 with {} up to {}", side.axis.name(), side.beside);
        }
    }
}

/// Measured by 242 directions and local moves in a trial of its own: 0.148 of the error box, at (1, −1, −1, −1, −1) or a mirror image.
#[test]
fn the_centred_box_of_the_x_face_is_not_that_of_random_poses() {
    use crate::problem::Draft;
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs/x-face-3d.toml");
    let problem = Draft::open(&file).unwrap().build().unwrap();
    let result = run(&problem, &quick(), &Exec::new()).unwrap();
    assert!((result.scale - 0.148).abs() < 0.002, "{}", result.scale);
}

#[test]
fn given_half_widths_stay_and_the_others_grow() {
    let problem = problem(Family::VFace, free(&[Dof::X, Dof::Pitch]));
    let exec = Exec::new();
    let with = |x: f64| {
        let settings = WindowSettings { fixed: [Some(x), None, None, None, None], ..quick() };
        run(&problem, &settings, &exec).unwrap()
    };
    let (small, large) = (with(0.05), with(0.3));
    let pitch = |result: &ToleranceWindow| result.sides[1].half_width;
    assert!(pitch(&small) > 1.1 * pitch(&large), "{small:?} {large:?}");
    assert_eq!((large.sides[0].half_width, large.sides[0].given), (0.3, true));
    let too_much = WindowSettings { fixed: [Some(0.9), None, None, None, None], ..quick() };
    assert!(matches!(run(&problem, &too_much, &exec), Err(WindowError::GivenFails { .. })));
}

#[test]
fn invalid_window_settings_are_refused() {
    let problem = problem(Family::VFace, free(&[Dof::X, Dof::Pitch]));
    let refused = |settings: WindowSettings| run(&problem, &settings, &Exec::new()).unwrap_err().to_string();
    let fixed = |k: usize, value: f64| {
        let mut fixed = [None; 5];
        fixed[k] = Some(value);
        WindowSettings { fixed, ..quick() }
    };
    assert!(refused(fixed(0, 1.5)).contains("error box ends at ±1.0000"));
    assert!(refused(fixed(1, 0.1)).starts_with("y: the design locks it"));
    assert!(refused(fixed(0, -0.1)).contains("no half-width"));
    let none = WindowSettings { proportions: Some(PoseError::default()), ..quick() };
    assert!(refused(none).starts_with("nothing to compute"));
}

#[test]
fn threads_do_not_change_the_window() {
    let problem = problem(Family::Pyramid, DofSet::ALL);
    let on = |threads: usize| {
        let exec = Exec::new().with_threads(threads).unwrap();
        run(&problem, &WindowSettings { motions: Some(1000), ..WindowSettings::default() }, &exec).unwrap()
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(4));
}

#[test]
fn all_certificates_together_are_wrong_in_at_most_five_percent() {
    let all: f64 = (0..100_000).map(chance).sum();
    assert!((0.0499..=0.05).contains(&all), "{all}");
    assert!((1.0 / chance(0)).ln() <= 3.0);
}

#[test]
fn a_place_shows_at_least_its_largest_error() {
    let pose = |x: f64, yaw: f64| PoseError { x, yaw, ..PoseError::default() };
    assert_eq!(place(&pose(0.25, -1e-7)), "x = 0.2500 D");
    assert_eq!(place(&pose(-2e-6, 0.0)), "x = -2.0e-6 D");
}
