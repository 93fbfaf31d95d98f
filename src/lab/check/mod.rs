//! Checks a folder of assets: its configuration, what was found, and reports of that for people and for build servers. Loading
//! and measuring is the command's.

mod assets;
mod cache;
mod config;
mod junit;
mod page;
mod pattern;
mod report;
mod sarif;

pub use assets::assets;
pub use cache::{Cache, Inputs};
pub use config::{Config, OptionValue, Section};
pub use junit::junit;
pub use page::{PICTURES, page, pictures};
pub use report::{Asset, GOLDEN, GateResult, Report, View};
pub use sarif::sarif;
