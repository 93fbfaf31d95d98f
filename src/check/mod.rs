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

pub(crate) use assets::{FolderError, assets};
pub(crate) use cache::{Cache, Inputs};
pub(crate) use config::{Config, ConfigError, OptionValue, Section};
pub(crate) use junit::junit;
pub(crate) use page::page;
pub(crate) use report::{Asset, GateResult, Numbers, Report, View};
pub(crate) use sarif::sarif;
