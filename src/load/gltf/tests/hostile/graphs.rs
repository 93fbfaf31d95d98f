//! Nodes that hang on one another in ways that they mustn't, or in great number.

use super::*;

/// A triangle whose nodes are these, of which the scene shows the last.
fn nodes(nodes: Vec<Value>) -> String {
    let mut draft = triangle();
    draft.root["scenes"] = json!([{ "nodes": [nodes.len() - 1] }]);
    draft.root["nodes"] = json!(nodes);
    draft.document().to_string()
}

/// Each the child of the next; the first has the mesh.
fn chain(count: usize) -> Vec<Value> {
    let next = (1..count).map(|i| json!({ "children": [i - 1] }));
    [json!({ "mesh": 0 })].into_iter().chain(next).collect()
}

pub fn cases() -> Vec<Case> {
    let mut circle = chain(200_000);
    circle[0]["children"] = json!([199_999]);
    let mut wide = vec![json!({ "mesh": 0 }); 20_000];
    wide.push(json!({ "children": (0..20_000).collect::<Vec<usize>>() }));
    vec![
        Case::refused(
            "two parents",
            nodes(vec![json!({ "mesh": 0 }), json!({ "children": [0] }), json!({ "children": [1, 0] })]),
            "/nodes/2/children/1 is 0, which is among /nodes/1/children already; export the model again",
        ),
        Case::refused(
            "a child twice",
            nodes(vec![json!({ "mesh": 0 }), json!({ "children": [0, 0] })]),
            "/nodes/1/children/1 is 0, which is among /nodes/1/children already; export the model again",
        ),
        Case::refused(
            "its own child",
            nodes(vec![json!({ "mesh": 0, "children": [0] })]),
            "/nodes/0/children lead back to node 0, which would be its own ancestor; export the model again",
        ),
        Case::refused(
            "a circle beside a tree",
            nodes(vec![json!({ "children": [1] }), json!({ "children": [0] }), json!({ "mesh": 0 })]),
            "/nodes/0/children lead back to node 0, which would be its own ancestor; export the model again",
        ),
        Case::refused(
            "a circle of 200,000",
            nodes(circle),
            "/nodes/0/children lead back to node 0, which would be its own ancestor; export the model again",
        ),
        Case::new("200,000 nodes nested", nodes(chain(200_000)), Gets::Read),
        Case::new("20,000 nodes side by side", nodes(wide), Gets::Read),
    ]
}
