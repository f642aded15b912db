//! Tests of `src/files`: tables of numbers that others wrote. What the program writes is tried in `program`.

mod table;
