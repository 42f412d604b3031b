//! The body of a PLY file, element by element: as lines, or as bytes.

use super::header::{Dialect, Element, Header, Kind};
use std::str::from_utf8;

/// The unread rest of a body.
pub(super) struct Body<'t> {
    bytes: &'t [u8],
    at: usize,
    dialect: Dialect,
    /// Lines before `at`; of a text alone.
    lines: usize,
}

impl<'t> Body<'t> {
    pub(super) const fn new(bytes: &'t [u8], header: &Header) -> Self {
        Self { bytes, at: header.end, dialect: header.dialect, lines: header.lines }
    }

    /// Reads an element, and gives every number with that of its property.
    pub(super) fn next(&mut self, element: &Element, mut each: impl FnMut(usize, f64)) -> Result<(), String> {
        if self.dialect == Dialect::Text { self.line(element, each) } else { self.binary(element, &mut each) }
    }

    /// Passes over all elements of a kind.
    pub(super) fn pass(&mut self, element: &Element) -> Result<(), String> {
        if self.dialect != Dialect::Text && element.properties.iter().all(|own| own.count.is_none()) {
            let one: usize = element.properties.iter().map(|own| own.kind.bytes()).sum();
            let all = usize::try_from(element.count).ok().and_then(|count| count.checked_mul(one));
            return self.take(all.unwrap_or(usize::MAX)).map(drop);
        }
        if self.dialect == Dialect::Text {
            return (0..element.count).try_for_each(|_| self.take_line().map(drop));
        }
        (0..element.count).try_for_each(|_| self.next(element, |_, _| {}))
    }

    fn take_line(&mut self) -> Result<&'t [u8], String> {
        let rest = &self.bytes[self.at..];
        if rest.is_empty() {
            return Err(format!("line {}: the file was cut off", self.lines + 1));
        }
        let end = rest.iter().position(|byte| *byte == b'\n');
        self.at += end.map_or(rest.len(), |end| end + 1);
        self.lines += 1;
        Ok(&rest[..end.unwrap_or(rest.len())])
    }

    fn line(&mut self, element: &Element, mut each: impl FnMut(usize, f64)) -> Result<(), String> {
        let line = self.take_line()?;
        let number = self.lines;
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let mut word = |kind: Kind, name: &str| {
            let word = words.next().ok_or_else(|| format!("line {number}: `{name}` is missing"))?;
            let read: Option<f64> = from_utf8(word).ok().and_then(|word| word.parse().ok());
            let is_right = |read: &f64| kind.is_float() || read.fract() == 0.0;
            read.filter(is_right).ok_or_else(|| {
                let shown = catchment_design::design::shortened(&String::from_utf8_lossy(word));
                format!("line {number}: `{shown}` is no number that `{name}` could have")
            })
        };
        for (k, property) in element.properties.iter().enumerate() {
            match property.count {
                None => each(k, word(property.kind, &property.name)?),
                Some(kind) => {
                    let count = word(kind, &property.name)?;
                    // As many words as the line has, at most.
                    for _ in 0..count.max(0.0) as u64 {
                        each(k, word(property.kind, &property.name)?);
                    }
                }
            }
        }
        if words.next().is_some() {
            return Err(format!(
                "line {number}: there are more numbers than `{}` has properties",
                element.name
            ));
        }
        Ok(())
    }

    fn binary(&mut self, element: &Element, each: &mut impl FnMut(usize, f64)) -> Result<(), String> {
        for (k, property) in element.properties.iter().enumerate() {
            let count = match property.count {
                None => 1,
                Some(kind) => {
                    let at = self.at;
                    let count = self.number(kind)?;
                    if count < 0.0 {
                        return Err(format!("byte {at}: the list `{}` has {count} members", property.name));
                    }
                    count as u64
                }
            };
            // No longer than the bytes that are left.
            for _ in 0..count {
                each(k, self.number(property.kind)?);
            }
        }
        Ok(())
    }

    fn cut_off(&self) -> String {
        format!("byte {}: the file was cut off", self.bytes.len())
    }

    fn take(&mut self, count: usize) -> Result<&'t [u8], String> {
        let taken = self.bytes[self.at..].get(..count).ok_or_else(|| self.cut_off())?;
        self.at += count;
        Ok(taken)
    }

    fn number(&mut self, kind: Kind) -> Result<f64, String> {
        let mut bytes = [0; 8];
        let size = kind.bytes();
        bytes[..size].copy_from_slice(self.take(size)?);
        if self.dialect == Dialect::BigEndian {
            bytes[..size].reverse();
        }
        // Little-endian from here on, zeros above.
        let whole = u64::from_le_bytes(bytes);
        Ok(match kind {
            Kind::Float { bytes: 4 } => f64::from(f32::from_bits(whole as u32)),
            Kind::Float { .. } => f64::from_bits(whole),
            Kind::Int { is_signed: false, .. } => whole as f64,
            Kind::Int { bytes, .. } => {
                let unused = 64 - 8 * bytes as u32;
                ((whole << unused).cast_signed() >> unused) as f64
            }
        })
    }
}
