//! README.md's table of instructions: cells of the one in docs/performance.md.

/// A column's name, and the cores that have its figures, in pictures of so many pixels and disparities.
const COLUMNS: [(&str, &[&str], [&str; 2]); 7] = [
    ("M0 (96x64x16)", &["m0"], ["96x64", "16"]),
    ("M3", &["m3"], SIZE),
    ("M4, M7", &["m4", "m7"], SIZE),
    ("M33", &["m33"], SIZE),
    ("M55", &["m55"], SIZE),
    ("RV32", &["rv32"], SIZE),
    ("RV32, vectors", &["rv32v"], SIZE),
];
const SIZE: [&str; 2] = ["160x120", "32"];
const METHODS: [&str; 3] = ["`fast`", "`block`", "`sgm`"];

/// The table, from the text of docs/performance.md.
pub fn table(performance: &str) -> Result<String, String> {
    let rows: Vec<Vec<_>> = performance
        .lines()
        .skip_while(|line| *line != "<!-- generated: firmware -->")
        .take_while(|line| *line != "<!-- end: firmware -->")
        .map(|line| line.split('|').map(str::trim).collect())
        .collect();
    let cell = |core: &str, method: &str, [pixels, disparities]: [&str; 2]| {
        let wanted = ["", core, method, pixels, disparities];
        let row = rows.iter().find(|row| row.starts_with(&wanted));
        row.and_then(|row| row.get(6)).copied().ok_or_else(|| format!("no row has {wanted:?}"))
    };
    let names = COLUMNS.map(|(name, ..)| format!(" {name} |")).concat();
    let mut table = format!("| |{names}\n| ---{} |\n", " | ---:".repeat(COLUMNS.len()));
    for method in METHODS {
        table += &format!("| {method} |");
        for (name, cores, size) in COLUMNS {
            let found: Vec<_> =
                cores.iter().map(|core| cell(core, method, size)).collect::<Result<_, _>>()?;
            if found.iter().any(|figure| *figure != found[0]) {
                return Err(format!("{method} differs among the cores of {name}: {found:?}"));
            }
            table += &format!(" {} |", found[0]);
        }
        table += "\n";
    }
    Ok(table)
}

/// The check above, on tables that it refuses.
mod shown_to_fail {
    use super::*;

    /// A table of all rows, with the figure of one of them.
    fn performance(core: &str, figure: &str) -> String {
        let row = |of: &str, size: [&str; 2], method: &str| {
            let figure = if of == core { figure } else { "1.25" };
            format!("| {of} | {method} | {} | {} | 9 | {figure} | 8 |\n", size[0], size[1])
        };
        let rows = COLUMNS.iter().flat_map(|(_, cores, size)| {
            cores.iter().flat_map(move |of| METHODS.map(|method| row(of, *size, method)))
        });
        format!("<!-- generated: firmware -->\n{}<!-- end: firmware -->\n", rows.collect::<String>())
    }

    #[test]
    fn figures_that_are_missing_or_differ() {
        let whole = table(&performance("m3", "2.50")).expect("a table");
        assert_eq!(whole.lines().nth(2), Some("| `fast` | 1.25 | 2.50 | 1.25 | 1.25 | 1.25 | 1.25 | 1.25 |"));
        assert!(table(&performance("m7", "2.50")).unwrap_err().contains("differs"));
        let text = performance("m3", "2.50").replace("| m55 |", "| m85 |");
        assert!(table(&text).unwrap_err().contains("m55"));
    }
}
