//! From triangles to patches, points, edges and sides.
