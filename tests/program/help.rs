//! Help and tables.

use super::*;

#[test]
fn help_names_every_command_with_units_and_examples() {
    let all = prints(&["--help"]);
    let known =
        <stillbase_commands::Subcommand as clap::Subcommand>::augment_subcommands(clap::Command::new("stillbase"));
    let names: Vec<&str> = known.get_subcommands().map(clap::Command::get_name).collect();
    assert!(names.len() > 14, "{names:?}");
    for command in names {
        assert!(all.contains(&format!("\n  {command} ")), "{command}");
        let help = prints(&[command, "--help"]);
        let of_itself = ["completions", "man", "schema"].contains(&command);
        let fixed = of_itself || ["figures", "keys", "results", "replay", "diff", "table"].contains(&command);
        assert!(fixed || help.contains("--set <KEY=VALUE>"), "{command}");
        assert!(of_itself || ["figures", "table"].contains(&command) || help.contains("--json"), "{command}");
        assert!(help.contains("Example"), "{command}");
    }
    assert!(prints(&["--version"]).starts_with("stillbase "));
}

#[test]
fn tables_show_units_and_the_same_numbers() {
    let table = prints(&["reach", "nine-link", "0.5,0.5"]);
    assert!(table.contains("b_min rad") && table.contains("0.5, 0.5"), "{table}");
    let check = prints(&["check", "nine-link-table-1"]);
    assert!(check.contains("machine          off balance by 2."), "{check}");
    for part in ["16.050 kg", "1.367816575", "0.127920111", "-0.000105000", "force balanced   no"] {
        assert!(check.contains(part), "{part} in {check}");
    }
    assert!(!prints(&["check", "nine-link"]).contains("-0.000000000"), "zero has no sign");
}
