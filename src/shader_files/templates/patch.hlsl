@HEADER@
// Vertex, hull and domain shader, shader model 5.0: vs_main, hs_main with hs_patch, and ds_main.

@FUNCTIONS@

cbuffer Tessellation : register(b0)
{
    StageConstants constants;
};

// A corner of the mesh.
struct Corner
{
    float3 position : POSITION;
    float3 normal : NORMAL;
    float2 uv : TEXCOORD0;
};

struct PatchFactors
{
    float edges[3] : SV_TessFactor;
    float inside : SV_InsideTessFactor;
    // The control points of side k near its start and near its end, and the one in the middle of the patch.
    precise float3 near_start[3] : NEAR_START;
    precise float3 near_end[3] : NEAR_END;
    float3 middle : MIDDLE;
};

struct Vertex
{
    // In object units; a unit vector; texture coordinates.
    precise float3 position : POSITION;
    float3 normal : NORMAL;
    float2 uv : TEXCOORD0;
    precise float4 place : SV_Position;
};

Corner vs_main(Corner corner)
{
    return corner;
}

// Computes the sides of a patch: side k runs from corner k to corner (k + 1) % 3.
PatchFactors hs_patch(InputPatch<Corner, @INDICES@> corners)
{
    PatchFactors made;
    ControlNet net;
    precise float3 sides;
    [unroll] for (uint k = 0; k < 3; k++)
    {
        uint next = (k + 1) % 3;
        SideNormals own;
        own.at_a = corners[k].normal;
        own.at_b = corners[next].normal;
        SideNormals across;
        across.at_a = @ACROSS_A@;
        across.at_b = @ACROSS_B@;
        precise HullSide side = hull_side(constants, corners[k].position, corners[next].position, own, across);
        made.near_start[k] = side.near_start;
        made.near_end[k] = side.near_end;
        sides[k] = side.factor;
        net.corners[k] = corners[k].position;
        net.edges[2 * k] = side.near_start;
        net.edges[2 * k + 1] = side.near_end;
    }
    net.center_ = center_control_point(net.corners, net.edges);
    float4 factors = tessellation_factors(constants, net, sides);
    made.edges[0] = factors.x;
    made.edges[1] = factors.y;
    made.edges[2] = factors.z;
    made.inside = factors.w;
    made.middle = net.center_;
    return made;
}

[domain("tri")]
[partitioning("@PARTITIONING@")]
[outputtopology("triangle_cw")]
[outputcontrolpoints(3)]
[patchconstantfunc("hs_patch")]
[maxtessfactor(64.0)]
Corner hs_main(InputPatch<Corner, @INDICES@> corners, uint k : SV_OutputControlPointID)
{
    return corners[k];
}

[domain("tri")]
Vertex ds_main(PatchFactors factors, float3 location : SV_DomainLocation, const OutputPatch<Corner, 3> corners)
{
    StagePatch hull;
    hull.net.center_ = factors.middle;
    [unroll] for (uint k = 0; k < 3; k++)
    {
        hull.net.corners[k] = corners[k].position;
        hull.net.edges[2 * k] = factors.near_start[k];
        hull.net.edges[2 * k + 1] = factors.near_end[k];
        hull.normals[k] = corners[k].normal;
        hull.uvs[k] = corners[k].uv;
    }
    precise StageVertex made = stage_vertex(hull, fixed_location(location));
    Vertex vertex;
    vertex.position = made.position;
    vertex.normal = made.normal;
    vertex.uv = made.uv;
    // The same bits on both sides of an edge give the same place on screen only if nothing is fused here either.
    vertex.place = mul(float4(made.position, 1.0), constants.clip_from_object);
    return vertex;
}
