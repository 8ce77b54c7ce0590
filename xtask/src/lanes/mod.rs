//! `cargo xtask lanes`: the generated code of the walk and of shading, as it is compiled for AVX2 and AVX-512.
//!
//! Code over lanes is compiled for a set of instructions only where it is inlined into the function that stands for that set. A call from
//! there to a kernel, or to a closure that was not inlined, runs what the build target guarantees, and nothing but the time tells. So the
//! library gz-bsp is compiled as others build it, and its listing read: calls that are not on a list with a reason are an error, and so
//! is more arithmetic on single numbers than on lanes.

mod listing;
mod symbol;

use crate::{Failure, cargo, finish, root};
use listing::Function;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Functions that stand for a set of instructions.
const LEVELS: [&str; 2] = ["run_avx2", "run_avx512"];

/// A library, and the tasks whose instances must be there at each level: words of a path in order, the last one its end.
struct Library {
    package: &'static str,
    tasks: &'static [&'static str],
}

const LIBRARIES: [Library; 3] = [
    Library { package: "gz-core", tasks: &["Directions", "FindPoints"] },
    Library {
        package: "gz-bsp",
        tasks: &[
            "ClosestTask",
            "AnyTask Stopped",
            "AnyTask GoingThrough",
            "Alone ClosestOf",
            "Alone Stopped",
            "Alone GoingThrough",
        ],
    },
    Library { package: "gz-shade", tasks: &["FindNormals", "Meet", "Bend", "LightAll"] },
];

/// What a hot function may call, by words of its path that stand together, and why.
const ALLOWED: [(&str, &str); 38] = [
    ("memcpy", "copies"),
    ("memset", "copies"),
    ("memmove", "copies"),
    ("core::panicking", "a fault of ours ends the work"),
    ("core::option::expect_failed", "a fault of ours ends the work"),
    ("core::option::unwrap_failed", "a fault of ours ends the work"),
    ("slice_index_fail", "a fault of ours ends the work"),
    ("slice::copy_from_slice_impl::len_mismatch_fail", "a fault of ours ends the work"),
    ("_Unwind_Resume", "a fault of ours ends the work"),
    ("batch::Desk::take", "once a batch"),
    ("batch::Loan::core::ops::drop::Drop::drop", "once a batch"),
    ("core::ptr::drop_in_place", "once a batch"),
    ("__rustc::__rust_dealloc", "once a batch"),
    ("abreast::Alone", "a task by itself, read like this one"),
    ("abreast::Abreast::send", "one ray by itself, set up for its walk"),
    ("abreast::Abreast::leave", "one ray by itself, set up for its walk"),
    ("queue::Queue::grow", "cold: the queue is full"),
    ("alloc::raw_vec", "a list is full"),
    ("passage::GoingThrough::sort", "once a bundle, where rays meet something"),
    ("passage::keep_several", "once a bundle, where rays meet something"),
    ("passage::in_order", "once a bundle, where rays meet something"),
    ("query::RayBatch::ray", "one ray by itself, set up for the exact test"),
    ("query::RayBatch::left_by", "one ray by itself, set up for the exact test"),
    ("kernel::nearest::Nearest::settle", "cold: what f32 cannot prove"),
    ("kernel::nearest::Nearest::settle_asked", "cold: what f32 cannot prove"),
    ("kernel::nearest::is_hit_asked", "cold: what f32 cannot prove"),
    ("kernel::together::bundle::RayBundle::settle", "cold: what f32 cannot prove"),
    ("kernel::together::bundle::RayBundle::settle_any", "cold: what f32 cannot prove"),
    ("kernel::order::is_hit", "cold: what f32 cannot prove"),
    ("kernel::answer::alone", "cold: what f64 cannot round"),
    ("kernel::gather::padded", "cold: the last rays of a batch"),
    ("kernel::gather::drop_invalid", "cold: origins next to 0"),
    ("BspTree::far_hits", "cold: rays beyond the range of f32"),
    ("BspTree::far_answers", "cold: rays beyond the range of f32"),
    ("kernel::exact", "cold: what f64 cannot prove"),
    ("robust", "cold: what f64 cannot prove"),
    ("powers::Powers::each", "powers that are no whole numbers, lane by lane"),
    ("light::GzLight::arrive", "a light that each lane sees from elsewhere"),
];

/// Where arithmetic on single numbers is expected, and why. It is told, and not an error elsewhere.
const SCALAR: [(&str, &str); 14] = [
    ("kernel/filter.rs", "the bounds of a bundle or of one ray"),
    ("kernel/bundle.rs", "the bounds of a bundle, one ray taken out of it"),
    ("cost/batch.rs", "the bounds of a bundle, one ray taken out of it"),
    ("f32/vec3.rs", "a direction that all rays share"),
    ("kernel/spans.rs", "what the rays of a bundle span"),
    ("kernel/nearest.rs", "the best hit of one ray"),
    ("cost/abreast.rs", "whether a ray ends before a cell"),
    ("cost/walk.rs", "the order of a ray's stack"),
    ("cost/together.rs", "the order of a bundle's queue"),
    ("gz-core/src/primary.rs", "the camera"),
    ("gz-shade/src/light.rs", "a light that each lane sees from elsewhere"),
    ("f64/dvec3.rs", "a light that each lane sees from elsewhere"),
    ("core_arch/", "the least and the greatest lane"),
    ("library/core/", "helpers of the above"),
];

/// Checks the listing that is named, or those of the libraries as they are now.
pub(crate) fn run(arguments: &[String]) -> Result<(), Failure> {
    let listings = match arguments {
        [] => LIBRARIES.iter().map(|library| Ok((library, build(library)?))).collect::<Result<Vec<_>, Failure>>()?,
        [file] if !file.starts_with('-') => vec![(named(Path::new(file))?, PathBuf::from(file))],
        _ => return Err(Failure { message: "lanes takes nothing, or a listing with v0 symbols".to_owned(), code: 2 }),
    };
    let mut faults = Vec::new();
    for (library, path) in listings {
        let text = std::fs::read_to_string(&path)
            .map_err(|error| Failure { message: format!("{}: {error}", path.display()), code: 1 })?;
        let (report, found) = judge(&text, library.tasks);
        print!("{report}");
        faults.extend(found);
    }
    match faults.len() {
        0 => Ok(()),
        n => Err(Failure { message: format!("{n} faults in the generated code: {}", faults.join("; ")), code: 4 }),
    }
}

impl Library {
    /// How its listings begin, as files are named.
    fn prefix(&self) -> String {
        format!("{}-", self.package.replace('-', "_"))
    }
}

/// The library that a listing is of, by its name.
fn named(file: &Path) -> Result<&'static Library, Failure> {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    LIBRARIES.iter().find(|library| name.starts_with(&library.prefix())).ok_or_else(|| {
        let names: Vec<String> = LIBRARIES.iter().map(Library::prefix).collect();
        let message = format!("{}: a listing's name begins with {}, which tells whose it is", file.display(), names.join(" or "));
        Failure { message, code: 1 }
    })
}

/// Compiles a library into a listing, in a folder of its own as its flags differ: names that can be read, and source lines.
fn build(library: &Library) -> Result<PathBuf, Failure> {
    if !cfg!(target_arch = "x86_64") {
        return Err(Failure { message: "lanes reads code for x86-64, which this machine is not".to_owned(), code: 1 });
    }
    let folder = root().join("target/lanes");
    let mut command = cargo();
    command.args(["rustc", "--quiet", "--release", "--package", library.package, "--lib", "--target-dir"]).arg(&folder);
    // The code of one library, before the linker's optimisations.
    command.args(["--config", "profile.release.lto=\"off\"", "--", "--emit", "asm"]);
    command.env_remove("CARGO_ENCODED_RUSTFLAGS").env("RUSTFLAGS", "-C symbol-mangling-version=v0 -C debuginfo=line-tables-only");
    finish(&mut command, &format!("compiling {}", library.package))?;
    newest(&folder.join("release/deps"), library)
        .ok_or_else(|| Failure { message: format!("no listing in {}", folder.display()), code: 1 })
}

/// The newest listing of a library in a folder.
fn newest(folder: &Path, library: &Library) -> Option<PathBuf> {
    let is_its = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(&library.prefix()) && name.ends_with(".s")
    };
    let files = std::fs::read_dir(folder).ok()?.filter_map(|entry| Some(entry.ok()?.path())).filter(is_its);
    files.max_by_key(|path| std::fs::metadata(path).and_then(|data| data.modified()).ok())
}

/// What is to be said of a listing, and what is wrong with it, where it must have `tasks`.
fn judge(text: &str, tasks: &[&str]) -> (String, Vec<String>) {
    let (mut report, mut faults) = (String::new(), Vec::new());
    let is_hot = |path: &str| LEVELS.iter().any(|level| path.contains(level)) && tasks.iter().any(|task| is_of(path, task));
    let functions = listing::functions(text, is_hot);
    for level in LEVELS {
        for task in tasks {
            let name = format!("{level} of {task}");
            let is_it = |it: &&Function| it.path.split("::").any(|word| word == level) && is_of(&it.path, task);
            match functions.iter().find(is_it) {
                Some(function) => describe(&name, function, &mut report, &mut faults),
                None => faults.push(format!("there is no {name}")),
            }
        }
    }
    (report, faults)
}

/// Whether a path is that of a task.
fn is_of(path: &str, task: &str) -> bool {
    let mut words = path.split("::");
    task.split(' ').all(|wanted| words.any(|word| word == wanted)) && words.next().is_none()
}

fn describe(name: &str, function: &Function, report: &mut String, faults: &mut Vec<String>) {
    let (packed, scalars) = (function.packed(), function.scalars());
    let [xmm, ymm, zmm] = function.packed;
    // Writing to a string never fails.
    let _ = writeln!(
        report,
        "{name}: {} instructions; {packed} floating-point operations on lanes ({zmm} of 512 bits, {ymm} of 256, {xmm} of 128), {scalars} on single numbers",
        function.instructions
    );
    for (file, count) in &function.scalar {
        let reason = SCALAR.iter().find(|(part, _)| file.contains(part)).map_or("no reason known", |(_, reason)| reason);
        let file = file.rsplit("crates/").next().unwrap_or(file).trim_start_matches("library/core/src/../../stdarch/crates/");
        let _ = writeln!(report, "  {count:>4} single in {file}: {reason}");
    }
    for (path, count) in &function.calls {
        match reason(path) {
            Some(reason) => {
                let _ = writeln!(report, "  {count:>4} calls of {path}: {reason}");
            }
            None => {
                let _ = writeln!(report, "  {count:>4} calls of {path}: NOT inlined");
                faults.push(format!("{name} calls {path}"));
            }
        }
    }
    if scalars >= packed {
        faults.push(format!("{name} has {scalars} operations on single numbers and {packed} on lanes"));
    }
}

/// Why a hot function may call this one.
fn reason(path: &str) -> Option<&'static str> {
    // A closure is compiled for the build target, whoever calls it.
    let is_closure = path.contains("{closure}") && !path.starts_with("core::ptr::drop_in_place");
    let fits = |known: &str| format!("::{path}::").contains(&format!("::{known}::"));
    ALLOWED.iter().find(|(known, _)| !is_closure && fits(known)).map(|(_, reason)| *reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUN: [&str; 12] = [
        "_RINvNtNtC7gz_core4simd3x868run_avx2INtNtNtC6gz_bsp4cost5batch11ClosestTaskuEEBR_",
        "_RINvNtNtC7gz_core4simd3x868run_avx2INtNtNtC6gz_bsp4cost5batch7AnyTaskNtNtNtB4_6kernel7passage7StoppeduEEBR_",
        "_RINvNtNtC7gz_core4simd3x868run_avx2INtNtNtC6gz_bsp4cost5batch7AnyTaskNtNtNtB4_6kernel7passage12GoingThroughuEEBR_",
        "_RINvNtNtC7gz_core4simd3x8610run_avx512INtNtNtC6gz_bsp4cost5batch11ClosestTaskuEEBU_",
        "_RINvNtNtC7gz_core4simd3x8610run_avx512INtNtNtC6gz_bsp4cost5batch7AnyTaskNtNtNtB4_6kernel7passage7StoppeduEEBU_",
        "_RINvNtNtC7gz_core4simd3x8610run_avx512INtNtNtC6gz_bsp4cost5batch7AnyTaskNtNtNtB4_6kernel7passage12GoingThroughuEEBU_",
        "_RINvNtNtC7gz_core4simd3x868run_avx2INtNtNtC6gz_bsp4cost7abreast5AloneINtNtBP_5quest5AnyOfNtNtNtB6_6kernel7passage12GoingThroughuEEEBR_",
        "_RINvNtNtC7gz_core4simd3x868run_avx2INtNtNtC6gz_bsp4cost7abreast5AloneINtNtBP_5quest5AnyOfNtNtNtB6_6kernel7passage7StoppeduEEEBR_",
        "_RINvNtNtC7gz_core4simd3x868run_avx2INtNtNtC6gz_bsp4cost7abreast5AloneINtNtBP_5quest9ClosestOfuEEEBR_",
        "_RINvNtNtC7gz_core4simd3x8610run_avx512INtNtNtC6gz_bsp4cost7abreast5AloneINtNtBS_5quest5AnyOfNtNtNtB6_6kernel7passage12GoingThroughuEEEBR_",
        "_RINvNtNtC7gz_core4simd3x8610run_avx512INtNtNtC6gz_bsp4cost7abreast5AloneINtNtBS_5quest5AnyOfNtNtNtB6_6kernel7passage7StoppeduEEEBR_",
        "_RINvNtNtC7gz_core4simd3x8610run_avx512INtNtNtC6gz_bsp4cost7abreast5AloneINtNtBS_5quest9ClosestOfuEEEBR_",
    ];

    /// A listing of the functions, `more` inside of the first.
    fn made_up(more: &str) -> String {
        let body = "\tvmulps\t%ymm1, %ymm2, %ymm3\n\tcallq\t*memcpy@GOTPCREL(%rip)\n";
        let function = |(k, name): (usize, &&str)| {
            let more = if k == 0 { more } else { "" };
            format!("{name}:\n{body}{more}\tretq\n.Lfunc_end{k}:\n\t.size\t{name}, 3\n")
        };
        RUN.iter().enumerate().map(function).collect()
    }

    fn faults(more: &str) -> Vec<String> {
        judge(&made_up(more), LIBRARIES[1].tasks).1
    }

    #[test]
    fn inlined_code_has_no_fault() {
        let (report, faults) = judge(&made_up(""), LIBRARIES[1].tasks);
        assert_eq!(faults, Vec::<String>::new());
        assert_eq!(report.lines().filter(|line| line.contains("1 of 256")).count(), 12, "{report}");
        assert!(report.contains("1 calls of memcpy: copies"), "{report}");
    }

    #[test]
    fn a_kernel_that_is_called_is_a_fault() {
        let found = faults("\tcallq\t_RNvMNtNtC7gz_core6kernel5groupNtB2_8TriGroup9survivors\n");
        assert_eq!(found, ["run_avx2 of ClosestTask calls gz_core::kernel::group::TriGroup::survivors"]);
        // As a jump at the end of the function, and through a register.
        assert_eq!(faults("\tjmp\t_RNvNtNtC7gz_core6kernel6bundle5least\n").len(), 1);
        assert_eq!(faults("\tmovq\t_RNvNtNtC7gz_core6kernel6bundle5least@GOTPCREL(%rip), %r14\n\tcallq\t*%r14\n").len(), 1);
        assert_eq!(faults("\tcallq\t*%rax\n"), ["run_avx2 of ClosestTask calls through %rax"]);
    }

    #[test]
    fn a_closure_that_is_called_is_a_fault_even_of_an_allowed_function() {
        let found = faults("\tcallq\t_RNCNvMNtNtC7gz_core6kernel7nearestNtB4_7Nearest6settle0B6_\n");
        assert_eq!(found, ["run_avx2 of ClosestTask calls {closure}::gz_core::kernel::nearest::Nearest::settle"]);
        assert_eq!(faults("\tcallq\t_RNvMNtNtC7gz_core6kernel7nearestNtB2_7Nearest6settle\n"), Vec::<String>::new());
    }

    #[test]
    fn more_single_numbers_than_lanes_are_a_fallback() {
        let found = faults("\tvaddss\t%xmm1, %xmm2, %xmm3\n\tvmulss\t%xmm1, %xmm2, %xmm3\n");
        assert_eq!(found, ["run_avx2 of ClosestTask has 2 operations on single numbers and 1 on lanes"]);
    }

    #[test]
    fn a_level_that_is_missing_is_a_fault() {
        let listing =
            made_up("").replace("run_avx512INtNtNtC6gz_bsp4cost5batch7AnyTask", "run_avx512INtNtNtC6gz_bsp4cost5batch7OddTask");
        assert_eq!(
            judge(&listing, LIBRARIES[1].tasks).1,
            ["there is no run_avx512 of AnyTask Stopped", "there is no run_avx512 of AnyTask GoingThrough"]
        );
        assert_eq!(judge("", LIBRARIES[1].tasks).1.len(), 12);
    }

    #[test]
    fn a_listing_is_the_only_argument() {
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(run(&words("--fast")).map_err(|failure| failure.code), Err(2));
        assert_eq!(run(&words("a b")).map_err(|failure| failure.code), Err(2));
        assert_eq!(run(&words("no/such/gz_bsp-listing.s")).map_err(|failure| failure.code), Err(1));
        // Whose it is cannot be told.
        assert_eq!(run(&words("no/such/listing.s")).map_err(|failure| failure.code), Err(1));
    }
}
