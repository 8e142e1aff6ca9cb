//! Studies: many runs of one scene, and what can be said before any.

pub mod stability;
