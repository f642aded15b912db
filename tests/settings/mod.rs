//! How values are typed, and what choices and parts are written as.

mod quantity;
mod words;
