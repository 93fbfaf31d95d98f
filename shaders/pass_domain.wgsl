// The tessellator alone, without a mesh: sets of factors in, domain points and triangles out.
// With: connectivity

struct DomainParams {
    partitioning: u32,
    set_count: u32,
}

// Room for the output of one set of factors: the most points and triangles that there are, at 127 rows.
const DOMAIN_POINTS: u32 = 8256u;
const DOMAIN_TRIANGLES: u32 = 16129u;

@group(0) @binding(0) var<uniform> domain_params: DomainParams;
// Bits of the three edge factors and the inside factor.
@group(0) @binding(1) var<storage, read> factor_sets: array<vec4<u32>>;
@group(0) @binding(2) var<storage, read_write> domain_counts: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read_write> domain_points: array<vec2<u32>>;
// Three indices a triangle.
@group(0) @binding(4) var<storage, read_write> domain_triangles: array<u32>;

@compute @workgroup_size(256)
fn domain_main(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let index = invocation.x;
    let case_index = invocation.y;
    if case_index >= domain_params.set_count {
        return;
    }
    let raw = bitcast<vec4<f32>>(factor_sets[case_index]);
    let factors = process(domain_params.partitioning, raw.xyz, raw.w);
    let points = point_count(factors);
    let triangles = triangle_count(factors);
    if index == 0u {
        domain_counts[case_index] = vec2<u32>(points, triangles);
    }
    if index < points {
        domain_points[case_index * DOMAIN_POINTS + index] = domain_point(domain_plan(factors), index);
    }
    if index < triangles {
        let triangle = domain_triangle(domain_plan(factors), index);
        let first = 3u * (case_index * DOMAIN_TRIANGLES + index);
        domain_triangles[first] = triangle.x;
        domain_triangles[first + 1u] = triangle.y;
        domain_triangles[first + 2u] = triangle.z;
    }
}
