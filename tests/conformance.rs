//! The conformance kit in `data/conformance/`: made anew and compared, byte by byte.
//!
//! `KIT_UPDATE=1 cargo test conformance` writes it.

use crate::support::kit::texts::{Ending, MUST_FAIL};
use crate::support::kit::{folder, kit, manifest};
use crate::support::*;
use lme_mpm::run::{parse, run};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::PathBuf;

/// The files of the kit are what this program makes; with `KIT_UPDATE` set it writes
/// them.
#[test]
fn conformance_kit_is_current() {
    let kit = kit();
    let mut files: BTreeMap<PathBuf, String> = BTreeMap::new();
    for piece in &kit {
        let path = folder().join(format!("level-{}", piece.level)).join(piece.name);
        assert!(files.insert(path, piece.text.clone()).is_none());
    }
    files.insert(folder().join("manifest.json"), manifest(&kit));
    for (path, text) in &files {
        if std::env::var_os("KIT_UPDATE").is_some() {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let found = fs::read_to_string(path).unwrap_or_default();
        assert_eq!(&found, text, "{} is not current: KIT_UPDATE=1 writes it", path.display());
    }
    // Nothing else lies there but what is written by hand.
    for level in 0..=5 {
        for entry in fs::read_dir(folder().join(format!("level-{level}"))).unwrap() {
            let path = entry.unwrap().path();
            assert!(files.contains_key(&path), "{} belongs to nothing", path.display());
        }
    }
}

/// The README says of every symbol in the kit what it is.
#[test]
fn conformance_symbols_are_explained() {
    let readme = fs::read_to_string(folder().join("README.md")).unwrap();
    let table: String = readme.lines().filter(|line| line.starts_with("| `")).collect();
    let kit = kit();
    let symbols: BTreeSet<&str> = kit
        .iter()
        .filter(|piece| piece.text.starts_with("k,step,symbol"))
        .flat_map(|piece| piece.text.lines().skip(1))
        .map(|line| line.split(',').nth(2).unwrap())
        .collect();
    assert!(symbols.len() > 20, "{symbols:?}");
    for symbol in symbols {
        assert!(table.contains(&format!("`{symbol}`")), "{symbol}");
    }
}

/// The manifest has what its schema requires, and nothing else.
#[test]
fn conformance_manifest_keeps_its_form() {
    let kit = kit();
    let manifest: Value = serde_json::from_str(&manifest(&kit)).unwrap();
    let schema = fs::read_to_string(folder().join("manifest.schema.json")).unwrap();
    let schema: Value = serde_json::from_str(&schema).unwrap();
    let keeps = |value: &Value, schema: &Value| {
        let mut keys: Vec<&str> = value.as_object().unwrap().keys().map(String::as_str).collect();
        let required = schema["required"].as_array().unwrap();
        let mut required: Vec<&str> = required.iter().map(|key| key.as_str().unwrap()).collect();
        keys.sort_unstable();
        required.sort_unstable();
        assert_eq!(keys, required);
    };
    keeps(&manifest, &schema);
    for tolerance in manifest["tolerances"].as_object().unwrap().values() {
        keeps(tolerance, &schema["properties"]["tolerances"]["additionalProperties"]);
    }
    let files = manifest["files"].as_array().unwrap();
    assert_eq!(files.len(), kit.len());
    for file in files {
        keeps(file, &schema["properties"]["files"]["items"]);
        let class = file["tolerance"].as_str().unwrap();
        assert!(manifest["tolerances"].get(class).is_some(), "{class}");
    }
}

/// What must fail, fails, and says why: refused by the key, or broken down within five
/// steps.
#[test]
fn conformance_must_fail() {
    for change in MUST_FAIL {
        let text = change.scene();
        match (parse("bad", "bad.toml", &text, &[]), change.ends) {
            (Err(error), Ending::Refused(key)) => {
                assert_eq!(error.key.replace("[0]", ""), key);
            }
            (Ok(scene), Ending::BreaksDownAtOnce) => {
                let stopped = run(&scene, &mut |_| {}).unwrap_err();
                assert!(stopped.broken.moment.step < 5, "{}", stopped.broken);
            }
            (_, ends) => panic!("not {ends:?}:\n{text}"),
        }
    }
}

/// The orders in `orders.csv` are those of the bar `data/scenes/vibration.toml` at 0.8 L/c on 10,
/// 20 and 40 cells with time steps so small that they do not show.
#[test]
fn conformance_orders_are_measured() {
    let text = fs::read_to_string(folder().join("level-4/orders.csv")).unwrap();
    let cells = [10, 20, 40];
    let h = cells.map(|n| 1.0 / f64::from(n));
    for mass in MASSES {
        let errors = cells.map(|n| {
            let (grid, cfl) =
                (format!("grid.cells={n}"), format!("time.cfl={:?}", 4e-4 * f64::from(n)));
            let sets =
                [mass.sets, &["time.end=0.8", "vibration.velocity=1e-7", &grid, &cfl]].concat();
            let scene = scene(VIBRATION, &sets);
            field_errors(&scene, &finished(&scene))
        });
        let Each { v, sigma, u } = orders(&h, &errors);
        for (quantity, order) in [("velocity", v), ("displacement", u), ("stress", sigma)] {
            let start = format!("linear,{},{quantity},", mass.name);
            let band = text.lines().find_map(|line| line.strip_prefix(&start)).unwrap();
            let (lowest, highest) = band.split_once(',').unwrap();
            let inside = lowest.parse::<f64>().unwrap()..=highest.parse::<f64>().unwrap();
            assert!(inside.contains(&order.slope), "{start} {}", order.slope);
        }
    }
}
