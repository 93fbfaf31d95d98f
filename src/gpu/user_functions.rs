//! Functions of the user's own, whatever they give: what a file of them has, the text of the module that runs them, and what is
//! reported of their loops.

use std::collections::HashSet;
use std::sync::{Arc, Mutex, PoisonError};

use bytemuck::{Pod, Zeroable};

use super::compute_pipeline::{ComputePipeline, ShaderModule};
use super::wgsl::{WgslModule, joined};
use super::wgsl_tokens::{declared, tokens};
use super::{Gpu, GpuError};

/// What stands before every name of this program in a module that has functions of the user's own.
pub const USER_PREFIX: &str = "pnaen_";

/// A function that a user's file has, or may have.
pub struct UserFunction {
    pub name: &'static str,
    /// The names of its parameters' types; `vec3` is one of f32.
    pub parameters: &'static [&'static str],
    /// The name of its result's type.
    pub result: &'static str,
    /// How it must be declared.
    pub signature: &'static str,
    /// The WGSL file that has its place in the module of a user's file without it.
    pub stand_in: &'static str,
}

/// What a user's file is for.
pub struct UserPurpose {
    /// What such a file is called: "LOD shader".
    pub name: &'static str,
    /// The WGSL file with the structs that its functions get and give.
    pub contract: &'static str,
    /// The first one a file must have.
    pub functions: &'static [UserFunction],
    /// The passes that call them.
    pub module: WgslModule,
    /// The entry points of these passes, in the order in which they run.
    pub entry_points: &'static [&'static str],
}

/// The text of a user's file, checked and bounded, as `inspect::user_shader` makes it.
#[derive(Debug, PartialEq, Eq)]
pub struct UserText {
    /// Every loop calls `pnaen_spend`.
    pub text: String,
    /// Which of the purpose's functions it has.
    pub has: Vec<bool>,
}

/// A user's file for one purpose.
pub trait UserShader: PartialEq + Send + Sync + Sized + 'static {
    /// What such a file is for.
    const PURPOSE: &'static UserPurpose;

    fn new(own: UserText) -> Self;

    fn own(&self) -> &UserText;

    /// The text of the module that runs it. It begins with the user's file, so that lines are those of the file.
    fn module_text(&self) -> String {
        Self::PURPOSE.module_text(self.own())
    }
}

impl UserPurpose {
    fn module_text(&self, own: &UserText) -> String {
        let is_replaced = |file: &str| {
            let mut functions = self.functions.iter().zip(&own.has);
            functions.any(|(function, &has)| has && function.stand_in == file)
        };
        let is_ours = |file: &&str| *file != self.contract && !is_replaced(file);
        let ours: Vec<_> = self.module.files().into_iter().filter(is_ours).collect();
        format!("{}\n{}\n{}", own.text, shaders::text(self.contract), self.prefixed(&joined(&ours)))
    }

    /// Puts the prefix before every name that a text declares, but not before those of the user's functions.
    fn prefixed(&self, text: &str) -> String {
        let all = tokens(text);
        let names: HashSet<_> = declared(&all).iter().map(|(_, name)| name.text).collect();
        let (mut out, mut copied) = (String::with_capacity(text.len() * 5 / 4), 0);
        for token in all.iter().filter(|token| names.contains(token.text) && !self.has_function(token.text)) {
            out += &text[copied..token.at];
            out += USER_PREFIX;
            copied = token.at;
        }
        out + &text[copied..]
    }

    fn has_function(&self, name: &str) -> bool {
        self.functions.iter().any(|function| function.name == name)
    }

    /// The names that a user's file mustn't declare: the structs of the contract, and functions and types of WGSL that the rest
    /// of the module needs. WGSL lets a file declare those anew.
    pub fn needed_names(&self) -> HashSet<String> {
        // The function that a file must have is never replaced.
        let text = self.module_text(&UserText { text: String::new(), has: vec![true] });
        let all = tokens(&text);
        let scalars = ["bool", "f32", "i32", "u32"].into_iter().map(str::to_owned);
        let used = all.windows(2).filter(|pair| pair[0].is_word() && ["(", "<"].contains(&pair[1].text));
        let of_contract = tokens(shaders::text(self.contract));
        let used = used.map(|pair| pair[0].text).chain(declared(&of_contract).into_iter().map(|(_, name)| name.text));
        used.filter(|name| !self.has_function(name)).map(str::to_owned).chain(scalars).collect()
    }
}

/// What is known after functions of the user's own ran for all patches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct UserReport {
    work: u32,
    /// 1 if their loops took too long. None of their results counts then.
    pub stopped: u32,
    /// Results that aren't numbers: factors, or sides with such a control point.
    pub not_numbers: u32,
}

/// The pipelines of a user's file, one for each of the purpose's entry points.
pub struct UserPipelines(pub(super) Vec<ComputePipeline>);

impl UserPipelines {
    /// Compiles nothing yet.
    fn new<S: UserShader>(shader: &S) -> Self {
        let module = Arc::new(ShaderModule::from_text(S::PURPOSE.module.0, shader.module_text()));
        Self(S::PURPOSE.entry_points.iter().map(|entry_point| ComputePipeline::new(&module, entry_point)).collect())
    }

    /// Compiles them.
    ///
    /// # Errors
    /// The driver refuses them, out of memory, or a lost device.
    pub fn prepare(&self, gpu: &Gpu) -> Result<(), GpuError> {
        self.0.iter().try_for_each(|pipeline| pipeline.get(gpu).map(|_| ()))
    }
}

/// The pipelines of users' files for one purpose that were requested last.
pub(super) struct RecentPipelines<S>(Mutex<Vec<(Arc<S>, Arc<UserPipelines>)>>);

/// For how many files pipelines are kept: those that are shown, and those that replace them.
const KEPT: usize = 2;

impl<S> Default for RecentPipelines<S> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<S: UserShader> RecentPipelines<S> {
    /// The pipelines of a file. Those of the same text are the same.
    pub(super) fn of(&self, shader: &Arc<S>) -> Arc<UserPipelines> {
        // What is behind the lock is whole even if a thread panicked while it held it.
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let place = kept.iter().position(|(known, _)| known == shader);
        let found = match place {
            Some(place) => kept.remove(place),
            None => (shader.clone(), Arc::new(UserPipelines::new(&**shader))),
        };
        let pipelines = found.1.clone();
        kept.truncate(KEPT - 1);
        kept.insert(0, found);
        pipelines
    }
}

#[cfg(test)]
mod tests {
    use super::super::user_lod::LOD_PURPOSE;

    #[test]
    fn names_of_ours_get_a_prefix_and_the_rest_stays() {
        let text =
            "struct A { b: u32 }\nfn c(a: A) -> u32 { return a.b + c2; } // A\nconst c2 = 1u;\nfn edge_factor() {}";
        let renamed = "struct pnaen_A { b: u32 }\nfn pnaen_c(a: pnaen_A) -> u32 { return a.b + pnaen_c2; } // A\n\
                       const pnaen_c2 = 1u;\nfn edge_factor() {}";
        assert_eq!(LOD_PURPOSE.prefixed(text), renamed);
    }
}
