//! Meshes of bars, discs and rings, built once per machine.
