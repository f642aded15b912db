fn main() {
    let name = std::env::args().nth(1).unwrap_or("case-3".into());
    let theme = if std::env::args().nth(2).as_deref() == Some("light") { stillbase::scene::palette::Theme::Light } else { Default::default() };
    if let Err(e) = stillbase::window::run(stillbase::scenario::Scenario::find(&name).unwrap(), theme) { eprintln!("{e}"); }
}
