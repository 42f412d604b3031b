//! Mutated copies of valid input, the same ones in every run.

/// Random numbers: a counter, scrambled (`splitmix64`).
pub(crate) struct Dice(u64);

impl Dice {
    /// The same numbers for the same seed.
    pub(crate) const fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform below `n`; 0 for `n` = 0.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }

    /// One element at random.
    pub(crate) fn one<'a, T>(&mut self, of: &'a [T]) -> &'a T {
        let at = self.below(of.len());
        &of[at]
    }
}

/// Numbers that often break readers.
const NUMBERS: [&str; 16] = [
    "0",
    "-0",
    "-1",
    "1e308",
    "-1e308",
    "1e-320",
    "1e999",
    "nan",
    "inf",
    "0.1",
    "255",
    "65536",
    "4294967295",
    "18446744073709551615",
    "18446744073709551616",
    "1.7976931348623157e308",
];

/// Tokens that have a meaning for a reader.
const PIECES: [&[u8]; 18] = [
    b"\0",
    b"\x1b[2J",
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"\n",
    b"\r",
    b",",
    b"\"",
    b"[",
    b"{",
    b"}",
    b"=",
    b" mm",
    b" deg",
    b"null",
    b"\xe2\x80\xae",
    b"\xc2\x9b",
    b"////////",
];

/// A copy of `seed` with one to four mutations; `others` supply pieces.
pub(crate) fn spoilt(dice: &mut Dice, seed: &[u8], others: &[Vec<u8>]) -> Vec<u8> {
    // Longest piece to copy or delete, and longest input.
    const PIECE: usize = 200;
    const LONGEST: usize = 1 << 20;
    let mut bytes = seed.to_vec();
    for _ in 0..=dice.below(4) {
        let at = dice.below(bytes.len() + 1);
        let end = (at + dice.below(PIECE)).min(bytes.len());
        match dice.below(9) {
            0 if !bytes.is_empty() => {
                let at = at.min(bytes.len() - 1);
                bytes[at] ^= 1 << dice.below(8);
            }
            1 if !bytes.is_empty() => {
                let at = at.min(bytes.len() - 1);
                bytes[at] = dice.next() as u8;
            }
            2 => drop(bytes.drain(at..end)),
            3 => {
                let piece = bytes[at..end].to_vec();
                bytes.splice(at..at, piece);
            }
            4 => {
                bytes.splice(at..at, dice.one(&PIECES).iter().copied());
            }
            5 | 6 => number(dice, &mut bytes, at),
            7 => {
                let other = dice.one(others);
                let from = dice.below(other.len() + 1);
                let to = (from + dice.below(PIECE)).min(other.len());
                bytes.splice(at..end, other[from..to].iter().copied());
            }
            _ => bytes.truncate(at),
        }
    }
    bytes.truncate(LONGEST);
    bytes
}

/// Replaces the next number by another one.
fn number(dice: &mut Dice, bytes: &mut Vec<u8>, at: usize) {
    let is_digit = |byte: &u8| byte.is_ascii_digit() || *byte == b'.';
    let Some(start) = bytes[at..].iter().position(is_digit).map(|k| at + k) else { return };
    let length = bytes[start..].iter().take_while(|byte| is_digit(byte)).count();
    bytes.splice(start..start + length, dice.one(&NUMBERS).bytes());
}
