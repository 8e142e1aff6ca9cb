//! The rooms of the house: who may know what, read from the `use` lines and paths of the
//! code itself.

use crate::support::{approve, approve_picture};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
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
        let files = ["output::files", "output::report", "output::results", "output::vtk"];
        let files = files.contains(&module.as_str());
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

/// What stands in each room, from the top down: its first sentence, its files, and the
/// rooms that it uses.
struct Room {
    name: &'static str,
    says: String,
    files: Vec<String>,
    uses: Vec<&'static str>,
}

fn rooms() -> Vec<Room> {
    let (all, arrows) = (modules(), arrows());
    let describe = |name: &'static str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(name).join("mod.rs");
        let text = fs::read_to_string(path).unwrap();
        let comment = text.lines().map_while(|line| line.strip_prefix("//!"));
        let comment = comment.map(str::trim).collect::<Vec<_>>().join(" ");
        let says = comment.split(". ").next().unwrap().trim_end_matches('.').to_string();
        let inside = |module: &&String| module.split("::").next() == Some(name);
        let file = |module: &String| module.split_once("::").map(|(_, file)| file.to_string());
        let leads = |other: &&&'static str| {
            arrows.iter().any(|(from, to)| inside(&from) && to.split("::").next() == Some(other))
        };
        Room {
            name,
            says,
            files: all.keys().filter(inside).filter_map(file).collect(),
            uses: ROOMS.iter().filter(|other| **other != name).filter(leads).copied().collect(),
        }
    };
    ROOMS.into_iter().map(describe).collect()
}

/// The map of the code in the book: a table and a picture, drawn from the code itself.
#[test]
fn house_is_on_the_map() {
    let rooms = rooms();
    let mut table = String::from("room,in a sentence,files,uses\n");
    for Room { name, says, files, uses } in &rooms {
        assert!(says.len() > 20 && files.len() > 1, "{name}: {says}");
        let list = |names: &[&str]| names.join(", ");
        let files = shelves(files).join("; ");
        writeln!(table, "{name},\"{says}\",\"{files}\",\"{}\"", list(uses)).unwrap();
    }
    approve("house__rooms", &table);
    approve_picture("house__map", picture(&rooms));
}

/// The files of a room in lines: its own first, then each folder with what is in it.
fn shelves(files: &[String]) -> Vec<String> {
    let mut lines: Vec<(String, Vec<&str>)> = vec![(String::new(), Vec::new())];
    let is_folder =
        |file: &&String| files.iter().any(|other| other.starts_with(&format!("{file}::")));
    for file in files.iter().filter(|file| !is_folder(file)) {
        let (folder, name) = file.rsplit_once("::").unwrap_or(("", file));
        match lines.iter_mut().find(|(known, _)| known == folder) {
            Some((_, names)) => names.push(name),
            None => lines.push((folder.to_string(), vec![name])),
        }
    }
    let line = |(folder, names): &(String, Vec<&str>)| match folder {
        folder if folder.is_empty() => names.join(", "),
        folder => format!("{}/ {}", folder.replace("::", "/"), names.join(", ")),
    };
    lines.iter().map(line).collect()
}

/// The rooms as floors of a house; a line on the right leads from each room down to those
/// that it uses.
fn picture(rooms: &[Room]) -> String {
    const WIDTH: usize = 480;
    const LINE: usize = 19;
    const COLOURS: [&str; 8] =
        ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#882255", "#44aa99"];
    let (mut body, mut y, mut floors) = (String::new(), 10, Vec::new());
    for Room { name, says, files, .. } in rooms {
        let says: Vec<String> = wrapped(&says.replace('&', "&amp;").replace('<', "&lt;"));
        let lines: Vec<String> = shelves(files).iter().flat_map(|line| wrapped(line)).collect();
        let height = 34 + LINE * (says.len() + lines.len());
        write!(
            body,
            "<rect x=\"10\" y=\"{y}\" width=\"{WIDTH}\" height=\"{height}\" rx=\"4\" fill=\"#f7f7f7\" \
             stroke=\"#444444\"/>\n<text x=\"22\" y=\"{}\" font-size=\"17\" font-weight=\"bold\">{name}\
             </text>\n",
            y + 21
        )
        .unwrap();
        let says = says.iter().map(|line| (line, "#000000"));
        let all = says.chain(lines.iter().map(|line| (line, "#555555")));
        for (n, (line, colour)) in all.enumerate() {
            let at = y + 21 + LINE * (n + 1);
            writeln!(
                body,
                "<text x=\"22\" y=\"{at}\" font-size=\"14.5\" fill=\"{colour}\">{line}</text>"
            )
            .unwrap();
        }
        floors.push(y + height / 2);
        y += height + 12;
    }
    for (from, room) in rooms.iter().enumerate() {
        for to in room.uses.iter().map(|name| ROOMS.iter().position(|room| room == name).unwrap()) {
            let (a, b) = (floors[from], floors[to] - 8 + 2 * from);
            let (edge, out) = (WIDTH + 10, WIDTH + 36 + 20 * (to - from));
            writeln!(
                body,
                "<path d=\"M {edge} {a} C {out} {a} {out} {b} {edge} {b}\" fill=\"none\" \
                 stroke=\"{}\" stroke-width=\"1.6\"{} marker-end=\"url(#tip)\"/>",
                COLOURS[from],
                [" ", " stroke-dasharray=\"7 3\"", " stroke-dasharray=\"2 3\""][from % 3]
                    .trim_end()
            )
            .unwrap();
        }
    }
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"640\" height=\"{y}\" viewBox=\"0 0 640 {y}\" font-family=\"sans-serif\">\n\
         <defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"7\" \
         markerHeight=\"7\" orient=\"auto\"><path d=\"M 0 0 L 8 4 L 0 8 z\" fill=\"#444444\"/></marker>\
         </defs>\n<rect width=\"640\" height=\"{y}\" fill=\"#ffffff\"/>\n{body}</svg>\n"
    )
}

/// A line in pieces of at most 58 letters, cut between words.
fn wrapped(line: &str) -> Vec<String> {
    let mut pieces = vec![String::new()];
    for word in line.split(' ') {
        let last = pieces.last_mut().unwrap();
        if last.chars().count() + word.chars().count() > 57 {
            pieces.push(word.to_string());
        } else {
            *last += if last.is_empty() { "" } else { " " };
            *last += word;
        }
    }
    pieces
}

/// One name, one thing: no two types of the program are called the same.
#[test]
fn house_names_mean_one_thing() {
    let mut known: BTreeMap<String, String> = BTreeMap::new();
    for (module, code) in modules() {
        for line in code.lines() {
            let line = line.trim_start_matches("pub ").trim_start_matches("pub(super) ");
            let kinds = ["struct ", "enum ", "trait ", "type "];
            if let Some(rest) = kinds.iter().find_map(|kind| line.strip_prefix(kind)) {
                let end = |c: char| !(c.is_alphanumeric() || c == '_');
                let name = rest[..rest.find(end).unwrap_or(rest.len())].to_string();
                let before = known.insert(name.clone(), module.clone());
                assert_eq!(before, None, "`{name}` of `{module}` exists twice");
            }
        }
    }
    assert!(known.len() > 50, "{}", known.len());
}

/// Functions have about 40 lines at most, or say why they have more, and never more than
/// six parameters.
#[test]
fn house_functions_are_short() {
    let mut count = 0;
    for entry in sources() {
        let text = fs::read_to_string(&entry).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        for (n, line) in lines.iter().enumerate() {
            let code = line.trim_start();
            let indent = &line[..line.len() - code.len()];
            let start = ["fn ", "pub fn ", "pub(super) fn ", "const fn ", "pub const fn "];
            if !start.iter().any(|start| code.starts_with(start)) {
                continue;
            }
            let end = format!("{indent}}}");
            let length = lines[n..].iter().position(|line| *line == end).map_or(1, |at| at + 1);
            let comment = lines[..n].iter().rev().map(|line| line.trim_start());
            let comment: Vec<&str> =
                comment.take_while(|line| line.starts_with(['/', '#'])).collect();
            let comment =
                comment.into_iter().rev().collect::<Vec<_>>().join(" ").replace("/// ", "");
            let place = format!("{}, line {}", entry.display(), n + 1);
            let reason = comment.contains("why this function is long");
            assert!(length <= 44 || reason, "{place}: {length} lines, and no word of why");
            let head: String =
                lines[n..].iter().take(14).map(|line| format!("{}\n", line.trim())).collect();
            let head = head.split(" {\n").next().unwrap();
            let parameters = match head.contains("(\n") {
                true => head.lines().filter(|line| line.ends_with(',')).count(),
                false => head.matches(": ").count(),
            };
            assert!(parameters <= 6 + usize::from(head.contains("self")), "{place}: {parameters}");
            count += 1;
        }
    }
    assert!(count > 300, "{count}");
}

/// All files of `src/`.
fn sources() -> Vec<std::path::PathBuf> {
    fn below(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
        for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
            match entry.file_type().unwrap().is_dir() {
                true => below(&entry.path(), found),
                false => found.push(entry.path()),
            }
        }
    }
    let mut found = Vec::new();
    below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut found);
    found.sort();
    found
}
