//! pnaen: loads a mesh, tessellates it in compute passes, and shows what the tessellation did.
//!
//! The way through the crate: [`mesh`] (what a file becomes) -> [`tessellate`] (the mathematics, on the CPU: the
//! reference) -> [`gpu`] (the same mathematics as compute passes) -> [`render`] (one indirect draw into a texture).
//! [`measure`] looks at what came out, also against a [`truth`], [`export`] writes it to files, [`engine`] puts them together. [`app`] (the
//! window) and [`cli`] (the commands) are two thin faces of all that, and hold no mathematics.

pub mod adjacency_file;
pub mod app;
pub mod chart;
pub mod cli;
pub mod commands;
pub mod engine;
pub mod export;
pub mod factors_file;
pub mod files;
pub mod gallery;
pub mod gpu;
pub mod load;
pub mod markdown;
pub mod measure;
pub mod mesh;
pub mod names;
pub mod numbers;
pub mod plot;
pub mod progress;
pub mod render;
#[cfg(test)]
mod rooms;
pub mod settings;
pub mod stability;
pub mod tessellate;
pub mod truth;
pub mod view;
