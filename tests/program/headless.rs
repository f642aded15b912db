//! `headless`, and what the window does without a display.

use super::*;

#[cfg(feature = "record")]
#[test]
fn headless_reports_the_three_cases() {
    let folder = Folder::new("cli");
    let file = word(folder.path("cases.rrd"));
    let got = object(&["headless", "-o", &file])["recordings"].clone();
    let rows = got.as_array().expect("list");
    let names: Vec<&str> = rows.iter().filter_map(|r| r["scenario"].as_str()).collect();
    assert_eq!(names, ["case-1", "case-2", "case-3"]);
    for row in rows {
        assert_eq!(
            keys(row),
            [
                "file",
                "peak_base_force",
                "peak_base_moment",
                "peak_torque",
                "reactionless",
                "scenario",
                "statements",
                "steps",
                "verdict"
            ]
        );
        assert_eq!((&row["file"], &row["steps"]), (&json!(file), &json!(1000)));
        assert_eq!(row["reactionless"], json!(row["scenario"] == "case-3"));
    }
    let known = planning()["motion"]["nine-link"].clone();
    near(&rows[0]["peak_base_moment"], &known["case_1_peak_base_moment"], 1e-5, "case 1");
    near(&rows[1]["peak_base_moment"], &json!(0.4853), 1e-4, "case 2");
    near(&rows[2]["peak_torque"], &known["case_3_peak_torque"], 1e-5, "case 3");
    near(&rows[2]["peak_base_moment"], &json!(0.0), 1e-9, "case 3");
}

#[cfg(feature = "record")]
#[test]
fn headless_refuses_wrong_input_before_it_runs() {
    let folder = Folder::new("cli");
    let taken = word(folder.file("taken.rrd", "mine"));
    let free = word(folder.path("free.rrd"));
    fails(&["headless", "-o", &taken], 2, &["taken.rrd", "exists", "--force"]);
    assert_eq!(fs::read_to_string(&taken).expect("file"), "mine");
    fails(&["headless", "/nonexistent.toml", "-o", &free], 2, &["/nonexistent.toml"]);
    fails(&["headless", "case-1", "case-1", "-o", &free], 2, &["case-1", "different names"]);
    fails(&["headless", "-o", &free, "--fps", "0"], 2, &["--fps", "above 0"]);
    fails(&["headless", "-o", &free, "--fps", "30", "--size", "0x800"], 2, &["--size", "16 to 8192"]);
    fails(&["headless", "-o", &word(folder.path("none/x.rrd"))], 2, &["no folder"]);
    fails(&["headless", "case-3", "-o", &free, "--set", "limits.a1=0,0.1"], 1, &["case-3", "A (0.500, 0.500) m"]);
    fails(&["headless"], 2, &["--output <FILE.rrd>"]);
    assert_eq!(folder.names(), ["taken.rrd"]);
    // A viewer instead of a file: one or the other, at an address, and there.
    fails(&["headless", "case-3", "-o", &free, "--spawn"], 2, &["--output", "--spawn"]);
    fails(&["headless", "--connect", "case-3"], 2, &["case-3", "rerun+http://127.0.0.1:9876/proxy"]);
    let silent = std::net::TcpListener::bind("127.0.0.1:0").and_then(|free| free.local_addr()).expect("a port");
    let silent = format!("rerun+http://{silent}/proxy");
    fails(&["headless", "case-3", "--connect", &silent], 2, &[&silent, "no viewer answers within 5 s", "--spawn"]);
    assert_eq!(folder.names(), ["taken.rrd"]);
}

#[cfg(all(feature = "record", unix))]
#[test]
fn without_a_viewer_to_start_it_says_what_to_install() {
    let run = Command::new(env!("CARGO_BIN_EXE_stillbase"))
        .args(["headless", "case-3", "--spawn"])
        .env("PATH", "/nonexistent")
        .output()
        .expect("it runs");
    assert_eq!(run.status.code(), Some(2));
    let said = String::from_utf8(run.stderr).expect("UTF-8");
    assert!(said.contains("pip install rerun-sdk==0.36.3") && said.contains("-o FILE.rrd"), "{said}");
}

#[test]
fn a_scenario_file_is_named_with_its_line() {
    let folder = Folder::new("cli");
    let case = include_str!("../../assets/scenarios/case-3.toml");
    let refused = |text: &str, words: &[&str]| fails(&["simulate", &word(folder.file("my.toml", text))], 2, words);
    refused(
        &case.replace("time = 1.0", "tiem = 1.0"),
        &["my.toml:13:", "task has no key \"tiem\": want time (nearest)"],
    );
    refused(&case.replace("time = 1.0", "time = -1.0"), &["my.toml", "task.time) is -1"]);
    refused(&case.replace("nine-link", "ten-link"), &["ten-link", "no such machine"]);
    fails(&["simulate", "case-9"], 2, &["case-9", "case-1 (nearest), case-2 (nearest), case-3 (nearest), circle"]);
    fails(&["chek"], 2, &["chek", "--help"]);
}

/// Without a display the window gives way to a recording, which replaces nothing.
#[cfg(all(target_os = "linux", feature = "record", feature = "window"))]
#[test]
fn without_a_display_it_records_and_names_the_file() {
    let folder = Folder::new("cli");
    let taken = word(folder.file("case-3.rrd", "mine"));
    let out = Command::new(env!("CARGO_BIN_EXE_stillbase"))
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .current_dir(&folder.0)
        .stdin(Stdio::null())
        .output()
        .expect("starts");
    let said = text(&out.stderr);
    assert_eq!(out.status.code(), Some(0), "{said}");
    assert!(said.contains("case-3-1.rrd") && said.contains("display"), "{said}");
    assert_eq!(fs::read_to_string(&taken).expect("file"), "mine");
}

/// With a display but nothing that draws on it, the same, and what is missing is said. Wants Xvfb.
#[cfg(all(target_os = "linux", feature = "record", feature = "window"))]
#[test]
fn without_a_graphics_driver_it_records_and_says_what_is_missing() {
    let Ok(mut display) = Command::new("Xvfb")
        .args(["-displayfd", "1", "-screen", "0", "800x600x24"])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
    else {
        println!("skipped: no Xvfb");
        return;
    };
    let mut number = String::new();
    let out = display.stdout.take().expect("piped");
    std::io::BufRead::read_line(&mut std::io::BufReader::new(out), &mut number).expect("its number");
    let folder = Folder::new("cli");
    let out = Command::new(env!("CARGO_BIN_EXE_stillbase"))
        .env("DISPLAY", format!(":{}", number.trim()))
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .env("VK_DRIVER_FILES", "/nonexistent")
        .current_dir(&folder.0)
        .stdin(Stdio::null())
        .output();
    let _ = display.kill();
    let _ = display.wait();
    let out = out.expect("starts");
    let said = text(&out.stderr);
    assert_eq!(out.status.code(), Some(0), "{said}");
    assert!(said.contains("case-3.rrd"), "{said}");
    assert!(said.contains("graphics driver") || said.contains("libvulkan") || said.contains("window needs"), "{said}");
    assert!(folder.0.join("case-3.rrd").exists());
}

/// Where no folder for sockets is set, drawing says nothing in the words of others.
#[cfg(all(feature = "record", target_os = "linux"))]
#[test]
fn drawing_without_a_runtime_folder_speaks_for_itself() {
    let folder = Folder::new("cli");
    let mut command = folder.command(&["headless", "case-3", "--fps", "2", "-o", "x.rrd", "--set", "duration=0.1"]);
    let out = command.env_remove("XDG_RUNTIME_DIR").env_remove("DISPLAY").output().expect("the program starts");
    let said = text(&out.stderr);
    assert_eq!(out.status.code(), Some(0), "{said}");
    assert!(said.lines().count() > 0 && said.lines().all(|line| line.starts_with("stillbase: ")), "{said}");
}
