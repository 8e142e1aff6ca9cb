//! A scene file as written: the shapes that serde reads, each value with its
//! place.

use serde::Deserialize;
use serde::de::{Deserializer, IntoDeserializer, SeqAccess, Visitor, value};
use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;
use toml::Spanned;

/// The file as written: every value with its place.
#[derive(Deserialize)]
pub struct File {
    pub title: Spanned<String>,
    pub method: Spanned<String>,
    pub mass: Spanned<String>,
    pub body: FileBody,
    pub grid: FileGrid,
    pub basis: FileBasis,
    pub time: FileTime,
    #[serde(default)]
    pub boundary: BTreeMap<String, Spanned<FileSide>>,
    #[serde(default)]
    pub initial_velocity: Vec<FileRegion>,
    pub vibration: Option<Spanned<FileVibration>>,
    pub manufactured: Option<Spanned<FileManufactured>>,
    pub body_force: Option<FileBodyForce>,
    pub traction: Option<FileTraction>,
    #[serde(default)]
    pub probe: Vec<FileProbe>,
    #[serde(default)]
    pub output: FileOutput,
}

#[derive(Deserialize)]
pub struct FileBody {
    pub length: Spanned<PerAxis<f64>>,
    pub origin: Option<Spanned<PerAxis<f64>>>,
    pub density: Spanned<f64>,
    pub youngs_modulus: Spanned<f64>,
    pub poisson_ratio: Spanned<f64>,
    #[serde(default)]
    pub ball: Vec<FileBall>,
}

#[derive(Deserialize)]
pub struct FileBall {
    pub centre: Spanned<PerAxis<f64>>,
    pub radius: Spanned<f64>,
}

#[derive(Deserialize)]
pub struct FileGrid {
    pub cells: Spanned<PerAxis<i64>>,
    pub particles_per_cell: Spanned<PerAxis<i64>>,
    #[serde(default)]
    pub beyond: BTreeMap<String, Spanned<i64>>,
}

#[derive(Deserialize)]
pub struct FileBasis {
    pub kind: Spanned<String>,
    pub gamma: Option<Spanned<f64>>,
    pub cutoff: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
pub struct FileTime {
    pub integrator: Spanned<String>,
    pub reading: Option<Spanned<String>>,
    pub stress_update: Option<Spanned<String>>,
    pub rho_b: Option<Spanned<f64>>,
    pub cfl: Option<Spanned<f64>>,
    pub fraction_of_critical: Option<Spanned<f64>>,
    pub allow_unstable: Option<Spanned<bool>>,
    pub end: Spanned<f64>,
}

#[derive(Deserialize)]
pub struct FileRegion {
    pub from: Spanned<PerAxis<f64>>,
    pub to: Spanned<PerAxis<f64>>,
    pub velocity: Spanned<PerAxis<f64>>,
}

#[derive(Deserialize)]
pub struct FileVibration {
    pub mode: Spanned<i64>,
    pub velocity: Spanned<f64>,
}

#[derive(Deserialize)]
pub struct FileManufactured {
    pub mode: Spanned<i64>,
    pub amplitude: Spanned<f64>,
}

#[derive(Deserialize)]
pub struct FileBodyForce {
    pub acceleration: Spanned<PerAxis<f64>>,
    pub ramp: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
pub struct FileTraction {
    pub ramp: Option<Spanned<f64>>,
    pub left: Option<Spanned<PerAxis<f64>>>,
    pub right: Option<Spanned<PerAxis<f64>>>,
    pub bottom: Option<Spanned<PerAxis<f64>>>,
    pub top: Option<Spanned<PerAxis<f64>>>,
    pub back: Option<Spanned<PerAxis<f64>>>,
    pub front: Option<Spanned<PerAxis<f64>>>,
}

#[derive(Deserialize)]
pub struct FileProbe {
    pub name: Spanned<String>,
    pub quantity: Spanned<String>,
    pub component: Option<Spanned<String>>,
    pub position: Spanned<PerAxis<f64>>,
}

#[derive(Deserialize, Default)]
pub struct FileOutput {
    pub every: Option<Spanned<i64>>,
    pub vtk: Option<Spanned<bool>>,
}

/// A number, or a list with one number for each axis.
pub struct PerAxis<T>(pub Vec<T>);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for PerAxis<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrMany<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for OneOrMany<T> {
            type Value = PerAxis<T>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number or a list of numbers")
            }
            fn visit_i64<E: serde::de::Error>(self, x: i64) -> Result<Self::Value, E> {
                let one: value::I64Deserializer<E> = x.into_deserializer();
                T::deserialize(one).map(|x| PerAxis(vec![x]))
            }
            fn visit_f64<E: serde::de::Error>(self, x: f64) -> Result<Self::Value, E> {
                let one: value::F64Deserializer<E> = x.into_deserializer();
                T::deserialize(one).map(|x| PerAxis(vec![x]))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
                let mut many = Vec::new();
                while let Some(x) = seq.next_element()? {
                    many.push(x);
                }
                Ok(PerAxis(many))
            }
        }
        deserializer.deserialize_any(OneOrMany(PhantomData))
    }
}

/// One condition for a whole side, or one for each component.
pub enum FileSide {
    Whole(String),
    Each(BTreeMap<String, Spanned<String>>),
}

impl<'de> Deserialize<'de> for FileSide {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Side;
        impl<'de> Visitor<'de> for Side {
            type Value = FileSide;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a string or a table of components")
            }
            fn visit_str<E>(self, whole: &str) -> Result<FileSide, E> {
                Ok(FileSide::Whole(whole.to_string()))
            }
            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<FileSide, A::Error> {
                BTreeMap::deserialize(value::MapAccessDeserializer::new(map)).map(FileSide::Each)
            }
        }
        deserializer.deserialize_any(Side)
    }
}
