// Blurs an environment as rough surfaces do. src/inspect/render/prefilter.rs has the first two functions, and
// src/inspect/for_tests/prefiltered.rs the others.

// A direction on a face of a cube map; `at` is -1 to 1 along the face's axes (WebGPU, section on cube maps).
fn cube_direction(face: u32, at: vec2<f32>) -> vec3<f32> {
    switch face {
        case 0u: { return vec3<f32>(1.0, -at.y, -at.x); }
        case 1u: { return vec3<f32>(-1.0, -at.y, at.x); }
        case 2u: { return vec3<f32>(at.x, 1.0, at.y); }
        case 3u: { return vec3<f32>(at.x, -1.0, -at.y); }
        case 4u: { return vec3<f32>(at.x, -at.y, 1.0); }
        default: { return vec3<f32>(-at.x, -at.y, -1.0); }
    }
}

// Point `index` of `count` of Hammersley's set in the unit square.
fn hammersley(index: u32, count: u32) -> vec2<f32> {
    return vec2<f32>(f32(index) / f32(count), f32(reverseBits(index) >> 8u) / 16777216.0);
}

// Two directions that are orthogonal to a unit vector and to each other (Duff et al. 2017, listing 3).
fn directions_across(normal: vec3<f32>) -> array<vec3<f32>, 2> {
    let side = select(-1.0, 1.0, normal.z >= 0.0);
    let a = -1.0 / (side + normal.z);
    let b = normal.x * normal.y * a;
    return array<vec3<f32>, 2>(
        vec3<f32>(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x),
        vec3<f32>(b, side + normal.y * normal.y * a, -normal.y),
    );
}

// A light's direction seen along the normal (z) of a GGX surface, by way of its microfacets (Walter et al. 2007, equations 35 and
// 36), and the square root of its density times 4 (w).
fn light_and_density(point: vec2<f32>, alpha: f32) -> vec4<f32> {
    let square = alpha * alpha;
    let cosine_squared = (1.0 - point.x) / (1.0 + (square - 1.0) * point.x);
    let sine_squared = square * point.x / (1.0 + (square - 1.0) * point.x);
    let angle = 2.0 * PI * point.y;
    let along = 2.0 * sqrt(cosine_squared * sine_squared);
    let spread = cosine_squared * square + sine_squared;
    return vec4<f32>(along * cos(angle), along * sin(angle), cosine_squared - sine_squared, alpha / (sqrt(PI) * spread));
}

// The level of the source whose texels are as large as a sample of that density, times 2 (Krivanek and Colbert 2008, section
// 3). `size` is the size of a face, in texels.
fn sample_level(root_density: f32, count: u32, size: f32) -> f32 {
    let texels = sqrt(24.0 / PI) * size / (root_density * sqrt(f32(count)));
    return max(log2(texels), 0.0);
}
