//! Lanes that every target has.

use super::doubles::{Doubles, EightDoubles};
use super::lanes::{Lanes, Simd, Task};

/// The instructions of the build target.
pub(super) struct PortableSimd;

impl Simd for PortableSimd {
    type Doubles = PortableDoubles;
    type Eight = Portable;
    type Sixteen = Pair<Portable>;

    #[inline(never)]
    fn apart<T: Task>(task: T) -> T::Output {
        task.run::<Self>()
    }

    #[inline(always)]
    fn join(low: Portable, high: Portable) -> Pair<Portable> {
        Pair(low, high)
    }

    #[inline(always)]
    fn widen(x: Portable) -> PortableDoubles {
        PortableDoubles(x.0.map(f64::from))
    }

    #[inline(always)]
    fn narrow(x: PortableDoubles) -> Portable {
        Portable(x.0.map(|x| x as f32))
    }

    #[inline(always)]
    fn prefetch<T>(_what: &T) {}
}

/// What every target has: eight numbers in an array.
#[derive(Clone, Copy)]
pub(super) struct Portable([f32; 8]);

#[inline(always)]
fn each(a: Portable, b: Portable, f: impl Fn(f32, f32) -> f32) -> Portable {
    Portable(std::array::from_fn(|i| f(a.0[i], b.0[i])))
}

#[inline(always)]
fn bits(holds: impl Fn(usize) -> bool) -> u32 {
    let mut out = 0;
    for i in 0..8 {
        out |= u32::from(holds(i)) << i;
    }
    out
}

impl Lanes<8> for Portable {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self([x; 8])
    }
    #[inline(always)]
    fn load(x: &[f32; 8]) -> Self {
        Self(*x)
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; 8]) {
        *to = self.0;
    }
    #[inline(always)]
    fn select(self, bits: u32, other: Self) -> Self {
        Self(std::array::from_fn(|i| if bits >> i & 1 != 0 { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn same_bits(self, other: Self) -> u32 {
        bits(|i| self.0[i].to_bits() == other.0[i].to_bits())
    }
    #[inline(always)]
    fn least(self) -> f32 {
        self.0.into_iter().fold(f32::INFINITY, f32::min)
    }
    #[inline(always)]
    fn greatest(self) -> f32 {
        self.0.into_iter().fold(f32::NEG_INFINITY, f32::max)
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        each(self, other, |a, b| a + b)
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        each(self, other, |a, b| a - b)
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        each(self, other, |a, b| a * b)
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        each(self, other, |a, b| a / b)
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        self.times(factor).plus(term)
    }
    #[inline(always)]
    fn mul_sub(self, factor: Self, term: Self) -> Self {
        self.times(factor).minus(term)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        each(self, self, |a, _| a.abs())
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        each(self, other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        each(self, other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        bits(|i| self.0[i] <= other.0[i])
    }
    #[inline(always)]
    fn below(self, other: Self) -> u32 {
        bits(|i| self.0[i] < other.0[i])
    }
    #[inline(always)]
    fn same(ids: &[u32; 8], id: u32) -> u32 {
        bits(|i| ids[i] == id)
    }
    #[inline(always)]
    fn set_some(id: u32, bits: u32, ids: &mut [u32; 8]) {
        for (i, to) in ids.iter_mut().enumerate() {
            *to = if bits >> i & 1 != 0 { id } else { *to };
        }
    }
}

/// Eight f64 in an array.
#[derive(Clone, Copy)]
pub(super) struct PortableDoubles([f64; 8]);

impl Doubles for PortableDoubles {
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] * other.0[i]))
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] / other.0[i]))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; 8])
    }
    #[inline(always)]
    fn or_more(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].or_more(other.0[i])))
    }
    #[inline(always)]
    fn or_less(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].or_less(other.0[i])))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn product_error(self, other: Self, product: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].product_error(other.0[i], product.0[i])))
    }
}

impl EightDoubles for PortableDoubles {
    #[inline(always)]
    fn load(x: &[f64; 8]) -> Self {
        Self(*x)
    }
    #[inline(always)]
    fn widen(x: &[f32; 8]) -> Self {
        Self(x.map(f64::from))
    }
    #[inline(always)]
    fn pick(x: &[f64; 8], places: &[u32; 8]) -> Self {
        Self(places.map(|place| x[place as usize % 8]))
    }
    #[inline(always)]
    fn array(self) -> [f64; 8] {
        self.0
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        bits(|i| self.0[i] <= other.0[i])
    }
    #[inline(always)]
    fn select(self, bits: u32, other: Self) -> Self {
        Self(std::array::from_fn(|i| if bits >> i & 1 != 0 { self.0[i] } else { other.0[i] }))
    }
}

/// Two times eight lanes.
#[derive(Clone, Copy)]
pub(super) struct Pair<L>(pub(super) L, pub(super) L);

/// Both halves of sixteen numbers.
#[inline(always)]
fn halves<T>(x: &[T; 16]) -> (&[T; 8], &[T; 8]) {
    match x.split_first_chunk::<8>().map(|(low, high)| (low, high.first_chunk::<8>())) {
        Some((low, Some(high))) => (low, high),
        _ => unreachable!("sixteen is twice eight"),
    }
}

#[inline(always)]
fn halves_mut<T>(x: &mut [T; 16]) -> (&mut [T; 8], &mut [T; 8]) {
    match x.split_first_chunk_mut::<8>().map(|(low, high)| (low, high.first_chunk_mut::<8>())) {
        Some((low, Some(high))) => (low, high),
        _ => unreachable!("sixteen is twice eight"),
    }
}

impl<L: Lanes<8>> Lanes<16> for Pair<L> {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(L::splat(x), L::splat(x))
    }
    #[inline(always)]
    fn load(x: &[f32; 16]) -> Self {
        let (low, high) = halves(x);
        Self(L::load(low), L::load(high))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; 16]) {
        let (low, high) = halves_mut(to);
        self.0.store(low);
        self.1.store(high);
    }
    #[inline(always)]
    fn select(self, bits: u32, other: Self) -> Self {
        Self(self.0.select(bits & 0xff, other.0), self.1.select(bits >> 8 & 0xff, other.1))
    }
    #[inline(always)]
    fn same_bits(self, other: Self) -> u32 {
        self.0.same_bits(other.0) | self.1.same_bits(other.1) << 8
    }
    #[inline(always)]
    fn least(self) -> f32 {
        self.0.min(self.1).least()
    }
    #[inline(always)]
    fn greatest(self) -> f32 {
        self.0.max(self.1).greatest()
    }
    #[inline(always)]
    fn least_of_each([a, b, c, d]: [Self; 4]) -> [f32; 4] {
        L::least_of_each([a.0.min(a.1), b.0.min(b.1), c.0.min(c.1), d.0.min(d.1)])
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(self.0.plus(other.0), self.1.plus(other.1))
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self(self.0.minus(other.0), self.1.minus(other.1))
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self(self.0.times(other.0), self.1.times(other.1))
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        Self(self.0.over(other.0), self.1.over(other.1))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Self(self.0.mul_add(factor.0, term.0), self.1.mul_add(factor.1, term.1))
    }
    #[inline(always)]
    fn mul_sub(self, factor: Self, term: Self) -> Self {
        Self(self.0.mul_sub(factor.0, term.0), self.1.mul_sub(factor.1, term.1))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs(), self.1.abs())
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0), self.1.min(other.1))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0), self.1.max(other.1))
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> u32 {
        self.0.at_most(other.0) | self.1.at_most(other.1) << 8
    }
    #[inline(always)]
    fn below(self, other: Self) -> u32 {
        self.0.below(other.0) | self.1.below(other.1) << 8
    }
    #[inline(always)]
    fn unzip3(points: &[[f32; 3]; 16]) -> [Self; 3] {
        let (low, high) = halves(points);
        let ([x, y, z], [x8, y8, z8]) = (L::unzip3(low), L::unzip3(high));
        [Self(x, x8), Self(y, y8), Self(z, z8)]
    }
    #[inline(always)]
    fn unzip8(rows: &[[f32; 8]; 16]) -> [Self; 8] {
        let (low, high) = halves(rows);
        let ([a, b, c, d, e, f, g, h], [i, j, k, l, m, n, o, p]) = (L::unzip8(low), L::unzip8(high));
        [Self(a, i), Self(b, j), Self(c, k), Self(d, l), Self(e, m), Self(f, n), Self(g, o), Self(h, p)]
    }
    #[inline(always)]
    fn same(ids: &[u32; 16], id: u32) -> u32 {
        let (low, high) = halves(ids);
        L::same(low, id) | L::same(high, id) << 8
    }
    #[inline(always)]
    fn set_some(id: u32, bits: u32, ids: &mut [u32; 16]) {
        let (low, high) = halves_mut(ids);
        L::set_some(id, bits & 0xff, low);
        L::set_some(id, bits >> 8 & 0xff, high);
    }
}
