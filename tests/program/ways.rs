//! Ways out on the command line: what a refusal prints works as it is typed back, and is the same in JSON.

use super::*;
use crate::support::Noise;
use stillbase::mechanics::machine::builtins;

/// Splits a printed command line as a shell does, for words without escapes.
fn split(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quoted, mut any) = (Vec::new(), String::new(), false, false);
    for c in line.chars() {
        match c {
            '\'' => (quoted, any) = (!quoted, true),
            ' ' if !quoted => {
                if any || !word.is_empty() {
                    words.push(std::mem::take(&mut word));
                }
                any = false;
            }
            c => word.push(c),
        }
    }
    if any || !word.is_empty() {
        words.push(word);
    }
    words
}

/// Runs a command that is refused, and returns every way out that it prints as the arguments to type.
fn ways_out(args: &[String]) -> Vec<Vec<String>> {
    let words: Vec<&str> = args.iter().map(String::as_str).collect();
    let out = stillbase(&words);
    assert_ne!(out.status.code(), Some(0), "{args:?}");
    let said = text(&out.stderr).to_owned();
    let ways = said.lines().filter_map(|line| {
        if let Some((_, command)) = line.split_once(": stillbase ") {
            return Some(split(command));
        }
        let (_, settings) = line.strip_prefix("stillbase: ")?.split_once(": --set ")?;
        Some(args.iter().cloned().chain(["--set".to_owned()]).chain(split(settings)).collect())
    });
    let ways: Vec<_> = ways.collect();
    // The same in JSON.
    let json: Vec<&str> = words.iter().copied().chain(["--json"]).collect();
    let printed: Value = serde_json::from_slice(&stillbase(&json).stdout).unwrap_or_else(|e| panic!("{json:?}: {e}"));
    let proposals = printed["proposals"].as_array().unwrap_or_else(|| panic!("{json:?}: {printed}")).clone();
    assert_eq!(proposals.len(), ways.len(), "{args:?}: {printed} {said}");
    for proposal in &proposals {
        let has = |key: &str| proposal.get(key).is_some();
        assert!(has("text") && (has("set") != has("command")), "{proposal}");
        assert!(said.contains(proposal["text"].as_str().expect("text")), "{said}: {proposal}");
    }
    ways
}

/// Every way out leads to success.
fn works(args: &[String]) -> usize {
    let ways = ways_out(args);
    for way in &ways {
        let words: Vec<&str> = way.iter().map(String::as_str).collect();
        let out = stillbase(&words);
        // A word that is only read now may still have no answer; then its own ways out have.
        let is_read =
            text(&stillbase(&args.iter().map(String::as_str).collect::<Vec<_>>()).stderr).contains("; see --help");
        match out.status.code() {
            Some(0) => {}
            Some(1) if is_read => assert!(works(way) > 0, "{way:?}"),
            _ => panic!("{args:?} proposes {way:?}: {}", text(&out.stderr)),
        }
    }
    ways.len()
}

/// What has been refused by a number or a word of its own has a way out that works.
#[test]
fn what_is_refused_says_what_would_work() {
    for line in [
        "pose nine-link 0.5,0.5 --b 0.3",
        "pose nine-link 5,5 --b 2.4",
        "pose nine-link -0.9,-0.9 --b -7",
        "pose nine-link 0.5,0.5 --b 1e9",
        "pose nine-link 1e9,0 --b=2.4",
        "pose nine-link 0.5,0.5 --b 2.4 --set limits.a1=0.1,0.2",
        "reach nine-link 0.5,0.5 5,5",
        "reach nine-link 0.5,0.5 -0.6,-0.2",
        "reach nine-link 0.5,0.5 -5,-5",
        "reach nine-link 5,5 -5,-5 0.5,0.5",
        "workspace nine-link --b 1e9",
        "check nine-link --set link.5.mass=-1",
        "check nine-link --set limits.a1=2.7,0.4",
        "check nine-link --set gravity=1e9,0",
        "plan nine-link 0.5,0.5 0.55,0.9 --b 0.2",
        "plan nine-link 0.5,0.5 5,5 --b 2.4",
        "plan nine-link 0.5,0.5 0.55,0.9 --kind reactionles",
        "plan case-3 --set task.b=0.2",
        "plan case-3 --set task.time=1e9",
        "simulate case-3 --set task.b=0.2 --every 1000",
        "simulate case-3 --set step=1 --every 1000",
        "simulate case-3 --set control.kp=-1 --every 1000",
        "simulate case-3 --set base.kind=fre --every 1000",
        "plan case-3 --kin reactionless",
        "check nine-linc",
        "check NINE-LINK",
        "plan case-33",
        "simulate case-4 --every 1000",
        "compare case-1 crcle",
        "design nine-link --task=cse-3",
        "learn serial-3",
        "tolerance wheels",
        "simulat case-3",
        "chek nine-link",
        "pose nine-link 0.5,0.5 --b 50",
        "plan case-3 --set task.b=50",
        "plan case-1 --set limits.a1=1.5,2.7",
    ] {
        assert!(works(&split(line)) > 0, "{line} has no way out");
    }
}

/// On every machine of the gallery with a b, whatever point and b are asked for.
#[test]
fn poses_and_reach_propose_what_there_is() {
    let mut noise = Noise::of(77);
    let mut found = 0;
    for machine in builtins() {
        let Ok(space) = stillbase::planning::pose_space::PoseSpace::of(machine) else { continue };
        let size = 1.5 * space.farthest();
        for _ in 0..2 {
            let at = format!("{:.3},{:.3}", noise.between(-size, size), noise.between(-size, size));
            let b = format!("{:.3}", noise.between(-8.0, 8.0));
            for args in [vec!["pose", machine.name(), &at, "--b", &b], vec!["reach", machine.name(), &at]] {
                if stillbase(&args).status.success() {
                    continue;
                }
                let args: Vec<String> = args.into_iter().map(str::to_owned).collect();
                let ways = works(&args);
                assert!(ways > 0, "{args:?} has no way out");
                found += ways;
            }
        }
    }
    assert!(found > 10, "only {found}");
}

/// A file that does not exist: the nearest file of its kind, and no other.
#[test]
fn a_misspelt_file_names_the_nearest() {
    let folder = Folder::new("nearest");
    let machine = folder.file("mine.toml", NINE_LINK);
    folder.file("notes.toml", "words = 1\n");
    folder.file("task.toml", include_str!("../../assets/scenarios/case-3.toml"));
    let at = |name: &str| machine.with_file_name(name).to_str().expect("a name").to_owned();
    for (command, wrong, right) in [
        ("check", "mne.toml", Some("mine.toml")),
        ("check", "MINE.toml", Some("mine.toml")),
        ("plan", "taks.toml", Some("task.toml")),
        ("plan", "tusk", Some("task.toml")),
        // A scenario is no machine, and what is neither is none.
        ("check", "tusk.toml", None),
        ("check", "note.toml", None),
        ("check", "else.toml", None),
    ] {
        let args = [command.to_owned(), at(wrong)];
        let said = text(&stillbase(&[command, &args[1]]).stderr).to_owned();
        let ways = ways_out(&args);
        let want: Vec<Vec<String>> = right.into_iter().map(|right| vec![command.to_owned(), at(right)]).collect();
        assert_eq!(ways, want, "{said}");
        assert_eq!(said.contains("the nearest file is"), right.is_some(), "{said}");
        assert_eq!(works(&args), want.len());
    }
    // A machine that a file names is no word of the command line, so the message alone helps.
    let scenario = include_str!("../../assets/scenarios/case-3.toml").replace("nine-link\"", "nine-linc\"");
    let file = folder.file("odd.toml", scenario).to_str().expect("a name").to_owned();
    assert!(ways_out(&["simulate".to_owned(), file.clone()]).is_empty());
    fails(&["simulate", &file], 2, &["nine-linc: no such machine: want nine-link (nearest), nine-link-table-1"]);
}
