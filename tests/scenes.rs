//! Scenes as declared: the table of keys against reading, schema, book and shipped files.

use crate::support::*;
use lme_mpm::run::parse;
use lme_mpm::scene::keys::{KEYS, Without, find};
use lme_mpm::scene::kind::Kind;
use lme_mpm::scene::schema::schema;
use lme_mpm::scene::{DYKA, SHIPPED, Scene, declare, shipped};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;

/// The shipped scenes are the files of `data/scenes/`, byte for byte, and have a title.
#[test]
fn scenes_shipped_are_the_files() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes");
    let files: BTreeSet<String> = program::files(folder.as_ref()).into_iter().collect();
    let names: BTreeSet<String> = SHIPPED.iter().map(|s| format!("{}.toml", s.name)).collect();
    assert_eq!(names, files);
    for scene in SHIPPED {
        assert_eq!(
            fs::read_to_string(format!("{folder}/{}.toml", scene.name)).unwrap(),
            scene.text
        );
        assert!(!declare(scene.name, scene.name, scene.text, &[]).unwrap().scene.title.is_empty());
    }
}

/// The table of keys as the book prints it.
#[test]
fn scenes_reference_is_approved() {
    let row =
        |cells: [&str; 4]| cells.map(|cell| format!("\"{}\"", cell.replace('"', "\"\""))).join(",");
    let mut table = row(["key", "allowed", "without it", "meaning"]);
    for key in KEYS {
        table += "\n";
        table += &row([key.path, &key.allowed(), &key.without_words(), key.help]);
    }
    approve("scene_reference", &table);
}

/// The annotated scene of the book is one, and names every table that a scene can have in
/// two dimensions.
#[test]
fn scenes_of_the_book_are_read() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/book/src/scene-reference.md");
    let page = fs::read_to_string(page).unwrap();
    let block = page.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    let example = scene(block, &[]);
    assert_eq!((example.dimension(), example.probes.len()), (2, 1));
    assert!(example.traction.is_some() && example.body_force.is_some());
    assert!(agree(block).unwrap());
}

/// Each word of a choice is understood where its table and the rest of the scene allow it.
#[test]
fn scenes_words_are_understood() {
    let mut words = 0;
    for key in KEYS {
        let (Kind::Choice(list) | Kind::ChoiceOrTable(list)) = key.kind else { continue };
        for word in list {
            let path = key.path.replace("<side>", "left").replace("<axis>", "x");
            let mut sets = vec![format!("{}={word}", path.replace("probe.", "probe.0."))];
            sets.extend(key.with.map(|(other, word)| format!("{other}={word}")));
            let chosen = [Some((key.path, *word)), key.with];
            for other in KEYS.iter().filter(|o| o.with.is_some() && chosen.contains(&o.with)) {
                if matches!(other.without, Without::Refused) && other.path != key.path {
                    let value = if let Kind::Choice(words) = other.kind { words[0] } else { "1" };
                    sets.push(format!("{}={value}", other.path));
                }
            }
            if *word == "mls" {
                sets.push("basis.kind=bspline".into()); // linear functions have none
            }
            let text = match *word {
                "quasi-static" => COLUMN, // nothing is thrown
                "updated" => DYKA_OTM,    // nodes go along
                _ => DYKA,
            };
            let refused = parse("test", "test.toml", text, &sets).err();
            let problem = refused.map_or(String::new(), |error| error.problem);
            let other_reason = problem.is_empty()
                || problem.contains("is not a component of it")
                || problem.contains("the method \"otm\"");
            assert!(other_reason, "{sets:?}: {problem}");
            words += 1;
        }
    }
    assert!(words > 30, "{words}");
}

/// Every key is read: two different values of it make two different scenes. Of each table one
/// shipped scene that has it is taken; the right side and x stand for all sides and axes.
#[test]
fn scenes_keys_are_read() {
    for key in KEYS {
        let (mut text, [mut a, mut b]) = match (key.place().0, key.kind) {
            (_, Kind::Table | Kind::List) => continue,
            (_, Kind::Text | Kind::Name(_)) => (DYKA, ["'abc'", "'abd'"]),
            (_, Kind::Flag) => (DYKA, ["true", "false"]),
            (_, Kind::Choice(words) | Kind::ChoiceOrTable(words)) => (DYKA, [words[0], words[1]]),
            (_, Kind::One(n) | Kind::PerAxis(n)) if n.whole => (DYKA, ["2", "3"]),
            (_, Kind::One(_) | Kind::PerAxis(_)) => (DYKA, ["0.03", "0.04"]),
        };
        // Scenes and values where those do not fit.
        (text, [a, b]) = match (key.place().0, key.path) {
            (_, "body.length") => (text, ["0.14", "0.15"]),
            (_, "body.ball.centre") => (DISCS, ["[0.3,0.2]", "[0.2,0.3]"]),
            (_, "body.ball.radius") => (DISCS, ["0.1", "0.15"]),
            (_, "basis.kind") => (text, ["linear", "ugimp"]),
            (_, "basis.degree") => (DYKA, [a, b]), // without a γ
            (_, "basis.metric") => (DYKA_OTM, [a, b]),
            (_, "time.integrator") => (text, ["newmark", "corrected-euler"]),
            (_, "initial_velocity.to") => (text, ["0.12", "0.13"]),
            (_, "initial_velocity.spin") => (DISCS, [a, b]),
            (_, "probe.component") => (DISCS, ["x", "y"]),
            (_, "time.load_steps") => (COLUMN, [a, b]),
            (_, "forces.degree") => (text, ["0", "2"]),
            (_, "output.vtk") => (DISCS, [a, b]),
            ("basis" | "manufactured", _) => (MANUFACTURED, [a, b]), // with local max-ent
            ("vortex", _) => (VORTEX, [a, b]),
            ("vibration", _) => (VIBRATION, [a, b]),
            ("body_force", _) => (GRAVITY, [a, b]),
            ("traction", _) => (TRACTION, [a, b]),
            _ => (text, [a, b]),
        };
        let mut path = key.path.replace("<side>", "right").replace("<axis>", "x");
        for list in ["body.ball.", "probe.", "initial_velocity."] {
            path = path.replace(list, &format!("{list}0."));
        }
        let with = |value: &str| {
            let mut sets = vec![format!("{path}={value}")];
            sets.extend(key.with.map(|(other, word)| format!("{other}={word}")));
            if path.starts_with("forces.") {
                sets.push("basis.kind=bspline".into());
            }
            if path == "forces.degree" {
                sets.push("forces.reconstruction=tls".into());
            }
            parse("test", "test.toml", text, &sets).unwrap_or_else(|error| panic!("{error}"))
        };
        assert_ne!(with(a), with(b), "nothing reads {}", key.path);
    }
}

/// A key that is set to what holds without it changes nothing.
#[test]
fn scenes_defaults_are_what_is_read() {
    let mut keys = 0;
    for key in KEYS {
        let value = match key.without {
            Without::Number(x) => x.to_string(),
            Without::Word(word) => word.to_string(),
            Without::Flag(flag) => flag.to_string(),
            Without::Refused | Without::Says(_) => continue,
        };
        let text = match key.place().0 {
            _ if key.with == Some(("method", "otm")) => DYKA_OTM,
            _ if key.path == "basis.degree" => &DYKA.replace("\"linear\"", "\"bspline\""),
            "basis" | "manufactured" => MANUFACTURED, // with local max-ent
            "body_force" => GRAVITY,
            "traction" => TRACTION,
            _ => DYKA, // free at its right end
        };
        let path = key.path.replace("<side>", "right").replace("<axis>", "x");
        let set = format!("{path}={value}");
        assert_eq!(scene(text, &[&set]), scene(text, &[]), "{set}");
        keys += 1;
    }
    assert_eq!(keys, 21);
}

/// No column of a history but a probe's own can be a probe's name.
#[test]
fn scenes_columns_name_no_probe() {
    let cube = "grid.cells=[2,2,2]";
    let loaded: [(Scene, usize); 6] = [
        (dyka(&["time.end=1e-6"]), 1),
        (scene(GRAVITY, &["time.end=1e-5"]), 1),
        (scene(DISCS, &["time.end=0.01"]), 2),
        (scene(DISCS, &["time.end=0.01", "body_force={acceleration=[0,-1]}"]), 2),
        (block(3, &["time.end=1e-4", cube]), 3),
        (block(3, &["time.end=1e-4", cube, "traction={right=[1,0,0]}"]), 3),
    ];
    let mut columns = BTreeSet::new();
    for (scene, dimension) in &loaded {
        assert_eq!(scene.dimension(), *dimension);
        for column in finished(scene).history.columns {
            if !scene.probes.iter().any(|probe| probe.name == column) {
                columns.insert(column);
            }
        }
    }
    assert!(columns.len() >= 14 && columns.contains("work"), "{columns:?}");
    let fields = ["particles", "velocity_field", "stress_field", "displacement_field", "energy"];
    columns.extend(fields.map(String::from));
    for column in columns {
        for name in [column.to_uppercase(), column] {
            let set = format!("probe.0.name={name}");
            let refused = parse("test", "test.toml", DYKA, &[set]).unwrap_err();
            assert_eq!(refused.key, "probe[0].name", "{name}");
            assert!(refused.problem.contains("taken"), "{refused}");
        }
    }
}

/// What is wrong with `value` by a schema, of the words that the schema of scenes has.
fn complaint(schema: &Value, value: &Value) -> Option<String> {
    let object = match schema {
        Value::Bool(true) => return None,
        Value::Bool(false) => return Some(format!("{value} may not be here")),
        _ => schema.as_object().unwrap(),
    };
    let none = serde_json::Map::new();
    let members = value.as_object().unwrap_or(&none);
    let valid = |schema: &Value| complaint(schema, value).is_none();
    let list = |what: &Value| what.as_array().unwrap().clone();
    for (word, what) in object {
        let good = match word.as_str() {
            "$schema" | "title" | "description" | "default" | "then" | "else" => true,
            "type" => match what.as_str().unwrap() {
                "object" => value.is_object(),
                "array" => value.is_array(),
                "string" => value.is_string(),
                "boolean" => value.is_boolean(),
                "number" => value.is_number(),
                "integer" => value.is_i64() || value.is_u64(),
                other => panic!("the type {other}"),
            },
            "enum" => list(what).contains(value),
            "const" => what == value,
            "minimum" => value.as_f64() >= what.as_f64(),
            "exclusiveMinimum" => value.as_f64() > what.as_f64(),
            "maximum" => value.as_f64() <= what.as_f64(),
            "exclusiveMaximum" => value.as_f64() < what.as_f64(),
            "minItems" => {
                value.as_array().is_none_or(|list| list.len() >= what.as_u64().unwrap() as usize)
            }
            "maxItems" => {
                value.as_array().is_none_or(|list| list.len() <= what.as_u64().unwrap() as usize)
            }
            "items" => {
                let wrong = value.as_array().into_iter().flatten().find_map(|v| complaint(what, v));
                if wrong.is_some() {
                    return wrong;
                }
                true
            }
            "properties" => {
                let own = |name: &String, v| what.get(name).and_then(|schema| complaint(schema, v));
                if let Some(wrong) = members.iter().find_map(|(name, v)| own(name, v)) {
                    return Some(wrong);
                }
                true
            }
            "required" => {
                list(what).iter().all(|name| members.contains_key(name.as_str().unwrap()))
            }
            "additionalProperties" => {
                members.keys().all(|name| object["properties"].get(name).is_some())
            }
            "anyOf" => list(what).iter().any(valid),
            "allOf" => list(what).iter().all(valid),
            "not" => !valid(what),
            "if" => valid(&object[if valid(what) { "then" } else { "else" }]),
            "pattern" => true, // text and names are read by the reader alone
            other => panic!("the word {other}"),
        };
        if !good {
            return Some(format!("{word} of {value}"));
        }
    }
    None
}

/// True for a text that both schema and reader take, false for one that both refuse; an
/// error where they differ.
fn agree(text: &str) -> Result<bool, String> {
    let read = parse("test", "test.toml", text, &[]);
    let table: toml::Table = text.parse().unwrap();
    let complaint = complaint(&schema(), &serde_json::to_value(table).unwrap());
    match (read, complaint) {
        (Ok(_), None) => Ok(true),
        (Err(_), Some(_)) => Ok(false),
        (read, complaint) => Err(format!("{:?}, {complaint:?}", read.err().map(|e| e.problem))),
    }
}

/// The schema takes what reading takes: the shipped scenes and their variants; it refuses
/// with the reader what one key, or a key and its word, make wrong.
#[test]
fn scenes_schema_agrees_with_reading() {
    for scene in SHIPPED {
        assert_eq!(agree(scene.text), Ok(true), "{}", scene.name);
    }
    let linear = "kind = \"linear\"";
    let newmark = "integrator = \"newmark\"";
    let cases = [
        (true, linear, "kind = \"lme\"\ngamma = 1\ncutoff = 0"),
        (true, newmark, "integrator = \"newmark\"\nreading = \"as-printed\""),
        (true, newmark, "integrator = \"generalized-alpha\"\nrho_b = 0"),
        (true, "cells = 40", "cells = [40]\nbeyond = { left = 2, right = 0 }"),
        (true, "left = \"fixed\"", "left = { x = \"fixed\" }"),
        (true, "density = 7833", "density = 7833\norigin = 0"),
        (false, "density = 7833", "densty = 7833"),
        (false, "density = 7833\n", ""),
        (false, "density = 7833", "density = 0"),
        (false, "density = 7833", "density = \"heavy\""),
        (false, "poisson_ratio = 0", "poisson_ratio = 0.5"),
        (false, "poisson_ratio = 0", "poisson_ratio = -1"),
        (false, "cells = 40", "cells = 40.5"),
        (false, "cells = 40", "cells = [1, 1, 1, 1]"),
        (false, "particles_per_cell = 2", "particles_per_cell = 65"),
        (false, "cells = 40", "cells = 40\nbeyond = { under = 1 }"),
        (false, "cells = 40", "cells = 40\nbeyond = { left = -1 }"),
        (false, linear, "kind = \"lme\""),
        (false, linear, "kind = \"lme\"\ngamma = 1\ncutoff = 1"),
        (false, linear, "kind = \"linear\"\ngamma = 1"),
        (false, linear, "kind = \"cubic\""),
        (false, newmark, "integrator = \"newmark\"\nrho_b = 1"),
        (false, newmark, "integrator = \"forward-euler\""),
        (false, newmark, "integrator = \"corrected-euler\"\nreading = \"as-printed\""),
        (false, "left = \"fixed\"", "left = { x = \"fix\" }"),
        (false, "left = \"fixed\"", "left = true"),
        (false, "every = 1", "every = 0"),
        (false, "every = 1", "vtk = \"yes\""),
        (false, "[[initial_velocity]]", "[initial_velocity]"),
        (false, "name = \"velocity_end\"", "name = \"momentum\""),
        (false, "name = \"velocity_end\"", "name = 3"),
    ];
    for (taken, from, to) in cases {
        let text = DYKA.replacen(from, to, 1);
        assert_ne!(text, DYKA, "{from}");
        assert_eq!(agree(&text), Ok(taken), "{to}");
    }
}

/// The paths of all properties of a schema.
fn properties(schema: &Value, path: &str, found: &mut BTreeSet<String>) {
    for (name, inner) in schema["properties"].as_object().into_iter().flatten() {
        let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        properties(inner, &path, found);
        properties(&inner["items"], &path, found);
        for other in inner["anyOf"].as_array().into_iter().flatten() {
            properties(other, &path, found);
        }
        found.insert(path);
    }
}

/// The schema has the keys of the table and no others, each with its help.
#[test]
fn scenes_schema_has_every_key() {
    let mut found = BTreeSet::new();
    properties(&schema(), "", &mut found);
    let known: BTreeSet<&str> = found.iter().map(|path| find(path).unwrap().path).collect();
    assert_eq!(known, KEYS.iter().map(|key| key.path).collect());
    assert_eq!(found.iter().filter(|path| path.starts_with("boundary.")).count(), 6 * (1 + 3));
    let density = &schema()["properties"]["body"]["properties"]["density"];
    assert_eq!(density["description"], "ρ at the start: a number above 0, in kg/m³.");
}

/// From an empty folder: what ships can be listed, shown, changed and run by name.
#[test]
fn scenes_by_name() {
    let dir = program::directory("scenes");
    let print = |arguments: &[&str]| {
        let output = program::program(&dir, arguments);
        assert!(output.status.success(), "{}", program::text(&output.stderr));
        program::text(&output.stdout)
    };
    let list = print(&["scenes"]);
    assert_eq!(list.lines().count(), SHIPPED.len());
    assert!(list.contains("gravity          Sudden gravity\n"), "{list}");
    let gravity = print(&["scenes", "show", "gravity"]);
    assert_eq!(gravity, shipped("gravity").unwrap().text);
    print(&["run", "gravity", "--quiet"]);
    // A file goes before a shipped scene of the same name.
    fs::write(dir.join("gravity"), gravity.replace("Sudden", "My")).unwrap();
    assert!(print(&["run", "gravity", "--out", "mine"]).contains("My gravity"));
    assert!(print(&["trace", "dyka", "--set", "grid.cells=4"]).starts_with("k,step,"));
    let row = "method=mpm mass=lumped basis.kind=linear time.integrator=newmark grid.cells=10 \
               grid.particles_per_cell=2 time.cfl=0.5";
    assert!(print(&["trade", "--scene", "vibration", "--row", row]).contains(row));
    let schema: Value = serde_json::from_str(&print(&["scenes", "schema"])).unwrap();
    assert_eq!(schema, lme_mpm::scene::schema::schema());
    for (arguments, words) in [
        (&["run", "gravty"][..], &["cannot read gravty", "dyka-otm, ", "did you mean `gravity`?"]),
        (&["recommend", "dyke", "--error", "1%"], &["dyke", "shipped: ", "did you mean `dyka`?"]),
        (&["scenes", "show", "dyke"], &["dyke", "free-flight", "'dyka'"]),
    ] {
        program::assert_fails(&program::program(&dir, arguments), 2, words);
    }
    assert_eq!(program::files(&dir), ["gravity", "mine", "out"]);
}

/// Each shell is told the commands and the names of the shipped scenes.
#[test]
fn completions_name_the_commands() {
    let dir = program::directory("completions");
    for shell in ["bash", "zsh", "fish"] {
        let output = program::program(&dir, &["completions", shell]);
        let script = program::text(&output.stdout);
        for word in ["run", "scenes", "recommend", "stability", "schema", "--set"] {
            let long = word.trim_start_matches("--");
            let said = script.contains(word) || script.contains(&format!("-l {long} "));
            assert!(said, "{shell} is not told {word}");
        }
    }
    let output = program::program(&dir, &["completions", "csh"]);
    program::assert_fails(&output, 2, &["csh", "bash", "fish"]);
}
