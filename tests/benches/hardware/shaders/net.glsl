// A corner of a patch's control net, which has three of these. Twin of NetCorner in ../peer.rs.

struct NetCorner {
    // The corner's position, and its texture coordinate's u.
    vec4 position_u;
    // Its normal, and its texture coordinate's v.
    vec4 normal_v;
    // The control point near the start of the side that starts here; w has x, y or z of the centre for corner 0, 1 or 2.
    vec4 near_center;
    // The same side's control point near its end; w is unused.
    vec4 far;
};

layout(std430, set = 0, binding = 0) readonly buffer Nets {
    NetCorner net_corners[];
};
