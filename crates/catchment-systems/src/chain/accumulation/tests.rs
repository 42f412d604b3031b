//! Accumulated errors compared with closed forms, random chains and the published table.

use super::super::shape::{ChainShape, FIRST_CORNERS, Reading, latches};
use super::*;
use proptest::prelude::*;

const DEGREE: f64 = PI / 180.0;

fn joints(degrees: f64) -> ChainErrors {
    ChainErrors { joint_sigma: degrees * DEGREE, ..ChainErrors::default() }
}

/// Every number of the specification's table, to its last digit (half a unit and its rounding).
#[test]
fn lateral_and_heading_deviations_match_the_table() {
    let modules = [2, 3, 4, 6, 8, 12, 16, 20];
    let rows = [
        (0.5, [0.0200, 0.0374, 0.0580, 0.1070, 0.1650, 0.3035, 0.4675, 0.6534]),
        (1.0, [0.0400, 0.0749, 0.1160, 0.2140, 0.3301, 0.6070, 0.9349, 1.3068]),
        (2.0, [0.0800, 0.1498, 0.2320, 0.4281, 0.6601, 1.2140, 1.8698, 2.6136]),
    ];
    let headings = [1.41, 1.73, 2.00, 2.45, 2.83, 3.46, 4.00, 4.47];
    let body = ModuleDimensions::default();
    for (sigma, lateral) in rows {
        for ((n, lateral), heading) in modules.into_iter().zip(lateral).zip(headings) {
            let ours = lateral_sigma(&body, n, sigma * DEGREE) / body.face;
            assert!((ours - lateral).abs() < 0.6e-4, "{n} modules, {sigma}°: {ours} for {lateral}");
            let degrees = heading_sigma(n, sigma * DEGREE) / DEGREE;
            assert!((degrees - sigma * heading).abs() < 0.006 * sigma, "{n}: {degrees}");
        }
    }
    // The sum of (j + ½)² over j < 12.
    let sum = (lateral_sigma(&body, 12, 1.0) / body.pitch).powi(2);
    assert!((sum - 575.0).abs() < 1e-9, "{sum}");
}

#[test]
fn the_closed_form_is_the_first_order_of_a_straight_chain() {
    let body = ModuleDimensions { pitch: 80.0, face: 50.0, overhang: 31.0, length: 70.0 };
    for body in [body, ModuleDimensions::default()] {
        for n in 1..=20 {
            let result = Closing::straight(body, n).first_order(&joints(1.0));
            let [lateral, normal, angle] = result.sigmas();
            assert!((lateral / lateral_sigma(&body, n, DEGREE) - 1.0).abs() < 1e-12);
            assert!((angle / heading_sigma(n, DEGREE) - 1.0).abs() < 1e-12);
            assert!(normal < 1e-12, "a straight chain has no gap to first order");
        }
    }
    // √3/2 in the limit of many modules.
    let result = Closing::straight(ModuleDimensions::default(), 200).first_order(&joints(1.0));
    assert!((result.correlation() - 0.75f64.sqrt()).abs() < 1e-3);
}

/// Random chains, exactly, within 1 % of the formula for 2 to 20 modules at 1°. The standard error of a
/// deviation from 60 000 chains is 0.29 %; effects beyond first order take 0.2 % of the lateral deviation at
/// 20 modules.
#[test]
fn random_chains_agree_with_the_formula_within_a_percent() {
    let (body, exec) = (ModuleDimensions::default(), Exec::new());
    for n in 2..=20 {
        let cloud = Closing::straight(body, n).cloud(&joints(1.0), 1, 60_000, &exec).unwrap();
        let [lateral, _, angle] = Covariance::of(&cloud).sigmas();
        let ratios =
            [lateral / lateral_sigma(&body, n, DEGREE), angle / heading_sigma(n, DEGREE)].map(|r| r - 1.0);
        assert!(ratios.iter().all(|r| r.abs() < 0.01), "{n}: {ratios:?}");
    }
}

#[test]
fn threads_and_the_number_of_chains_change_nothing() {
    let errors = ChainErrors { encoder_step: 0.01, link_sigma: 0.3, base_sigma: 0.01, ..joints(2.0) };
    let closing = Closing::straight(ModuleDimensions::default(), 9);
    let cloud =
        |threads, chains| closing.cloud(&errors, 5, chains, &Exec::new().with_threads(threads).unwrap());
    let one = cloud(1, 2000).unwrap();
    assert_eq!(cloud(2, 2000).unwrap(), one);
    assert_eq!(cloud(4, 700).unwrap(), one[..700]);
    assert_ne!(closing.cloud(&errors, 6, 700, &Exec::new()).unwrap(), one[..700]);
}

/// Covariance of (lateral, normal, angle) at the closing link of the O: the published numbers to their digits.
#[test]
fn the_ring_closes_with_the_published_covariance() {
    for (first_corner, lateral, correlation) in [(1, 9.23, 0.62), (2, 7.23, 0.0), (3, 9.23, -0.62)] {
        let angles = ChainShape::O { first_corner }.angles();
        let latch = latches(&angles)[0];
        let result =
            Closing::latch(ModuleDimensions::default(), &angles, &latch, &[]).first_order(&joints(1.0));
        let sigmas = result.sigmas();
        assert!((sigmas[0] - lateral).abs() < 0.006, "{first_corner}: {sigmas:?}");
        assert!((sigmas[1] - 11.25).abs() < 0.006 && (sigmas[2] / DEGREE - 3.46).abs() < 0.006);
        assert!((result.correlation() - correlation).abs() < 0.006, "{first_corner}: {result:?}");
    }
    // 5.5 times less than a straight chain of as many modules.
    let straight = lateral_sigma(&ModuleDimensions::default(), 12, DEGREE);
    assert!((straight / 7.23 - 5.5).abs() < 0.01, "{}", straight / 7.23);
}

/// In a latched loop nothing is wrong: of the second latch only the joints outside of the first count.
#[test]
fn joints_in_a_latched_loop_add_no_error() {
    let of = |reading| {
        let angles = ChainShape::Block { reading }.angles();
        let latches = latches(&angles);
        Closing::latch(ModuleDimensions::default(), &angles, &latches[1], &latches[..1])
    };
    assert_eq!(of(Reading::Middle).joints(), [2, 6]);
    assert_eq!(of(Reading::Tail).joints(), [2, 3]);
    // Middle: levers of joint 2 at (a, 0) and 6 at (0, −a) on the face at (0, −½ a), along x: ½ a each.
    let [lateral, _, angle] = of(Reading::Middle).first_order(&joints(1.0)).sigmas();
    assert!(
        (lateral - 47.5 * DEGREE * 2f64.sqrt()).abs() < 1e-9 && (angle - DEGREE * 2f64.sqrt()).abs() < 1e-12
    );
}

#[test]
fn every_optional_term_has_its_closed_form() {
    let body = ModuleDimensions::default();
    let of = |errors: ChainErrors, n| Closing::straight(body, n).first_order(&errors);
    let n = 8;
    // Links lengthen a straight chain, and nothing else.
    let result = of(ChainErrors { link_sigma: 0.2, ..ChainErrors::default() }, n);
    assert!((result.sigmas()[1] - 0.2 * 7f64.sqrt()).abs() < 1e-12 && result.sigmas()[0] < 1e-12);
    // A turned base is a joint at the first rotor.
    let result = of(ChainErrors { base_sigma: DEGREE, ..ChainErrors::default() }, n);
    assert!((result.sigmas()[0] - 7.5 * 95.0 * DEGREE).abs() < 1e-9 && result.sigmas()[2] == DEGREE);
    let result = of(ChainErrors { base_offset_sigma: 3.0, ..ChainErrors::default() }, n);
    assert!(
        (result.sigmas()[0] - 3.0).abs() + (result.sigmas()[1] - 3.0).abs() < 1e-12
            && result.sigmas()[2] == 0.0
    );
    // A uniform error of width s has the deviation s/√12.
    let result = of(ChainErrors { encoder_step: 12f64.sqrt() * DEGREE, ..ChainErrors::default() }, n);
    assert!((result.sigmas()[0] / lateral_sigma(&body, n, DEGREE) - 1.0).abs() < 1e-12);
    // A side force bends every joint by its lever: c F Σ l², with Σ l² = 575 a² for 12 modules.
    let result = of(ChainErrors { compliance: 1e-3, side_force: 2.0, ..ChainErrors::default() }, 12);
    assert!((result.mean[0] - 2e-3 * 575.0 * 95.0 * 95.0 / 1e3).abs() < 1e-9, "{:?}", result.mean);
    assert!((result.mean[2] - 2e-3 * 72.0 * 0.095).abs() < 1e-12, "{:?}", result.mean);
}

proptest! {
    /// First order compared with random chains, for folded chains with all errors. 4 000 chains: 1.1 %
    /// standard error of a deviation, and small errors, so that effects beyond first order are far less; 6 %
    /// is more than five standard errors.
    #[test]
    fn first_order_agrees_with_random_chains(
        first_corner in FIRST_CORNERS, seed in 0u64..1000, link in 0.1..1.0f64, step in 0.0..0.01f64,
    ) {
        let angles = ChainShape::O { first_corner }.angles();
        let errors = ChainErrors { link_sigma: link, encoder_step: step, compliance: 1e-4, side_force: 3.0, ..joints(0.3) };
        let closing = Closing::latch(ModuleDimensions::default(), &angles, &latches(&angles)[0], &[]);
        let expected = closing.first_order(&errors);
        let result = Covariance::of(&closing.cloud(&errors, seed, 4000, &Exec::new()).unwrap());
        for ((result, expected), k) in result.sigmas().into_iter().zip(expected.sigmas()).zip(0..) {
            prop_assert!((result / expected - 1.0).abs() < 0.06, "{k}: {result} for {expected}");
        }
        for ((off, sigma), mean) in result.mean.into_iter().zip(expected.sigmas()).zip(expected.mean) {
            // Five standard errors of a mean, and second order: levers of 285 mm times the variances of twelve joints.
            let second = 12.0 * 285.0 * (0.3 * DEGREE + step).powi(2);
            prop_assert!((off - mean).abs() < 5.0 * sigma / 4000f64.sqrt() + second, "{off} for {mean}");
        }
    }
}
