//! Names of the fields of a drawing, for screen readers and for commands that lead to them.

/// Length of the bar that is drawn by numbers.
pub const BAR_LENGTH: &str = "length of the new bar";
/// Its angle.
pub const BAR_ANGLE: &str = "angle of the new bar";
/// The pin where it begins.
pub const BAR_FROM: &str = "new bar from";
/// The pin on which a motor is hung.
pub const MOTOR_PIN: &str = "pin of the new motor";
/// The pin of the end effector.
pub const END_PIN: &str = "pin of the end effector";
/// The bar or pin whose card is shown.
pub const CARD: &str = "bar or pin in the card";
