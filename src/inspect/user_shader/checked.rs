//! Parses a user's text with the compiler that wgpu has, and checks what that allows and functions of the user's own may not have.

use std::error::Error;

use naga::front::wgsl::{ParseError, parse_str};
use naga::proc::Layouter;
use naga::valid::{Capabilities, ValidationError, ValidationFlags, Validator};
use naga::{AddressSpace, Block, Function, Module, Span, Statement, TypeInner, WithSpan};

use super::bounded::{Source, line_of};
use super::{Fault, FaultKind, type_faults};
use gpu::user_functions::{USER_PREFIX, UserFunction, UserPurpose};
use gpu::user_lod::LOD_PURPOSE;
use gpu::user_surface::SURFACE_PURPOSE;

/// How deep blocks may be nested: compilers recurse into them.
pub(super) const MOST_DEPTH: usize = 64;
/// Bytes that all variables of the file may take together, which every invocation has.
pub(super) const MOST_MEMORY: u64 = 16_384;

/// Checks a user's text. Returns which of the purpose's functions it has.
pub(super) fn check(text: &str, source: &Source, purpose: &UserPurpose) -> Result<Vec<bool>, Fault> {
    check_purpose(source, purpose)?;
    let whole = format!("{text}\n{}", shaders::text(purpose.contract));
    let module = parse_str(&whole).map_err(|error| parser_fault(text, &error))?;
    check_globals(text, &module)?;
    let mut has = Vec::new();
    for function in purpose.functions {
        let is_there = check_signature(&module, source, function)?;
        if has.is_empty() && !is_there {
            let UserFunction { name, signature, .. } = *function;
            return Err(Fault { line: 1, kind: FaultKind::NoFunction { name, signature } });
        }
        has.push(is_there);
    }
    for (handle, function) in module.functions.iter() {
        check_block(text, &function.body, 0, module.functions.get_span(handle))?;
    }
    validate(text, &module)?;
    check_memory(text, &module)?;
    Ok(has)
}

/// Refuses a file that has the function of another purpose in place of this one's.
fn check_purpose(source: &Source, purpose: &UserPurpose) -> Result<(), Fault> {
    let has = |own: &UserPurpose| own.functions.first().is_some_and(|function| source.has(function.name));
    let other = [&LOD_PURPOSE, &SURFACE_PURPOSE].into_iter().find(|other| has(other));
    match other.and_then(|other| Some((other, other.functions.first()?.name))) {
        Some((other, function)) if !has(purpose) => {
            let kind = FaultKind::OtherPurpose { function, is: other.name, opened: purpose.name };
            Err(Fault { line: source.line(function), kind })
        }
        _ => Ok(()),
    }
}

/// Holds bounded functions to it that every loop of theirs is bounded.
pub(super) fn check_loops(functions: &str, purpose: &UserPurpose) -> Result<(), Fault> {
    let spend = format!("fn {USER_PREFIX}spend(work: u32) -> bool {{ return false; }}");
    let whole = format!("{functions}\n{}\n{spend}", shaders::text(purpose.contract));
    let module = parse_str(&whole).map_err(|error| parser_fault(functions, &error))?;
    let spend = module.functions.iter().find(|(_, own)| own.name.as_deref() == Some(&format!("{USER_PREFIX}spend")));
    let calls_spend = |statement: &Statement| matches!(statement, Statement::Call { function, .. } if Some(*function) == spend.map(|(handle, _)| handle));
    for (_, function) in module.functions.iter() {
        if let Some(at) = unbounded(&function.body, &calls_spend) {
            let kind = FaultKind::Language("this loop can't be bounded; write it in another way".to_owned());
            return Err(Fault { line: line_of_span(functions, at), kind });
        }
    }
    Ok(())
}

/// A loop in a block that doesn't begin with a statement of the kind asked for, wherever blocks lie in it.
fn unbounded(block: &Block, is_bound: &impl Fn(&Statement) -> bool) -> Option<Span> {
    block.span_iter().find_map(|(statement, span)| match statement {
        Statement::Loop { body, .. } if !has_itself(body, is_bound) => Some(*span),
        statement => blocks_of(statement).into_iter().find_map(|inner| unbounded(inner, is_bound)),
    })
}

/// Whether a statement of the kind asked for stands in a block itself, or in a plain block within it.
fn has_itself(block: &Block, is_bound: &impl Fn(&Statement) -> bool) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Block(inner) => has_itself(inner, is_bound),
        statement => is_bound(statement),
    })
}

/// Parses and validates the whole module, whose first lines are those of the user's text.
pub(super) fn check_module(text: &str, whole: &str) -> Result<(), Fault> {
    let module = parse_str(whole).map_err(|error| parser_fault(text, &error))?;
    validate(text, &module)
}

fn validate(text: &str, module: &Module) -> Result<(), Fault> {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
    validator.validate(module).map(|_| ()).map_err(|error| validator_fault(text, &error))
}

/// The line of a span; the last one of the user's text for what lies behind it.
fn line_of_span(text: &str, span: Span) -> usize {
    line_of(text, span.to_range().map_or(0, |range| range.start))
}

fn parser_fault(text: &str, error: &ParseError) -> Fault {
    let own = |span: &Span| span.to_range().is_some_and(|range| range.start < text.len());
    let labels: Vec<_> = error.labels().collect();
    // Of a name that is declared twice, one may be ours.
    let label = labels.iter().find(|(span, _)| own(span)).or(labels.first());
    let line = label.map_or(1, |(span, _)| line_of_span(text, *span));
    // Some say the same as the message.
    let is_new = |detail: &&str| !detail.is_empty() && !error.message().contains(*detail);
    let detail = label.map(|(_, detail)| *detail).filter(is_new);
    let said = detail.map_or_else(|| error.message().to_owned(), |detail| format!("{} ({detail})", error.message()));
    Fault { line, kind: FaultKind::Language(said) }
}

fn validator_fault(text: &str, error: &WithSpan<ValidationError>) -> Fault {
    let spans = error.spans().map(|(span, _)| *span).filter(Span::is_defined);
    // The innermost statement or expression is named last.
    let line = spans.last().map_or(1, |span| line_of_span(text, span));
    let said = type_faults::said(error.as_inner()).unwrap_or_else(|| {
        let mut said = Vec::new();
        let mut cause: Option<&dyn Error> = Some(error.as_inner());
        while let Some(own) = cause {
            said.push(own.to_string());
            cause = own.source();
        }
        said.join(": ")
    });
    Fault { line, kind: FaultKind::Language(said) }
}

fn check_globals(text: &str, module: &Module) -> Result<(), Fault> {
    if let Some(entry) = module.entry_points.first() {
        let first = entry.function.body.span_iter().next().map_or(1, |(_, span)| line_of_span(text, *span));
        return Err(Fault { line: first, kind: FaultKind::EntryPoint });
    }
    let shared = module.global_variables.iter().find(|(_, variable)| variable.space != AddressSpace::Private);
    let shared = shared.map(|(handle, variable)| (module.global_variables.get_span(handle), &variable.name));
    let overrides = module.overrides.iter().map(|(handle, own)| (module.overrides.get_span(handle), &own.name));
    match shared.into_iter().chain(overrides).next() {
        Some((span, name)) => {
            let name = name.clone().unwrap_or_else(|| "this".to_owned());
            Err(Fault { line: line_of_span(text, span), kind: FaultKind::Binding(name) })
        }
        None => Ok(()),
    }
}

/// Whether there is this function. Its parameters and its result must have their types.
fn check_signature(module: &Module, source: &Source, wanted: &UserFunction) -> Result<bool, Fault> {
    let found = module.functions.iter().find(|(_, function)| function.name.as_deref() == Some(wanted.name));
    let Some((_, function)) = found else { return Ok(false) };
    let takes = function.arguments.len() == wanted.parameters.len()
        && function.arguments.iter().zip(wanted.parameters).all(|(own, name)| is_type(module, own.ty, name));
    let gives = function.result.as_ref().is_some_and(|result| is_type(module, result.ty, wanted.result));
    match takes && gives {
        true => Ok(true),
        false => Err(Fault { line: source.line(wanted.name), kind: FaultKind::Signature(wanted.signature) }),
    }
}

/// Whether a type is the one that is called `f32`, `vec3` (one of f32), or as a struct.
fn is_type(module: &Module, ty: naga::Handle<naga::Type>, name: &str) -> bool {
    let own = &module.types[ty];
    match own.inner {
        TypeInner::Scalar(scalar) => name == "f32" && scalar == naga::Scalar::F32,
        TypeInner::Vector { size, scalar } => {
            name == "vec3" && size == naga::VectorSize::Tri && scalar == naga::Scalar::F32
        }
        _ => own.name.as_deref() == Some(name),
    }
}

/// The blocks within a statement.
fn blocks_of(statement: &Statement) -> Vec<&Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Switch { cases, .. } => cases.iter().map(|case| &case.body).collect(),
        Statement::Loop { body, continuing, .. } => vec![body, continuing],
        _ => Vec::new(),
    }
}

/// Allows only statements that stay within an invocation. `around` is the span of the statement that the block is in.
fn check_block(text: &str, block: &Block, depth: usize, around: Span) -> Result<(), Fault> {
    for (statement, span) in block.span_iter() {
        let span = if span.is_defined() { *span } else { around };
        let fault = |kind| Err(Fault { line: line_of_span(text, span), kind });
        if depth > MOST_DEPTH {
            return fault(FaultKind::Nested);
        }
        match statement {
            Statement::Emit(_)
            | Statement::Block(_)
            | Statement::If { .. }
            | Statement::Switch { .. }
            | Statement::Loop { .. }
            | Statement::Break
            | Statement::Continue
            | Statement::Return { .. }
            | Statement::Store { .. }
            | Statement::Call { .. } => {}
            _ => return fault(FaultKind::Statement),
        }
        blocks_of(statement).into_iter().try_for_each(|inner| check_block(text, inner, depth + 1, span))?;
    }
    Ok(())
}

/// Bounds the memory of all variables, and of every type, since values that are no variables take memory too.
fn check_memory(text: &str, module: &Module) -> Result<(), Fault> {
    let mut layouter = Layouter::default();
    let too_large = |bytes, span| Fault { line: line_of_span(text, span), kind: FaultKind::Memory(bytes) };
    layouter.update(module.to_ctx()).map_err(|_| too_large(u64::from(u32::MAX), Span::UNDEFINED))?;
    let size = |ty| u64::from(layouter[ty].size);
    let globals = &module.global_variables;
    let mut variables: Vec<_> = globals.iter().map(|(own, it)| (size(it.ty), globals.get_span(own))).collect();
    for (_, Function { local_variables: locals, .. }) in module.functions.iter() {
        variables.extend(locals.iter().map(|(own, it)| (size(it.ty), locals.get_span(own))));
    }
    let bytes: u64 = variables.iter().map(|(bytes, _)| bytes).sum();
    // The largest one is where to begin.
    let largest = variables.iter().max_by_key(|(bytes, _)| *bytes);
    if let Some((_, span)) = largest.filter(|_| bytes > MOST_MEMORY) {
        return Err(too_large(bytes, *span));
    }
    let types = module.types.iter().map(|(own, _)| (size(own), module.types.get_span(own)));
    match types.max_by_key(|(bytes, _)| *bytes) {
        Some((bytes, span)) if bytes > MOST_MEMORY => Err(too_large(bytes, span)),
        _ => Ok(()),
    }
}
