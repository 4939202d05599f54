//! What README.md and docs/ tell a user to type, and the files that they name.

/// The folder that `git clone` makes.
pub const CLONE: &str = "stereopsis";

/// Endings of files that commands write.
const WRITTEN: [&str; 7] = [".png", ".pfm", ".ply", ".json", ".txt", ".html", ".csv"];

/// The `sh` blocks as scripts to run at the root of a clone.
///
/// Left out are `git clone` and `cd` into the clone, which the test has done with the local repository, and
/// the two test commands, which run this very test.
pub fn blocks(readme: &str) -> Vec<String> {
    let mut blocks = Vec::new();
    let mut lines = readme.lines();
    while lines.by_ref().any(|line| line.trim() == "```sh") {
        let block = lines.by_ref().take_while(|line| line.trim() != "```").filter(|line| is_run(line.trim()));
        let script: String = block.map(|line| format!("{line}\n")).collect();
        if !script.trim().is_empty() {
            blocks.push(script);
        }
    }
    blocks
}

fn is_run(line: &str) -> bool {
    let into_clone = line == format!("cd {CLONE}");
    let tests = ["cargo test", "cargo xtask test"].iter().any(|tests| line.starts_with(tests));
    !into_clone && !line.starts_with("git clone ") && !tests
}

/// The programs that the lines of a block begin with, each once.
pub fn programs(commands: &str) -> Vec<&str> {
    let mut programs: Vec<_> = commands.lines().filter_map(|line| line.split_whitespace().next()).collect();
    programs.sort();
    programs.dedup();
    programs
}

/// The folders after `--out`.
pub fn out_folders(commands: &str) -> Vec<&str> {
    let words: Vec<_> = commands.split_whitespace().collect();
    words.windows(2).filter(|pair| pair[0] == "--out").map(|pair| pair[1]).collect()
}

/// File names in `code` outside of blocks, with the ending of something written.
pub fn promised_files(readme: &str) -> Vec<String> {
    let mut in_block = false;
    let mut names = Vec::new();
    for line in readme.lines() {
        if line.trim_start().starts_with("```") {
            in_block = !in_block;
            continue;
        }
        if in_block {
            continue;
        }
        let code = line.split('`').skip(1).step_by(2);
        let is_file =
            |word: &&str| WRITTEN.iter().any(|end| word.ends_with(end)) && !word.contains([' ', '*', '<']);
        names.extend(code.filter(is_file).map(str::to_owned));
    }
    names.sort();
    names.dedup();
    names
}

/// The reading of README.md, on a small one.
mod on_a_small_readme {
    use super::*;

    const README: &str = "Writes `a.png` and `Vec`.\n```sh\ngit clone https://example.org/x stereopsis\ncd \
                          stereopsis\ncargo run -- demo --out demo\n```\n```rust\nlet x = \
                          `b.png`;\n```\n```sh\ncargo xtask test\n```\n`c.json` `a.png`";

    #[test]
    fn what_is_run() {
        assert_eq!(blocks(README), ["cargo run -- demo --out demo\n"]);
        assert_eq!(out_folders(&blocks(README).concat()), ["demo"]);
        assert_eq!(programs("cargo run -- demo\ncmake --build out\n\ncargo xtask c\n"), ["cargo", "cmake"]);
    }

    #[test]
    fn what_is_promised() {
        assert_eq!(promised_files(README), ["a.png", "c.json"]);
    }
}
