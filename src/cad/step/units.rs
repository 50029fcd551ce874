//! Units of length of a file's representation contexts.

use std::collections::BTreeSet;

use super::super::Trouble;
use super::part21::Exchange;
use super::value::{Instance, Value};

/// Conversions of units into other units, at most.
const DEEPEST: usize = 8;
/// Contexts in a file, at most.
const CONTEXTS: usize = 20_000;
/// Units of one context that are looked at.
const UNITS: usize = 16;
/// Different units of length in a file, at most.
const DIFFERENT: usize = 8;

/// A context and its unit of length.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Context {
    id: u64,
    /// mm.
    unit: f64,
}

/// The unit of length, in mm, in which the instance at `place` is given; `None` when the file names none.
pub(super) fn length_unit(file: &Exchange, place: usize) -> Result<Option<f64>, Trouble> {
    let mut contexts: Vec<Context> = Vec::new();
    for at in 0..file.len() {
        if let Some(unit) = context_unit(file, at)? {
            contexts.push(Context { id: file.id(at), unit });
            if contexts.len() > CONTEXTS {
                let message = format!("the file has more than {CONTEXTS} contexts of units");
                return Err(Trouble::file(file.line(at), message));
            }
        }
    }
    let mut units: Vec<f64> = contexts.iter().map(|c| c.unit).collect();
    units.sort_by(f64::total_cmp);
    units.dedup();
    if units.len() <= 1 {
        return Ok(units.first().copied());
    }
    if units.len() > DIFFERENT {
        let message = format!("the file has {} different units of length", units.len());
        return Err(Trouble::file(file.line(place), message));
    }
    let holds = |unit: &f64| {
        let ids = contexts.iter().filter(|c| c.unit == *unit).map(|c| c.id);
        reaches(file, &ids.collect(), place)
    };
    Ok(units.into_iter().find(holds))
}

/// The unit of length of the context at a place, if it is one.
fn context_unit(file: &Exchange, at: usize) -> Result<Option<f64>, Trouble> {
    const NAME: &str = "GLOBAL_UNIT_ASSIGNED_CONTEXT";
    if !file.body(at).starts_with('(') && file.keyword(at) != NAME || !file.body(at).contains(NAME) {
        return Ok(None);
    }
    let instance = file.instance(at)?;
    let values = if instance.is_complex() { instance.of(NAME) } else { Some(instance.all()) };
    let units = values.and_then(|v| v.last()).and_then(Value::references);
    for id in units.ok_or_else(|| file.wrong(at, "list of units"))?.into_iter().take(UNITS) {
        if let Some(mm) = unit_in_mm(file, id, at, 0)? {
            return Ok(Some(mm));
        }
    }
    Ok(None)
}

/// A unit in mm, if it is one of length.
fn unit_in_mm(file: &Exchange, id: u64, from: usize, depth: usize) -> Result<Option<f64>, Trouble> {
    let (place, unit) = file.small(id, from)?;
    if depth > DEEPEST {
        return Err(file.wrong(from, "unit that ends in metres"));
    }
    if let Some(metres) = si_metres(&unit) {
        return Ok(metres.map(|m| m * 1000.0));
    }
    let Some(values) = unit.of("CONVERSION_BASED_UNIT") else { return Ok(None) };
    if unit.is_complex() && !unit.is("LENGTH_UNIT") {
        return Ok(None);
    }
    let factor = values.last().and_then(Value::reference).ok_or_else(|| file.wrong(place, "factor"))?;
    let (at, measure) = file.small(factor, place)?;
    let [Value::Typed(..) | Value::Number(_), Value::Reference(base)] = measure.all() else {
        return Err(file.wrong(at, "measure and unit"));
    };
    let size = measure.all().first().and_then(Value::number).filter(|x| *x > 0.0);
    let size = size.ok_or_else(|| file.wrong(at, "measure above 0"))?;
    Ok(unit_in_mm(file, *base, at, depth + 1)?.map(|mm| mm * size))
}

/// Outer `None`: no SI unit; inner: none of length. In metres.
fn si_metres(unit: &Instance<'_>) -> Option<Option<f64>> {
    let values = unit.of("SI_UNIT")?;
    let name = values.last();
    if name != Some(&Value::Word("METRE")) {
        return Some(None);
    }
    let prefix = values.iter().rev().nth(1);
    Some(match prefix {
        Some(Value::Word(word)) => prefix_of(word),
        _ => Some(1.0),
    })
}

fn prefix_of(word: &str) -> Option<f64> {
    const PREFIXES: [(&str, f64); 9] = [
        ("KILO", 1e3),
        ("HECTO", 1e2),
        ("DECA", 1e1),
        ("DECI", 1e-1),
        ("CENTI", 1e-2),
        ("MILLI", 1e-3),
        ("MICRO", 1e-6),
        ("NANO", 1e-9),
        ("MEGA", 1e6),
    ];
    PREFIXES.iter().find(|(name, _)| *name == word).map(|(_, factor)| *factor)
}

/// Whether a representation in one of these contexts holds the instance at `target`, directly or not.
fn reaches(file: &Exchange, contexts: &BTreeSet<u64>, target: usize) -> bool {
    let mut seen = vec![false; file.len()];
    let mut open: Vec<usize> = Vec::new();
    for at in 0..file.len() {
        let keyword = file.keyword(at);
        let holds = |id: u64| contexts.contains(&id);
        if keyword.ends_with("REPRESENTATION") && references(file.body(at)).last().is_some_and(holds) {
            open.push(at);
        }
    }
    while let Some(at) = open.pop() {
        if at == target {
            return true;
        }
        if core::mem::replace(&mut seen[at], true) {
            continue;
        }
        open.extend(references(file.body(at)).filter_map(|id| file.place(id)).filter(|&p| !seen[p]));
    }
    false
}

/// What an instance's text refers to, in order.
fn references(body: &str) -> impl Iterator<Item = u64> {
    // Every second piece between quotes is text.
    body.split('\'').step_by(2).flat_map(|piece| {
        piece.split('#').skip(1).filter_map(|rest| {
            let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
            rest.get(..end)?.parse().ok()
        })
    })
}
