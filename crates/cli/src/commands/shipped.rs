//! `limitmesh completions` and `limitmesh man`: what packages of the program bring along, made from its command line.

use clap::{Command, CommandFactory};
use clap_mangen::Man;

use crate::arguments::{Arguments, CompletionsArguments, ManArguments};
use crate::failure::Outcome;
use crate::output;

/// Prints the completions of a shell.
pub(crate) fn completions(arguments: &CompletionsArguments) -> anyhow::Result<Outcome> {
    let program = Arguments::command();
    // Completions would list hidden commands, too.
    let mut shown = Command::new("limitmesh")
        .version(env!("CARGO_PKG_VERSION"))
        .args(program.get_arguments())
        .subcommands(commands(&program).cloned());
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut shown, "limitmesh", &mut text);
    output::print(&String::from_utf8(text)?)?;
    Ok(Outcome::Done)
}

/// Writes the pages of the manual.
pub(crate) fn man(arguments: &ManArguments) -> anyhow::Result<Outcome> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    for command in std::iter::once(&program).chain(commands(&program)) {
        // A page has no short form, and would leave out what only the short help hides.
        let command = command.clone().mut_args(|own| own.hide_short_help(false));
        let man = Man::new(command).source(concat!("limitmesh ", env!("CARGO_PKG_VERSION")));
        let mut page = Vec::new();
        man.render(&mut page)?;
        output::write_file(&arguments.folder.join(man.get_filename()), &page)?;
    }
    Ok(Outcome::Done)
}

/// The commands that help lists.
fn commands(program: &Command) -> impl Iterator<Item = &Command> {
    program.get_subcommands().filter(|own| !own.is_hide_set())
}
