//! What cbindgen's text needs for C++98, and the functions' declarations with a prefix.

use crate::steps::{Failure, Outcome};

/// cbindgen's head of the enum of statuses.
const ENUM: &str = "enum stereopsis_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {";
/// One that has a name and a type of its own where an enum cannot have a size.
const PORTABLE_ENUM: &str = "#if defined(__cplusplus) ? __cplusplus >= 201103L : __STDC_VERSION__ >= 202311L
enum stereopsis_status : int32_t
#elif defined(__cplusplus)
enum stereopsis_status_numbers
#else
enum stereopsis_status
#endif
{";
/// cbindgen's type of a status.
const TYPE: &str = "#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum stereopsis_status stereopsis_status;
#else
typedef int32_t stereopsis_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus
";
/// The same with C++98.
const PORTABLE_TYPE: &str = "#if defined(__cplusplus) ? __cplusplus < 201103L : __STDC_VERSION__ < 202311L
typedef int32_t stereopsis_status;
#elif !defined(__cplusplus)
typedef enum stereopsis_status stereopsis_status;
#endif
";
/// Where the functions begin, and where they end.
const FUNCTIONS: (&str, &str) =
    ("extern \"C\" {\n#endif // __cplusplus\n", "#ifdef __cplusplus\n}  // extern");

const DESCRIPTION: &str = "/**
 * Declares all functions with `prefix` before their names, for a library that was built with it:
 * `STEREOPSIS_FUNCTIONS(near_);` in a file makes `near_stereopsis_init` and the others known.
 */
#ifdef __cplusplus
#define STEREOPSIS_EXTERN extern \"C\"
#else
#define STEREOPSIS_EXTERN extern
#endif
#define STEREOPSIS_FUNCTIONS(prefix) \\\n";

/// The header for C99 and C++98 with the functions once more as a macro.
pub fn portable(text: &str) -> Outcome<String> {
    let missing = |what: &str| Failure::new(format!("cbindgen's text has changed: it has no {what}"));
    let replaced = |text: &str, from: &str, to: &str| match text.matches(from).count() {
        1 => Ok(text.replace(from, to)),
        _ => Err(missing(from)),
    };
    let text = replaced(text, ENUM, PORTABLE_ENUM)?;
    let text = replaced(&text, TYPE, PORTABLE_TYPE)?;
    // A comma behind the last number is C99's.
    let text = text.replace(",\n};\n#if", "\n};\n#if");
    let (_, after) = text.split_once(FUNCTIONS.0).ok_or_else(|| missing(FUNCTIONS.0))?;
    let (functions, _) = after.split_once(FUNCTIONS.1).ok_or_else(|| missing(FUNCTIONS.1))?;
    let declarations = declarations(functions);
    let end = "\n#endif  /* STEREOPSIS_H */";
    replaced(&text, end, &format!("\n{DESCRIPTION}{declarations}\n{end}"))
}

/// The declarations without their descriptions, as lines of a macro.
fn declarations(functions: &str) -> String {
    let is_code = |line: &&str| !["/**", " *"].iter().any(|sign| line.starts_with(sign));
    let words: Vec<_> = functions.lines().filter(is_code).flat_map(str::split_whitespace).collect();
    let code = words.join(" ");
    let prefixed = code.split(';').map(str::trim).filter(|one| !one.is_empty()).map(|one| {
        let (head, arguments) = one.split_once('(').unwrap_or((one, "void)"));
        let name = head.rfind([' ', '*']).map_or(0, |at| at + 1);
        format!("  STEREOPSIS_EXTERN {}prefix##{}({arguments}", &head[..name], &head[name..])
    });
    prefixed.collect::<Vec<_>>().join("; \\\n")
}

#[cfg(test)]
mod tests {
    use super::declarations;

    #[test]
    fn functions_have_a_prefix() {
        let text = "/**\n * Returns a text; or none.\n */\nconst char *stereopsis_text(int32_t status);\n\n\
                    int stereopsis_f(struct stereopsis *handle,\n                 size_t count);\n";
        let expected = "  STEREOPSIS_EXTERN const char *prefix##stereopsis_text(int32_t status); \\\n  \
                        STEREOPSIS_EXTERN int prefix##stereopsis_f(struct stereopsis *handle, size_t count)";
        assert_eq!(declarations(text), expected);
    }
}
