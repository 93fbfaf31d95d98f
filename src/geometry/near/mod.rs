//! What is near: nearest points of triangles, and how far one surface is from another, with a proof.

mod crossings;
mod farthest;
mod polygon;
mod triangle_tree;

pub use crossings::{Crossing, cross, crossings};
pub use farthest::{Farthest, Goal, Interval, Soup, farthest};
pub use triangle_tree::{Closest, TriangleTree, closest_on_triangle};
