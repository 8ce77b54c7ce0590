//! Numbers side by side, and how a task gets the best form of them.

use super::SimdLevel;
use super::doubles::EightDoubles;
use super::portable::PortableSimd;
use super::view::rows_of;
use crate::Hit;

/// `N` f32 numbers worked on together.
///
/// Implementations differ in speed and in whether [`Self::mul_add`] rounds once or twice; code over lanes may only take decisions that
/// are right for both. A NaN operand of `min` and `max` gives either operand. Where lanes are told by bits, bit `i` stands for lane `i`.
pub trait Lanes<const N: usize>: Copy {
    /// All lanes `x`.
    fn splat(x: f32) -> Self;
    /// Lane `i` is `x[i]`.
    fn load(x: &[f32; N]) -> Self;
    /// Writes lane `i` to `to[i]`.
    fn store(self, to: &mut [f32; N]);
    /// `self` where the bit is set, `other` elsewhere.
    fn select(self, bits: u32, other: Self) -> Self;
    /// Where `self` and `other` have equal bits.
    fn same_bits(self, other: Self) -> u32;
    /// The least lane; none is NaN.
    fn least(self) -> f32;
    /// The greatest lane; none is NaN.
    fn greatest(self) -> f32;
    /// The least lane of each row; none is NaN. Together, as the steps from lane to lane wait for one another.
    #[inline(always)]
    fn least_of_each(rows: [Self; 4]) -> [f32; 4] {
        [rows[0].least(), rows[1].least(), rows[2].least(), rows[3].least()]
    }
    /// Lane by lane `self + other`.
    fn plus(self, other: Self) -> Self;
    /// Lane by lane `self - other`.
    fn minus(self, other: Self) -> Self;
    /// Lane by lane `self * other`.
    fn times(self, other: Self) -> Self;
    /// Lane by lane `self / other`.
    fn over(self, other: Self) -> Self;
    /// Lane by lane `self * factor + term`, with one or two roundings.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// Lane by lane `self * factor - term`, with one or two roundings.
    fn mul_sub(self, factor: Self, term: Self) -> Self;
    /// Lane by lane without its sign.
    fn abs(self) -> Self;
    /// The lesser of each lane.
    fn min(self, other: Self) -> Self;
    /// The greater of each lane.
    fn max(self, other: Self) -> Self;
    /// Where `self` is at most `other`; clear for NaN.
    fn at_most(self, other: Self) -> u32;
    /// Where `self` is below `other`; clear for NaN.
    fn below(self, other: Self) -> u32;
    /// Where `ids` are `id`.
    fn same(ids: &[u32; N], id: u32) -> u32;
    /// Sets `ids` to `id` where the bit is set.
    fn set_some(id: u32, bits: u32, ids: &mut [u32; N]);

    /// The lanes whose bit is set, in their order, each with a number in the lower half; what follows them means nothing.
    #[inline(always)]
    fn front(self, numbers: &[u32; N], bits: u32, front: &mut [i64; N]) {
        let (lanes, mut count) = (self.array(), 0);
        for (lane, (x, number)) in lanes.iter().zip(numbers).enumerate() {
            front[count % N] = i64::from(x.to_bits()) << 32 | i64::from(*number);
            count += (bits >> lane & 1) as usize;
        }
    }

    /// The coordinates of points: lane `i` of result `k` is `points[i][k]`.
    #[inline(always)]
    fn unzip3(points: &[[f32; 3]; N]) -> [Self; 3] {
        load3(&columns(points))
    }

    /// Lane `i` of result `k` is `rows[i][k]`.
    #[inline(always)]
    fn unzip8(rows: &[[f32; 8]; N]) -> [Self; 8] {
        let [a, b, c, d, e, f, g, h] = &columns(rows);
        [Self::load(a), Self::load(b), Self::load(c), Self::load(d), Self::load(e), Self::load(f), Self::load(g), Self::load(h)]
    }

    /// The lanes as an array.
    #[inline(always)]
    fn array(self) -> [f32; N] {
        let mut out = [0.0; N];
        self.store(&mut out);
        out
    }
}

/// Rows of numbers as columns.
#[inline(always)]
pub(super) fn columns<T: Copy + Default, const N: usize, const M: usize>(rows: &[[T; M]; N]) -> [[T; N]; M] {
    let mut columns = [[T::default(); N]; M];
    for (i, row) in rows.iter().enumerate() {
        for (column, x) in columns.iter_mut().zip(row) {
            column[i] = *x;
        }
    }
    columns
}

/// Three rows of numbers, such as the coordinates of points.
///
/// Written out, like all that works on lanes: what a closure does is not compiled for the level of its caller.
#[inline(always)]
pub fn load3<const N: usize, L: Lanes<N>>(rows: &[[f32; N]; 3]) -> [L; 3] {
    [L::load(&rows[0]), L::load(&rows[1]), L::load(&rows[2])]
}

/// Three numbers, each in all lanes.
#[inline(always)]
pub fn splat3<const N: usize, L: Lanes<N>>(x: [f32; 3]) -> [L; 3] {
    [L::splat(x[0]), L::splat(x[1]), L::splat(x[2])]
}

/// Three times the lanes as arrays.
#[inline(always)]
pub fn arrays3<const N: usize, L: Lanes<N>>(x: [L; 3]) -> [[f32; N]; 3] {
    [x[0].array(), x[1].array(), x[2].array()]
}

/// A set of vector instructions: the lanes that it has.
pub trait Simd {
    /// Whether answers are proved; only `kernel::InPlainF32` says no, to be measured against.
    const CERTIFIED: bool = true;

    /// Eight f64.
    type Doubles: EightDoubles;
    /// Eight numbers.
    type Eight: Lanes<8>;
    /// Sixteen numbers.
    type Sixteen: Lanes<16>;

    /// Runs a task as a function of its own, for the same instructions: what is compiled into its caller shares the caller's registers.
    fn apart<T: Task>(task: T) -> T::Output;

    /// Sixteen numbers from the lower and the upper eight.
    fn join(low: Self::Eight, high: Self::Eight) -> Self::Sixteen;

    /// The lanes widened.
    fn widen(x: Self::Eight) -> Self::Doubles;

    /// The coordinates of the corners of eight triangles: lane `i` of number `3 c + k` is coordinate `k` of corner `c` of `corners[i]`.
    #[inline(always)]
    fn corners(corners: &[&[f32; 9]; 8]) -> [Self::Eight; 9] {
        let mut rows = [[0.0; 8]; 9];
        for (i, nine) in corners.iter().enumerate() {
            for (row, x) in rows.iter_mut().zip(nine.iter()) {
                row[i] = *x;
            }
        }
        [
            Self::Eight::load(&rows[0]),
            Self::Eight::load(&rows[1]),
            Self::Eight::load(&rows[2]),
            Self::Eight::load(&rows[3]),
            Self::Eight::load(&rows[4]),
            Self::Eight::load(&rows[5]),
            Self::Eight::load(&rows[6]),
            Self::Eight::load(&rows[7]),
            Self::Eight::load(&rows[8]),
        ]
    }

    /// The lanes rounded to f32.
    fn narrow(x: Self::Doubles) -> Self::Eight;

    /// Writes hits from rows of their t, triangles (as numbers of equal bits), u and v.
    #[inline(always)]
    fn write_hits(rows: [Self::Eight; 4], hits: &mut [Hit; 8]) {
        let rows = [rows[0].array(), rows[1].array(), rows[2].array(), rows[3].array()];
        for (i, to) in rows_of(hits).iter_mut().enumerate() {
            *to = [rows[0][i], rows[1][i], rows[2][i], rows[3][i]];
        }
    }

    /// Asks for the cache lines of `what` ahead of its use.
    fn prefetch<T>(what: &T);
}

/// Work written once over [`Simd`]; its `run` and all below it must be `#[inline(always)]` to be compiled for each level.
pub trait Task {
    /// What the work gives.
    type Output;
    /// The work.
    fn run<S: Simd>(self) -> Self::Output;
}

/// Runs `task` with the instructions of `level`, or of the best level where this machine lacks it.
pub fn dispatch<T: Task>(level: SimdLevel, task: T) -> T::Output {
    match level.or_best() {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `or_best` returns no level above `best`, and `available` lists this one only where its features were detected.
        SimdLevel::Avx512 => unsafe { super::x86::run_avx512(task) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        SimdLevel::Avx2 => unsafe { super::x86::run_avx2(task) },
        _ => task.run::<PortableSimd>(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::Doubles;
    use super::*;

    struct All;

    /// What each operation gives on `a`, `b` and twos, and the bits of each question.
    #[inline(always)]
    fn everything<const N: usize, L: Lanes<N>>(a: [f32; N], b: [f32; N]) -> (Vec<f32>, Vec<u32>) {
        let (a, b, c) = (L::load(&a), L::load(&b), L::splat(2.0));
        let some = a.select(0b1010_0110_0011_0101, L::splat(5.0)).array().into_iter().chain([a.least(), a.greatest()]);
        let some = some.chain(L::least_of_each([a, b, a.plus(c), L::splat(0.0).minus(a)]));
        let mut ids = std::array::from_fn(|i| i as u32 % 3);
        let two = L::same(&ids, 2);
        L::set_some(u32::MAX, 0b1001_0110_0011_0101, &mut ids);
        let numbers =
            [a.plus(b), a.minus(b), a.times(b), a.over(c), a.mul_add(b, c), a.mul_sub(b, c), a.min(b), a.max(b), a.abs()]
                .into_iter()
                .flat_map(L::array)
                .chain(some)
                .collect();
        (numbers, [a.at_most(b), a.below(b), two].into_iter().chain(ids).collect())
    }

    impl Task for All {
        type Output = [(Vec<f32>, Vec<u32>); 2];

        #[inline(always)]
        fn run<S: Simd>(self) -> Self::Output {
            let a = [1.0, -2.0, 3.5, 0.0, -0.5, 8.0, 1e30, 7.0];
            let b = [2.0, -2.0, 0.25, 4.0, 16.0, -1.0, 1.0, 7.5];
            let twice = |x: [f32; 8]| std::array::from_fn(|i| if i < 8 { x[i] } else { -x[i - 8] });
            [everything::<8, S::Eight>(a, b), everything::<16, S::Sixteen>(twice(a), twice(b))]
        }
    }

    struct Unzip;

    impl Task for Unzip {
        type Output = [Vec<f64>; 25];

        #[inline(always)]
        fn run<S: Simd>(self) -> Self::Output {
            let points: [[f32; 3]; 16] = std::array::from_fn(|i| [0, 100, 200].map(|k| (k + i) as f32));
            let doubles: [[f64; 3]; 8] = std::array::from_fn(|i| [0, 100, 200].map(|k| (k + i) as f64));
            let rows: [[f32; 8]; 16] = std::array::from_fn(|i| std::array::from_fn(|k| (100 * k + i) as f32));
            let (eight, sixteen) = (<S::Eight>::unzip3(points.first_chunk().unwrap()), <S::Sixteen>::unzip3(&points));
            let (eight8, sixteen8) = (<S::Eight>::unzip8(rows.first_chunk().unwrap()), <S::Sixteen>::unzip8(&rows));
            let doubles = <S::Doubles>::unzip3(&doubles);
            let f64s = |row: &[f32]| row.iter().map(|&x| x.into()).collect::<Vec<f64>>();
            std::array::from_fn(|k| match k {
                0..3 => f64s(&eight[k].array()),
                3..6 => f64s(&sixteen[k - 3].array()),
                6..9 => doubles[k - 6].array().to_vec(),
                9..17 => f64s(&eight8[k - 9].array()),
                _ => f64s(&sixteen8[k - 17].array()),
            })
        }
    }

    /// For each set of eight lanes, what is brought to the front.
    struct Fronts;

    impl Task for Fronts {
        type Output = Vec<Vec<i64>>;

        #[inline(always)]
        fn run<S: Simd>(self) -> Self::Output {
            let lanes = <S::Eight>::load(&[0.0, -1.0, 2.0, -0.0, f32::INFINITY, 5.0, f32::NEG_INFINITY, 7.0]);
            let mut sets = Vec::new();
            for bits in 0..256u32 {
                let mut front = [0; 8];
                lanes.front(&[1, 2, 3, 4, 5, u32::MAX, 7, 8], bits, &mut front);
                sets.push(front[..bits.count_ones() as usize].to_vec());
            }
            sets
        }
    }

    #[test]
    fn every_level_brings_lanes_to_the_front() {
        let expected = dispatch(SimdLevel::Portable, Fronts);
        assert_eq!(expected[0], []);
        let number = |x: f32, low: u32| (u64::from(x.to_bits()) << 32 | u64::from(low)).cast_signed();
        assert_eq!(expected[0b1010_1010], [number(-1.0, 2), number(-0.0, 4), number(5.0, u32::MAX), number(7.0, 8)]);
        assert_eq!(expected[255].len(), 8);
        for &level in SimdLevel::available() {
            assert_eq!(dispatch(level, Fronts), expected, "{level:?}");
        }
    }

    /// Sums and parts of f64 products.
    struct Exact;

    impl Task for Exact {
        type Output = [Vec<f64>; 3];

        #[inline(always)]
        fn run<S: Simd>(self) -> Self::Output {
            let (a, b): (_, [f64; 8]) =
                (std::array::from_fn(|i| 1.0 / (3.1 + i as f64)), std::array::from_fn(|i| (i as f64 + 0.1) * 1e20));
            let (a, b) = (<S::Doubles>::load(&a), <S::Doubles>::load(&b));
            let error = a.product_error(b, a.times(b));
            [error, a.sqrt(), a.select(0b0110_1001, b)].map(|row| row.array().to_vec())
        }
    }

    #[test]
    fn every_level_knows_the_error_of_a_product() {
        let expected: [Vec<f64>; 3] = std::array::from_fn(|k| {
            let row = (0..8).map(|i| {
                let (a, b) = (1.0 / (3.1 + f64::from(i)), (f64::from(i) + 0.1) * 1e20);
                let chosen = if 0b0110_1001 >> i & 1 != 0 { a } else { b };
                [a.mul_add(b, -(a * b)), a.sqrt(), chosen][k]
            });
            row.collect()
        });
        assert!(expected[0].iter().all(|&error| error != 0.0));
        for &level in SimdLevel::available() {
            assert_eq!(dispatch(level, Exact), expected, "{level:?}");
        }
    }

    #[test]
    fn every_level_takes_points_apart() {
        for &level in SimdLevel::available() {
            for (k, row) in dispatch(level, Unzip).into_iter().enumerate() {
                let (of, count) = (if k < 9 { k % 3 } else { (k - 9) % 8 }, if (3..6).contains(&k) || k >= 17 { 16 } else { 8 });
                let expected = (0..count).map(|i| f64::from(100 * of as u32 + i));
                assert_eq!(row, expected.collect::<Vec<_>>(), "{level:?} {k}");
            }
        }
    }

    #[test]
    fn every_level_gives_the_same_on_numbers_that_do_not_round() {
        let expected = dispatch(SimdLevel::Portable, All);
        let (numbers, bits) = &expected[0];
        assert_eq!(numbers[..8], [3.0, -4.0, 3.75, 4.0, 15.5, 7.0, 1e30, 14.5]);
        assert_eq!(numbers[72..], [1.0, 5.0, 3.5, 5.0, -0.5, 8.0, 5.0, 5.0, -2.0, 1e30, -2.0, -2.0, 0.0, -1e30]);
        const ALL: u32 = u32::MAX;
        assert_eq!(bits[..], [0b1001_1011, 0b1001_1001, 0b0010_0100, ALL, 1, ALL, 0, ALL, ALL, 0, 1]);
        assert_eq!(expected[1].1[..3], [0b0110_0110_1001_1011, 0b0110_0100_1001_1001, 0b0100_1001_0010_0100]);
        for &level in SimdLevel::available() {
            assert_eq!(dispatch(level, All), expected, "{level:?}");
        }
    }
}
