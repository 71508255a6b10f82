//! `docs/cli.md`: every command with its options, as clap knows them.

use std::fmt::Write;

use clap::{Arg, Command, CommandFactory};

use super::made;
use crate::arguments::Arguments;

const BEGINNING: &str = "\
# The command line

Every command and option, with its unit, default and effect. `limitmesh COMMAND -h` prints the most used options,
`limitmesh COMMAND --help` all of them.

This page is generated from the program: do not edit it.
";

#[test]
fn the_page_lists_the_command_line() {
    made::check("docs/cli.md", page().as_bytes());
}

fn page() -> String {
    let mut whole = Arguments::command();
    whole.build();
    let mut page = BEGINNING.to_owned();
    let about = whole.get_long_about().map(ToString::to_string);
    writeln!(page, "\n{}", text(about)).unwrap();
    let shown: Vec<&Command> = whole
        .get_subcommands()
        .filter(|own| !own.is_hide_set() && own.get_name() != "help")
        .collect();
    page.push_str("\n| command | what it does |\n|---|---|\n");
    for command in &shown {
        let name = command.get_name();
        let about = text(command.get_about().map(ToString::to_string));
        writeln!(page, "| [`{name}`](#limitmesh-{name}) | {about} |").unwrap();
    }
    page.push_str("\n## Options of every command\n\n");
    for argument in whole.get_arguments().filter(|own| own.is_global_set()) {
        page.push_str(&entry(argument));
    }
    page.push_str(&examples(&whole));
    shown
        .iter()
        .for_each(|command| page.push_str(&section(command)));
    page
}

/// The page of a command: its purpose, its usage, its options by their headings, and examples.
fn section(command: &Command) -> String {
    let mut page = format!("\n## limitmesh {}\n\n", command.get_name());
    let about = command
        .get_long_about()
        .or(command.get_about())
        .map(ToString::to_string);
    writeln!(page, "{}\n", text(about)).unwrap();
    let usage = command.clone().render_usage().to_string();
    writeln!(
        page,
        "```text\n{}\n```",
        usage.trim_start_matches("Usage:").trim()
    )
    .unwrap();
    let own: Vec<&Arg> = command
        .get_arguments()
        .filter(|argument| !argument.is_global_set() && !argument.is_hide_set())
        .filter(|argument| !["help", "version"].contains(&argument.get_id().as_str()))
        .collect();
    let mut headings: Vec<&str> = Vec::new();
    for argument in &own {
        let heading = heading(argument);
        if !headings.contains(&heading) {
            headings.push(heading);
        }
    }
    for name in headings {
        writeln!(page, "\n### {}: {name}\n", command.get_name()).unwrap();
        own.iter()
            .filter(|argument| heading(argument) == name)
            .for_each(|own| page.push_str(&entry(own)));
    }
    page + &examples(command)
}

/// The text after a command's options in its help.
fn examples(command: &Command) -> String {
    let help = command.get_after_long_help().or(command.get_after_help());
    help.map_or_else(String::new, |help| {
        format!("\n```text\n{}\n```\n", help.to_string().trim())
    })
}

fn heading(argument: &Arg) -> &str {
    argument
        .get_help_heading()
        .unwrap_or(if argument.is_positional() {
            "arguments"
        } else {
            "options"
        })
}

/// An argument as an item of a list: how it is written, its help, the values that it takes and its default.
fn entry(argument: &Arg) -> String {
    let help = argument
        .get_long_help()
        .or(argument.get_help())
        .map(ToString::to_string);
    let mut item = format!(
        "* **`{}`**: {}\n",
        call(argument),
        text(help).replace("\n", "\n  ").replace("\n  \n", "\n\n")
    );
    let takes_values = argument.get_action().takes_values();
    let values = argument.get_possible_values();
    for value in values
        .iter()
        .filter(|value| takes_values && !value.is_hide_set())
    {
        match value.get_help() {
            Some(help) => writeln!(
                item,
                "  * `{}`: {}",
                value.get_name(),
                text(Some(help.to_string()))
            ),
            None => writeln!(item, "  * `{}`", value.get_name()),
        }
        .unwrap();
    }
    let defaults = argument.get_default_values();
    if takes_values && !defaults.is_empty() {
        let defaults: Vec<String> = defaults
            .iter()
            .map(|own| format!("`{}`", own.display()))
            .collect();
        writeln!(item, "\n  Default: {}.", defaults.join(", ")).unwrap();
    }
    item
}

/// `-o, --output <FILE>`.
fn call(argument: &Arg) -> String {
    let short = argument.get_short().map(|short| format!("-{short}"));
    let long = argument.get_long().map(|long| format!("--{long}"));
    let names: Vec<String> = short.into_iter().chain(long).collect();
    let values = argument
        .get_value_names()
        .filter(|_| argument.get_action().takes_values());
    let values = values.map_or_else(String::new, |names| {
        names
            .iter()
            .map(|name| format!("<{name}>"))
            .collect::<Vec<_>>()
            .join(" ")
    });
    match argument.is_require_equals_set() {
        true => format!("{}[={values}]", names.join(", ")),
        false => format!("{} {values}", names.join(", ")).trim().to_owned(),
    }
}

/// Help as Markdown, on as many lines as it has, without spaces at their ends; what would be formatting is escaped.
fn text(help: Option<String>) -> String {
    let help = help
        .unwrap_or_default()
        .replace('*', "\\*")
        .replace('<', "\\<")
        .replace('|', "\\|");
    help.lines()
        .map(str::trim_end)
        .collect::<Vec<_>>()
        .join("\n")
}
