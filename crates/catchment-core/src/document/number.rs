//! Formats of numbers for people and programs.

use std::fmt::Write;

/// A length in the design's unit, in which D is `width`: to a thousandth of D, also for parts in metres;
/// without a minus sign before zero.
pub fn length(value: f64, width: f64) -> String {
    fixed(value, decimals(width))
}

/// A number with so many decimals; rounding does not print as −0.000.
pub fn fixed(value: f64, decimals: usize) -> String {
    let nothing = 0.5 * 0.1f64.powf(decimals as f64);
    format!("{:.decimals$}", if value.abs() < nothing { 0.0 } else { value })
}

/// Decimals that show a thousandth of D, at least three.
pub fn decimals(width: f64) -> usize {
    /// As many as numbers in double precision have.
    const MOST: f64 = 15.0;
    (LEAST_DECIMALS - width.log10().floor()).clamp(LEAST_DECIMALS, MOST) as usize
}

const LEAST_DECIMALS: f64 = 3.0;

/// A share of 1 as `16.32 %`.
pub fn percent(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}

/// A share of 1 as `16.3 %`.
pub fn tenths(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// The same with the interval of its estimate: `16.3 % (15.1 % … 17.6 %)`.
pub fn tenths_between(share: f64, [low, high]: [f64; 2]) -> String {
    format!("{} ({} … {})", tenths(share), tenths(low), tenths(high))
}

/// A number in short form: up to four decimals, no trailing zeros.
pub fn rounded(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A number rounded to so many significant digits.
pub fn to_digits(value: f64, digits: i32) -> f64 {
    if value == 0.0 || !value.is_finite() { value } else { to_place(value, digits - 1 - order(value)) }
}

/// Coordinates of a point with as many decimals as the largest has at so many significant digits; without −0.
pub fn point_to_digits(point: [f64; 3], digits: i32) -> [f64; 3] {
    /// Less than this is noise, in any unit of a drawing.
    const SMALLEST: f64 = 1e-9;
    let largest = point.iter().fold(SMALLEST, |most: f64, coordinate| most.max(coordinate.abs()));
    point.map(|coordinate| to_place(coordinate, digits - 1 - order(largest)) + 0.0)
}

/// The power of ten of the first digit.
fn order(value: f64) -> i32 {
    value.abs().log10().floor() as i32
}

/// Multiplies or divides by an integer power of ten, which keeps the last digit exact.
fn to_place(value: f64, places: i32) -> f64 {
    let shift = 10f64.powi(places.abs());
    if places >= 0 { (value * shift).round() / shift } else { (value / shift).round() * shift }
}

/// Four significant digits.
pub fn significant(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let magnitude = value.abs().log10().floor();
    if !(-4.0..6.0).contains(&magnitude) {
        return format!("{value:.3e}");
    }
    format!("{value:.*}", (3.0 - magnitude).max(0.0) as usize)
}

/// Four significant digits of a non-negative number, rounded towards 0: for lower bounds.
pub fn rounded_down(value: f64) -> String {
    let digits = 10f64.powf(3.0 - value.log10().floor());
    significant(if value > 0.0 { (value * digits).floor() / digits } else { 0.0 })
}

/// `2.391 ± 0.013`: the farther end of the interval, rounded up to two digits, and the value to as many decimals.
pub fn with_error(value: f64, [lo, hi]: [f64; 2]) -> String {
    let error = (hi - value).max(value - lo);
    if !(error > 0.0 && error.is_finite()) {
        return significant(value);
    }
    // If an interval reaches far to one side, a half-width would mislead; both ends are written.
    if error > value.abs() && lo > 0.0 {
        return format!("{} … {}", significant(lo), significant(hi));
    }
    let decimals = (1.0 - error.log10().floor()).clamp(0.0, 9.0);
    let unit = 10f64.powf(-decimals);
    // Slightly less than a whole unit, so that rounding of the division does not add a unit.
    let up = ((error / unit - 1e-9).ceil()) * unit;
    let decimals = decimals as usize;
    format!("{value:.decimals$} ± {up:.decimals$}")
}

/// The value, and both ends of its interval, to as many decimals as two digits of the interval's half-width need.
pub fn with_interval(value: f64, [lo, hi]: [f64; 2]) -> [String; 3] {
    let error = (hi - value).max(value - lo);
    let decimals =
        if error > 0.0 && error.is_finite() { (1.0 - error.log10().floor()).clamp(0.0, 9.0) } else { 4.0 };
    [value, lo, hi].map(|number| format!("{number:.*}", decimals as usize))
}

/// Thousands kept apart by thin gaps: 24 300 000.
pub fn grouped(n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (position, digit) in digits.chars().enumerate() {
        if position > 0 && (digits.len() - position).is_multiple_of(3) {
            // Writing to a String cannot fail.
            let _ = text.write_char(' ');
        }
        text.push(digit);
    }
    text
}

/// A number with all its digits, as tables for programs have it: the shortest text that reads back as the number.
pub fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), ToOwned::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A peg of 8 mm whose file is in metres, a part in millimetres, and a part in D.
    #[test]
    fn lengths_show_a_thousandth_of_the_width_in_any_unit() {
        assert_eq!(length(0.006_612, 0.007_964), "0.006612");
        assert_eq!([length(12.3456, 50.0), length(0.1, 1.0)], ["12.346", "0.100"]);
        assert_eq!([length(-1e-9, 0.007_964), length(-1e-4, 50.0)], ["0.000000", "0.000"]);
    }

    #[test]
    fn numbers_keep_four_digits() {
        let written = [0.0, 0.012_345, 2.345_67, 23.4567, 12_345.6, 1.5e-7].map(significant);
        assert_eq!(written, ["0", "0.01235", "2.346", "23.46", "12346", "1.500e-7"]);
        let at_least = [0.0, 0.012_349, 9.999_9, 0.5, 12_345.6].map(rounded_down);
        assert_eq!(at_least, ["0", "0.01234", "9.999", "0.5000", "12340"]);
        assert_eq!(grouped(24_300_000), "24 300 000");
        assert_eq!(rounded(-0.5), "-0.5");
        assert_eq!(with_error(2.391_34, [2.380, 2.403_44]), "2.391 ± 0.013");
        assert_eq!(with_error(31.42, [30.0, 32.0]), "31.4 ± 1.5");
        assert_eq!(with_error(2.0, [1.5, 2.1]), "2.00 ± 0.50");
        // Half of it would be more than the number itself.
        assert_eq!(with_error(0.002_053, [0.001_66, 0.004_772]), "0.001660 … 0.004772");
        assert_eq!(with_error(0.0, [0.0, 0.000_961]), "0.00000 ± 0.00097");
    }

    #[test]
    fn lengths_of_single_precision_have_no_noise() {
        let shown =
            [84.209_999_1, 0.0, -0.012_345_678_9, 12_345_678.9, 50.0].map(|value| to_digits(value, 7));
        assert_eq!(shown, [84.21, 0.0, -0.012_345_68, 12_345_680.0, 50.0]);
        assert_eq!(to_digits(f64::INFINITY, 7), f64::INFINITY);
        assert_eq!(point_to_digits([-12.345_678_91, 0.000_000_4, -1e-12], 7), [-12.345_68, 0.0, 0.0]);
        assert_eq!(point_to_digits([0.0, -1e-17, 0.0], 7).map(f64::to_bits), [0; 3]);
    }

    #[test]
    fn programs_get_every_digit() {
        assert_eq!([1.0, -0.1, 1e300, 0.1 + 0.2].map(number), ["1", "-0.1", "1e300", "0.30000000000000004"]);
    }
}
