//! Who is near whom: the grid of cells that the sweeps walk, and stand-alone neighbour searches.

pub mod brute;
mod cell_set;
mod grid;
pub mod search;
mod sort;

pub use cell_set::{CellSet, Reached};
pub use grid::{Cells, Grid, Run, Runs};
pub use sort::Sorter;
