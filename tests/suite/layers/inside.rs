//! Order inside the layers: folders that build on each other one way, and files without a circle.
//!
//! A file depends on another by naming something of it, or by calling an inherent method that is defined
//! there: a type may have `impl` blocks in several files, and a call of its methods needs no `use`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::sources;

/// The files and folders inside a layer, lowest first: each may name those before it.
const ROOMS: [(&str, &[&str]); 1] = [(
    "dynamics",
    &[
        "clock", "result", "model", "equation", "series", "drive", "state", "step", "record", "motion",
        "contact", "run", "map", "lanes", "live",
    ],
)];

/// The most files of a layer that may depend on each other in a circle.
const CIRCLES: [(&str, usize); 8] = [
    ("numeric", 2),
    ("scene", 2),
    ("mechanics", 2),
    ("dynamics", 1),
    ("study", 2),
    ("output", 2),
    ("cli", 2),
    ("app", 2),
];

/// Where a type may have methods, as folders or files of its layer.
const METHODS: [(&str, &str, &[&str]); 3] = [
    ("dynamics", "Motion", &["motion", "contact", "run"]),
    ("dynamics", "Recorder", &["record"]),
    ("dynamics", "Stepper", &["step"]),
];

/// Names of variables and fields whose methods are those of a type.
const RECEIVERS: [(&str, &str); 4] =
    [("motion", "Motion"), ("record", "Recorder"), ("stepper", "Stepper"), ("model", "Model")];

/// One source file: its module below `crate`, its code without comments and unit tests, and what it hands on
/// from the files below it (`pub use`), which is no use of its own.
struct Source {
    module: Vec<String>,
    code: String,
    exports: Vec<Vec<String>>,
}

impl Source {
    fn read(src: &Path, path: &Path) -> Self {
        let own = path.strip_prefix(src).unwrap().with_extension("");
        let mut module: Vec<String> = own.iter().map(|part| part.to_string_lossy().into_owned()).collect();
        module.pop_if(|last| last == "mod");
        let text = fs::read_to_string(path).unwrap();
        let text = text.split("#[cfg(test)]").next().unwrap_or_default();
        let code = text.lines().map(|line| line.split("//").next().unwrap_or_default());
        Self::new(module, &code.collect::<Vec<_>>().join("\n"))
    }

    fn new(module: Vec<String>, text: &str) -> Self {
        let (mut code, mut exports) = (String::new(), Vec::new());
        for statement in text.split_inclusive(';') {
            let export = statement.split_once("use ").filter(|(before, _)| before.trim().starts_with("pub"));
            match export.filter(|(before, _)| !before.contains(['{', '='])) {
                Some((_, path)) => drop(read_path(path, &[], &mut exports)),
                None => code.push_str(statement),
            }
        }
        Self { module, code, exports }
    }

    fn name(&self) -> String {
        self.module.join("/")
    }

    /// The file or folder of its layer that it lies in; none for the layer's own `mod.rs`.
    fn room(&self) -> Option<&str> {
        self.module.get(1).map(String::as_str)
    }

    /// Paths that its code names, as they stand there.
    fn paths(&self) -> Vec<Vec<String>> {
        let mut found = Vec::new();
        let mut rest = self.code.as_str();
        while let Some(start) = rest.find(|c: char| c.is_alphabetic() || c == '_') {
            let scope = rest[..start].ends_with('(') && rest[start..].starts_with("in ");
            rest = read_path(&rest[start..], &[], &mut found);
            if scope {
                rest = rest.split_once(')').map_or("", |(_, after)| after); // pub(in path)
            }
        }
        found
    }

    /// A path from the root of the crate, where it leads to a module of the crate.
    fn resolved(&self, path: &[String], files: &BTreeMap<&[String], &Self>) -> Option<Vec<String>> {
        if path.len() < 2 {
            return None; // `pub(super)`, `mod name;`
        }
        let (mut at, mut rest) = (self.module.clone(), path);
        match path.first()?.as_str() {
            "crate" => (at, rest) = (Vec::new(), &path[1..]),
            "self" => rest = &path[1..],
            "super" => {}
            first if files.contains_key([at.as_slice(), &[first.to_string()]].concat().as_slice()) => {}
            _ => return None,
        }
        while rest.first().is_some_and(|part| part == "super") {
            at.pop();
            rest = &rest[1..];
        }
        let mut named = None;
        for part in rest {
            at.push(part.clone());
            if !files.contains_key(at.as_slice()) {
                at.pop();
                named = Some(part);
                break;
            }
        }
        let home = files.get(at.as_slice())?;
        let handed = named.and_then(|name| home.exports.iter().find(|path| path.last() == Some(name)));
        handed.map_or(Some(at), |path| home.resolved(path, files))
    }

    /// Its inherent `impl` blocks: the type and the code.
    fn methods(&self) -> Vec<(String, &str)> {
        let mut blocks = Vec::new();
        for (start, _) in
            self.code.match_indices("\nimpl").filter(|(at, _)| !self.code[*at..].starts_with("\nimpl_"))
        {
            let block = &self.code[start + 1..];
            let block = &block[..block.find("\n}").unwrap_or(block.len())];
            let head = block.split('{').next().unwrap_or_default();
            let own = head.strip_prefix("impl").unwrap_or_default();
            let own = if own.starts_with('<') { after_generics(own) } else { own };
            if !head.contains(" for ") {
                blocks.push((own.trim().chars().take_while(|c| c.is_alphanumeric()).collect(), block));
            }
        }
        blocks
    }
}

/// Reads a path at the start of the text, with a group at its end where there is one; what follows it.
fn read_path<'a>(text: &'a str, before: &[String], found: &mut Vec<Vec<String>>) -> &'a str {
    let mut path = before.to_vec();
    let mut rest = text;
    loop {
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        path.push(rest[..end].to_string());
        rest = &rest[end..];
        let Some(more) = rest.strip_prefix("::") else { break };
        if let Some(group) = more.strip_prefix('{') {
            let mut inside = group;
            loop {
                inside = inside.trim_start_matches(|c: char| c.is_whitespace() || c == ',');
                match inside.chars().next() {
                    Some(c) if c.is_alphabetic() || c == '_' => inside = read_path(inside, &path, found),
                    _ => return inside.strip_prefix('}').unwrap_or(inside),
                }
            }
        }
        if !more.starts_with(|c: char| c.is_alphabetic() || c == '_') {
            break;
        }
        rest = more;
    }
    found.push(path);
    rest
}

/// What follows the generic parameters at the start of a text.
fn after_generics(text: &str) -> &str {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        depth += i32::from(c == '<') - i32::from(c == '>');
        if depth == 0 {
            return &text[at + 1..];
        }
    }
    ""
}

fn layer(name: &str) -> Vec<Source> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files: Vec<PathBuf> = Vec::new();
    sources(&src.join(name), &mut files);
    files.sort();
    files.iter().map(|path| Source::read(&src, path)).collect()
}

/// For each file those that it depends on, with the name or method by which it does.
fn dependencies(files: &[Source]) -> BTreeMap<String, BTreeMap<String, String>> {
    let modules: BTreeMap<&[String], &Source> =
        files.iter().map(|file| (file.module.as_slice(), file)).collect();
    let mut homes: BTreeMap<(String, String), String> = BTreeMap::new();
    for file in files {
        for (own, block) in file.methods() {
            for (at, _) in block.match_indices("fn ") {
                let name: String =
                    block[at + 3..].chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                homes.insert((own.clone(), name), file.name());
            }
        }
    }
    let mut all = BTreeMap::new();
    for file in files {
        let mut needs: BTreeMap<String, String> = BTreeMap::new();
        for path in file.paths() {
            if let Some(module) = file.resolved(&path, &modules) {
                needs.insert(module.join("/"), path.join("::"));
            }
        }
        let mut calls = |code: &str, receiver: &str, own: &str| {
            for (at, found) in code.match_indices(&format!("{receiver}.")) {
                if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
                    continue;
                }
                let rest = &code[at + found.len()..];
                let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
                if rest[end..].starts_with(['(', ':'])
                    && let Some(home) = homes.get(&(own.to_string(), rest[..end].to_string()))
                {
                    needs.insert(home.clone(), format!("{own}::{}()", &rest[..end]));
                }
            }
        };
        for (own, block) in file.methods() {
            calls(block, "self", &own);
        }
        for (receiver, own) in RECEIVERS {
            calls(&file.code, receiver, own);
        }
        needs.remove(&file.name());
        all.insert(file.name(), needs);
    }
    all
}

#[test]
fn each_folder_of_a_layer_names_only_those_before_it() {
    for (name, order) in ROOMS {
        let place = |room: &str| order.iter().position(|own| *own == room);
        let files = layer(name);
        let needs = dependencies(&files);
        let mut wrong = Vec::new();
        for file in &files {
            let Some(room) = file.room() else { continue };
            let Some(own) = place(room) else {
                wrong.push(format!("{room} has no place in the order of {name}"));
                continue;
            };
            for (needed, by) in &needs[&file.name()] {
                let other = needed.split('/').nth(1).and_then(place);
                if other.is_none_or(|other| other > own) {
                    wrong.push(format!("{} uses {needed} ({by})", file.name()));
                }
            }
        }
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
}

/// The files that a file depends on, directly or by way of others.
fn reached<'a>(needs: &'a BTreeMap<String, BTreeMap<String, String>>, from: &'a str) -> BTreeSet<&'a str> {
    let (mut all, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(file) = open.pop() {
        open.extend(needs[file].keys().map(String::as_str).filter(|other| all.insert(*other)));
    }
    all
}

#[test]
fn no_more_files_than_said_depend_on_each_other_in_a_circle() {
    for (name, most) in CIRCLES {
        let needs = dependencies(&layer(name));
        let all: BTreeMap<&str, BTreeSet<&str>> =
            needs.keys().map(|file| (file.as_str(), reached(&needs, file))).collect();
        for (file, own) in &all {
            let circle: Vec<&str> = own.iter().copied().filter(|other| all[other].contains(file)).collect();
            let edges = circle.iter().flat_map(|file| {
                let inside = needs[*file].iter().filter(|(other, _)| circle.contains(&other.as_str()));
                inside.map(move |(other, by)| format!("{file} -> {other} ({by})"))
            });
            let edges: Vec<String> = edges.collect();
            assert!(circle.len() <= most, "a circle of {} files:\n{}", circle.len(), edges.join("\n"));
        }
    }
}

#[test]
fn methods_of_a_type_are_defined_where_they_belong() {
    for (name, own, rooms) in METHODS {
        let mut homes = 0;
        for file in layer(name) {
            if file.methods().iter().any(|(of, _)| of == own) {
                homes += 1;
                let room = file.room().unwrap_or_default();
                assert!(rooms.contains(&room), "{} defines methods of {own}", file.name());
            }
        }
        assert!(homes > 0, "no methods of {own} found in {name}");
    }
}

#[test]
fn the_reader_of_files_sees_names_and_methods() {
    let file =
        |module: &[&str], code: &str| Source::new(module.iter().map(ToString::to_string).collect(), code);
    let files = [
        file(&["l"], ""),
        file(&["l", "a"], "\nimpl<T: Into<f64>> Motion<T> {\n    pub fn rest(&self) {}\n}\n"),
        file(&["l", "b"], "use super::{a::{X, Y}, c};\nfn f() { motion.rest() }"),
        file(&["l", "c"], "\nimpl Motion {\n    fn go(&self) { self.rest::<f64>(); crate::l::d::g(); }\n}\n"),
        file(&["l", "d"], "use child::Z;\npub use child::V;\nimpl From<X> for Y {\n}\n"),
        file(&["l", "d", "child"], ""),
        file(&["l", "d", "other"], "use super::V;"),
    ];
    let needs = dependencies(&files);
    let of = |name: &str| needs[name].keys().map(String::as_str).collect::<Vec<_>>();
    assert_eq!(of("l/a"), [""; 0]);
    assert_eq!(of("l/b"), ["l/a", "l/c"]);
    assert_eq!(of("l/c"), ["l/a", "l/d"]);
    assert_eq!(of("l/d"), ["l/d/child"]);
    assert_eq!(of("l/d/other"), ["l/d/child"]);
    assert_eq!(reached(&needs, "l/c").into_iter().collect::<Vec<_>>(), ["l/a", "l/d", "l/d/child"]);
}
