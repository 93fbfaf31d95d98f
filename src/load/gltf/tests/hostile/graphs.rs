//! Nodes with several parents, in cycles, or in great number.

use super::*;

/// A triangle with these nodes, of which the scene shows the last.
fn nodes(nodes: Vec<Value>) -> String {
    let mut draft = triangle();
    draft.root["scenes"] = json!([{ "nodes": [nodes.len() - 1] }]);
    draft.root["nodes"] = json!(nodes);
    draft.document().to_string()
}

/// A chain in which each node is the child of the next; the first has the mesh.
fn chain(count: usize) -> Vec<Value> {
    let next = (1..count).map(|i| json!({ "children": [i - 1] }));
    [json!({ "mesh": 0 })].into_iter().chain(next).collect()
}

pub(super) fn cases() -> Vec<Case> {
    let mut circle = chain(300_000);
    circle[0]["children"] = json!([299_999]);
    let mut wide = vec![json!({ "mesh": 0 }); 300_000];
    wide.push(json!({ "children": (0..300_000).collect::<Vec<usize>>() }));
    vec![
        Case::new(
            "two parents",
            nodes(vec![json!({ "mesh": 0 }), json!({ "children": [0] }), json!({ "children": [1, 0] })]),
            Gets::Repaired("/nodes/2/children/1 | 0 | /nodes/1/children | placed"),
        ),
        Case::new(
            "a child twice",
            nodes(vec![json!({ "mesh": 0 }), json!({ "children": [0, 0] })]),
            Gets::Repaired("/nodes/1/children/1 | 0 | /nodes/1/children | placed"),
        ),
        Case::refused(
            "a circle with another parent",
            nodes(vec![json!({ "mesh": 0, "children": [1] }), json!({ "children": [0] }), json!({ "children": [0] })]),
            "Empty | no node | mesh",
        ),
        Case::new(
            "a child of 300,000 nodes",
            nodes(
                [json!({ "mesh": 0 })]
                    .into_iter()
                    .chain(vec![json!({ "children": [0] }); 300_000])
                    .chain([json!({ "children": (1..=300_000).collect::<Vec<usize>>() })])
                    .collect(),
            ),
            Gets::Repaired("/nodes/2/children/0 | 0 | /nodes/1/children | placed"),
        ),
        Case::refused(
            "its own child",
            nodes(vec![json!({ "mesh": 0, "children": [0] })]),
            "Document | /nodes/0/children | 0 | ancestor",
        ),
        Case::new(
            "a circle beside the scene",
            nodes(vec![json!({ "children": [1] }), json!({ "children": [0] }), json!({ "mesh": 0 })]),
            Gets::Read,
        ),
        Case::refused(
            "a circle beside a tree, without scenes",
            nodes(vec![json!({ "children": [1] }), json!({ "children": [0] }), json!({ "mesh": 0 })])
                .replace("\"scenes\"", "\"others\""),
            "Document | /nodes/0/children | 0 | ancestor",
        ),
        Case::refused("a circle of 300,000", nodes(circle), "Document | /nodes/0/children | 0 | ancestor"),
        Case::new("300,000 nodes nested", nodes(chain(300_000)), Gets::Read),
        Case::new("300,000 nodes side by side", nodes(wide), Gets::Read),
    ]
}
