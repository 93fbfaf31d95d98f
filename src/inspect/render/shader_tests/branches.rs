//! No fragment shader branches on a uniform. Mesa's llvmpipe takes the values of such uniforms for constants, and compiles the shader
//! again whenever they change (`nir_inline_uniforms` in Mesa): that is, for every picture.

use naga::{AddressSpace, Block, Expression, Function, Handle, LocalVariable, Module, ShaderStage, Statement};

/// What a value is made of. Of several, the last one counts: a driver knows a value only if it knows all that it is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Source {
    /// Only of what is known when the pipeline is made.
    Constants,
    /// Of uniforms, too.
    Uniforms,
    /// Of what differs from pixel to pixel, or isn't in a uniform.
    Others,
}

/// What was found in a function that was called with arguments of these sources.
struct Walk<'a> {
    module: &'a Module,
    function: &'a Function,
    arguments: Vec<Source>,
    /// Of the values of variables.
    variables: Vec<Source>,
    /// Of the results of calls, by expression.
    results: Vec<Source>,
    returned: Source,
    /// Of what is written where pointers of the caller lead.
    written: Source,
    /// The functions with branches on uniforms.
    found: Vec<String>,
}

/// The functions with branches on uniforms that an entry point calls, itself included. A function is named once for each branch.
fn uniform_branches(module: &Module, entry: &naga::EntryPoint) -> Vec<String> {
    let arguments = vec![Source::Others; entry.function.arguments.len()];
    let mut found = Walk::over(module, &entry.function, &entry.name, arguments).found;
    found.sort();
    found.dedup();
    found
}

impl<'a> Walk<'a> {
    /// Walks over a function until nothing more is learned of its variables.
    fn over(module: &'a Module, function: &'a Function, name: &str, arguments: Vec<Source>) -> Self {
        let variables = vec![Source::Constants; function.local_variables.len()];
        let results = vec![Source::Constants; function.expressions.len()];
        let mut walk = Self {
            module,
            function,
            arguments,
            variables,
            results,
            returned: Source::Constants,
            written: Source::Constants,
            found: Vec::new(),
        };
        loop {
            let before = walk.learned();
            walk.found.clear();
            walk.block(&function.body, Source::Constants, name);
            if before == walk.learned() {
                return walk;
            }
        }
    }

    fn learned(&self) -> (Vec<Source>, Vec<Source>, [Source; 2]) {
        (self.variables.clone(), self.results.clone(), [self.returned, self.written])
    }

    /// `control` is what decides whether the block runs.
    fn block(&mut self, block: &Block, control: Source, name: &str) {
        for statement in block {
            match statement {
                Statement::Block(inner) => self.block(inner, control, name),
                Statement::If { condition, accept, reject } => {
                    let inner = self.branch(*condition, "if", name).max(control);
                    self.block(accept, inner, name);
                    self.block(reject, inner, name);
                }
                Statement::Switch { selector, cases } => {
                    let inner = self.branch(*selector, "switch", name).max(control);
                    cases.iter().for_each(|case| self.block(&case.body, inner, name));
                }
                Statement::Loop { body, continuing, break_if } => {
                    self.block(body, control, name);
                    self.block(continuing, control, name);
                    if let Some(condition) = break_if {
                        self.branch(*condition, "loop", name);
                    }
                }
                Statement::Store { pointer, value } => {
                    let stored = self.source(*value).max(control);
                    self.store(*pointer, stored);
                }
                Statement::Return { value } => {
                    let value = value.map_or(Source::Constants, |value| self.source(value));
                    self.returned = self.returned.max(value).max(control);
                }
                Statement::Call { function, arguments, result } => self.call(*function, arguments, *result, control),
                Statement::Emit(_) | Statement::Break | Statement::Continue | Statement::Kill => {}
                other => panic!("no fragment shader here is known to have {other:?}"),
            }
        }
    }

    /// Notes a branch if it depends on uniforms alone.
    fn branch(&mut self, condition: Handle<Expression>, kind: &str, name: &str) -> Source {
        let source = self.source(condition);
        if source == Source::Uniforms {
            self.found.push(format!("{name}: {kind}"));
        }
        source
    }

    fn call(
        &mut self,
        called: Handle<Function>,
        arguments: &[Handle<Expression>],
        result: Option<Handle<Expression>>,
        control: Source,
    ) {
        let sources: Vec<_> = arguments.iter().map(|&argument| self.source(argument)).collect();
        let of = &self.module.functions[called];
        let inner = Walk::over(self.module, of, of.name.as_deref().unwrap_or("a function"), sources.clone());
        self.found.extend(inner.found);
        if let Some(result) = result {
            let known = &mut self.results[result.index()];
            *known = (*known).max(inner.returned);
        }
        // A function may write where a pointer leads.
        let all = sources.into_iter().fold(control.max(inner.written), Source::max);
        let is_pointer = |argument: &naga::FunctionArgument| {
            matches!(self.module.types[argument.ty].inner, naga::TypeInner::Pointer { .. })
        };
        let written: Vec<_> =
            of.arguments.iter().zip(arguments).filter(|(own, _)| is_pointer(own)).map(|(_, &given)| given).collect();
        written.into_iter().for_each(|pointer| self.store(pointer, all));
    }

    fn store(&mut self, pointer: Handle<Expression>, stored: Source) {
        match &self.function.expressions[pointer] {
            Expression::LocalVariable(variable) => {
                let known = &mut self.variables[variable.index()];
                *known = (*known).max(stored);
            }
            Expression::AccessIndex { base, .. } => self.store(*base, stored),
            Expression::Access { base, index } => {
                let index = self.source(*index);
                self.store(*base, stored.max(index));
            }
            Expression::FunctionArgument(_) => self.written = self.written.max(stored),
            other => panic!("no fragment shader here is known to write to {other:?}"),
        }
    }

    fn source(&self, expression: Handle<Expression>) -> Source {
        let of =
            |all: &[Handle<Expression>]| all.iter().map(|&one| self.source(one)).fold(Source::Constants, Source::max);
        match &self.function.expressions[expression] {
            Expression::Literal(_) | Expression::Constant(_) | Expression::Override(_) | Expression::ZeroValue(_) => {
                Source::Constants
            }
            Expression::Compose { components, .. } => of(components),
            Expression::Access { base, index } => of(&[*base, *index]),
            Expression::AccessIndex { base, .. } => self.source(*base),
            Expression::Splat { value, .. } => self.source(*value),
            Expression::Swizzle { vector, .. } => self.source(*vector),
            Expression::FunctionArgument(index) => self.arguments[*index as usize],
            Expression::GlobalVariable(global) => match self.module.global_variables[*global].space {
                AddressSpace::Uniform => Source::Uniforms,
                _ => Source::Others,
            },
            Expression::LocalVariable(variable) => self.variable(*variable),
            Expression::Load { pointer } => self.source(*pointer),
            Expression::Unary { expr, .. } | Expression::As { expr, .. } => self.source(*expr),
            Expression::Binary { left, right, .. } => of(&[*left, *right]),
            Expression::Select { condition, accept, reject } => of(&[*condition, *accept, *reject]),
            Expression::Relational { argument, .. } => self.source(*argument),
            Expression::Math { arg, arg1, arg2, arg3, .. } => {
                let all: Vec<_> = [Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten().collect();
                of(&all)
            }
            Expression::CallResult(_) => self.results[expression.index()],
            // Textures, derivatives, lengths of buffers.
            _ => Source::Others,
        }
    }

    fn variable(&self, variable: Handle<LocalVariable>) -> Source {
        let init = self.function.local_variables[variable].init;
        self.variables[variable.index()].max(init.map_or(Source::Constants, |init| self.source(init)))
    }
}

/// The fragment shaders of a module.
fn fragments(module: &Module) -> impl Iterator<Item = &naga::EntryPoint> {
    module.entry_points.iter().filter(|entry| entry.stage == ShaderStage::Fragment)
}

/// Branches on uniforms that change only with a setting, so that a shader is compiled once for each of its values.
const EXCEPTIONS: [(&str, &str); 3] = [
    ("pixel_normal: if", "the kind of normals, where they are evaluated at pixels"),
    ("patch_second_derivatives: if", "the surface, for its curvature"),
    ("patch_tangents: if", "the surface, for its normals at pixels and its curvature"),
];

#[test]
fn no_fragment_shader_branches_on_a_uniform() {
    let mut count = 0;
    let mut found = std::collections::BTreeSet::new();
    for (_, module) in super::modules() {
        for entry in fragments(module) {
            found.extend(uniform_branches(module, entry));
            count += 1;
        }
    }
    assert!(count > 30, "{count} fragment shaders");
    let expected = EXCEPTIONS.map(|(branch, _)| branch.to_owned());
    assert_eq!(found, expected.into(), "exceptions are listed with their reasons");
}

/// The branches that a fragment shader with this body has, beside functions that it may call.
fn found_in(body: &str) -> Vec<String> {
    let text = format!(
        "struct Frame {{ number: f32, count: u32 }}
        override SWITCH: bool = true;
        @group(0) @binding(0) var<uniform> frame: Frame;
        @group(0) @binding(1) var<storage, read> stored: array<f32>;
        fn is_large(number: f32) -> bool {{ return number > 0.5; }}
        fn halved(number: f32) -> f32 {{ if number > 0.5 {{ return 0.5 * number; }} return number; }}
        fn write_number(place: ptr<function, f32>) {{ *place = frame.number; }}
        @fragment fn main(@location(0) place: f32) -> @location(0) vec4<f32> {{
            var sum = place;
            {body}
            return vec4<f32>(sum);
        }}"
    );
    let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
    fragments(&module).flat_map(|entry| uniform_branches(&module, entry)).collect()
}

#[test]
fn a_branch_on_a_uniform_is_found() {
    for (body, expected) in [
        ("if frame.number > 0.5 { sum += 1.0; }", "main: if"),
        ("if SWITCH && frame.number > 0.5 { sum += 1.0; }", "main: if"),
        ("let large = is_large(frame.number); if large { sum += 1.0; }", "main: if"),
        ("var number = 1.0; number = frame.number; if number > 0.5 { sum += 1.0; }", "main: if"),
        ("var number = 1.0; write_number(&number); if number > 0.5 { sum += 1.0; }", "main: if"),
        ("for (var i = 0u; i < frame.count; i++) { sum += 1.0; }", "main: if"),
        ("switch frame.count { case 0u: { sum += 1.0; } default: {} }", "main: switch"),
        ("sum += halved(frame.number);", "halved: if"),
    ] {
        assert!(found_in(body).contains(&expected.to_owned()), "{body}: {:?}", found_in(body));
    }
}

#[test]
fn a_branch_on_what_no_uniform_decides_is_none() {
    for body in [
        "if SWITCH { sum += frame.number; }",
        "if place > frame.number { sum += 1.0; }",
        "if stored[0] > 0.5 { sum += 1.0; }",
        "for (var i = 0u; i < 4u; i++) { sum += frame.number; }",
        "sum = select(sum, 1.0, frame.number > 0.5);",
        "sum += halved(place * frame.number);",
        "var number = frame.number; if place > 0.0 { number = 1.0; } if number > 0.5 { sum += 1.0; }",
    ] {
        assert_eq!(found_in(body), Vec::<String>::new(), "{body}");
    }
}
