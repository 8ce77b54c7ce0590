//! Names of functions in generated code, as far as this check needs them.

/// The path of a symbol of rustc's v0 mangling: its identifiers in order, generic arguments behind, such as
/// `gz_core::simd::x86::run_avx2::gz_bsp::cost::batch::ClosestTask`. A closure shows as `{closure}`. Any other symbol is given as it is.
pub(super) fn path(symbol: &str) -> String {
    match symbol.strip_prefix("_R").and_then(words) {
        Some(words) if !words.is_empty() => words.join("::"),
        _ => symbol.to_owned(),
    }
}

/// Not a demangler: tags are skipped, identifiers kept. Numbers that are no lengths (disambiguators, references back, constants) stand
/// behind a tag that tells them.
fn words(mangled: &str) -> Option<Vec<String>> {
    let mut words = Vec::new();
    let mut rest = mangled;
    while let Some(tag) = rest.chars().next() {
        if tag.is_ascii_digit() {
            let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
            let length: usize = rest[..digits].parse().ok()?;
            // A separator stands where the identifier itself begins with a digit or an underscore.
            let body = &rest[digits..];
            let body = if length > 0 { body.strip_prefix('_').unwrap_or(body) } else { body };
            let word = body.get(..length)?;
            if length > 0 {
                words.push(word.to_owned());
            }
            rest = &body[length..];
            continue;
        }
        rest = &rest[tag.len_utf8()..];
        match tag {
            // Up to the next underscore: a number in base 62.
            's' | 'B' | 'L' => rest = &rest[rest.find('_')? + 1..],
            // A length of type usize: hexadecimal, up to the next underscore.
            'j' => rest = rest.trim_start_matches(|c: char| c.is_ascii_hexdigit()).strip_prefix('_').unwrap_or(rest),
            'N' if rest.starts_with('C') => {
                words.push("{closure}".to_owned());
                rest = &rest[1..];
            }
            // A namespace in lower case is no tag of its own.
            'N' => rest = rest.get(1..)?,
            // What the linker or compiler has put behind.
            '.' | '@' | '$' => break,
            _ => {}
        }
    }
    Some(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identifiers_are_kept_in_order() {
        let run = "_RINvNtNtCsh2yhpxfAhjv_7gz_core4simd3x868run_avx2INtNtNtCslpNrPB6we2K_6gz_bsp4cost5batch11ClosestTaskuEEBR_";
        assert_eq!(path(run), "gz_core::simd::x86::run_avx2::gz_bsp::cost::batch::ClosestTask");
        let settle = "_RNvMNtNtCsh2yhpxfAhjv_7gz_core6kernel7nearestNtB2_7Nearest6settle";
        assert_eq!(path(settle), "gz_core::kernel::nearest::Nearest::settle");
        assert_eq!(path("_RNvCsfLfy6EI15iL_7___rustc14___rust_dealloc"), "__rustc::__rust_dealloc");
    }

    #[test]
    fn a_closure_shows_and_a_constant_is_no_length() {
        let closure =
            "_RINvNtCsgEmfK2I1SDS_4core5array8map_onceAfj3_Kj10_NCINvNtCsh2yhpxfAhjv_7gz_core6bundle6paddedAfj3_Kj10_E0E";
        assert_eq!(path(closure), "core::array::map_once::{closure}::gz_core::bundle::padded");
    }

    #[test]
    fn other_symbols_stay_as_they_are() {
        for other in ["memcpy", "_Unwind_Resume", "_ZN7gz_core4simd3x868run_avx217hc1121c847a826fbcE", "_R9short"] {
            assert_eq!(path(other), other);
        }
    }
}
