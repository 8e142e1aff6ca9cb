//! A run gives a summary, and files with histories, pictures and particles.

#[cfg(feature = "program")]
pub mod figure;
#[cfg(feature = "program")]
pub mod files;
#[cfg(feature = "program")]
pub mod report;
#[cfg(feature = "program")]
pub mod results;
pub mod summary;
#[cfg(feature = "program")]
pub mod vtk;
