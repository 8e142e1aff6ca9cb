//! The solver for a page: scenes go in as text, numbers come out.
//!
//! Compiled to WebAssembly it has a bare C interface. A page asks for memory with [`alloc`],
//! writes a request into it, and calls [`limit`], [`begin`], [`history`], [`exact`], [`moment`],
//! [`point`], [`shape`] or [`steps`], which frees the request; a run that has begun is taken on by
//! [`go_on`]. A request is UTF-8: fields with a zero byte between them, first a number
//! whose meaning depends on the call, then the scene, then the `KEY=VALUE` of each `--set`.
//!
//! An answer begins with the number of the bytes that follow, a little-endian `u32`. They are
//! parts, one after the other: the length of the name, the name, the length of the content, the
//! content; the lengths are such numbers, too. Lists of numbers are little-endian `f64`, all
//! else is text. The page gives the answer back with [`free`]. A request that cannot be served
//! has the part `error`, the program's own words.

mod answer;
mod bar;
mod live;
mod steps;

use answer::Answer;
use bar::Request;
use live::Live;
use std::cell::RefCell;

thread_local! {
    /// The run that has begun; a page has one at a time.
    static LIVE: RefCell<Option<Box<dyn Live>>> = const { RefCell::new(None) };
}

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

/// Begins a run and answers its sizes and limits; the request's number is the largest number of
/// moments at which the particles are kept. A run that was under way is given up.
///
/// # Safety
///
/// As for [`free`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn begin(start: *mut u8, length: usize) -> *mut u8 {
    LIVE.set(None);
    let serve = |request: &Request| {
        let (answer, live) = live::begin(request);
        LIVE.set(live);
        answer
    };
    unsafe { answer(start, length, serve) }
}

/// Takes the run that has begun on by so many time steps, and answers what is new: its history,
/// its particles, and at the end its summary and its warnings.
#[unsafe(no_mangle)]
pub extern "C" fn go_on(steps: usize) -> *mut u8 {
    let answer = LIVE.with_borrow_mut(|live| match live {
        Some(live) => live.go_on(steps),
        None => Answer::error("no run has begun"),
    });
    Box::into_raw(answer.into_bytes().into_boxed_slice()).cast()
}

/// Runs a scene and answers its history alone, every step that the scene records, as numbers and
/// as the program's own file `history.csv`.
///
/// # Safety
///
/// As for [`free`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn history(start: *mut u8, length: usize) -> *mut u8 {
    unsafe { answer(start, length, live::history) }
}

/// Answers the exact fields of a bar at as many moments as the request's number says.
///
/// # Safety
///
/// As for [`free`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn exact(start: *mut u8, length: usize) -> *mut u8 {
    unsafe { answer(start, length, bar::exact) }
}

/// Answers the exact fields of a bar at one moment (s), the request's number.
///
/// # Safety
///
/// As for [`free`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn moment(start: *mut u8, length: usize) -> *mut u8 {
    unsafe { answer(start, length, bar::moment) }
}

/// Answers the exact history of one material point (m) of a bar, the request's number.
///
/// # Safety
///
/// As for [`free`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn point(start: *mut u8, length: usize) -> *mut u8 {
    unsafe { answer(start, length, bar::point) }
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

/// Answers what particles and nodes of a bar are after each of the nine steps of one time step,
/// whose number is the request's.
///
/// # Safety
///
/// As for [`free`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn steps(start: *mut u8, length: usize) -> *mut u8 {
    unsafe { answer(start, length, steps::steps) }
}
