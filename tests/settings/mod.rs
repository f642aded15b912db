//! How values are typed.

mod quantity;
