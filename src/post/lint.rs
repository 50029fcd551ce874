//! What can be said of a post file beyond its being usable: parts that no program reaches, abilities that its
//! words cannot express, codes that cannot be told apart.

use std::collections::{BTreeMap, BTreeSet};

use super::Dialect;
use super::check::{at, first_byte, patterns, templates};
use super::load::{builtin_text, is_own, name_builtins};
use super::template::Renderer;
use super::tree;
use super::variables;
use crate::diag::codes::tools as codes;
use crate::diag::{Diagnostic, did_you_mean};
use crate::readback;
use crate::source::SourceMap;
use crate::units::LengthUnit;

/// Every finding; files that messages point into are added to `sources`.
#[must_use]
pub fn lint(dialect: &Dialect, sources: &mut SourceMap) -> Vec<Diagnostic> {
    let mut lint = Lint { dialect, sources, findings: Vec::new() };
    lint.variables();
    lint.blocks();
    lint.words();
    lint.options();
    lint.arcs();
    lint.feeds();
    lint.control();
    lint.codes();
    let findings = lint.findings;
    name_builtins(findings, sources)
}

struct Lint<'a> {
    dialect: &'a Dialect,
    sources: &'a SourceMap,
    findings: Vec<Diagnostic>,
}

impl Lint<'_> {
    /// What the file itself says, not what it inherits.
    fn own(&self, path: &str) -> bool {
        tree::find(&self.dialect.tree, path)
            .is_some_and(|entry| is_own(self.dialect, entry.key.file, self.sources))
    }

    fn unreachable(&mut self, path: &str, message: String) {
        let finding = at(self.dialect, path, &codes::UNREACHABLE, message);
        self.findings.push(shortened(finding));
    }

    fn inexpressible(&mut self, path: &str, message: String) {
        self.findings.push(at(self.dialect, path, &codes::INEXPRESSIBLE, message));
    }

    fn alike(&mut self, path: &str, message: String) {
        self.findings.push(at(self.dialect, path, &codes::ALIKE, message));
    }

    /// Variables that no program will ever define.
    fn variables(&mut self) {
        let renderer = Renderer::new(&self.dialect.spec.comments);
        for (path, scope, template) in templates(self.dialect) {
            for name in renderer.variables(template) {
                if variables::is_known(&name, scope) || self.has_option(&name) {
                    continue;
                }
                let known: Vec<&str> = variables::of(scope).collect();
                let finding = unknown_variable(self.dialect, &path, &name, &known);
                self.findings.push(shortened(finding));
            }
        }
    }

    fn has_option(&self, name: &str) -> bool {
        name.strip_prefix("options.").is_some_and(|key| self.dialect.spec.options.contains_key(key))
    }

    /// Blocks of the tool change that its order does not name.
    fn blocks(&mut self) {
        let change = &self.dialect.spec.tool_change;
        for name in change.blocks.keys().filter(|n| !change.order.contains(n)) {
            let path = format!("tool-change.blocks.{name}");
            if self.own(&path) {
                let message =
                    format!("no tool change prints the block `{name}`: `tool-change.order` does not name it");
                self.unreachable(&path, message);
            }
        }
    }

    /// Words that nothing prints.
    fn words(&mut self) {
        let spec = &self.dialect.spec;
        let printed: BTreeSet<&str> =
            patterns(self.dialect).into_iter().flat_map(|(_, _, items)| items).map(String::as_str).collect();
        let slots: Vec<&str> = super::pattern::Slot::ALL.iter().map(|s| s.name()).collect();
        let built_in = base_words();
        for name in spec.words.keys() {
            let path = format!("words.{name}");
            let of_motion = slots.contains(&name.as_str());
            let used = printed.contains(name.as_str()) || (!of_motion && built_in.contains(name));
            if used || !self.own(&path) {
                continue;
            }
            let message = if of_motion {
                format!("no pattern prints the word `{name}`")
            } else {
                format!("nothing prints the word `{name}`")
            };
            self.unreachable(&path, message);
        }
    }

    /// Options that no template reads.
    fn options(&mut self) {
        let Some(read) = self.dialect.read_options() else { return };
        for name in self.dialect.spec.options.keys().filter(|name| !read.contains(*name)) {
            let path = format!("options.{name}");
            if self.own(&path) {
                self.unreachable(&path, format!("no template reads `{path}`"));
            }
        }
    }

    fn arcs(&mut self) {
        let spec = &self.dialect.spec;
        if !spec.arcs.enabled {
            return;
        }
        let has = |item: &str| spec.patterns.arc.iter().any(|i| i == item);
        let by_motion = has("motion") && spec.codes.arc_cw != spec.codes.arc_ccw;
        let by_axis = has("axis");
        let by_direction = has("direction") && spec.codes.direction_cw != spec.codes.direction_ccw;
        if !by_motion && !by_direction && !by_axis {
            let message = "clockwise and counter-clockwise arcs are printed alike".to_owned();
            let paths = ["codes.arc-cw", "codes.arc-ccw", "codes.direction-cw", "codes.direction-ccw"];
            let place = paths.into_iter().find(|p| self.own(p)).unwrap_or("patterns.arc");
            self.inexpressible(place, message);
        }
    }

    fn feeds(&mut self) {
        let spec = &self.dialect.spec;
        let has = |item: &str| spec.patterns.line.iter().any(|i| i == item);
        if !has("feed") {
            self.inexpressible(
                "patterns.line",
                "`patterns.line` has no `feed`: no move has a feed".to_owned(),
            );
        }
        let modes = [
            ("inverse-time", spec.feed.inverse_time, &spec.codes.inverse_time),
            ("per-revolution", spec.feed.per_revolution, &spec.codes.per_revolution),
        ];
        let spelled = |name: &str| spec.words.get(name).map(|w| (&w.prefix, &w.suffix));
        // A feed word that says its own unit needs no code before it.
        let says_itself = |name: &str| spelled(&format!("feed-{name}")) != spelled("feed");
        for (name, _, code) in modes.into_iter().filter(|(name, claimed, _)| *claimed && !says_itself(name)) {
            let path = format!("feed.{name}");
            if code.is_empty() {
                self.inexpressible(&path, format!("`{path}` is true, but `codes.{name}` is empty"));
            } else if !has("feed-mode") {
                let message =
                    format!("`{path}` is true, but `patterns.line` has no `feed-mode` that would say so");
                self.inexpressible(&path, message);
            }
        }
        let units = [LengthUnit::Millimetre, LengthUnit::Inch];
        if units.iter().any(|u| spec.rotary.enabled.of(*u)) && !has("rotary") {
            let message = "`rotary.enabled` is true, but `patterns.line` has no word `rotary`".to_owned();
            self.inexpressible("rotary.enabled", message);
        }
        if spec.path_control.share > 0.0 && spec.path_control.tolerance.is_empty() {
            let message = "`path-control.share` gives the control a part of the tolerance, but `path-control.tolerance` is empty";
            self.inexpressible("path-control.share", message.to_owned());
        }
    }

    /// The control that reads the program back.
    fn control(&mut self) {
        let Err(unknown) = readback::needs(self.dialect.control()) else { return };
        let message = format!("nothing could be proven: {unknown}");
        let finding = at(self.dialect, "post.control", &codes::INEXPRESSIBLE, message);
        let near = unknown.name().and_then(|name| did_you_mean(name, readback::controls()));
        self.findings.push(match near {
            Some(near) => finding.help(format!("did you mean `{near}`?")),
            None => finding,
        });
    }

    /// Codes that mean two things.
    fn codes(&mut self) {
        let spec = &self.dialect.spec;
        if spec.codes.rapid == spec.codes.line && spec.patterns.rapid == spec.patterns.line {
            let message = format!("moves at rapid and at feed are both printed with `{}`", spec.codes.line);
            self.alike("codes.rapid", message);
        }
        let says_sense = spec.spindle.on.iter().any(|item| item == "code");
        if spec.spindle.clockwise == spec.spindle.counter_clockwise && says_sense {
            let message = format!("both senses of the spindle are `{}`", spec.spindle.clockwise);
            let paths = ["spindle.counter-clockwise", "spindle.clockwise"];
            let place = paths.into_iter().find(|p| self.own(p)).unwrap_or("spindle.counter-clockwise");
            self.alike(place, message);
        }
        self.switches();
        self.planes();
        let mut owners: BTreeMap<&str, &str> = BTreeMap::new();
        for (group, rules) in &spec.groups {
            for code in &rules.codes {
                if let Some(other) = owners.insert(code, group).filter(|other| other != group) {
                    let message = format!("`{code}` is in two modal groups, `{other}` and `{group}`");
                    self.alike(&format!("groups.{group}.codes"), message);
                }
            }
        }
    }
}

impl Lint<'_> {
    /// Codes that switch, each of which must switch one thing only.
    fn switches(&mut self) {
        let spec = &self.dialect.spec;
        let switches = [
            ("spindle.clockwise", &spec.spindle.clockwise),
            ("spindle.off", &spec.spindle.off),
            ("coolant.flood", &spec.coolant.flood),
            ("coolant.off", &spec.coolant.off),
            ("coolant.mist", &spec.coolant.mist),
            ("coolant.through", &spec.coolant.through),
            ("stops.stop", &spec.stops.stop),
            ("stops.optional", &spec.stops.optional),
        ];
        let mut alike = Vec::new();
        for (i, (path, code)) in switches.iter().enumerate().filter(|(_, (_, code))| !code.is_empty()) {
            for (other, _) in switches.iter().take(i).filter(|(_, c)| c == code) {
                let place = if self.own(path) { path } else { other };
                alike.push((*place, format!("`{other}` and `{path}` are both `{code}`")));
            }
        }
        alike.into_iter().for_each(|(place, message)| self.alike(place, message));
    }
}

impl Lint<'_> {
    /// Planes that are claimed and cannot be told apart.
    fn planes(&mut self) {
        let spec = &self.dialect.spec;
        let codes = [
            ("xy", "codes.plane-xy", &spec.codes.plane_xy),
            ("zx", "codes.plane-zx", &spec.codes.plane_zx),
            ("yz", "codes.plane-yz", &spec.codes.plane_yz),
        ];
        let printed = spec.arcs.enabled && spec.patterns.arc.iter().any(|item| item == "plane");
        let claimed = |plane: &str| spec.arcs.planes.iter().any(|p| p == plane);
        let wanted: Vec<_> = codes
            .into_iter()
            .filter(|(plane, _, code)| printed && claimed(plane) && !code.is_empty())
            .collect();
        let mut alike = Vec::new();
        for (i, (_, path, code)) in wanted.iter().enumerate() {
            for (_, other, _) in wanted.iter().take(i).filter(|(_, _, c)| c == code) {
                let place = if self.own(path) { path } else { other };
                alike.push((*place, format!("`{other}` and `{path}` are both `{code}`")));
            }
        }
        alike.into_iter().for_each(|(place, message)| self.alike(place, message));
    }
}

/// Words of the file that all built-in posts inherit from: the writer knows what they are for.
fn base_words() -> BTreeSet<String> {
    let text = builtin_text("iso").unwrap_or_default();
    let words = text.parse::<toml::Table>().ok().and_then(|mut t| t.remove("words"));
    words.and_then(|w| w.as_table().map(|t| t.keys().cloned().collect())).unwrap_or_default()
}

fn unknown_variable(dialect: &Dialect, path: &str, name: &str, known: &[&str]) -> Diagnostic {
    let finding = at(
        dialect,
        path,
        &codes::UNKNOWN_VARIABLE,
        format!("the template `{path}` has no variable `{name}`"),
    );
    let option = name.strip_prefix("options.");
    let near = match option {
        Some(key) => did_you_mean(key, dialect.spec.options.keys().map(String::as_str)),
        None => did_you_mean(name, known.iter().copied()),
    };
    match (near, option) {
        (Some(near), Some(_)) => finding.help(format!("did you mean `options.{near}`?")),
        (Some(near), None) => finding.help(format!("did you mean `{near}`?")),
        (None, Some(option)) => finding.help(format!("say `{option} = \"\u{2026}\"` in [options]")),
        (None, None) => finding.help(format!("its variables are {}", known.join(", "))),
    }
}

/// Values can be long; a caret under the start is enough.
fn shortened(mut finding: Diagnostic) -> Diagnostic {
    if let Some(primary) = &mut finding.primary {
        primary.span = first_byte(primary.span);
    }
    finding
}
