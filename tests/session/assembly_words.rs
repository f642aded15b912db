//! Faults of scenarios of assemblies: all at once, each in its line, and what is proposed does.

use stillbase::mechanics::assembly::{Assembly, builtin_assemblies};
use stillbase::session::assembly::{ASSEMBLY_KEYS, AssemblyScenario};
use stillbase::settings::fault::Fault;

fn builtin(name: &str) -> Assembly {
    builtin_assemblies().iter().find(|own| own.name == name).expect("built in").clone()
}

fn read(assembly: &Assembly, text: &str) -> Result<AssemblyScenario, Vec<Fault>> {
    AssemblyScenario::parse(text, "strange.toml", assembly.clone()).map_err(|why| {
        let (file, faults) = why.faults().expect("they are told");
        assert_eq!(file, "strange.toml");
        faults.list.clone()
    })
}

const FREE: &str = "\
machine = \"two-arms\"
name = \"two\"
title = \"Two\"
summary = \"Two arms\"
lead = \"right\"
against = [\"left\", \"right\"]
step = 0.002
duration = 2.0

[base]
kind = \"free\"
mass = 60.0
com = [0.0, 0.0, -0.3]
inertia = [4.0, 5.0, 6.0]
momentum = [0.0, 0.0, 1.0]
angular_momentum = [0.0, 0.1, 0.0]

[task.left]
kind = \"change-b\"
b = 1.9
b_to = 2.3
from = [0.7, 0.6]
to = [0.6, 0.3]
time = 3.0

[task.right]
kind = \"change-b\"
b = 2.2
from = [0.5, 0.5]
to = [0.4, 0.6]

[scenario.left]
compare_b = 2.0

[scenario.left.control]
kp = 300.0

[[scenario.left.edit]]
step = 20
do = \"slide-b\"
b = 2.2
";

const COMPLIANT: &str = "\
machine = \"two-arms\"

[base]
kind = \"compliant\"
mass = 60.0
inertia = [4.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 6.0]
stiffness = [2e4, 2e4, 2e4, 2e3, 2e3, 2e3]
damping = [200, 200, 200, 10, 10, 10]

[task.left]
kind = \"reactionless\"
b = 2.2
from = [0.5, 0.5]
to = [0.4, 0.6]

[task.right]
kind = \"minimum-norm\"
shape = \"line\"
b = 2.2
from = [0.5, 0.5]
to = [0.4, 0.6]
";

const TIP: &str = "\
machine = \"carrier-and-arm\"

[tip]
block = \"arm\"
from = [0.45, 0.35, 0.09]
via = [[0.46, 0.36, 0.09]]
to = [0.47, 0.37, 0.08]
closed = true
time = 2.0
law = \"septic\"
choice = \"mid-range\"
b = { carrier = 3.279, arm = 2.71 }
";

const GOOD: [(&str, &str); 3] = [("two-arms", FREE), ("two-arms", COMPLIANT), ("carrier-and-arm", TIP)];

/// Returns the number, from 1, key and value of each line that states one.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str, &str)> {
    let all = text.lines().enumerate();
    all.filter_map(|(i, line)| line.split_once(" = ").map(|(key, value)| (i + 1, key, value)))
}

/// Returns the number, from 1, of the line that states a key.
fn line_of(text: &str, path: &str) -> Option<usize> {
    let mut table = String::new();
    text.lines()
        .position(|line| {
            if line.starts_with('[') {
                table = format!("{}.", line.trim_matches(['[', ']']));
            }
            line.split_once(" = ").is_some_and(|(key, _)| format!("{table}{key}") == path)
        })
        .map(|at| at + 1)
}

fn with_line(text: &str, number: usize, line: &str) -> String {
    let all = text.lines().enumerate().map(|(i, own)| if i + 1 == number { line } else { own });
    all.collect::<Vec<_>>().join("\n") + "\n"
}

#[test]
fn all_faults_are_told_each_in_its_line() {
    let text = FREE
        .replace("lead = \"right\"", "lead = \"rigth\"")
        .replace("title = \"Two\"", "title = 3")
        .replace("step = 0.002", "steep = 0.002")
        .replace("kind = \"free\"", "kind = \"fre\"")
        .replace("com = [0.0, 0.0, -0.3]", "com = [0.0, -0.3]")
        .replace("[4.0, 5.0, 6.0]", "[4.0, 5.0]")
        .replace("momentum = [0.0, 0.0, 1.0]", "momentun = [0.0, 0.0, 1.0]")
        .replace("[task.left]", "[tasks.left]")
        .replace("b_to = 2.3", "b_too = 2.3")
        .replace("from = [0.7, 0.6]", "from = [0.7, nan]")
        .replace("compare_b = 2.0", "compare_b = 1e9")
        .replace("kp = 300.0", "kq = 300.0")
        .replace("do = \"slide-b\"", "do = \"slide\"");
    let told = read(&builtin("two-arms"), &text).expect_err("faults");
    let want = [
        (3, "title is the number 3: want a text in quotes"),
        (5, "block that is led (lead) names no block \"rigth\": want \"right\" (nearest)"),
        (7, "the file has no key \"steep\": want step (nearest)"),
        (11, "how the base is held (base.kind) is \"fre\": want \"free\" (nearest)"),
        (13, "centre of mass of the base (base.com) has 2 values instead of 3: want three numbers, m"),
        (14, "inertia of the base (base.inertia) has 2 numbers: want [x, y, z]"),
        (15, "base has no key \"momentun\": want momentum (nearest)"),
        (18, "the file has no key \"tasks\": want task (nearest)"),
        (21, "task of block left has no key \"b_too\": want b_to (nearest)"),
        (22, "point A of block left (task.left.from) is not a finite number: want one"),
        (33, "pose constant to compare with of block left (scenario.left.compare_b) is 1e9: want -1000 to 1000 rad"),
        (36, "control of block left has no key \"kq\": want k"),
        (40, "kind of edit 1 of block left (scenario.left.edit[1].do) is \"slide\": want \"slide-b\" (nearest)"),
    ];
    let seen: Vec<(Option<usize>, &str)> = told.iter().map(|fault| (fault.line, &fault.text[..])).collect();
    for (line, words) in want {
        assert!(
            seen.iter().any(|(at, text)| *at == Some(line) && text.starts_with(words)),
            "{line} {words}: {seen:#?}"
        );
    }
    assert_eq!(told.len(), want.len(), "{seen:#?}");
}

/// A key with a letter too many is told with the line that is right, which then is.
#[test]
fn misspelt_keys_are_mended_as_proposed() {
    let mut count = 0;
    for (name, good) in GOOD {
        let assembly = builtin(name);
        let whole = read(&assembly, good).expect("sound");
        // What an edit lacks is told before what it has too much.
        let edits = good.lines().position(|line| line.starts_with("[[")).unwrap_or(usize::MAX);
        for (number, key, value) in lines(good).filter(|(number, key, _)| *key != "machine" && *number < edits) {
            let last = key.chars().last().expect("a letter");
            let told = read(&assembly, &with_line(good, number, &format!("{key}{last} = {value}"))).expect_err(key);
            let words = format!("has no key \"{key}{last}\": want {key} (nearest)");
            let fault = told.iter().find(|fault| fault.line == Some(number) && fault.text.contains(&words));
            let fault = fault.unwrap_or_else(|| panic!("{key}: {told:#?}"));
            let again = read(&assembly, &with_line(good, number, &fault.example));
            assert_eq!(again.as_ref(), Ok(&whole), "{key}: {}", fault.example);
            count += 1;
        }
    }
    assert!(count > 30, "{count}");
    // Headers, too.
    for (header, other, words) in [
        ("[task.left]", "[tasks.left]", "the file has no key \"tasks\": want task (nearest)"),
        ("[task.left]", "[task.lefft]", "table of tasks has no key \"lefft\": want left (nearest)"),
        (
            "[scenario.left]",
            "[scenario.lefft]",
            "table of settings of blocks has no key \"lefft\": want left (nearest)",
        ),
        ("[base]", "[bases]", "the file has no key \"bases\": want base (nearest)"),
        ("[base]", "[spacecraft]", "the file has no key \"spacecraft\": want base"),
    ] {
        let told = read(&builtin("two-arms"), &FREE.replace(header, other)).expect_err(other);
        assert!(told[0].text.starts_with(words), "{told:#?}");
        assert!(told[0].line.is_some() && told[0].key == other.trim_matches(['[', ']']).replace("tasks.left", "tasks"));
    }
    // A block that needs a task is told one that does.
    let lacking = FREE.split("[task.right]").next().expect("text");
    let told = read(&builtin("two-arms"), lacking).expect_err("no task");
    assert!(told[0].text.starts_with("block right has no task") && told.len() == 1, "{told:#?}");
    read(&builtin("two-arms"), &format!("{lacking}\n{}\n", told[0].example)).expect("as proposed");
    // A misspelt table beside one that is right joins it.
    let both = format!("{lacking}\n[tasks.right]\nkind = \"reactionless\"\n");
    let told = read(&builtin("two-arms"), &both).expect_err("tasks");
    let texts: Vec<&str> = told.iter().map(|fault| &fault.text[..]).collect();
    assert!(texts.iter().any(|text| text.starts_with("the file has no key \"tasks\"")), "{texts:#?}");
    assert!(texts.iter().any(|text| text.contains("of block right (task.right.from) is missing")), "{texts:#?}");
}

/// Strange values: a fault has its line and says what would be right, and an example that is offered is no worse.
#[test]
fn strange_values_are_told() {
    const VALUES: [&str; 17] = [
        "3",
        "-1",
        "1e300",
        "nan",
        "-inf",
        "\"x\"",
        "\"\"",
        "true",
        "[]",
        "{}",
        "[nan, 1, 2]",
        "[[1]]",
        "[1, \"x\"]",
        "{ a = 1 }",
        "2020-01-01",
        "[1, 2, 3, 4, 5, 6]",
        "[[nan, 1, 1]]",
    ];
    let (mut refused, mut mended) = (0, 0);
    for (name, good) in GOOD {
        let assembly = builtin(name);
        for (number, key, _) in lines(good).filter(|(_, key, _)| *key != "machine") {
            // Paths in space take their time.
            for value in VALUES.iter().step_by(if good == TIP { 3 } else { 1 }) {
                let text = with_line(good, number, &format!("{key} = {value}"));
                let Err(told) = read(&assembly, &text) else { continue };
                refused += 1;
                for fault in &told {
                    assert!(fault.line.is_some() && fault.text.contains("want "), "{key} = {value}: {fault:#?}");
                    assert!(fault.text.len() < 700, "{fault:#?}");
                }
                let own = told.iter().find(|fault| fault.line == Some(number) && !fault.example.is_empty());
                if let (Some(fault), [_]) = (own, &told[..]) {
                    let again = read(&assembly, &with_line(good, number, &fault.example));
                    let same = again.as_ref().err().is_some_and(|again| again[0].text == fault.text);
                    assert!(!same, "{key} = {value}: {fault:#?}");
                    mended += usize::from(again.is_ok());
                }
            }
        }
    }
    assert!(refused > 200 && mended > 100, "{refused} {mended}");
}

/// A key at its default is as good as none.
#[test]
fn defaults_are_those_of_the_keys() {
    for (name, good) in GOOD {
        let assembly = builtin(name);
        for (_, tables) in ASSEMBLY_KEYS {
            for key in tables.iter().copied().flatten() {
                let Some(number) = line_of(good, key.path) else { continue };
                let last = key.path.rsplit('.').next().expect("a word");
                let without = read(&assembly, &with_line(good, number, ""));
                match key.default {
                    "" if key.when != "base.kind = compliant" || good == COMPLIANT => {
                        let told = without.expect_err(key.path);
                        assert!(told[0].text.contains(&format!("({})", key.path)), "{told:#?}");
                    }
                    "" | "none" => drop(without.expect(key.path)),
                    default => {
                        let typed = match in_toml(default) {
                            Some(typed) => typed,
                            None => format!("{default:?}"),
                        };
                        let stated = read(&assembly, &with_line(good, number, &format!("{last} = {typed}")));
                        assert_eq!(stated.expect(key.path), without.expect(key.path), "{}", key.path);
                    }
                }
            }
        }
    }
}

/// Returns a default as TOML has it; `None` for a word.
fn in_toml(default: &str) -> Option<String> {
    let reads = |text: &str| format!("x = {text}").parse::<toml::Table>().is_ok();
    [default.to_owned(), format!("[{default}]")].into_iter().find(|text| reads(text))
}
