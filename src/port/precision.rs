//! Recognises numbers that have fewer digits than they should: printed with too few, or made in
//! single precision.

use super::entry::Entry;
use super::patterns::Both;
use crate::run::table::shortest;

/// So many digits are less than what 64 bits hold.
const FEW: usize = 13;

/// Says what the digits of a port's numbers tell, where those of `group` differ from the
/// reference.
pub fn of(theirs: &[Entry], group: &[Both]) -> Option<String> {
    if !group.iter().all(|both| apart(both.right, both.own, group) < 1e-3) {
        return None;
    }
    let single = |x: f64| f64::from(x as f32) == x || shortest(f64::from(x as f32)) == shortest(x);
    let numbers = || theirs.iter().map(|entry| entry.value).filter(|x| *x != 0.0);
    if numbers().all(single) {
        return Some(
            "all numbers are those of single precision (32 bits): compute and print in double"
                .into(),
        );
    }
    let most = numbers().map(digits).max().unwrap_or(0);
    if most < FEW {
        return Some(format!(
            "the numbers are printed with {most} digits: 17 (%.17g) read back as the same"
        ));
    }
    let behind = numbers().map(decimals).max().unwrap_or(0);
    if behind < FEW {
        return Some(format!("the numbers are printed with {behind} decimals: use %.17g"));
    }
    let rounded = |both: &Both| both.own == f64::from(both.right as f32);
    let changed = group.iter().any(|both| both.own != both.right);
    (changed && group.iter().all(rounded))
        .then(|| "these numbers are those of single precision (32 bits)".into())
}

/// Says what small differences tell by their size, relative to the largest of `group`.
pub fn by_size(group: &[Both]) -> Option<String> {
    let off = group.iter().map(|both| apart(both.right, both.own, group));
    let largest = off.fold(0.0, f64::max);
    (1e-12..3e-6).contains(&largest).then(|| {
        let symbol = group.first().map_or("", |both| both.entry.symbol);
        let why = match symbol {
            "N_Ip" | "grad_N_Ip" | "lambda" => "is λ solved to the last digit?",
            _ => "has a constant few digits, or is a sum cancelled?",
        };
        format!("the difference is {largest:.0e} of the largest: is something in single precision, or {why}")
    })
}

/// Gives how far two numbers are apart, relative to the largest of their group.
fn apart(right: f64, own: f64, group: &[Both]) -> f64 {
    let largest = group.iter().map(|both| both.right.abs()).fold(f64::MIN_POSITIVE, f64::max);
    (right - own).abs() / largest
}

/// Counts the significant digits of the shortest decimal that reads back as `x`.
fn digits(x: f64) -> usize {
    let text = format!("{x:e}");
    text.split('e').next().unwrap_or("").chars().filter(char::is_ascii_digit).count()
}

/// Counts the decimals behind the point.
fn decimals(x: f64) -> usize {
    let exponent = format!("{x:e}").split('e').nth(1).and_then(|e| e.parse::<i64>().ok());
    (digits(x) as i64 - 1 - exponent.unwrap_or(0)).max(0) as usize
}
