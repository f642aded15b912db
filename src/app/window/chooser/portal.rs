//! Whether the system has dialogs for files.

/// On Linux the desktop may have some, or Zenity shows them.
#[cfg(target_os = "linux")]
pub fn is_there() -> bool {
    pollster::block_on(answers()).is_ok() || zenity()
}

/// Elsewhere they belong to the system.
#[cfg(not(target_os = "linux"))]
pub fn is_there() -> bool {
    true
}

/// A portal that has dialogs for files says which version of them.
#[cfg(target_os = "linux")]
async fn answers() -> zbus::Result<()> {
    // It may have to be started first.
    const PATIENCE: std::time::Duration = std::time::Duration::from_secs(5);
    let bus = zbus::connection::Builder::session()?.method_timeout(PATIENCE).build().await?;
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
