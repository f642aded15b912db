//! Detection of the system's file dialogs.

/// Whether there are file dialogs: on Linux those of a desktop portal or of Zenity.
#[cfg(target_os = "linux")]
pub fn is_there() -> bool {
    pollster::block_on(ask_portal()).is_ok() || zenity()
}

/// Elsewhere the system always has file dialogs.
#[cfg(not(target_os = "linux"))]
pub fn is_there() -> bool {
    true
}

/// Asks the portal for the version of its file dialogs; fails if it has none.
#[cfg(target_os = "linux")]
async fn ask_portal() -> zbus::Result<()> {
    // The portal may have to be started first.
    const REPLY_TIMEOUT: std::time::Duration = std::time::Duration::from_secs(5);
    let bus = zbus::connection::Builder::session()?.method_timeout(REPLY_TIMEOUT).build().await?;
    let (portal, at) = (Some("org.freedesktop.portal.Desktop"), "/org/freedesktop/portal/desktop");
    let version = ("org.freedesktop.portal.FileChooser", "version");
    bus.call_method(portal, at, Some("org.freedesktop.DBus.Properties"), "Get", &version).await?;
    Ok(())
}

#[cfg(target_os = "linux")]
fn zenity() -> bool {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&folders).any(|folder| folder.join("zenity").is_file())
}
