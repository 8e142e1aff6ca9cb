//! Makes the JSON Schema of a scene, for editors that complete and check as one types.

use super::keys::{KEYS, Key, Without, children};
use super::kind::{Kind, Number};
use super::source::join;
use serde_json::{Map, Value, json};
use std::ops::Bound::{Excluded, Included};

/// Makes the schema (JSON Schema, draft 7) of a scene file. It says what a key may be by
/// itself, and which keys go with a chosen word; what keys ask of each other beyond that, only
/// reading says.
pub fn schema() -> Value {
    let mut schema = table("");
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!("A scene of lme-mpm");
    schema
}

/// Describes the table at `path`: its keys and no others.
fn table(path: &str) -> Value {
    let mut properties = Map::new();
    for key in children(path) {
        for name in key.names() {
            properties.insert(name.to_string(), value(key, &join(path, name)));
        }
    }
    let required: Vec<&str> =
        children(path).filter(|key| key.is_required()).map(|key| key.place().1).collect();
    let mut schema = json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    });
    let conditions: Vec<Value> = KEYS.iter().flat_map(|chosen| going_with(path, chosen)).collect();
    if !conditions.is_empty() {
        schema["allOf"] = json!(conditions);
    }
    schema
}

/// Describes, for each word of the key `chosen`, what the keys of the table `path` that go with
/// it say.
fn going_with(path: &str, chosen: &Key) -> Vec<Value> {
    let Kind::Choice(words) = chosen.kind else { return Vec::new() };
    let condition = |word: &&str| {
        let own = children(path).filter(|key| key.with == Some((chosen.path, *word)));
        let (mut refused, mut needed) = (Map::new(), Vec::new());
        for key in own {
            let name = key.place().1;
            refused.insert(name.to_string(), json!(false));
            if matches!(key.without, Without::Refused) {
                needed.push(name);
            }
        }
        (!refused.is_empty()).then(|| {
            json!({
                "if": { "properties": { chosen.place().1: { "const": word } } },
                "then": { "required": needed },
                "else": { "properties": refused },
            })
        })
    };
    words.iter().filter_map(condition).collect()
}

/// Describes what the value of the key at `path` may be.
fn value(key: &Key, path: &str) -> Value {
    let mut schema = match key.kind {
        Kind::Table => table(path),
        Kind::List => json!({ "type": "array", "items": table(path) }),
        Kind::Text => {
            json!({ "type": "string", "pattern": "^[^\\u0000-\\u001f\\u007f-\\u009f\\u202a-\\u202e\\u2066-\\u2069\\ufffe\\uffff]*$" })
        }
        Kind::Name(taken) => json!({
            "type": "string",
            "pattern": "^[A-Za-z0-9_]{1,64}$",
            "not": { "enum": taken },
        }),
        Kind::Choice(words) => json!({ "enum": words }),
        Kind::ChoiceOrTable(words) => json!({ "anyOf": [{ "enum": words }, table(path)] }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::One(number) => one(number),
        Kind::PerAxis(number) => {
            let list =
                json!({ "type": "array", "items": one(number), "minItems": 1, "maxItems": 3 });
            json!({ "anyOf": [one(number), list] })
        }
    };
    schema["description"] = json!(format!("{}: {}.", key.help, key.allowed()));
    match key.without {
        Without::Number(x) if x.trunc() == x => schema["default"] = json!(x as i64),
        Without::Number(x) => schema["default"] = json!(x),
        Without::Word(word) => schema["default"] = json!(word),
        Without::Flag(flag) => schema["default"] = json!(flag),
        Without::Refused | Without::Says(_) => {}
    }
    schema
}

fn one(number: Number) -> Value {
    let mut schema = json!({ "type": if number.whole { "integer" } else { "number" } });
    match number.least {
        Included(a) => schema["minimum"] = json!(a),
        Excluded(a) => schema["exclusiveMinimum"] = json!(a),
        _ => {}
    }
    match number.most {
        Included(b) => schema["maximum"] = json!(b),
        Excluded(b) => schema["exclusiveMaximum"] = json!(b),
        _ => {}
    }
    schema
}
