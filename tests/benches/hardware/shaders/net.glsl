// A patch's control net as the peer has it: three of these. Twin of NetCorner in ../peer.rs.

struct NetCorner {
    // The corner's position, and its texture coordinate's u.
    vec4 position_u;
    // Its normal, and its texture coordinate's v.
    vec4 normal_v;
    // The control point of the side that starts here near its start, and this one of the centre's coordinates.
    vec4 near_center;
    // The same side's control point near its end; w is nothing.
    vec4 far;
};

layout(std430, set = 0, binding = 0) readonly buffer Nets {
    NetCorner net_corners[];
};
