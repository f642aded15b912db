//! What keys are called, how values are typed, and what choices and parts are written as.

mod keys;
mod quantity;
mod text;
mod words;
