//! The command line: its words, and what programs say on standard error when they cannot do what is asked,
//! one line.

use clap::error::{Error, ErrorKind};

/// The command line, word by word.
pub fn words() -> Vec<String> {
    std::env::args_os().map(|word| word.to_string_lossy().into_owned()).collect()
}

/// clap's message, which has several paragraphs, as one line: the first one and the tips. `commands` is what
/// is told to one who names another command.
pub fn usage_line(error: &Error, commands: &str) -> String {
    let text = error.render().to_string();
    let first = text.lines().map(str::trim).take_while(|line| !line.is_empty());
    let mut line = first.collect::<Vec<_>>().join(" ");
    for tip in text.lines().filter_map(|line| line.trim().strip_prefix("tip: ")) {
        line = line + "; " + tip;
    }
    match error.kind() {
        ErrorKind::InvalidSubcommand => line = line + "; " + commands,
        ErrorKind::MissingRequiredArgument | ErrorKind::UnknownArgument => line += "; see --help",
        _ => {}
    }
    line.strip_prefix("error: ").map_or(line.clone(), str::to_owned)
}

/// The longest word of a file that is said again, characters.
const MOST_SAID: usize = 60;

/// A word of a file as an error says it again: its beginning, where it is long.
pub fn word(found: &str) -> String {
    match found.char_indices().nth(MOST_SAID) {
        Some((end, _)) => format!("{}...", &found[..end]),
        None => found.to_owned(),
    }
}

/// The text with line ends and other control characters, which a file's name may hold, written out.
pub fn one_line(text: &str) -> String {
    text.chars().flat_map(|c| if c.is_control() { c.escape_default().collect() } else { vec![c] }).collect()
}
