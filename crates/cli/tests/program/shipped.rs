//! What packages of the program bring along: completions of shells, pages of the manual.

use std::fs;
use std::process::{Command, Stdio};

use crate::common::{command, done, folder, names};

#[test]
fn shells_complete_commands_and_options() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = done(&format!("completions {shell}"), &[]).stdout;
        says!(script, "refine");
        says!(script, "tolerance");
        silent!(script, "batch-job");
    }
}

#[test]
#[cfg(unix)]
fn bash_offers_what_fits() {
    let mut bash = Command::new("bash");
    let lines = "eval \"$COMPLETIONS\"; COMP_WORDS=(limitmesh refine x.obj --toler); COMP_CWORD=3; \
        _limitmesh limitmesh --toler x.obj; echo \"${COMPREPLY[@]}\"";
    let script = done("completions bash", &[]).stdout;
    let bash = bash.args(["-c", lines]).env("COMPLETIONS", script);
    let offered = bash.stderr(Stdio::inherit()).output().expect("bash runs");
    says!(String::from_utf8_lossy(&offered.stdout), "--tolerance");
}

#[test]
fn each_command_has_a_page_of_the_manual() {
    let folder = folder();
    done("man {}", &[folder.path()]);
    let pages = names(folder.path());
    let page = |name: &str| fs::read_to_string(folder.path().join(name)).expect(name);
    says!(page("limitmesh.1"), "Exit codes");
    says!(page("limitmesh-refine.1"), "tolerance");
    says!(page("limitmesh-refine.1"), "text rather than binary");
    assert!(!pages.contains(&"limitmesh-man.1".to_owned()), "{pages:?}");
    let help = command("--help", &[]).output().expect("the program runs");
    let help = String::from_utf8(help.stdout).expect("UTF-8");
    let listed = help.split_once("Commands:\n").expect("a list").1.lines();
    let listed = listed.take_while(|line| !line.trim().is_empty());
    // Deeper lines go on with what a command does.
    let listed = listed.filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    for name in listed.filter(|&name| !["", "help"].contains(&name)) {
        assert!(
            pages.contains(&format!("limitmesh-{name}.1")),
            "{name} in {pages:?}"
        );
    }
}
