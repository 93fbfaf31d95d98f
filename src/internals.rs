//! What the project's own benches, fuzzers and tests in other processes use. It isn't part of the library's interface,
//! and changes without notice.

pub use crate::app::window::run::run_watched;
pub use crate::app::{App, persistence::Persistence};
pub use crate::cli::picture_comparison::{CompareError, compare};
pub use crate::engine::measurements::Measurements;
pub use crate::engine::{Engine, Loaded, Preparation, load as load_and_prepare};
pub use crate::files::Limits;
pub use crate::gpu::adapters::AdapterChoice;
pub use crate::gpu::device::Gpu;
pub use crate::gpu::layout::{CurveNet, Patch as PatchLayout};
pub use crate::gpu::readback::read_buffer;
pub use crate::gpu::recorder::{DRAWING, PASSES, PassTime, Timing, take_times};
pub use crate::load::heights::{HeightError, HeightSource};
pub use crate::load::import::{Import, LengthUnit, NormalSource};
pub use crate::load::memory_budget::Budget;
pub use crate::load::mesh_file::{Format, read};
pub use crate::load::parts::Part;
pub use crate::load::selection::Selection;
pub use crate::load::source::Source;
pub use crate::measure::optimum::{Compared, Optimum, compare_with_optimum};
pub use crate::mesh::adjacency::Layout;
pub use crate::mesh::mesh_builder::MeshBuilder;
pub use crate::mesh::orientation::UpAxis;
pub use crate::mesh::shapes::Shape;
pub use crate::mesh::weld_preview::weld_previews;
pub use crate::numbers::utc;
pub use crate::plot::{BLUE, FONT, INK, use_font};
pub use crate::render::camera::Camera;
pub use crate::render::scene::Scene;
pub use crate::render::target::{Target, samples};
pub use crate::settings::light::Lighting;
pub use crate::settings::options::TOLERANCE_RANGE;
pub use crate::settings::{ARENA_BYTES, Settings};
pub use crate::tessellate::domain::{domain_plan, domain_point, domain_triangle};
pub use crate::tessellate::factors::{outer_count, point_count, row_base, triangle_count};
pub use crate::tessellate::hull_factors::HullFactors;
