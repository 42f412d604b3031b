//! Colours that colour-blind readers can distinguish: blue and orange by hue, grey and purple by lightness.

use catchment_core::acceptance::Outcome;

/// Red, green and blue.
pub type Rgb = [u8; 3];

/// Unknown outcome, or no contact.
pub const NOTHING: Rgb = [0xe6, 0xe9, 0xed];
/// The fixed half.
pub const FIXED: Rgb = [0x8f, 0xa9, 0xc9];
/// Its outline.
pub const FIXED_EDGE: Rgb = [0x2d, 0x42, 0x61];
/// The moving half.
pub const MOVING: Rgb = [0xee, 0xb8, 0x6c];
/// Its outline.
pub const MOVING_EDGE: Rgb = [0x82, 0x50, 0x12];

/// The colour of an outcome in a map.
pub const fn outcome(outcome: Outcome) -> Rgb {
    match outcome {
        Outcome::Aligned => [0x4b, 0x95, 0xc9],
        Outcome::Jammed => [0xf4, 0xc0, 0x7a],
        Outcome::Missed => NOTHING,
        Outcome::Undecided => [0x9c, 0x4f, 0x96],
    }
}

/// The colour of an error's curve, in the order of `Dof::ALL` (Okabe and Ito's palette).
pub const CURVES: [Rgb; 5] =
    [[0x00, 0x72, 0xb2], [0xd5, 0x5e, 0x00], [0x00, 0x9e, 0x73], [0xcc, 0x79, 0xa7], [0x7a, 0x6a, 0x00]];

/// Sequential map for heights, low to high: viridis (van der Walt and Smith, CC0) at nine points.
const VIRIDIS: [Rgb; 9] = [
    [0x44, 0x01, 0x54],
    [0x47, 0x2d, 0x7b],
    [0x3b, 0x52, 0x8b],
    [0x2c, 0x72, 0x8e],
    [0x21, 0x91, 0x8c],
    [0x28, 0xae, 0x80],
    [0x5e, 0xc9, 0x62],
    [0xad, 0xdc, 0x30],
    [0xfd, 0xe7, 0x25],
];

/// The colour of `share` in [0, 1].
pub fn sequential(share: f64) -> Rgb {
    let place = share.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let k = (place as usize).min(VIRIDIS.len() - 2);
    mix(VIRIDIS[k], VIRIDIS[k + 1], place - k as f64)
}

/// `share` of `b`, the rest of `a`.
pub fn mix(a: Rgb, b: Rgb, share: f64) -> Rgb {
    let channel = |k: usize| (f64::from(a[k]) * (1.0 - share) + f64::from(b[k]) * share).round() as u8;
    [channel(0), channel(1), channel(2)]
}

/// `#rrggbb`.
pub fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
