//! One scene: its settings, its picture, its measurements, what is judged by them, and the files that are made of it.

pub mod adjacency_file;
pub mod engine;
pub mod export;
#[cfg(any(test, feature = "for_tests"))]
pub mod for_tests;
pub mod gates;
pub mod html;
pub mod measure;
pub mod plot;
pub mod reference_shape;
pub mod render;
pub mod settings;
pub mod shader_files;
pub mod shot;
pub mod user_shader;
