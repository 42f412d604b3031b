//! Parser of distributions: from a file, or a line.

use super::super::{FAMILY, defect, shortened};
use super::{Circumstance, Dynamics, ScalarDistribution};
use crate::design::{Design, Quantity, SourceText, nearest};
use catchment_base::diagnostic::{Diagnostic, DiagnosticCollector, Diagnostics};
use catchment_base::suggest::{number_help, value_help};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Share of a law that has to lie in its range.
const MOST_OF_IT: f64 = 0.5;
/// Most values of a measured law.
const MOST_VALUES: usize = 100_000;
/// How a law is written on a line.
const FORM: &str = "such as \"50 mm/s\", \"50 ± 10 mm/s\", \"40..60 mm/s\" or \"0.2 */ 1.3\"";
/// How it is written as a table.
const TABLES: &str = "{ mean, sigma }, { from, to }, { median, factor } or { measured = [ … ] }";

/// Reads `speed=50 ± 10 mm/s` for a design.
///
/// # Errors
/// The errors of the text, with their byte ranges.
pub fn parse_draw(text: &str, design: &Design) -> Result<(Circumstance, ScalarDistribution), Diagnostics> {
    Ok(draw(text, design)?)
}

fn draw(text: &str, design: &Design) -> Result<(Circumstance, ScalarDistribution), Diagnostic> {
    let Some((name, law)) = text.split_once('=') else {
        let message = format!("`{}` is no circumstance and its law", shortened(text));
        return Err(placed(0..text.len(), defect(message, "write \"friction=0.1..0.3\"")));
    };
    let of = named(name.trim()).map_err(|fault| placed(0..name.len(), fault))?;
    let law = line(law, of, design).and_then(|law| sound(law, of));
    law.map(|law| (of, law)).map_err(|fault| placed(name.len() + 1..text.len(), fault))
}

/// Reads a file with a table `[dynamics]` for a design.
///
/// # Errors
/// Everything that is wrong with the file, each in its place.
pub fn read_dynamics(source: &SourceText, design: &Design) -> Result<Dynamics, Diagnostics> {
    let (document, syntax) = DeTable::parse_recoverable(&source.text);
    let mut diagnostics = DiagnosticCollector::default();
    let broken: Vec<Range<usize>> = syntax.iter().map(|error| error.span().unwrap_or(0..0)).collect();
    for (error, span) in syntax.iter().zip(&broken) {
        let help = value_help(&source.text, span.start);
        let fault = Diagnostic::error(FAMILY, error.message().to_owned(), help);
        diagnostics.push_at(fault, || Some(span.clone()));
    }
    let mut reader = Reader { diagnostics, broken, design, dynamics: Dynamics::default() };
    reader.file(document.get_ref());
    let Reader { diagnostics, dynamics, .. } = reader;
    diagnostics.refuse().map_err(|diagnostics| diagnostics.of(source.clone()))?;
    Ok(dynamics)
}

struct Reader<'a> {
    diagnostics: DiagnosticCollector,
    /// Ranges in which the text is not TOML: errors there are consequences.
    broken: Vec<Range<usize>>,
    design: &'a Design,
    dynamics: Dynamics,
}

impl Reader<'_> {
    fn note(&mut self, fault: Diagnostic) {
        let span = fault.span.clone().unwrap_or_default();
        if !self.broken.iter().any(|b| b.start <= span.end && span.start <= b.end) {
            self.diagnostics.push(fault.at(Some(span)));
        }
    }

    fn file(&mut self, root: &DeTable<'_>) {
        const HELP: &str = "begin with [dynamics]";
        for (name, _) in root.iter().filter(|(name, _)| name.get_ref() != "dynamics") {
            let message = format!("unknown key `{}` in the file", shortened(name.get_ref()));
            self.note(placed(name.span(), defect(message, HELP)));
        }
        let Some(value) = root.get("dynamics") else {
            if self.broken.is_empty() {
                self.note(placed(0..0, defect("the file declares no dynamics", HELP)));
            }
            return;
        };
        let DeValue::Table(table) = value.get_ref() else {
            self.note(placed(value.span(), defect("`dynamics` is no table", HELP)));
            return;
        };
        if table.is_empty() && self.broken.is_empty() {
            let message = "it declares nothing";
            self.note(placed(value.span(), defect(message, "such as speed = \"50 ± 10 mm/s\"")));
        }
        for (name, value) in table {
            let of = match named(name.get_ref()) {
                Ok(of) => of,
                Err(fault) => {
                    self.note(placed(name.span(), fault));
                    continue;
                }
            };
            match self
                .law(value, of)
                .and_then(|law| sound(law, of).map_err(|fault| placed(value.span(), fault)))
            {
                Ok(law) => self.dynamics.declared.insert(of, law).map_or((), |_| ()),
                Err(fault) => self.note(fault),
            }
        }
    }

    fn law(&mut self, value: &Value<'_>, of: Circumstance) -> Result<ScalarDistribution, Diagnostic> {
        if let DeValue::Table(table) = value.get_ref() {
            return self.table(table, value.span(), of);
        }
        line(&written(value)?, of, self.design).map_err(|fault| placed(value.span(), fault))
    }

    fn table(
        &mut self,
        table: &DeTable<'_>,
        span: Range<usize>,
        of: Circumstance,
    ) -> Result<ScalarDistribution, Diagnostic> {
        const KEYS: [&str; 7] = ["mean", "sigma", "from", "to", "median", "factor", "measured"];
        for (name, _) in table {
            if !KEYS.contains(&&**name.get_ref()) {
                let help = nearest(name.get_ref(), KEYS)
                    .map_or_else(|| TABLES.to_owned(), |meant| format!("did you mean `{meant}`?"));
                let message = format!("unknown key `{}` in {}", shortened(name.get_ref()), of.name());
                return Err(placed(name.span(), defect(message, help)));
            }
        }
        let design = self.design;
        let number = |key: &str, bare: bool| match table.get(key) {
            Some(value) => {
                let text = written(value)?;
                let read = if bare { plain(&text) } else { quantity(&text, of, None, design) };
                read.map(Some).map_err(|fault| placed(value.span(), fault))
            }
            None => Ok(None),
        };
        let of_two = |first: &str, second: &str, bare: bool| {
            Ok::<_, Diagnostic>(number(first, false)?.zip(number(second, bare)?).filter(|_| table.len() == 2))
        };
        if let Some((mean, sigma)) = of_two("mean", "sigma", false)? {
            return Ok(ScalarDistribution::Normal { mean, sigma });
        }
        if let Some((from, to)) = of_two("from", "to", false)? {
            return Ok(ScalarDistribution::Uniform { from, to });
        }
        if let Some((median, factor)) = of_two("median", "factor", true)? {
            return Ok(ScalarDistribution::Lognormal { median, factor });
        }
        let list = table.get("measured").filter(|_| table.len() == 1);
        let Some(list) = list else {
            let message = format!("the law of {} is not complete, or two at once", of.name());
            return Err(placed(span, defect(message, TABLES)));
        };
        let DeValue::Array(values) = list.get_ref() else {
            return Err(placed(list.span(), defect("`measured` is no list", "measured = [0.1, 0.2]")));
        };
        if values.is_empty() || values.len() > MOST_VALUES {
            let message = format!("{} measured values", values.len());
            return Err(placed(list.span(), defect(message, format!("give 1 to {MOST_VALUES}"))));
        }
        let mut measured = Vec::new();
        for value in values {
            let read = quantity(&written(value)?, of, None, design);
            measured.push(read.map_err(|fault| placed(value.span(), fault))?);
        }
        Ok(ScalarDistribution::Measured { measured })
    }
}

fn placed(span: Range<usize>, fault: Diagnostic) -> Diagnostic {
    Diagnostic { span: Some(span), ..fault }
}

type Value<'t> = Spanned<DeValue<'t>>;

/// A number or a text, as it is written.
fn written(value: &Value<'_>) -> Result<String, Diagnostic> {
    match value.get_ref() {
        DeValue::String(text) => Ok(text.to_string()),
        // TOML lets digits be grouped.
        DeValue::Integer(integer) => Ok(integer.as_str().replace('_', "")),
        DeValue::Float(float) => Ok(float.as_str().replace('_', "")),
        _ => Err(placed(value.span(), defect("it is no number and no law", FORM))),
    }
}

/// The circumstance of this name.
fn named(name: &str) -> Result<Circumstance, Diagnostic> {
    let names = Circumstance::ALL.map(Circumstance::name);
    let result = Circumstance::ALL.into_iter().find(|of| of.name() == name);
    result.ok_or_else(|| {
        let help = nearest(name, names)
            .map_or_else(|| format!("one of {}", names.join(", ")), |meant| format!("did you mean {meant}?"));
        defect(format!("there is no circumstance `{}`", shortened(name)), help)
    })
}

/// A law on a line.
fn line(text: &str, of: Circumstance, design: &Design) -> Result<ScalarDistribution, Diagnostic> {
    let two = |separator: &str| {
        let (first, second) = text.split_once(separator)?;
        Some((first.trim(), second.trim()))
    };
    // `50 ± 10 mm/s`: the unit stands once, behind both.
    let both = |(first, second): (&str, &str)| {
        let unit = unit_of(second);
        Ok::<_, Diagnostic>((
            quantity(first, of, Some(unit), design)?,
            quantity(second, of, Some(unit_of(first)), design)?,
        ))
    };
    if let Some(parts) = two("±").or_else(|| two("+-")) {
        let (mean, sigma) = both(parts)?;
        return Ok(ScalarDistribution::Normal { mean, sigma });
    }
    if let Some((median, factor)) = two("*/") {
        return Ok(ScalarDistribution::Lognormal {
            median: quantity(median, of, None, design)?,
            factor: plain(factor)?,
        });
    }
    if let Some(parts) = two("..") {
        let (from, to) = both(parts)?;
        return Ok(ScalarDistribution::Uniform { from, to });
    }
    Ok(ScalarDistribution::constant(quantity(text, of, None, design)?))
}

/// The text after the number.
fn unit_of(text: &str) -> &str {
    let is_unit = |c: char| c.is_alphabetic() || c == '°' || c == '/' || c == ' ';
    let number = text.trim_end_matches(is_unit);
    text[number.len()..].trim()
}

/// A number without a unit.
fn plain(text: &str) -> Result<f64, Diagnostic> {
    let read = text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
    read.ok_or_else(|| {
        let help = number_help(text).unwrap_or_else(|| FORM.to_owned());
        defect(format!("`{}` is no number", shortened(text.trim())), help)
    })
}

/// A number of a parameter, in its unit; a number without a unit has the unit written beside it.
fn quantity(text: &str, of: Circumstance, beside: Option<&str>, design: &Design) -> Result<f64, Diagnostic> {
    let (text, own) = (text.trim(), unit_of(text.trim()));
    let unit = if own.is_empty() { beside.unwrap_or_default() } else { own };
    let number = text[..text.len() - own.len()].trim();
    if number.is_empty() {
        return Err(defect(format!("{}: `{}` is no number", of.name(), shortened(text)), FORM));
    }
    let refusal =
        |c: crate::design::DesignDefect| Diagnostic::error(FAMILY, format!("{}: {c}", of.name()), c.help());
    match of {
        Circumstance::Friction | Circumstance::Restitution if unit.is_empty() => plain(number),
        Circumstance::Friction | Circumstance::Restitution => {
            Err(defect(format!("{} has no unit", of.name()), "give a bare number"))
        }
        Circumstance::Mass => {
            let factor = match unit {
                "" | "kg" => 1.0,
                "g" => 1e-3,
                "lb" => 0.453_592_37,
                _ => {
                    let message = format!("mass: there is no unit `{}`", shortened(unit));
                    return Err(defect(message, "kg, g or lb"));
                }
            };
            Ok(factor * plain(number)?)
        }
        Circumstance::Height => {
            let read = format!("{number} {unit}").parse::<Quantity>().map_err(refusal)?;
            read.length_d(&design.scale()).map_err(refusal)
        }
        _ => {
            let length = match unit.strip_suffix("/s") {
                Some(length) => length.trim(),
                None if unit.is_empty() => "",
                None => {
                    let message = format!("{}: `{}` is no rate", of.name(), shortened(unit));
                    return Err(defect(message, "per second, such as \"50 mm/s\" or \"2 deg/s\""));
                }
            };
            let read = format!("{number} {length}").parse::<Quantity>().map_err(refusal)?;
            let turns =
                matches!(of, Circumstance::SpinRoll | Circumstance::SpinPitch | Circumstance::SpinYaw);
            let value = if turns { read.angle_rad() } else { read.length_d(&design.scale()) };
            value.map_err(refusal)
        }
    }
}

/// A valid distribution within the range of its parameter.
fn sound(law: ScalarDistribution, of: Circumstance) -> Result<ScalarDistribution, Diagnostic> {
    let name = of.name();
    match &law {
        ScalarDistribution::Normal { sigma, .. } if *sigma < 0.0 => {
            return Err(defect(format!("{name}: a standard deviation cannot be negative"), FORM));
        }
        ScalarDistribution::Uniform { from, to } if from > to => {
            return Err(defect(format!("{name}: {from} is above {to}"), "the lower first"));
        }
        ScalarDistribution::Lognormal { median, factor } if *factor < 1.0 || *median <= 0.0 => {
            let message = format!("{name}: a lognormal law has a median above 0 and a factor of 1 or more");
            return Err(defect(message, "such as \"0.2 */ 1.3\""));
        }
        _ => {}
    }
    let [lo, hi] = of.range();
    let inside = law.inside([lo, hi]);
    if inside < MOST_OF_IT {
        let unit = if of.unit().is_empty() { String::new() } else { format!(" {}", of.unit()) };
        let help = format!("it lies from {lo} to {hi}{unit}");
        let message = if law.is_constant() {
            format!("{name} = {}{unit} is out of range", law.mean())
        } else {
            format!("{name}: {:.0} % of this law is out of range", 100.0 * (1.0 - inside))
        };
        return Err(defect(message, help));
    }
    Ok(law)
}
