//! `stereo completions` and `stereo man`: what a shell and a reader of manuals want to know of the commands.

use crate::failure::Failure;
use crate::shared::print;
use clap::{Args, Command};
use clap_complete::Shell;
use clap_mangen::Man;
use std::path::PathBuf;
use stereopsis_host::command_line::one_line;
use stereopsis_host::output::Staging;

/// What follows the options in the help of `completions`.
pub const COMPLETIONS: &str = "Examples:
  stereo completions bash > ~/.local/share/bash-completion/completions/stereo
  stereo completions zsh > ~/.zfunc/_stereo
  stereo completions fish > ~/.config/fish/completions/stereo.fish";

#[derive(Debug, Args)]
pub struct CompletionsArgs {
    /// The shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

#[derive(Debug, Args)]
pub struct ManArgs {
    /// Folder for the pages, stereo.1 and one for each command; made when it is missing
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Prints the completions of the program, whose commands are given.
pub fn completions(args: &CompletionsArgs, mut program: Command) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut program, "stereo", &mut script);
    print(&String::from_utf8_lossy(&script))
}

/// Writes the pages of the manual.
pub fn man(args: &ManArgs, mut program: Command) -> Result<(), Failure> {
    program.build();
    let mut pages = Vec::new();
    render(program, &mut pages)?;
    let mut staging = Staging::new(&args.out)?;
    for (name, page) in &pages {
        staging.write(name, |out| out.write_all(page))?;
    }
    staging.commit(&[])?;
    print(&format!(
        "{} pages are in {}: man {}\n",
        pages.len(),
        one_line(&args.out.display().to_string()),
        one_line(&args.out.join("stereo.1").display().to_string())
    ))
}

/// The page of a command and those of its own commands.
fn render(command: Command, pages: &mut Vec<(String, Vec<u8>)>) -> Result<(), Failure> {
    let own: Vec<_> = command.get_subcommands().filter(|own| own.get_name() != "help").cloned().collect();
    let man = Man::new(command);
    let mut page = Vec::new();
    man.render(&mut page)?;
    pages.push((man.get_filename(), page));
    own.into_iter().try_for_each(|own| render(own, pages))
}
