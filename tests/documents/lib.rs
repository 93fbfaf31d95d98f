//! Files that tests write and then read.

pub mod lamp;
pub mod moving;
pub mod package;
pub mod panoramas;
pub mod scenes;
pub mod shot;
pub mod webp;
