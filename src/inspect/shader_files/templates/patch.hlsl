@HEADER@
// Vertex, hull and domain shader, shader model 5.0: vs_main, hs_main with hs_patch, and ds_main.

@FUNCTIONS@

cbuffer Tessellation : register(b0)
{
    StageConstants constants;
};

@D@cbuffer Heights : register(b1)
@D@{
@D@    HeightConstants height_constants;
@D@};
@D@
// A corner of the mesh.
struct Corner
{
    float3 position : POSITION;
    float3 normal : NORMAL;
    float2 uv : TEXCOORD0;
@U@    // The second vertex buffer: the unit vector along which the corner's point moves, the gradients of its texture coordinates,
@U@    // and the length of the point's shortest edge in px of level 0.
@V@    // The second vertex buffer: the unit vector along which the corner's point moves, and the gradients of its texture coordinates.
@D@    float3 direction : DIRECTION;
@D@    float3 along_u : ALONG_U;
@D@    float3 along_v : ALONG_V;
@U@    float texels : TEXELS;
@V@    // The third vertex buffer: the mip level at a point, which levels.hlsl keeps at the point's dominant corner.
@V@    uint level : LEVEL;
};

// What the hull shader hands on of corner k and of side k, which runs from corner k to corner (k + 1) % 3.
struct HullCorner
{
    float3 position : POSITION;
    float3 normal : NORMAL;
    float2 uv : TEXCOORD0;
    // The control points of the side near its start and near its end, and the factor of its edge.
    precise float3 near_start : NEAR_START;
    precise float3 near_end : NEAR_END;
    precise float factor : SIDE_FACTOR;
@D@    float3 direction : DIRECTION;
@D@    float3 along_u : ALONG_U;
@D@    float3 along_v : ALONG_V;
@D@    // The dominant corner on the same point.
@D@    float2 dominant_uv : DOMINANT_UV;
@D@    float3 dominant_along_u : DOMINANT_ALONG_U;
@D@    float3 dominant_along_v : DOMINANT_ALONG_V;
@D@    // The corners of the dominant side, at the start of side k and at its end.
@D@    float2 start_uv : START_UV;
@D@    float3 start_along_u : START_ALONG_U;
@D@    float3 start_along_v : START_ALONG_V;
@D@    float2 end_uv : END_UV;
@D@    float3 end_along_u : END_ALONG_U;
@D@    float3 end_along_v : END_ALONG_V;
};

struct HullOutput
{
    float edges[3] : SV_TessFactor;
    float inside : SV_InsideTessFactor;
    // The control point in the middle of the patch.
    float3 middle : MIDDLE;
@D@    // The mip levels at the corners, on the sides, and inside.
@D@    precise float3 corner_levels : CORNER_LEVELS;
@D@    precise float3 side_levels : SIDE_LEVELS;
@D@    precise float inside_level : INSIDE_LEVEL;
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

// Computes side k of a patch.
HullCorner hull_corner(InputPatch<Corner, @INDICES@> corners, uint k)
{
    uint next = (k + 1) % 3;
    SideNormals own;
    own.at_a = corners[k].normal;
    own.at_b = corners[next].normal;
    SideNormals across;
    across.at_a = @ACROSS_A@;
    across.at_b = @ACROSS_B@;
    precise HullSide side = hull_side(constants, corners[k].position, corners[next].position, own, across);
    HullCorner made;
    made.position = corners[k].position;
    made.normal = corners[k].normal;
    made.uv = corners[k].uv;
    made.near_start = side.near_start;
    made.near_end = side.near_end;
    made.factor = side.factor;
@D@    made.direction = corners[k].direction;
@D@    made.along_u = corners[k].along_u;
@D@    made.along_v = corners[k].along_v;
@D@    made.dominant_uv = corners[9 + k].uv;
@D@    made.dominant_along_u = corners[9 + k].along_u;
@D@    made.dominant_along_v = corners[9 + k].along_v;
@D@    made.start_uv = corners[12 + 2 * k].uv;
@D@    made.start_along_u = corners[12 + 2 * k].along_u;
@D@    made.start_along_v = corners[12 + 2 * k].along_v;
@D@    made.end_uv = corners[13 + 2 * k].uv;
@D@    made.end_along_u = corners[13 + 2 * k].along_u;
@D@    made.end_along_v = corners[13 + 2 * k].along_v;
    return made;
}

// Computes what a patch has once, of the sides that hs_main has computed.
HullOutput hs_patch(InputPatch<Corner, @INDICES@> corners, OutputPatch<HullCorner, 3> hull)
{
    HullOutput made;
    ControlNet net;
    precise float3 sides;
    [unroll] for (uint k = 0; k < 3; k++)
    {
        net.corners[k] = hull[k].position;
        net.edges[2 * k] = hull[k].near_start;
        net.edges[2 * k + 1] = hull[k].near_end;
        sides[k] = hull[k].factor;
    }
    net.center_ = center_control_point(net.corners, net.edges);
    float4 factors = tessellation_factors(constants, net, sides);
    made.edges[0] = factors.x;
    made.edges[1] = factors.y;
    made.edges[2] = factors.z;
    made.inside = factors.w;
    made.middle = net.center_;
@D@    [unroll] for (uint i = 0; i < 3; i++)
@D@    {
@U@        made.corner_levels[i] = corner_level(height_constants, constants.factor, corners[i].texels);
@V@        made.corner_levels[i] = level_of(corners[9 + i].level);
@D@        made.side_levels[i] = side_level(height_constants, sides[i], corners[12 + 2 * i].uv, corners[13 + 2 * i].uv);
@D@    }
@D@    float2 uvs[3] = { corners[0].uv, corners[1].uv, corners[2].uv };
@D@    made.inside_level = level_inside(height_constants, segments_inside(factors), uvs);
    return made;
}

[domain("tri")]
[partitioning("@PARTITIONING@")]
[outputtopology("triangle_cw")]
[outputcontrolpoints(3)]
[patchconstantfunc("hs_patch")]
[maxtessfactor(64.0)]
HullCorner hs_main(InputPatch<Corner, @INDICES@> corners, uint k : SV_OutputControlPointID)
{
    return hull_corner(corners, k);
}

@D@StageRelief patch_relief(HullOutput factors, const OutputPatch<HullCorner, 3> corners)
@D@{
@D@    StageRelief relief;
@D@    [unroll] for (uint k = 0; k < 3; k++)
@D@    {
@D@        HullCorner own = corners[k];
@D@        relief.directions[k] = own.direction;
@D@        relief.own[k].uv = own.uv;
@D@        relief.own[k].along_u = own.along_u;
@D@        relief.own[k].along_v = own.along_v;
@D@        relief.dominant[k].uv = own.dominant_uv;
@D@        relief.dominant[k].along_u = own.dominant_along_u;
@D@        relief.dominant[k].along_v = own.dominant_along_v;
@D@        relief.sides[2 * k].uv = own.start_uv;
@D@        relief.sides[2 * k].along_u = own.start_along_u;
@D@        relief.sides[2 * k].along_v = own.start_along_v;
@D@        relief.sides[2 * k + 1].uv = own.end_uv;
@D@        relief.sides[2 * k + 1].along_u = own.end_along_u;
@D@        relief.sides[2 * k + 1].along_v = own.end_along_v;
@D@    }
@D@    relief.corner_levels = factors.corner_levels;
@D@    relief.side_levels = factors.side_levels;
@D@    relief.inside_level = factors.inside_level;
@D@    return relief;
@D@}
@D@
[domain("tri")]
Vertex ds_main(HullOutput factors, float3 location : SV_DomainLocation, const OutputPatch<HullCorner, 3> corners)
{
    StagePatch hull;
    hull.net.center_ = factors.middle;
    [unroll] for (uint k = 0; k < 3; k++)
    {
        hull.net.corners[k] = corners[k].position;
        hull.net.edges[2 * k] = corners[k].near_start;
        hull.net.edges[2 * k + 1] = corners[k].near_end;
        hull.normals[k] = corners[k].normal;
        hull.uvs[k] = corners[k].uv;
    }
@N@    precise StageVertex made = stage_vertex(hull, fixed_location(location));
@D@    uint2 domain = fixed_location(location);
@D@    precise StageVertex made = displaced_vertex(height_constants, hull, patch_relief(factors, corners), domain);
    Vertex vertex;
    vertex.position = made.position;
    vertex.normal = made.normal;
    vertex.uv = made.uv;
    // The same bits on both sides of an edge give the same place on screen only if nothing is fused here either.
    vertex.place = mul(float4(made.position, 1.0), constants.clip_from_object);
    return vertex;
}
