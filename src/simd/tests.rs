//! Every level must do every operation like plain numbers do.

use super::*;

struct Operations<R>(Vec<R>);

impl<R: Real> Task<R> for Operations<R> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes<Real = R>>(self) {
        let input = &self.0;
        let eps = R::from_f64(if size_of::<R>() == 4 { 2e-7 } else { 4e-16 });
        let mut out = vec![R::default(); L::N];
        for k in 0..input.len() / L::N {
            let x = &input[k * L::N..];
            // SAFETY: `x` and `out` hold at least N numbers.
            unsafe {
                let v = L::load(x.as_ptr());
                let close = |got: L, want: &dyn Fn(R) -> R, out: &mut [R]| {
                    got.store(out.as_mut_ptr());
                    for l in 0..L::N {
                        let w = want(x[l]);
                        let bound = eps * if w < R::default() { -w } else { w };
                        let d = out[l] - w;
                        assert!(
                            d <= bound && -d <= bound,
                            "{:?}: {:?} instead of {w:?}",
                            x[l],
                            out[l]
                        );
                    }
                };
                let one = R::from_f64(1.0);
                close(v.sqrt(), &|a| <R as Lanes>::sqrt(a), &mut out);
                close(v.recip(), &|a| one / a, &mut out);
                close(v.mul_add(v, v), &|a| a * a + a, &mut out);
                close(-v, &|a| -a, &mut out);
                let half = L::constant(0.5);
                let mask = v.less(half);
                close(
                    v.only(mask),
                    &|a| {
                        if a < R::from_f64(0.5) {
                            a
                        } else {
                            R::default()
                        }
                    },
                    &mut out,
                );
                close(
                    v.select(mask, half),
                    &|a| {
                        if a < R::from_f64(0.5) {
                            a
                        } else {
                            R::from_f64(0.5)
                        }
                    },
                    &mut out,
                );
                v.compress_store(L::bits(mask), out.as_mut_ptr());
                let chosen: Vec<R> = x[..L::N]
                    .iter()
                    .copied()
                    .filter(|&a| a < R::from_f64(0.5))
                    .collect();
                assert_eq!(L::bits(mask).count_ones() as usize, chosen.len());
                assert_eq!(&out[..chosen.len()], &chosen[..]);
                let mut spread = vec![one; L::N];
                L::expand_load(L::bits(mask), out.as_ptr()).store(spread.as_mut_ptr());
                for l in 0..L::N {
                    let kept = if x[l] < R::from_f64(0.5) {
                        x[l]
                    } else {
                        R::default()
                    };
                    assert_eq!(spread[l], kept);
                }
                for n in 0..L::N {
                    let mut sums = vec![one; L::N];
                    v.add_first(n, sums.as_mut_ptr());
                    for l in 0..L::N {
                        assert_eq!(sums[l], if l < n { one + x[l] } else { one });
                    }
                }
                let total: R = x[..L::N].iter().copied().sum();
                let d = (v.sum() - total).to_f64().abs();
                assert!(d <= 16.0 * eps.to_f64() * total.to_f64());
            }
        }
        // SAFETY: `out` holds N numbers.
        unsafe { L::zero().sqrt().store(out.as_mut_ptr()) };
        assert!(out.iter().all(|&z| z == R::default()));
        let doubles: Vec<f64> = (0..L::N).map(|k| 1e6 + 1e-3 * k as f64).collect();
        // SAFETY: `doubles` and `out` hold N numbers.
        unsafe { L::load_relative(doubles.as_ptr(), 1e6).store(out.as_mut_ptr()) };
        for (o, x) in out.iter().zip(&doubles) {
            assert_eq!(*o, R::from_f64(x - 1e6));
        }
    }
}

#[test]
fn every_level_computes_like_plain_numbers() {
    let x: Vec<f64> = (0..640)
        .map(|k| 1e-6 + ((k * 7919 % 641) as f64 / 641.0).powi(2))
        .collect();
    let levels = available_levels();
    for l in &levels {
        force_level(*l);
        assert_eq!(level(), *l);
        dispatch::<f64, _>(Operations(x.clone()));
        dispatch::<f32, _>(Operations(x.iter().map(|&a| a as f32).collect()));
    }
    force_level(levels[levels.len() - 1]);
}
