use super::*;
use crate::design::{Design, SourceText};
use catchment_base::diagnostic::Diagnostics;
use std::path::Path;

fn design() -> Design {
    let text = "[connector]\nfamily = \"v-face\"\nwidth = 50\nunit = \"mm\"\n";
    crate::design::read(text, Path::new("")).unwrap().design
}

fn read(text: &str) -> Result<Dynamics, Diagnostics> {
    read_dynamics(&SourceText::new("dynamics.toml", text.to_owned()), &design())
}

/// The messages about a file, with the text to which each refers.
fn wrong(text: &str) -> Vec<(String, String)> {
    let of = |diagnostic: &catchment_base::diagnostic::Diagnostic| {
        let place = diagnostic.span.clone().map_or_else(String::new, |span| text[span].to_owned());
        (place, diagnostic.message.clone())
    };
    read(text).unwrap_err().list.iter().map(of).collect()
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * b.abs().max(1.0)
}

#[test]
fn every_law_is_read_in_its_units() {
    let text = "[dynamics]\nspeed = { mean = \"50 mm/s\", sigma = 0.2 }\ndrift_x = \"0 ± 5 mm/s\"\nspin_yaw = \"-1..2 deg/s\"\n\
                mass = { from = \"1_800 g\", to = 2.2 }\nfriction = \"0.2 */ 1.3\"\nrestitution = { measured = [0.05, 0.1, 0.3] }\n\
                height = \"5 mm\"\n";
    let result = read(&text.replace("1_800 g", "1800 g")).unwrap();
    let law = |of| result.law(of).unwrap().clone();
    assert_eq!(law(Circumstance::Speed), ScalarDistribution::Normal { mean: 1.0, sigma: 0.2 });
    let ScalarDistribution::Normal { mean, sigma } = law(Circumstance::DriftX) else { panic!() };
    assert!(mean == 0.0 && near(sigma, 0.1));
    let ScalarDistribution::Uniform { from, to } = law(Circumstance::SpinYaw) else { panic!() };
    assert!(near(from, -1f64.to_radians()) && near(to, 2f64.to_radians()));
    assert_eq!(law(Circumstance::Mass), ScalarDistribution::Uniform { from: 1.8, to: 2.2 });
    assert_eq!(law(Circumstance::Friction), ScalarDistribution::Lognormal { median: 0.2, factor: 1.3 });
    assert_eq!(
        law(Circumstance::Restitution),
        ScalarDistribution::Measured { measured: vec![0.05, 0.1, 0.3] }
    );
    let ScalarDistribution::Constant { value } = law(Circumstance::Height) else { panic!() };
    assert!(near(value, 0.1) && result.varies());
    let (of, law) = parse_draw("speed = 40 mm/s +- 10 mm/s", &design()).unwrap();
    assert_eq!((of, law), (Circumstance::Speed, ScalarDistribution::Normal { mean: 0.8, sigma: 0.2 }));
    let json = serde_json::to_string(&result).unwrap();
    assert_eq!(serde_json::from_str::<Dynamics>(&json).unwrap(), result);
}

#[test]
fn all_problems_come_at_once_in_their_places() {
    let text = "[dynamics]\nspead = 1\nspeed = \"50 mm\"\nmass = -2\nfriction = { mean = 0.2 }\nrestitution = \"0.5 ± 100\"\nheight = \"2 deg\"\n\
                spin_roll = { meen = 1, sigma = 2 }\ndrift_x = { from = 2, to = 1 }\ndrift_y = { mean = 0, sigma = -1 }\nspin_yaw = true\n[more]\n";
    let result = wrong(text);
    let places: Vec<&str> = result.iter().map(|(place, _)| place.as_str()).collect();
    let expected = [
        "spead",
        "\"50 mm\"",
        "-2",
        "{ mean = 0.2 }",
        "\"0.5 ± 100\"",
        "\"2 deg\"",
        "meen",
        "{ from = 2, to = 1 }",
        "{ mean = 0, sigma = -1 }",
        "true",
        "more",
    ];
    assert_eq!(places, expected, "{result:?}");
    assert!(result[4].1.contains("100 % of this law is out of range"), "{:?}", result[4]);
    for (text, printout) in [
        ("", "declares no dynamics"),
        ("dynamics = 3", "no table"),
        ("[dynamics]\n", "declares nothing"),
        ("[dynamics]\nfriction = \"0.2 mm\"\n", "friction has no unit"),
        ("[dynamics]\nmass = \"2 stone\"\n", "no unit `stone`"),
        ("[dynamics]\nfriction = { measured = [] }\n", "0 measured values"),
        ("[dynamics]\nspeed = \"1e9\"\n", "out of range"),
        ("[dynamics]\nspeed = \"fast\"\n", "speed"),
    ] {
        let result = wrong(text);
        assert!(result[0].1.contains(printout), "{text}: {result:?}");
    }
    for (text, printout) in [
        ("friction", "no circumstance and its law"),
        ("fricton=0.1", "no circumstance `fricton`"),
        ("mass=0", "out of range"),
    ] {
        let refusal = parse_draw(text, &design()).unwrap_err();
        assert!(refusal.to_string().contains(printout), "{refusal}");
    }
}

/// Number k of a sequence that is even in [0, 1): `SplitMix64`.
fn uniform(k: u64) -> f64 {
    let mut z = k.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// Mean and share in the range of the sampled values, within five standard errors; for truncated
/// distributions those of the truncated one.
#[test]
fn values_have_the_moments_of_their_law() {
    const COUNT: u64 = 40_000;
    let root = (COUNT as f64).sqrt();
    // A normal law cut at its mean has the mean μ + σ·√(2/π), and σ·√(1 − 2/π).
    let half = (2.0 / std::f64::consts::PI).sqrt();
    let spread = libm::log(1.3);
    let cases = [
        (ScalarDistribution::Normal { mean: 1.0, sigma: 0.2 }, [-10.0, 10.0], 1.0, 0.2),
        (ScalarDistribution::Normal { mean: 0.0, sigma: 0.2 }, [0.0, 10.0], 0.2 * half, 0.2),
        (ScalarDistribution::Uniform { from: 1.0, to: 3.0 }, [0.0, 10.0], 2.0, 0.58),
        (ScalarDistribution::Uniform { from: -1.0, to: 3.0 }, [0.0, 10.0], 1.5, 0.87),
        (
            ScalarDistribution::Lognormal { median: 0.2, factor: 1.3 },
            [0.0, 10.0],
            0.2 * (0.5 * spread * spread).exp(),
            0.06,
        ),
        (ScalarDistribution::Measured { measured: vec![1.0, 2.0, 6.0] }, [0.0, 10.0], 3.0, 2.2),
        (ScalarDistribution::constant(0.3), [0.0, 1.0], 0.3, 1e-9),
    ];
    for (law, range, mean, sigma) in cases {
        let values: Vec<f64> = (0..COUNT)
            .map(|k| law.draw(range, |index| uniform(ScalarDistribution::DRAWN * k + index)))
            .collect();
        assert!(values.iter().all(|value| (range[0]..=range[1]).contains(value)), "{law:?}");
        let result = values.iter().sum::<f64>() / COUNT as f64;
        assert!((result - mean).abs() < 5.0 * sigma / root, "{law:?}: {result} for {mean}");
    }
    assert!(
        (ScalarDistribution::Normal { mean: 0.0, sigma: 1.0 }.inside([-1.0, 1.0]) - 0.682_689_492).abs()
            < 1e-8
    );
    assert!(
        (ScalarDistribution::Lognormal { median: 0.2, factor: 1.3 }.inside([0.2 / 1.3, 0.26])
            - 0.682_689_492)
            .abs()
            < 1e-8
    );
}
