//! Reads the probes of a scene.

use super::fault::SceneError;
use super::keys::AXES;
use super::parts::{Body, Probe, Quantity};
use super::values::Values;

/// Reads the list `probe`.
pub fn probes(values: &Values, body: &Body) -> Result<Vec<Probe>, Box<SceneError>> {
    let mut probes: Vec<Probe> = Vec::new();
    for entry in values.entries("probe") {
        let key = format!("{entry}.name");
        let name = values.word(&key)?;
        // Files on some systems do not tell upper from lower case.
        if probes.iter().any(|probe| probe.name.eq_ignore_ascii_case(name)) {
            return Err(values.error(&key, format!("\"{name}\" is taken")));
        }
        let inside = |d: usize, x: f64| body.origin[d] <= x && x <= body.origin[d] + body.length[d];
        let position = values.axes_if(&format!("{entry}.position"), inside)?;
        probes.push(Probe {
            name: name.to_string(),
            quantity: quantity(values, &entry)?,
            position: (0..values.dimension()).map(|d| position[d] - body.origin[d]).collect(),
        });
    }
    Ok(probes)
}

fn quantity(values: &Values, entry: &str) -> Result<Quantity, Box<SceneError>> {
    let kinds = [
        ("velocity", Quantity::Velocity(0)),
        ("stress", Quantity::Stress(0, 0)),
        ("displacement", Quantity::Displacement(0)),
    ];
    let (quantity, component) = (format!("{entry}.quantity"), format!("{entry}.component"));
    let kind = values.choose(&quantity, &kinds)?;
    if !values.has(&component) {
        if values.dimension() == 1 {
            return Ok(kind);
        }
        let problem = "in 2D and 3D a probe needs the key `component`";
        return Err(values.error_at(&component, &quantity, problem));
    }
    let letters = values.word(&component)?;
    let axes: Vec<usize> =
        letters.chars().filter_map(|c| AXES.iter().position(|axis| axis.starts_with(c))).collect();
    match (kind, axes.as_slice()) {
        _ if axes.iter().any(|axis| *axis >= values.dimension()) => None,
        (Quantity::Velocity(_), &[i]) => Some(Quantity::Velocity(i)),
        (Quantity::Displacement(_), &[i]) => Some(Quantity::Displacement(i)),
        (Quantity::Stress(..), &[i, j]) => Some(Quantity::Stress(i, j)),
        _ => None,
    }
    .ok_or_else(|| values.error(&component, format!("\"{letters}\" is not a component of it")))
}
