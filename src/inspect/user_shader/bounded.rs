//! Reads a user's text token by token: what can be told before it is parsed, and how much work a call of its functions is. Bounds
//! its loops.
//!
//! Work is counted in tokens: a call goes through those of the function's body, and through the bodies of what that calls. Every
//! turn of a loop reports its own work to `pnaen_spend`; once there was too much, every function with a loop returns. WGSL has no
//! recursion, so nothing else can take long.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use super::{Fault, FaultKind};
use gpu::user_functions::{USER_PREFIX, UserPurpose};
use gpu::wgsl_tokens::{Token, declared, tokens};

/// The most tokens of a statement: compilers recurse into expressions.
pub(super) const MOST_TOKENS: usize = 1024;
/// The least work that a turn of a loop counts as. Mesa's software driver ends every loop after 65,535 turns, as if that were its
/// end; with this much work a turn, ours is stopped before.
const LEAST_WORK_OF_TURN: u32 = 65;
/// The most work of a call, with every loop counted once.
pub(super) const MOST_WORK: u64 = 16_384;

/// A text whose brackets match, and whose names are none of ours.
pub(super) struct Source<'a> {
    text: &'a str,
    tokens: Vec<Token<'a>>,
    /// For every bracket that opens, the token that closes it.
    closed_by: HashMap<usize, usize>,
    functions: HashMap<&'a str, Function>,
}

/// A function: the token with its name, the type of its result as text, and the tokens of its body.
struct Function {
    name: usize,
    result: Option<String>,
    body: Range<usize>,
}

/// The number of the line that a byte is in, from 1.
pub(super) fn line_of(text: &str, at: usize) -> usize {
    1 + text.as_bytes()[..at.min(text.len())].iter().filter(|&&byte| byte == b'\n').count()
}

impl<'a> Source<'a> {
    pub(super) fn new(text: &'a str, purpose: &UserPurpose) -> Result<Self, Fault> {
        let tokens = tokens(text);
        let closed_by = brackets(text, &tokens)?;
        check_names(text, &tokens, purpose)?;
        let mut statements = tokens.split(|token| matches!(token.text, ";" | "{" | "}"));
        if let Some(statement) = statements.find(|statement| statement.len() > MOST_TOKENS) {
            return Err(Fault { line: line_of(text, statement[0].at), kind: FaultKind::LongStatement });
        }
        let mut source = Self { text, tokens, closed_by, functions: HashMap::new() };
        let found: Vec<_> = (0..source.tokens.len()).filter_map(|at| source.function(at)).collect();
        source.functions = found.into_iter().collect();
        Ok(source)
    }

    /// The function whose keyword is token `at`.
    fn function(&self, at: usize) -> Option<(&'a str, Function)> {
        let name = self.tokens.get(at + 1).filter(|_| self.tokens[at].text == "fn")?;
        let body = self.block_after(at)?;
        // Attributes stand before a result's type in entry points alone, which are refused.
        let close = *self.closed_by.get(&(at + 2))?;
        let result = self.tokens.get(close + 1..body.start - 1).filter(|tokens| !tokens.is_empty());
        // The arrow is two tokens.
        let result = result.map(|tokens| tokens.iter().skip(2).map(|token| token.text).collect());
        Some((name.text, Function { name: at + 1, result, body }))
    }

    /// The tokens between the first brace after token `at` and the one that closes it. Headers of functions and loops have no braces.
    fn block_after(&self, at: usize) -> Option<Range<usize>> {
        let open = at + self.tokens[at..].iter().position(|token| token.text == "{")?;
        Some(open + 1..*self.closed_by.get(&open)?)
    }

    /// Whether the text has a function of this name.
    pub(super) fn has(&self, function: &str) -> bool {
        self.functions.contains_key(function)
    }

    /// The line of a function's name; the first one without such a function.
    pub(super) fn line(&self, function: &str) -> usize {
        self.functions.get(function).map_or(1, |own| line_of(self.text, self.tokens[own.name].at))
    }

    /// The work of these tokens and of what they call. `known` has that of functions whose work is known already.
    fn work(&self, tokens: Range<usize>, known: &mut HashMap<&'a str, u64>) -> u64 {
        let mut work = tokens.len() as u64;
        for at in tokens {
            let is_call = self.tokens.get(at + 1).is_some_and(|next| next.text == "(");
            let name = self.tokens[at].text;
            if let Some(called) = self.functions.get(name).filter(|_| is_call) {
                let of_call = match known.get(name) {
                    Some(&of_call) => of_call,
                    None => self.work(called.body.clone(), known),
                };
                known.insert(name, of_call);
                work = work.saturating_add(of_call);
            }
        }
        work
    }

    /// The text with bounded loops. It must have been parsed, so that no function calls itself.
    ///
    /// # Errors
    /// A call is too much work even if every loop ends after its first turn.
    pub(super) fn bounded(&self, purpose: &UserPurpose) -> Result<String, Fault> {
        let mut known = HashMap::new();
        for name in purpose.functions.iter().map(|function| function.name) {
            let work = self.functions.get(name).map_or(0, |own| self.work(own.body.clone(), &mut known));
            if work > MOST_WORK {
                return Err(Fault { line: self.line(name), kind: FaultKind::Work { name, work } });
            }
        }
        let (mut out, mut copied) = (String::with_capacity(self.text.len() * 2), 0);
        for (at, token) in self.tokens.iter().enumerate() {
            if !matches!(token.text, "for" | "while" | "loop") {
                continue;
            }
            let Some(block) = self.block_after(at) else { continue };
            let inside = self.tokens[block.start - 1].at + 1;
            // A function that nobody calls may be any work.
            let work = u32::try_from(self.work(at..block.end, &mut known)).unwrap_or(u32::MAX >> 1);
            let work = work.max(LEAST_WORK_OF_TURN);
            // A result of zero of the function around it; nothing if that has no result.
            let around = self.functions.values().find(|own| own.body.contains(&at));
            let result = around.and_then(|own| own.result.as_ref()).map(|result| format!("{result}()"));
            let result = result.unwrap_or_default();
            out += &self.text[copied..inside];
            // A loop may have no other end than a return, and then nothing follows it.
            out += &format!(" if {USER_PREFIX}spend({work}u) {{ return {result}; }} ");
            copied = inside;
        }
        Ok(out + &self.text[copied..])
    }
}

/// For every bracket that opens, the token that closes it.
fn brackets(text: &str, tokens: &[Token]) -> Result<HashMap<usize, usize>, Fault> {
    let (mut open, mut closed_by) = (Vec::new(), HashMap::new());
    let fault = |at: usize, kind| Fault { line: line_of(text, tokens[at].at), kind };
    for (at, token) in tokens.iter().enumerate() {
        let opener = match token.text {
            "{" | "(" | "[" => {
                open.push(at);
                continue;
            }
            "}" => "{",
            ")" => "(",
            "]" => "[",
            _ => continue,
        };
        let last: Option<usize> = open.pop();
        match last.filter(|&last| tokens[last].text == opener) {
            Some(last) => drop(closed_by.insert(last, at)),
            None => return Err(last.map_or(fault(at, FaultKind::Unopened), |last| fault(last, FaultKind::Unclosed))),
        }
    }
    open.first().map_or(Ok(closed_by), |&first| Err(fault(first, FaultKind::Unclosed)))
}

/// Names that the module's own part declares, or needs from WGSL itself, where a file may declare them anew.
fn check_names(text: &str, tokens: &[Token], purpose: &UserPurpose) -> Result<(), Fault> {
    let fault = |token: &Token, kind: fn(String) -> FaultKind| {
        Err(Fault { line: line_of(text, token.at), kind: kind(token.text.to_owned()) })
    };
    if let Some(token) = tokens.iter().find(|token| token.text.starts_with(USER_PREFIX)) {
        return fault(token, FaultKind::Prefix);
    }
    let needed: HashSet<String> = purpose.needed_names();
    match declared(tokens).iter().map(|(_, name)| name).find(|name| needed.contains(name.text)) {
        Some(token) => fault(token, FaultKind::Taken),
        None => Ok(()),
    }
}
