use super::*;
use gpu::user_lod::LOD_PURPOSE;
use gpu::{LodShader, SurfaceShader};

/// What every file must have.
const EDGE: &str = "fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32 { return 2.0; }";

fn compile(text: &str) -> Result<LodShader, Fault> {
    super::compile(text)
}

/// The line of the fault in a text, and what is said.
fn fault(text: &str) -> (usize, String) {
    let fault = compile(text).expect_err(text);
    (fault.line, fault.kind.to_string())
}

#[test]
fn the_examples_can_be_used() {
    fn use_all<S: UserShader>(folder: &str) {
        let folder = assets::path(folder);
        let mut count = 0;
        for entry in std::fs::read_dir(folder).expect("the examples' folder") {
            let path = entry.expect("an entry").path();
            read_user_shader::<S>(&path).unwrap_or_else(|error| panic!("{error}"));
            count += 1;
        }
        assert!(count >= 3, "{count} examples");
    }
    use_all::<LodShader>("lod");
    use_all::<SurfaceShader>("surface");
}

#[test]
fn types_that_do_not_fit_are_named_as_the_language_names_them() {
    for (body, line, says) in [
        ("return 3u;", 3, "this `return` gives a value of another type than the function's result"),
        ("let x = 1.0;", 2, "this function can end without a value: give one with `return`"),
        ("let n = 3u;\n return length(edge.a * n);", 4, "`*` can't be between vec3<f32> and u32"),
        ("if edge.side { return 1.0; }\n return 2.0;", 3, "the condition of this `if` is no bool"),
        ("return half(edge.a);", 3, "argument 1 of this call has another type than the function's parameter"),
    ] {
        let text = format!(
            "fn half(x: f32) -> f32 {{ return 0.5 * x; }}\n\
             fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> f32 {{\n{body}\n}}\n"
        );
        let (at, said) = fault(&text);
        assert!(at == line && said.starts_with(says), "{body}: line {at}: {said}");
    }
}

#[test]
fn a_function_for_control_points_is_held_to_its_contract() {
    let fault = |text: &str| super::compile::<SurfaceShader>(text).expect_err(text);
    let own = "fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> EdgePoints { return EdgePoints(edge.a, edge.b); }";
    super::compile::<SurfaceShader>(own).unwrap_or_else(|fault| panic!("{fault}"));
    // A file for factors is none for control points, and the other way round.
    let missing = "there is no function edge_points; write: fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> EdgePoints";
    for text in ["", "fn half(x: f32) -> f32 { return 0.5 * x; }"] {
        let Fault { line, kind } = fault(text);
        assert!(line == 1 && kind.to_string().starts_with(missing), "{text}: {kind}");
    }
    let other =
        "the file was opened as surface shader, but edge_factor is the function of another kind of file, LOD shader";
    let Fault { line, kind } = fault(&format!("\n{EDGE}"));
    assert!(line == 2 && kind.to_string().starts_with(other), "{line}: {kind}");
    let other =
        "the file was opened as LOD shader, but edge_points is the function of another kind of file, surface shader";
    assert!(compile(own).expect_err("another kind").to_string().contains(other));
    for text in [
        "fn edge_points(edge: SurfaceEdge) -> EdgePoints { return EdgePoints(edge.a, edge.b); }",
        "fn edge_points(triangle: SurfaceTriangle, edge: SurfaceEdge) -> EdgePoints { return EdgePoints(edge.a, edge.b); }",
        "fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) -> vec3<f32> { return edge.a; }",
        "fn edge_points(edge: SurfaceEdge, triangle: SurfaceTriangle) { }",
    ] {
        let Fault { line, kind } = fault(&format!("\n{text}"));
        assert!(line == 2 && matches!(kind, FaultKind::Signature(_)), "{text}: line {line}: {kind}");
    }
    for (text, line, says) in [
        ("\n\nfn f() -> f32 { return nothing; }", 3, "nothing"),
        ("struct EdgePoints { ab: f32 }", 1, "the name EdgePoints is declared"),
        ("const pnaen_points = 1;", 1, "the name pnaen_points begins with pnaen_"),
        ("fn dot(a: f32) -> f32 { return a; }", 1, "the name dot is declared"),
        ("override size = 3u;", 1, "size can't be used here"),
    ] {
        let Fault { line: found, kind } = fault(&format!("{text}\n{own}"));
        assert!(found == line && kind.to_string().contains(says), "{text}: line {found}: {kind}");
    }
    // Names that only our other functions have are free.
    let free = "fn straight_control_point(a: f32) -> f32 { return a; } var<private> corner_attributes: f32; struct Curve { points: f32 }";
    super::compile::<SurfaceShader>(&format!("{free}\n{own}")).unwrap_or_else(|fault| panic!("{fault}"));
}

#[test]
fn what_the_language_does_not_allow_is_said_at_its_line() {
    for (text, line, says) in [
        ("\n\nfn f() -> f32 { return distanc(1.0, 2.0); }", 3, "distanc"),
        ("fn f() {\n  let a = 1u + 1.0;\n}", 2, ""),
        ("const A = 1;\nconst A = 2;", 2, "redefinition"),
        ("fn f() { g(); }\nfn g() { f(); }", 2, "cyclic"),
        ("fn f(a: u32) -> u32 {\n  return f(a);\n}", 1, "recursive"),
        ("fn f() {\n  var a: array<u32, 4>;\n  a[7] = 1u;\n}", 3, ""),
    ] {
        let (found, said) = fault(&format!("{text}\n{EDGE}"));
        assert!(found == line && said.contains(says), "{text}: line {found}: {said}");
    }
    // What only fragment shaders have is found where the program calls the function.
    let (_, said) = fault(&EDGE.replace("2.0", "dpdx(view.radius)"));
    assert!(said.contains("pnaen_user_edges_main"), "{said}");
}

#[test]
fn functions_that_are_missing_or_have_other_parameters_are_named() {
    let missing = "there is no function edge_factor; write: fn edge_factor(";
    for text in ["", "// nothing", "const edge_factor = 1.0;", "fn inside_factor() -> f32 { return 1.0; }"] {
        let (line, said) = fault(text);
        assert!(line == 1 && said.starts_with(missing), "{text}: {said}");
    }
    for own in [
        "fn edge_factor() -> f32 { return 1.0; }",
        "fn edge_factor(edge: Edge, triangle: Triangle, view: View) -> u32 { return 1u; }",
        "fn edge_factor(edge: Edge, triangle: Triangle, view: View) { }",
        "fn edge_factor(edge: Edge, view: View, triangle: Triangle) -> f32 { return 1.0; }",
        "fn edge_factor(edge: Edge, triangle: ptr<function, Triangle>, view: View) -> f32 { return 1.0; }",
    ] {
        let (line, said) = fault(&format!("\n{own}"));
        assert!(line == 2 && said.contains(LOD_PURPOSE.functions[0].signature), "{own}: line {line}: {said}");
    }
    let inside = "fn inside_factor(triangle: Triangle, factors: vec3<u32>, view: View) -> f32 { return 1.0; }";
    let (line, said) = fault(&format!("{EDGE}\n\n{inside}"));
    assert!(line == 3 && said.contains(LOD_PURPOSE.functions[1].signature), "line {line}: {said}");
    let inside = inside.replace("vec3<u32>", "vec3f");
    compile(&format!("{EDGE}\n{inside}")).expect("a vector by its short name");
}

#[test]
fn what_touches_more_than_an_invocation_is_refused() {
    for (text, says) in [
        ("@group(0) @binding(0) var<storage, read_write> data: array<u32>;", "data can't be used here"),
        ("var<workgroup> shared_data: u32;", "shared_data can't be used here"),
        ("override size = 3u;", "size can't be used here"),
        ("@compute @workgroup_size(1)\nfn main() { let a = 1; }", "entry points can't be used here"),
        ("fn f() { workgroupBarrier(); }", "this statement can't be used"),
        ("fn f() { storageBarrier(); }", "this statement can't be used"),
        ("var<private> much: array<f32, 1000000>;", "variables take 4000000 bytes"),
        ("fn f() -> f32 { var a: array<vec4<f32>, 1025>; return a[0].x; }", "variables take 16400 bytes"),
        ("fn f() -> f32 { let a = array<f32, 100000>(); return a[3]; }", "variables take 400000 bytes"),
    ] {
        let (_, said) = fault(&format!("{text}\n{EDGE}"));
        assert!(said.contains(says), "{text}: {said}");
    }
    // What takes the most is where to begin.
    let (line, said) = fault(&format!("\nvar<private> few: f32;\nvar<private> much: array<f32, 5000>;\n{EDGE}"));
    assert_eq!((line, said.contains("variables take 20004 bytes")), (3, true), "{said}");
}

#[test]
fn names_of_the_program_and_what_it_needs_of_wgsl_stay_as_they_are() {
    for (text, says) in [
        ("fn pnaen_spend(work: u32) -> bool { return false; }", "the name pnaen_spend begins with pnaen_"),
        ("fn f() { let pnaen_a = 1; }", "the name pnaen_a begins with pnaen_"),
        ("fn max(a: f32, b: f32) -> f32 { return a; }", "the name max is declared by the program or by WGSL"),
        ("alias f32 = u32;", "the name f32 is declared"),
        ("struct vec3 { a: f32 }", "the name vec3 is declared"),
        ("struct Edge { a: f32 }", "the name Edge is declared"),
        ("const View = 1;", "the name View is declared"),
    ] {
        let (line, said) = fault(&format!("\n{text}\n{EDGE}"));
        assert!(line == 2 && said.contains(says), "{text}: line {line}: {said}");
    }
    // Names that other files of the module have, and built-in functions that these don't call.
    let free = "struct Params { points: f32 } const WORKGROUP = 3.0; var<private> params: Params;\n\
                fn factor_side(a: f32) -> f32 { return a; } fn load_net(own: Params) -> f32 { return own.points; }\n\
                fn process(a: f32) -> f32 { return smoothstep(a, 1.0, WORKGROUP) + load_net(params); }\n\
                fn smoothstep(a: f32, b: f32, c: f32) -> f32 { return factor_side(a + b + c); }";
    let edge = EDGE.replace("2.0", "process(2.0)");
    compile(&format!("{free}\n{edge}")).unwrap_or_else(|fault| panic!("{fault}"));
}

#[test]
fn brackets_that_do_not_match_are_named_where_they_are() {
    for (text, line, says) in [
        ("fn f() {\n  if true {\n}\n", 1, "never closed"),
        ("fn f() {\n  let a = (1 + 2;\n}", 2, "never closed"),
        ("\n}\n", 2, "closes nothing"),
        ("fn f() { /* }\n", 1, "never closed"),
    ] {
        let (found, said) = fault(&format!("{text}// {EDGE}"));
        assert!(found == line && said.contains(says), "{text}: line {found}: {said}");
    }
}

#[test]
fn every_loop_reports_its_work() {
    let loops = "fn f() -> u32 {\n  var a = 0u;\n  for (var i = 0u; i < 9u; i++) { a += i; }\n  while a < 20u { a += g(a); }\n\
                 \x20 loop { if a > 30u { break; } a++; continuing { a++; } }\n  /* loop { */ loop {\n    break;\n  }\n\
                 \x20 loop { a++; continuing { a++; break if a > 40u; } }\n  return a;\n}\n\
                 fn g(a: u32) -> u32 { var b = a; for (;;) { b++; if b > 3u { return b; } } return b; }";
    let shader = compile(&format!("{loops}\n{EDGE}")).unwrap_or_else(|fault| panic!("{fault}"));
    let text = shader.module_text();
    let own = &text[..text.find("struct Edge").expect("the contract")];
    assert_eq!(own.matches("pnaen_spend(").count(), 6, "{own}");
    assert_eq!(own.lines().count(), loops.lines().count() + 1 + 3, "no line moves: {own}");
    // What every turn counts at least; a turn that calls a function with a long sum counts that, too.
    assert!(own.contains("while a < 20u { if pnaen_spend(65u) { return u32(); }  a += g(a); }"), "{own}");
    let long = format!(
        "fn g(a: u32) -> u32 {{ return a{}; }}\nfn f() {{ for (;;) {{ if g(1u) > 3u {{ break; }} }} }}",
        "+1u".repeat(200)
    );
    let text = compile(&format!("{long}\n{EDGE}")).unwrap_or_else(|fault| panic!("{fault}")).module_text();
    let turn = text.split_once("for (;;) { if pnaen_spend(").and_then(|(_, rest)| rest.split_once("u) { return ; }"));
    let work: u32 = turn.expect("a loop").0.parse().expect("a number");
    assert!((400..450).contains(&work), "{work}");
}

#[test]
fn work_without_loops_is_bounded_too() {
    // Every function calls the one before twice.
    let mut text = "fn g0(a: f32) -> f32 { return a + 1.0; }\n".to_owned();
    for i in 1..40 {
        text += &format!("fn g{i}(a: f32) -> f32 {{ return g{0}(a) + g{0}(a + 1.0); }}\n", i - 1);
    }
    let edge = EDGE.replace("2.0", "g39(2.0)");
    let (line, said) = fault(&format!("{text}{edge}"));
    assert!(line == 41 && said.starts_with("a call of edge_factor goes through "), "line {line}: {said}");
    // Functions that nobody calls cost nothing.
    compile(&format!("{text}{EDGE}")).unwrap_or_else(|fault| panic!("{fault}"));
}

#[test]
fn texts_that_compilers_would_recurse_into_are_refused() {
    let stack = |text: String| {
        let thread = std::thread::Builder::new().stack_size(STACK).spawn(move || fault(&text));
        thread.expect("a thread").join().expect("no overflow")
    };
    let (line, said) = stack(format!("\nconst A = 1{};\n{EDGE}", "+1".repeat(1000)));
    assert!(line == 2 && said.contains("more than 1024 words and signs"), "line {line}: {said}");
    let chain = "if a > 1.0 { } else ".repeat(500);
    let (line, said) = stack(format!("fn f(a: f32) {{\n{chain} {{ }} }}\n{EDGE}"));
    assert!(line <= 2 && said.contains("nested more than 64 deep"), "line {line}: {said}");
    for nested in ["(", "-", "!", "array<", "{"] {
        let (_, said) = stack(format!("fn f() {{ let a = {};\n}}\n{EDGE}", nested.repeat(900)));
        assert!(!said.is_empty(), "{nested}");
    }
}

#[test]
fn files_that_are_no_such_texts_are_named() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("lod.wgsl");
    let said = |bytes: &[u8]| {
        std::fs::write(&path, bytes).expect("a writable temporary folder");
        read_user_shader::<LodShader>(&path).expect_err("it can't be used").to_string()
    };
    assert!(said(&vec![b' '; 65_537]).contains("lod.wgsl has more than 65536 bytes"));
    assert!(said(b"\xff\xfe// \x00").contains("isn't a text in UTF-8"));
    assert!(said(b"fn 3x()").contains("lod.wgsl, line 1: "));
    let marked = format!("\u{feff}{EDGE}");
    std::fs::write(&path, marked).expect("a writable temporary folder");
    assert!(read_user_shader::<LodShader>(&path).is_ok(), "a byte order mark is left out");
    let gone = read_user_shader::<LodShader>(&folder.path().join("no.wgsl")).expect_err("there is none").to_string();
    assert!(gone.contains("no.wgsl can't be read: there is no such file"), "{gone}");
    let this = read_user_shader::<LodShader>(folder.path()).expect_err("a folder").to_string();
    assert!(this.contains("file"), "{this}");
}
