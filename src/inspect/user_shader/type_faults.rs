//! Says in WGSL's words what is wrong with types: the compiler's messages have numbers of its own for expressions and types.

use naga::back::binary_operation_str;
use naga::common::wgsl::TryToWgsl;
use naga::valid::{CallError, ExpressionError, FunctionError, ValidationError};
use naga::{TypeInner, VectorSize};

/// What is wrong, if it is one of the mistakes that are made often.
pub(super) fn said(error: &ValidationError) -> Option<String> {
    let ValidationError::Function { source, .. } = error else { return None };
    match source {
        FunctionError::InvalidReturnType { expression: None, .. } => {
            Some("this function can end without a value: give one with `return`".to_owned())
        }
        FunctionError::InvalidReturnType { .. } => {
            Some("this `return` gives a value of another type than the function's result".to_owned())
        }
        FunctionError::InvalidIfType(_) => Some("the condition of this `if` is no bool".to_owned()),
        FunctionError::InvalidCall { error, .. } => said_of_call(error),
        FunctionError::Expression { source, .. } => said_of_expression(source),
        _ => None,
    }
}

fn said_of_call(error: &CallError) -> Option<String> {
    match error {
        CallError::ArgumentCount { required, seen } => {
            Some(format!("this call has {seen} arguments, and the function takes {required}"))
        }
        CallError::ArgumentType { index, .. } => {
            Some(format!("argument {} of this call has another type than the function's parameter", index + 1))
        }
        _ => None,
    }
}

fn said_of_expression(error: &ExpressionError) -> Option<String> {
    let ExpressionError::InvalidBinaryOperandTypes { op, lhs_type, rhs_type, .. } = error else { return None };
    let [left, right] = [type_name(lhs_type)?, type_name(rhs_type)?];
    Some(format!("`{}` can't be between {left} and {right}", binary_operation_str(*op)))
}

/// A type of numbers as WGSL names it.
fn type_name(of: &TypeInner) -> Option<String> {
    let count = |size: VectorSize| size as u8;
    match *of {
        TypeInner::Scalar(scalar) => scalar.try_to_wgsl().map(str::to_owned),
        TypeInner::Vector { size, scalar } => Some(format!("vec{}<{}>", count(size), scalar.try_to_wgsl()?)),
        TypeInner::Matrix { columns, rows, scalar } => {
            Some(format!("mat{}x{}<{}>", count(columns), count(rows), scalar.try_to_wgsl()?))
        }
        _ => None,
    }
}
