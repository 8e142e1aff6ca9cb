//! The rooms of the house: who may know what, read from the `use` lines and paths of the
//! code itself.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The rooms of `src/` from the top down. A room uses only rooms that stand after it.
const ROOMS: [&str; 8] = ["cli", "study", "output", "port", "run", "setup", "scene", "method"];

/// The code: module path (`method::basis::lme`) and text without comments.
fn modules() -> BTreeMap<String, String> {
    fn read(folder: &Path, path: &str, found: &mut BTreeMap<String, String>) {
        for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let name = entry.file_name().to_string_lossy().into_owned();
            let below = |name: &str| match path {
                "" => name.to_string(),
                _ => format!("{path}::{name}"),
            };
            if entry.file_type().unwrap().is_dir() {
                read(&entry.path(), &below(&name), found);
            } else if name != "lib.rs" && name != "main.rs" {
                let text = fs::read_to_string(entry.path()).unwrap();
                let code = text.lines().map(|line| line.split("//").next().unwrap());
                let code = code.collect::<Vec<_>>().join("\n");
                let module = match name.trim_end_matches(".rs") {
                    "mod" => path.to_string(),
                    name => below(name),
                };
                found.insert(module, code);
            }
        }
    }
    let mut found = BTreeMap::new();
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), "", &mut found);
    found
}

/// `a::{b, c::{d, e}}` → `a::b`, `a::c::d`, `a::c::e`.
fn branches(tree: &str) -> Vec<String> {
    let Some((stem, inside)) = tree.split_once('{') else {
        return vec![tree.split(" as ").next().unwrap().trim().to_string()];
    };
    let inside = inside.trim().strip_suffix('}').unwrap_or(inside);
    let (mut depth, mut piece, mut pieces) = (0, String::new(), Vec::new());
    for c in inside.chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if c == ',' && depth == 0 {
            pieces.push(std::mem::take(&mut piece));
        } else {
            piece.push(c);
        }
    }
    pieces.push(piece);
    pieces.retain(|piece| !piece.trim().is_empty());
    pieces.iter().flat_map(|piece| branches(&format!("{}{}", stem.trim(), piece.trim()))).collect()
}

/// All paths that a module names: of its `use` lines, and those spelled out in the code
/// that begin with the crate.
fn named(module: &str, code: &str) -> Vec<String> {
    let mut paths: Vec<String> = Vec::new();
    for piece in code.split("use ").skip(1) {
        let tree = piece.split(';').next().unwrap().replace('\n', " ");
        paths.extend(branches(&tree));
    }
    for start in ["crate::", "lme_mpm::"] {
        for (at, _) in code.match_indices(start) {
            let end = |c: char| !(c.is_alphanumeric() || c == '_' || c == ':');
            let rest = &code[at..];
            paths.push(rest[..rest.find(end).unwrap_or(rest.len())].to_string());
        }
    }
    let parent = module.rsplit_once("::").map_or("", |(parent, _)| parent);
    let is_folder = |all: &BTreeMap<String, String>| {
        let inside = format!("{module}::");
        all.keys().any(|other| other.starts_with(&inside))
    };
    let all = modules();
    let own = if is_folder(&all) { module } else { parent };
    let absolute = |path: &String| {
        let path = path.trim();
        match path.split_once("::") {
            Some(("crate" | "lme_mpm", rest)) => rest.to_string(),
            Some(("super", rest)) if is_folder(&all) => format!("{parent}::{rest}"),
            Some(("super", rest)) => format!("{own}::{rest}"),
            Some(("self", rest)) => format!("{module}::{rest}"),
            _ => format!("{module}::{path}"), // a child, or another crate
        }
    };
    paths.iter().map(absolute).collect()
}

/// The module that a path leads into: the longest beginning of it that is one.
fn target<'a>(path: &str, all: &'a BTreeMap<String, String>) -> Option<&'a str> {
    let mut path = path;
    loop {
        if let Some((module, _)) = all.get_key_value(path) {
            return Some(module);
        }
        path = path.rsplit_once("::")?.0;
    }
}

/// Which module uses which.
fn arrows() -> BTreeSet<(String, String)> {
    let all = modules();
    let mut arrows = BTreeSet::new();
    for (module, code) in &all {
        for path in named(module, code) {
            if let Some(used) = target(&path, &all).filter(|used| used != module) {
                arrows.insert((module.clone(), used.to_string()));
            }
        }
    }
    arrows
}

fn room(module: &str) -> usize {
    let name = module.split("::").next().unwrap();
    ROOMS.iter().position(|room| *room == name).unwrap_or_else(|| panic!("`{name}` is no room"))
}

/// No import from a lower room to a higher one.
#[test]
fn house_imports_point_down() {
    let arrows = arrows();
    assert!(arrows.len() > 100, "{}", arrows.len());
    for (from, to) in &arrows {
        assert!(room(from) <= room(to), "`{from}` uses `{to}`, which stands above it");
    }
}

/// No circle of files: whoever reads one file at a time, lowest first, meets nothing that
/// he has not read.
#[test]
fn house_has_no_circles() {
    let mut arrows = arrows();
    loop {
        let before = arrows.len();
        // What uses nothing more, or is used by nothing more, is in no circle.
        let users: BTreeSet<String> = arrows.iter().map(|(from, _)| from.clone()).collect();
        let used: BTreeSet<String> = arrows.iter().map(|(_, to)| to.clone()).collect();
        arrows.retain(|(from, to)| users.contains(to) && used.contains(from));
        if arrows.len() == before {
            break;
        }
    }
    assert!(arrows.is_empty(), "a circle: {arrows:?}");
}

/// The method knows no scene, file, terminal, clock or thread, and neither does what
/// another program takes of the rest.
#[test]
fn house_keeps_its_walls() {
    for (module, code) in modules() {
        let program = ["cli", "study", "port"].contains(&ROOMS[room(&module)]);
        let files = ["output::files", "output::report", "output::vtk"].contains(&module.as_str());
        for word in ["std::fs", "std::time", "std::thread", "std::net", "std::env", "println!"] {
            assert!(program || files || !code.contains(word), "`{module}` has {word}");
        }
        let crates = ["serde", "toml::", "csv::", "clap", "kuva", "annotate"];
        let above = crates.into_iter().find(|name| code.contains(name));
        assert!(!module.starts_with("method") || above.is_none(), "`{module}` has {above:?}");
    }
}

/// The test reads trees of paths as the compiler does.
#[test]
fn house_reads_use_lines() {
    assert_eq!(branches("a::{b, c::{d, e as f}}"), ["a::b", "a::c::d", "a::c::e"]);
    let code = "use super::steps::*;\nuse crate::method::{cost::Cost, grid};\n";
    let found = named("method::time::euler", code);
    for path in ["method::time::steps::*", "method::cost::Cost", "method::grid"] {
        assert!(found.iter().any(|one| one == path), "{found:?}");
    }
    assert_eq!(target("method::cost::Cost", &modules()), Some("method::cost"));
}
