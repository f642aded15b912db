//! Removes half-written files before a signal ends the program, if the signal can be caught.

/// Starts a thread that waits for signals that end the program.
#[cfg(unix)]
pub fn watch() {
    use signal_hook::consts::{SIGALRM, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU, SIGXFSZ};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;

    let ignored = ignored();
    let ends = [SIGINT, SIGHUP, SIGTERM, SIGQUIT, SIGXCPU, SIGALRM, SIGUSR1, SIGUSR2];
    let heard = ends.into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
    // With this signal handled, writing beyond the size limit returns an error, which is reported with the file name.
    let _ = signal_hook::flag::register(SIGXFSZ, std::sync::Arc::default());
    // Without the handler, half-written files stay until the next run that writes to their folder.
    let Ok(mut signals) = Signals::new(heard) else { return };
    let wait = move || {
        if let Some(signal) = signals.forever().next() {
            let _held = stillbase_files::abandon();
            let _ = emulate_default_handler(signal);
        }
    };
    let _ = std::thread::Builder::new().name("signals".into()).spawn(wait);
}

/// Signals that the program was started to ignore, as with `nohup`: bit 0 is signal 1.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = stillbase_files::text::read(std::path::Path::new("/proc/self/status")).unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Does nothing, because other systems have no signals: half-written files stay until the next run that writes to their
/// folder.
#[cfg(not(unix))]
pub fn watch() {}
