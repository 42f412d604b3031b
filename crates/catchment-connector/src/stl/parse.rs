//! From bytes to triangles, both dialects.

use crate::mesh::{self, FileOffset, MeshProblem, Triangle, TriangleLocation};
use crate::source::most_bytes;
use catchment_design::design::MeshPreparation;
use glam::DVec3;

/// Header and triangle count of a binary file.
const HEADER: usize = 84;
/// Bytes per triangle of a binary file: normal, three corners, attribute.
const RECORD: usize = 50;
/// Longest piece of a file that a message repeats.
const SHOWN: usize = 24;

/// Parses the first `bytes` of a file of `size` bytes.
pub(super) fn parse(
    bytes: &[u8],
    size: u64,
    treatment: MeshPreparation,
) -> Result<Vec<Triangle>, Vec<MeshProblem>> {
    if bytes.is_empty() {
        return Err(vec![MeshProblem::Empty]);
    }
    Ok(if is_binary(bytes, size) {
        refuse_binary(bytes, size, treatment)?;
        binary(&bytes[HEADER..])
    } else {
        let most = most_bytes(treatment);
        if size > most {
            return Err(vec![MeshProblem::TooLong { bytes: size, most }]);
        }
        ascii(bytes, treatment).map_err(|problem| vec![problem])?
    })
}

/// Refuses a binary file by its header: the first `bytes` hold it.
pub(super) fn refuse_early(
    bytes: &[u8],
    size: u64,
    treatment: MeshPreparation,
) -> Result<(), Vec<MeshProblem>> {
    if is_binary(bytes, size) { refuse_binary(bytes, size, treatment) } else { Ok(()) }
}

/// Triangles that a binary header announces.
fn announced(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER - 4..HEADER)?.try_into().ok()?;
    Some(u64::from(u32::from_le_bytes(count)))
}

/// Bytes of a binary file of so many triangles.
const fn length(triangles: u64) -> u64 {
    HEADER as u64 + RECORD as u64 * triangles
}

fn is_binary(bytes: &[u8], size: u64) -> bool {
    announced(bytes).is_some_and(|count| length(count) == size) || !looks_like_text(bytes)
}

fn refuse_binary(bytes: &[u8], size: u64, treatment: MeshPreparation) -> Result<(), Vec<MeshProblem>> {
    let problem = match announced(bytes) {
        None => MeshProblem::NotStl { found: size },
        Some(triangles) if length(triangles) != size => {
            MeshProblem::Length { triangles, expected: length(triangles), found: size }
        }
        Some(triangles) if triangles > mesh::most_read(treatment) as u64 => {
            mesh::too_many(treatment, triangles)
        }
        Some(_) => return Ok(()),
    };
    Err(vec![problem])
}

/// Whether the file begins with the word `solid` and holds no zero byte, as every binary header does.
fn looks_like_text(bytes: &[u8]) -> bool {
    let text = bytes.trim_ascii_start();
    text.len() >= 5 && text[..5].eq_ignore_ascii_case(b"solid") && !bytes.contains(&0)
}

fn binary(records: &[u8]) -> Vec<Triangle> {
    records
        .chunks_exact(RECORD)
        .enumerate()
        .map(|(triangle, record)| {
            let number = |k: usize| {
                let at = 12 + 4 * k;
                let bytes = [record[at], record[at + 1], record[at + 2], record[at + 3]];
                f64::from(f32::from_le_bytes(bytes))
            };
            let corner = |k: usize| DVec3::new(number(3 * k), number(3 * k + 1), number(3 * k + 2));
            Triangle {
                corners: [corner(0), corner(1), corner(2)],
                place: TriangleLocation { triangle, start: FileOffset::Byte(HEADER + RECORD * triangle) },
            }
        })
        .collect()
}

type Split<'a> = std::slice::Split<'a, u8, fn(&u8) -> bool>;

/// The non-empty lines of an ASCII file, with their numbers.
struct Lines<'a> {
    lines: std::iter::Enumerate<Split<'a>>,
    last: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<(usize, Vec<&'a [u8]>)> {
        for (k, line) in self.lines.by_ref() {
            self.last = k + 1;
            let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty()).collect();
            if !words.is_empty() {
                return Some((k + 1, words));
            }
        }
        None
    }

    /// The next line, which must begin with the words of `expected`; returns the words after them.
    fn expect(&mut self, expected: &'static str) -> Result<(usize, Vec<&'a [u8]>), MeshProblem> {
        let Some((line, words)) = self.next() else {
            return Err(MeshProblem::Syntax {
                line: self.last,
                expected,
                found: "the end of the file".into(),
            });
        };
        let keywords = expected.split(' ').count();
        if begins(&words, expected) {
            Ok((line, words[keywords..].to_vec()))
        } else {
            Err(MeshProblem::Syntax { line, expected, found: shown(&words) })
        }
    }
}

fn begins(words: &[&[u8]], keywords: &str) -> bool {
    let mut given = words.iter();
    keywords.split(' ').all(|k| given.next().is_some_and(|w| w.eq_ignore_ascii_case(k.as_bytes())))
}

fn shown(words: &[&[u8]]) -> String {
    let text: String = String::from_utf8_lossy(&words.join(&b' ')).chars().take(SHOWN).collect();
    format!("`{}`", text.escape_debug())
}

fn ascii(bytes: &[u8], treatment: MeshPreparation) -> Result<Vec<Triangle>, MeshProblem> {
    let is_newline: fn(&u8) -> bool = |b| *b == b'\n';
    let mut lines = Lines { lines: bytes.split(is_newline).enumerate(), last: 1 };
    let mut triangles = Vec::new();
    lines.expect("solid")?;
    let mut inside = true;
    loop {
        let Some((line, words)) = lines.next() else {
            if inside {
                let found = "the end of the file: it was cut off".into();
                return Err(MeshProblem::Syntax { line: lines.last, expected: "facet or endsolid", found });
            }
            return Ok(triangles);
        };
        if inside && begins(&words, "facet") {
            let triangle = triangles.len();
            if triangle == mesh::most_read(treatment) {
                return Err(mesh::too_many(treatment, count_facets(bytes)));
            }
            lines.expect("outer loop")?;
            let mut corners = [DVec3::ZERO; 3];
            for corner in &mut corners {
                *corner = vertex(lines.expect("vertex")?)?;
            }
            lines.expect("endloop")?;
            lines.expect("endfacet")?;
            triangles.push(Triangle {
                corners,
                place: TriangleLocation { triangle, start: FileOffset::Line(line) },
            });
        } else if inside && begins(&words, "endsolid") {
            inside = false;
        } else if !inside && begins(&words, "solid") {
            inside = true;
        } else {
            let expected = if inside { "facet or endsolid" } else { "solid or the end of the file" };
            return Err(MeshProblem::Syntax { line, expected, found: shown(&words) });
        }
    }
}

fn vertex((line, words): (usize, Vec<&[u8]>)) -> Result<DVec3, MeshProblem> {
    let wrong = || MeshProblem::Syntax { line, expected: "three numbers after vertex", found: shown(&words) };
    let [x, y, z] = words[..] else { return Err(wrong()) };
    let number = |w: &[u8]| std::str::from_utf8(w).ok().and_then(|t| t.parse::<f64>().ok()).ok_or_else(wrong);
    Ok(DVec3::new(number(x)?, number(y)?, number(z)?))
}

/// How many triangles a text file announces, for the message only.
fn count_facets(bytes: &[u8]) -> u64 {
    bytes.split(|b| *b == b'\n').filter(|line| line.trim_ascii_start().starts_with(b"facet")).count() as u64
}
