//! Equations on the command line.

use super::*;

fn equation<'a>(answer: &'a Value, number: &str) -> &'a Value {
    let all = answer["equations"].as_array().expect("a list");
    all.iter().find(|one| one["number"] == number).unwrap_or_else(|| panic!("no ({number})"))
}

#[test]
fn a_line_of_symbols_has_its_numbers_below() {
    let text = prints(&["learn", "nine-link-table-1", "--equation", "7", "--equation", "(8)"]);
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    let at = lines.iter().position(|line| line.contains("m₁ l_c1")).expect("g₁");
    let [symbols, numbers] = [lines[at], lines[at + 1]].map(|line| line.chars().collect::<Vec<_>>());
    // Signs stand below each other.
    let places = |line: &[char], sign: char| (0..line.len()).filter(|i| line[*i] == sign).collect::<Vec<_>>();
    assert_eq!(places(&symbols, '='), places(&numbers, '='));
    assert!(lines[at + 1].contains("− 1.549800 + 0.302400 − 0.052350 + 1.300000"), "{}", lines[at + 1]);
    assert!(lines[at + 1].ends_with("= 0.000250 kg m") || lines[at + 1].contains("=   0.000250 kg m"), "{text}");
    assert!(text.contains("does not hold: off by 0.000250 kg m in g₁"), "{text}");
    assert!(text.contains("(8)") && !text.contains("(9)"), "{text}");
}

#[test]
fn a_run_has_every_equation_at_an_instant() {
    let answer = object(&["learn", "case-1", "--at", "0.3"]);
    assert_eq!(answer["time"], 0.3);
    assert_eq!(answer["equations"].as_array().map(Vec::len), Some(19));
    // What the base feels then, by another command.
    let run = object(&["simulate", "case-1", "--every", "300"]);
    assert_eq!(run["time"][1], 0.3);
    let five = &equation(&answer, "5")["lines"][0];
    near(&five["left"], &five["right"], 1e-12, "(5)");
    near(&five["left"], &run["signals"]["moment/total"][1], 1e-9, "n_B");
    assert!(five["left"].as_f64().expect("a number").abs() > 0.5);
    assert_eq!(equation(&answer, "12")["holds"], false);
    let term = &equation(&answer, "7")["lines"][0]["left_terms"][3];
    assert_eq!(term["symbol"], "(m₅ + m₇ + m₈ + m₉) l₁");
    assert_eq!(term["parts"][0], json!({"from": "link 5", "value": 0.35}));
    let bare = object(&["learn", "nine-link-bare", "--equation", "13"]);
    assert!(equation(&bare, "13")["why_not"].as_str().expect("why").contains("kg m²"));
}

#[test]
fn a_pose_is_given() {
    let given = ["learn", "serial-3r", "--pose", "-0.5,0.1,1", "--rates", "1,0,-2", "--accelerations", "0,3,0"];
    let answer = object(&given);
    near(&answer["q"], &json!([-0.5, 0.1, 1.0]), 1e-15, "q");
    for one in answer["equations"].as_array().expect("a list") {
        let is_law = !["10", "12"].contains(&one["number"].as_str().expect("a number"));
        assert!(!is_law || one["holds"] == true, "{one}");
    }
    assert!(prints(&["learn", "two-drive"]).contains("(12) Motion without a moment"));
}

#[test]
fn what_is_no_equation_or_instant_is_refused() {
    fails(&["learn", "--equation", "17"], 2, &["--equation", "1 to 16 or A1 to A3"]);
    fails(&["learn", "--at", "7"], 2, &["--at 7", "1.000 s"]);
    fails(&["learn", "nine-link", "--at", "0.1"], 2, &["--at", "scenario"]);
    fails(&["learn", "--pose", "1,2"], 2, &["--pose", "3 drives"]);
    fails(&["learn", "--pose", "1,2,1e300"], 2, &["--pose", "1000000"]);
    fails(&["learn", "--rates", "1,2,3"], 2, &["--pose"]);
    fails(&["learn", "nothing"], 2, &["nothing", "case-3"]);
}
