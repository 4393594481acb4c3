//! The counting sort: complete, stable, and the same for any number of threads.

use kolk::neighbours::{Cells, Sorter};
use proptest::prelude::*;

/// The order and the cells for particles with these bins, on `threads` threads.
fn sort(bins: &[u32], cells: usize, parts: usize, threads: usize) -> (Vec<u32>, Cells) {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    let mut table = Cells::new(cells, parts);
    let mut sorter = Sorter::new(bins.len());
    pool.install(|| {
        // Twice: what an earlier sort left behind must not show.
        sorter.sort(&mut table, |_| 0);
        sorter.sort(&mut table, |i| bins[i]);
    });
    (sorter.order, table)
}

/// Compares with a stable sort by the standard library, with 1 and 4 threads.
fn check(bins: &[u32], cells: usize, parts: usize) {
    let mut wanted: Vec<u32> = (0..bins.len() as u32).collect();
    wanted.sort_by_key(|&i| bins[i as usize]);
    for threads in [1, 4] {
        let (order, table) = sort(bins, cells, parts, threads);
        assert_eq!(order, wanted, "{threads} threads");
        assert_eq!(table.count(), cells);
        for cell in 0..cells {
            let first = bins
                .iter()
                .filter(|&&b| (b as usize) < cell * parts)
                .count();
            let end = bins
                .iter()
                .filter(|&&b| (b as usize) < (cell + 1) * parts)
                .count();
            assert_eq!(
                table.particles(cell, cell + 1),
                first..end,
                "cell {cell}, {threads} threads"
            );
            if cells > 40 {
                break;
            }
        }
        assert_eq!(table.particles(0, cells), 0..bins.len());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..Default::default() })]

    #[test]
    fn few_cells(parts in prop::sample::select(vec![1usize, 4, 8]), x in prop::collection::vec(0.0..1.0_f64, 0..400)) {
        let bins: Vec<u32> = x.iter().map(|x| (x * (12 * parts) as f64) as u32).collect();
        check(&bins, 12, parts);
    }

    #[test]
    fn many_cells(x in prop::collection::vec(0.0..1.0_f64, 0..3000), crowd in any::<bool>()) {
        // A crowd: nearly all in a few bins, the rest anywhere.
        let bins: Vec<u32> = x.iter().map(|x| ((if crowd { x.powi(20) } else { *x }) * 8.0 * 1500.0) as u32).collect();
        check(&bins, 1500, 8);
    }
}

#[test]
fn all_in_one_bin_and_one_in_each() {
    for n in [0, 1, 31, 32, 33, 511, 513, 5000] {
        check(&vec![0; n], 1, 1);
        check(&vec![7; n], 1, 8);
        check(&(0..n as u32).rev().collect::<Vec<_>>(), n.max(1), 1);
    }
}

#[test]
fn a_large_set_is_sorted() {
    let bins: Vec<u32> = (0..300_000u32)
        .map(|k| k.wrapping_mul(2_654_435_761) % 80_000)
        .collect();
    check(&bins, 10_000, 8);
}

#[test]
fn the_first_cell_at_or_after_a_particle() {
    let bins = [0, 0, 4, 5, 9, 9, 9, 15];
    let (_, table) = sort(&bins, 4, 4, 1);
    // Cells start at particles 0, 2, 4 and 7.
    for (index, cell) in [
        (0, 0),
        (1, 1),
        (2, 1),
        (3, 2),
        (4, 2),
        (5, 3),
        (7, 3),
        (8, 4),
    ] {
        assert_eq!(table.cell_from(index), cell, "from particle {index}");
    }
}
