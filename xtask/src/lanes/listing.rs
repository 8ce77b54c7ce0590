//! What a function does, read from an assembly listing for x86-64 in AT&T form.

use super::symbol;
use std::collections::BTreeMap;

/// A function of a listing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Function {
    /// Its path.
    pub(super) path: String,
    /// Instructions.
    pub(super) instructions: usize,
    /// Floating-point operations on registers of 128, 256 and 512 bits, all their lanes together.
    pub(super) packed: [usize; 3],
    /// Floating-point operations on one number, by the source file that they come from.
    pub(super) scalar: BTreeMap<String, usize>,
    /// Calls, and jumps out of the function, by path.
    pub(super) calls: BTreeMap<String, usize>,
}

impl Function {
    pub(super) fn scalars(&self) -> usize {
        self.scalar.values().sum()
    }

    pub(super) fn packed(&self) -> usize {
        self.packed.iter().sum()
    }
}

/// All functions whose path satisfies `wanted`, in the order of the listing.
pub(super) fn functions(listing: &str, wanted: impl Fn(&str) -> bool) -> Vec<Function> {
    let (mut found, mut current): (Vec<Function>, Option<Function>) = (Vec::new(), None);
    let mut files: BTreeMap<&str, &str> = BTreeMap::new();
    let mut file = "";
    // Where a register was loaded from the table of addresses last, in the order of the text.
    let mut loaded: BTreeMap<&str, &str> = BTreeMap::new();
    for line in listing.lines() {
        if let Some(label) = label(line) {
            // Labels inside of a function are local.
            found.extend(current.take());
            let path = symbol::path(label);
            current = wanted(&path).then(|| Function { path, ..Function::default() });
            loaded.clear();
            continue;
        }
        let Some((operation, arguments)) = instruction(line) else { continue };
        match operation {
            ".file" => {
                if let Some((number, name)) = file_of(arguments) {
                    files.insert(number, name);
                }
            }
            ".loc" => file = arguments.split_whitespace().next().and_then(|number| files.get(number)).copied().unwrap_or(""),
            ".size" | ".cfi_endproc" => found.extend(current.take()),
            _ if operation.starts_with('.') => {}
            _ => {
                if let Some(function) = &mut current {
                    function.take(operation, arguments, file, &mut loaded);
                }
            }
        }
    }
    found.extend(current);
    found
}

impl Function {
    fn take<'l>(&mut self, operation: &str, arguments: &'l str, file: &str, loaded: &mut BTreeMap<&'l str, &'l str>) {
        self.instructions += 1;
        if operation.starts_with("mov")
            && let Some((source, register)) = arguments.split_once(", ")
            && let Some(symbol) = source.strip_suffix("@GOTPCREL(%rip)")
        {
            loaded.insert(register, symbol);
        }
        if let Some(target) = target(operation, arguments, loaded) {
            *self.calls.entry(target).or_default() += 1;
        } else if let Some(kind) = floating(operation) {
            match kind {
                Floating::Scalar => *self.scalar.entry(file.to_owned()).or_default() += 1,
                Floating::Packed => {
                    let width = if arguments.contains("%zmm") { 2 } else { usize::from(arguments.contains("%ymm")) };
                    self.packed[width] += 1;
                }
            }
        }
    }
}

/// A label of the listing that begins a function.
fn label(line: &str) -> Option<&str> {
    line.strip_suffix(':').filter(|label| !label.starts_with(['.', '\t', ' ', '#']))
}

/// An instruction or a directive.
fn instruction(line: &str) -> Option<(&str, &str)> {
    let line = line.strip_prefix(['\t', ' '])?.trim();
    let line = line.split_once('#').map_or(line, |(code, _)| code.trim_end());
    (!line.is_empty()).then(|| line.split_once(|c: char| c.is_whitespace()).unwrap_or((line, "")))
}

/// Number and name of `.file 3 "folder" "name"`.
fn file_of(arguments: &str) -> Option<(&str, &str)> {
    let (number, rest) = arguments.split_once(' ')?;
    // The last but a checksum, which has no quotes.
    let name = rest.split('"').filter(|part| !part.trim().is_empty()).take_while(|part| !part.contains(" md5 ")).last()?;
    number.parse::<usize>().is_ok().then_some((number, name))
}

/// Where a call or a jump out of the function goes.
fn target(operation: &str, arguments: &str, loaded: &BTreeMap<&str, &str>) -> Option<String> {
    let is_call = operation.starts_with("call");
    if !is_call && operation != "jmp" && operation != "jmpq" {
        return None;
    }
    let symbol = arguments.trim_end_matches("@PLT");
    if let Some(pointer) = symbol.strip_prefix('*') {
        if let Some(symbol) = pointer.strip_suffix("@GOTPCREL(%rip)").or_else(|| loaded.get(pointer).copied()) {
            return Some(symbol::path(symbol));
        }
        // A jump through a register goes to another branch of a match.
        return is_call.then(|| format!("through {pointer}"));
    }
    (!symbol.starts_with(".L")).then(|| symbol::path(symbol))
}

/// How many numbers a floating-point operation works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Floating {
    Scalar,
    Packed,
}

/// Whether an instruction computes with floating-point numbers; loads, moves and bit operations do not.
fn floating(operation: &str) -> Option<Floating> {
    let name = operation.strip_prefix('v').unwrap_or(operation);
    let stem = name.get(..name.len().checked_sub(2)?)?;
    let computes =
        ["add", "sub", "mul", "div", "sqrt", "min", "max", "ucomi", "comi", "cmp", "fmadd", "fmsub", "fnmadd", "fnmsub", "rcp14"]
            .iter()
            .any(|known| stem.starts_with(known));
    match name.get(name.len() - 2..)? {
        "ss" | "sd" if computes || name.starts_with("cvt") => Some(Floating::Scalar),
        "ps" | "pd" if computes || name.starts_with("cvt") => Some(Floating::Packed),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LISTING: &str = "\t.file\t7 \"/src\" \"kernel/filter.rs\"\n\
        \t.file\t8 \"walk.rs\"\n\
        _RNvC4here3hot:\n\t.cfi_startproc\n\t.loc\t7 12 3\n\tpushq\t%rbp\n\
        \tmovq\t_RNvC4here5other@GOTPCREL(%rip), %r14\n\
        .LBB0_1:\n\tvmulps\t%ymm1, %ymm2, %ymm3\n\tvfmadd213ps\t%zmm1, %zmm2, %zmm3\n\tvaddss\t%xmm1, %xmm2, %xmm3\n\
        \t.loc\t8 1 1\n\tvucomiss\t%xmm1, %xmm2\n\tvmovss\t(%rax), %xmm1 # comment\n\tvcmpltps %zmm1, %zmm2, %k1\n\
        \tcallq\t*%r14\n\tcallq\t*%rbx\n\tcallq\tmemcpy@PLT\n\tjmp\t.LBB0_1\n\tjmpq\t*%rax\n\tjmp\t_RNvC4here4tail\n\
        .Lfunc_end0:\n\t.size\t_RNvC4here3hot, .Lfunc_end0-_RNvC4here3hot\n\
        _RNvC4here4cold:\n\tvaddss\t%xmm1, %xmm2, %xmm3\n\tretq\n";

    #[test]
    fn a_function_is_counted_up_to_its_end() {
        let found = functions(LISTING, |path| path == "here::hot");
        assert_eq!(found.len(), 1);
        let hot = &found[0];
        assert_eq!((hot.packed, hot.packed(), hot.scalars()), ([0, 1, 2], 3, 2));
        assert_eq!(hot.scalar, BTreeMap::from([("kernel/filter.rs".to_owned(), 1), ("walk.rs".to_owned(), 1)]));
        let calls: Vec<&str> = hot.calls.keys().map(String::as_str).collect();
        assert_eq!(calls, ["here::other", "here::tail", "memcpy", "through %rbx"]);
        assert_eq!(hot.instructions, 14);
    }

    #[test]
    fn instructions_that_compute_are_told_from_those_that_move() {
        for (name, kind) in [
            ("vaddss", Some(Floating::Scalar)),
            ("mulsd", Some(Floating::Scalar)),
            ("vcvtss2sd", Some(Floating::Scalar)),
            ("vucomiss", Some(Floating::Scalar)),
            ("vfnmadd231ps", Some(Floating::Packed)),
            ("vcvtps2pd", Some(Floating::Packed)),
            ("vcmpneqps", Some(Floating::Packed)),
            ("vmovaps", None),
            ("vbroadcastss", None),
            ("vxorps", None),
            ("vpaddd", None),
            ("ss", None),
            ("x", None),
        ] {
            assert_eq!(floating(name), kind, "{name}");
        }
    }
}
