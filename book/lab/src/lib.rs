//! The solver for a page: scenes go in as text, numbers come out.
//!
//! Compiled to WebAssembly it has a bare C interface. A page asks for memory with [`alloc`],
//! writes a request into it, and calls [`limit`], [`run`], [`history`] or [`shape`], which frees
//! the request. A request is UTF-8: fields with a zero byte between them, first a number
//! whose meaning depends on the call, then the scene, then the `KEY=VALUE` of each `--set`.
//!
//! An answer begins with the number of the bytes that follow, a little-endian `u32`. They are
//! parts, one after the other: the length of the name, the name, the length of the content, the
//! content; the lengths are such numbers, too. Lists of numbers are little-endian `f64`, all
//! else is text. The page gives the answer back with [`free`]. A request that cannot be served
//! has the part `error`, the program's own words.

mod answer;
mod bar;

use answer::Answer;
use bar::Request;

/// Lends `length` bytes; [`free`] takes them back.
#[unsafe(no_mangle)]
pub extern "C" fn alloc(length: usize) -> *mut u8 {
    Box::into_raw(vec![0_u8; length].into_boxed_slice()).cast()
}

/// Takes back `length` bytes at `start`.
///
/// # Safety
///
/// `start` and `length` are those of a call of [`alloc`], or of an answer and its four bytes
/// more, and nobody has given them back before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn free(start: *mut u8, length: usize) {
    drop(unsafe { Box::from_raw(std::ptr::slice_from_raw_parts_mut(start, length)) });
}

/// Answers a request at `start`, which it frees, with `serve`.
///
/// # Safety
///
/// As for [`free`].
unsafe fn answer(start: *mut u8, length: usize, serve: impl Fn(&Request) -> Answer) -> *mut u8 {
    let bytes = unsafe { Box::from_raw(std::ptr::slice_from_raw_parts_mut(start, length)) };
    let answer = match Request::read(&bytes) {
        Ok(request) => serve(&request),
        Err(problem) => Answer::error(problem),
    };
    Box::into_raw(answer.into_bytes().into_boxed_slice()).cast()
}

/// Answers what the time step of a scene is, and the limit that is predicted for it.
///
/// # Safety
///
/// As for [`free`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn limit(start: *mut u8, length: usize) -> *mut u8 {
    unsafe { answer(start, length, bar::limit) }
}

/// Runs a scene and answers its history, its particles and the exact fields at as many moments
/// as the request's number says at most, its summary, and its warnings.
///
/// # Safety
///
/// As for [`free`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn run(start: *mut u8, length: usize) -> *mut u8 {
    unsafe { answer(start, length, bar::run) }
}

/// Runs a scene and answers its history alone, every step that the scene records, as numbers and
/// as the program's own file `history.csv`.
///
/// # Safety
///
/// As for [`free`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn history(start: *mut u8, length: usize) -> *mut u8 {
    unsafe { answer(start, length, bar::history) }
}

/// Answers N_I(x) and dN_I/dx of a bar's nodes at as many equally spaced places of it as the
/// request's number says.
///
/// # Safety
///
/// As for [`free`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shape(start: *mut u8, length: usize) -> *mut u8 {
    unsafe { answer(start, length, bar::shape) }
}
