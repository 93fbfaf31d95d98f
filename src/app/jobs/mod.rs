//! What runs on threads of their own while the window goes on: loading, checking, measuring and writing files.

pub(super) mod background_job;
pub(super) mod chart_job;
pub(super) mod companion_files;
pub(super) mod deviation_job;
pub(super) mod drawn_measurement;
pub(super) mod explain_job;
pub(super) mod file_watch;
pub(super) mod folder_job;
pub(super) mod given;
pub(super) mod given_factors;
pub(super) mod job_list;
pub(super) mod leak_job;
pub(super) mod measure_job;
pub(super) mod mesh_checks;
mod patience;
pub(super) mod picture_job;
pub(super) mod scenes;
pub(super) mod silhouette_job;
pub(super) mod stand_in;
pub(super) mod user_shader_job;
pub(super) mod walk;
