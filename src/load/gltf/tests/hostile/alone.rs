//! Documents that are refused here, although at least two of three other programs show triangles of them.

/// Why, and the documents' names.
pub(super) const ALONE: [(&str, &[&str]); 11] = [
    (
        "where the mesh lies isn't known, and the others draw it as if the file said nothing about it",
        &["a matrix of three numbers", "a translation beyond f32", "a scale of nothing", "a rotation of three numbers"],
    ),
    (
        "the shape depends on its morph targets, of which the others show none",
        &["weights that are text", "targets that are a number", "a morph target with a weight that isn't there"],
    ),
    (
        "some of its positions lie beyond the data, and the others draw whatever they find there",
        &[
            "one element more than there is",
            "an offset of 2^62",
            "an offset of 4",
            "a view longer than its buffer",
            "a stride past the end",
            "sparse values beyond the list",
            "more sparse values than there are",
        ],
    ),
    (
        "its positions aren't stored as the format says, so that their bytes may mean something else",
        &[
            "a stride below 4",
            "a stride within an element",
            "positions of two numbers",
            "sparse places that are no integers",
        ],
    ),
    ("its only face has a position that isn't finite", &["positions that are no numbers"]),
    (
        "a triangle has a vertex that isn't in the file, and the others draw another one or end",
        &["an index beyond the vertices", "an index that starts anew"],
    ),
    (
        "its vertices may lie anywhere before their joints place them, and the others pose no skins",
        &["fewer matrices than joints"],
    ),
    (
        "the file says that it can't be shown without an extension that isn't read here, nor by the others",
        &["an extension that nobody knows", "an extension of the shape, required"],
    ),
    (
        "it would take more memory than a file of this size may take (--max-memory allows more)",
        &["6000 triangles on 5000 nodes", "60,000 triangles on 3000 nodes"],
    ),
    (
        "its compression isn't known. The others don't look at the compressed data, and draw what stands in its place",
        &["a compression that there isn't"],
    ),
    ("the file hides all of its nodes, and the others don't know that it can", &["a scene of hidden nodes"]),
];
