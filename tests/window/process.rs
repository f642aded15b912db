//! Processes that end with the test, however it ends.

use std::io::{BufRead as _, BufReader};
use std::os::unix::process::CommandExt as _;
use std::process::{Child, Command};
use std::sync::mpsc::channel;
use std::time::Duration;

use rustix::process::{Pid, Signal, kill_process_group, set_parent_process_death_signal};

/// A process with all that it starts, which goes when this goes.
pub struct Owned(pub Child);

impl Owned {
    pub fn start(command: &mut Command) -> Self {
        let program = command.get_program().to_owned();
        let leave_with_test = || Ok(set_parent_process_death_signal(Some(Signal::TERM))?);
        // SAFETY: between fork and exec it only asks the kernel to end this process with the one that starts it.
        unsafe { command.process_group(0).pre_exec(leave_with_test) };
        Self(command.spawn().unwrap_or_else(|why| panic!("{}: {why}", program.display())))
    }

    fn signal(&self, signal: Signal) {
        if let Some(group) = i32::try_from(self.0.id()).ok().and_then(Pid::from_raw) {
            // Nobody may be left.
            let _ = kill_process_group(group, signal);
        }
    }

    /// As a power cut would end it.
    pub fn kill(&mut self) {
        self.signal(Signal::KILL);
        let _ = self.0.wait();
    }
}

impl Drop for Owned {
    fn drop(&mut self) {
        // Some have children in groups of their own, and end these themselves.
        self.signal(Signal::TERM);
        for _ in 0..40 {
            if !matches!(self.0.try_wait(), Ok(None)) {
                break;
            }
            std::thread::sleep(Duration::from_millis(25));
        }
        self.kill();
    }
}

/// The first line that a process writes.
pub fn first_line(of: &mut Owned, what: &str) -> String {
    let output = of.0.stdout.take().expect("piped");
    let (send, receive) = channel();
    std::thread::spawn(move || {
        let mut line = String::new();
        let mut output = BufReader::new(output);
        let _ = output.read_line(&mut line);
        let _ = send.send(line);
        // Whoever writes on must not be told that nobody reads.
        let _ = std::io::copy(&mut output, &mut std::io::sink());
    });
    let line = receive.recv_timeout(Duration::from_secs(20)).unwrap_or_default();
    let line = line.trim();
    assert!(!line.is_empty(), "{what} did not come");
    line.to_owned()
}
