//! Post files as trees with places: parsing, checking against the schema, inheriting.

use std::collections::BTreeMap;

use toml::de::{DeTable, DeValue};

use super::schema::{Key, ROOT, Shape};
use crate::diag::{Diagnostic, codes, did_you_mean};
use crate::source::{FileId, Span};

/// A table with the places of its keys and values.
pub type Table = BTreeMap<String, Entry>;

/// A value with its places.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The key.
    pub key: Span,
    /// The value.
    pub value: Span,
    /// What it is.
    pub node: Node,
}

/// A table, or anything else.
#[derive(Debug, Clone)]
pub enum Node {
    /// A table.
    Table(Table),
    /// A scalar or an array.
    Leaf(toml::Value),
}

/// Parses and checks one post file.
///
/// # Errors
/// Every error of the file, with its place.
pub fn parse(file: FileId, text: &str) -> Result<Table, Vec<Diagnostic>> {
    let (root, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        return Err(errors.iter().map(|e| syntax_error(file, text, e)).collect());
    }
    let table = convert_table(file, root.get_ref());
    let mut errors = Vec::new();
    check_table(&table, ROOT, "", &mut errors);
    if errors.is_empty() { Ok(table) } else { Err(errors) }
}

/// The child's keys over the parent's; tables are merged key by key, everything else is replaced.
#[must_use]
pub fn merge(mut parent: Table, child: Table) -> Table {
    for (name, entry) in child {
        match (parent.remove(&name), entry) {
            (Some(Entry { node: Node::Table(old), .. }), Entry { key, value, node: Node::Table(new) }) => {
                parent.insert(name, Entry { key, value, node: Node::Table(merge(old, new)) });
            }
            (_, entry) => {
                parent.insert(name, entry);
            }
        }
    }
    parent
}

/// The tree without places, for deserialisation.
#[must_use]
pub fn plain(table: &Table) -> toml::Table {
    table.iter().map(|(name, entry)| (name.clone(), plain_node(&entry.node))).collect()
}

/// A node without places.
#[must_use]
pub fn plain_node(node: &Node) -> toml::Value {
    match node {
        Node::Table(table) => toml::Value::Table(plain(table)),
        Node::Leaf(value) => value.clone(),
    }
}

/// The entry at a dotted path.
#[must_use]
pub fn find<'a>(table: &'a Table, path: &str) -> Option<&'a Entry> {
    let (first, rest) = path.split_once('.').map_or((path, None), |(a, b)| (a, Some(b)));
    let entry = table.get(first)?;
    match (rest, &entry.node) {
        (None, _) => Some(entry),
        (Some(rest), Node::Table(inner)) => find(inner, rest),
        (Some(_), Node::Leaf(_)) => None,
    }
}

fn syntax_error(file: FileId, text: &str, error: &toml::de::Error) -> Diagnostic {
    let range = error.span().unwrap_or(text.len()..text.len());
    Diagnostic::new(
        &codes::post::NOT_TOML,
        Span::new(file, range.start, range.end),
        format!("the post file is not TOML: {}", error.message()),
    )
}

fn convert_table(file: FileId, table: &DeTable<'_>) -> Table {
    table
        .iter()
        .map(|(key, value)| {
            let place = |r: core::ops::Range<usize>| Span::new(file, r.start, r.end);
            let entry = Entry {
                key: place(key.span()),
                value: place(value.span()),
                node: convert(file, value.get_ref()),
            };
            (key.get_ref().clone().into_owned(), entry)
        })
        .collect()
}

fn convert(file: FileId, value: &DeValue<'_>) -> Node {
    match value {
        DeValue::Table(table) => Node::Table(convert_table(file, table)),
        other => Node::Leaf(leaf(other)),
    }
}

/// Numbers that TOML can write and that the machine cannot hold become texts, so that the schema refuses them.
fn leaf(value: &DeValue<'_>) -> toml::Value {
    match value {
        DeValue::String(text) => toml::Value::String(text.clone().into_owned()),
        DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix())
            .map_or_else(|_| toml::Value::String(number.to_string()), toml::Value::Integer),
        DeValue::Float(number) => number
            .as_str()
            .parse()
            .map_or_else(|_| toml::Value::String(number.to_string()), toml::Value::Float),
        DeValue::Boolean(flag) => toml::Value::Boolean(*flag),
        DeValue::Datetime(time) => toml::Value::Datetime(*time),
        DeValue::Array(items) => toml::Value::Array(items.iter().map(|item| leaf(item.get_ref())).collect()),
        DeValue::Table(table) => toml::Value::Table(
            table
                .iter()
                .map(|(key, item)| (key.get_ref().clone().into_owned(), leaf(item.get_ref())))
                .collect(),
        ),
    }
}

fn check_table(table: &Table, keys: &[Key], path: &str, errors: &mut Vec<Diagnostic>) {
    for (name, entry) in table {
        match keys.iter().find(|k| k.name == name) {
            Some(key) => check(entry, key.shape, &join(path, name), errors),
            None => errors.push(unknown_key(name, entry.key, keys, path)),
        }
    }
}

fn join(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

fn unknown_key(name: &str, span: Span, keys: &[Key], path: &str) -> Diagnostic {
    let place = if path.is_empty() { "a post file".to_owned() } else { format!("[{path}]") };
    let error = Diagnostic::new(&codes::post::UNKNOWN_KEY, span, format!("{place} has no key `{name}`"))
        .at("unknown key");
    match did_you_mean(name, keys.iter().map(|k| k.name)) {
        Some(near) => error.help(format!("did you mean `{near}`?")),
        None => match tables_with(name).as_slice() {
            [] => {
                let names: Vec<&str> = keys.iter().map(|k| k.name).collect();
                error.help(format!("its keys are {}", names.join(", ")))
            }
            tables => error.help(format!("`{name}` is a key of {}", tables.join(", "))),
        },
    }
}

/// Tables of a post file that have a key.
fn tables_with(name: &str) -> Vec<String> {
    ROOT.iter()
        .filter(|table| matches!(table.shape, Shape::Table(keys) if keys.iter().any(|k| k.name == name)))
        .map(|table| format!("[{}]", table.name))
        .collect()
}

fn check(entry: &Entry, shape: Shape, path: &str, errors: &mut Vec<Diagnostic>) {
    match (shape, &entry.node) {
        (Shape::Table(keys), Node::Table(table)) => check_table(table, keys, path, errors),
        (Shape::Tables(keys), Node::Table(table)) => {
            for (name, inner) in table {
                check(inner, Shape::Table(keys), &join(path, name), errors);
            }
        }
        (Shape::Texts, Node::Table(table)) => {
            for (name, inner) in table {
                check(inner, Shape::Text, &join(path, name), errors);
            }
        }
        (Shape::TextListTable, Node::Table(table)) => {
            for (name, inner) in table {
                check(inner, Shape::TextList, &join(path, name), errors);
            }
        }
        (_, Node::Table(table)) => check_by_unit(entry, table, shape, path, errors),
        (_, Node::Leaf(value)) => {
            if let Err(wanted) = check_leaf(value, shape) {
                errors.push(wrong_value(entry.value, path, &wanted, value));
            }
        }
    }
}

/// `{ mm = …, inch = … }`.
fn check_by_unit(entry: &Entry, table: &Table, shape: Shape, path: &str, errors: &mut Vec<Diagnostic>) {
    let single = match shape {
        Shape::IntegerByUnit(low, high) => Shape::Integer(low, high),
        Shape::NumberByUnit(low, high) => Shape::Number(low, high),
        Shape::TextByUnit => Shape::Text,
        Shape::FlagByUnit => Shape::Flag,
        _ => {
            errors.push(Diagnostic::new(
                &codes::post::WRONG_VALUE,
                entry.key,
                format!("`{path}` is {}, not a table", describe(shape)),
            ));
            return;
        }
    };
    const UNITS: &[Key] = &[
        Key { name: "mm", shape: Shape::Text, doc: "in millimetre programs" },
        Key { name: "inch", shape: Shape::Text, doc: "in inch programs" },
    ];
    for (name, inner) in table {
        if UNITS.iter().any(|k| k.name == name) {
            check(inner, single, &join(path, name), errors);
        } else {
            errors.push(unknown_key(name, inner.key, UNITS, path));
        }
    }
    for unit in UNITS.iter().filter(|k| !table.contains_key(k.name)) {
        errors.push(Diagnostic::new(
            &codes::post::WRONG_VALUE,
            entry.value,
            format!("`{path}` says nothing for `{}`; give both `mm` and `inch`, or one value", unit.name),
        ));
    }
}

fn check_leaf(value: &toml::Value, shape: Shape) -> Result<(), String> {
    let fits = match (shape, value) {
        (Shape::Text | Shape::TextByUnit, toml::Value::String(_))
        | (Shape::Flag | Shape::FlagByUnit, toml::Value::Boolean(_)) => true,
        (Shape::Integer(low, high) | Shape::IntegerByUnit(low, high), toml::Value::Integer(n)) => {
            (low..=high).contains(n)
        }
        (Shape::Number(low, high) | Shape::NumberByUnit(low, high), value) => {
            number(value).is_some_and(|n| (low..=high).contains(&n))
        }
        (Shape::Choice(words), toml::Value::String(text)) => return check_choice(words, text),
        (Shape::Choices(words), toml::Value::Array(items)) => {
            return items.iter().try_for_each(|item| match item {
                toml::Value::String(text) => check_choice(words, text),
                _ => Err(describe(shape)),
            });
        }
        (Shape::TextList, toml::Value::Array(items)) => items.iter().all(toml::Value::is_str),
        (Shape::TextLists, toml::Value::Array(items)) => items
            .iter()
            .all(|item| item.as_array().is_some_and(|inner| inner.iter().all(toml::Value::is_str))),
        (Shape::Range, toml::Value::Array(items)) => match items.as_slice() {
            [low, high] => number(low).zip(number(high)).is_some_and(|(a, b)| a < b),
            _ => false,
        },
        _ => false,
    };
    if fits { Ok(()) } else { Err(describe(shape)) }
}

fn number(value: &toml::Value) -> Option<f64> {
    match value {
        // Schema ranges are far below 2^53.
        toml::Value::Integer(n) => Some(*n as f64),
        toml::Value::Float(n) => n.is_finite().then_some(*n),
        _ => None,
    }
}

fn check_choice(words: &[&str], text: &str) -> Result<(), String> {
    if words.contains(&text) {
        return Ok(());
    }
    let near = did_you_mean(text, words.iter().copied()).map(|w| format!("; did you mean \"{w}\"?"));
    Err(describe(Shape::Choice(&[])) + &words.join("\", \"") + "\"" + &near.unwrap_or_default())
}

fn wrong_value(span: Span, path: &str, wanted: &str, value: &toml::Value) -> Diagnostic {
    let found = value.to_string();
    let found: String = if found.chars().count() > 40 {
        found.chars().take(40).chain("…".chars()).collect()
    } else {
        found
    };
    Diagnostic::new(&codes::post::WRONG_VALUE, span, format!("`{path}` is {wanted}, not {found}"))
}

/// «a text», «an integer from 0 to 9» …
#[must_use]
pub fn describe(shape: Shape) -> String {
    match shape {
        Shape::Text => "a text".into(),
        Shape::Flag => "`true` or `false`".into(),
        Shape::Integer(low, high) => format!("an integer from {low} to {high}"),
        Shape::IntegerByUnit(low, high) => {
            format!("an integer from {low} to {high}, or one each for `mm` and `inch`")
        }
        Shape::Number(low, high) => format!("a number from {low} to {high}"),
        Shape::NumberByUnit(low, high) => {
            format!("a number from {low} to {high}, or one each for `mm` and `inch`")
        }
        Shape::TextByUnit => "a text, or one each for `mm` and `inch`".into(),
        Shape::FlagByUnit => "`true` or `false`, or one each for `mm` and `inch`".into(),
        Shape::Choice(_) => "one of \"".into(),
        Shape::Choices(words) => format!("a list of \"{}\"", words.join("\", \"")),
        Shape::TextList => "a list of texts".into(),
        Shape::TextLists => "a list of lists of texts".into(),
        Shape::Range => "a list of two numbers, the smaller first".into(),
        Shape::Table(_) | Shape::Tables(_) | Shape::Texts | Shape::TextListTable => "a table".into(),
    }
}
