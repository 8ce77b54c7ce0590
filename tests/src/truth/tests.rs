//! The truth against hand-made cases, against 128-bit integers written out by hand, and its quick steps against integers alone.

use super::*;
use std::cmp::Ordering;

/// Numbers from a seed.
struct Lcg(u64);

impl Lcg {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    fn within(&mut self, n: i64) -> i64 {
        (self.next() % (2 * n as u64 + 1)) as i64 - n
    }

    fn unit(&mut self) -> f32 {
        (self.next() >> 7) as f32 / (1 << 24) as f32
    }

    fn below(&mut self, n: usize) -> usize {
        self.next() as usize % n
    }
}

fn ray(origin: [f64; 3], direction: [f32; 3]) -> Ray {
    Ray { origin, direction, tmin: 0.0, tmax: f32::INFINITY }
}

const WALL: Triangle = [[-9.0, -9.0, 2.0], [9.0, -9.0, 2.0], [0.0, 9.0, 2.0]];

fn same(ray: &Ray, triangles: &[Triangle]) -> Option<Found> {
    let (quick, plain) = (Truth::new(triangles).closest(ray), plain::closest(ray, triangles));
    let bits = |found: Option<Found>| found.map(|f| (f.tri, f.t.to_bits(), f.u.to_bits(), f.v.to_bits()));
    assert_eq!(bits(quick), bits(plain), "{ray:?} {triangles:?}");
    assert_eq!(Truth::new(triangles).any(ray), plain.is_some());
    plain
}

#[test]
fn hits_made_by_hand() {
    // Through the middle of the base, at a quarter of its height, through a corner, beside it.
    let found = same(&ray([0.0, -9.0, 0.0], [0.0, 0.0, 1.0]), &[WALL]);
    assert_eq!(found, Some(Found { tri: 0, t: 2.0, u: 0.5, v: 0.0 }));
    let found = same(&ray([0.0, -4.5, 1.0], [0.0, 0.0, 0.25]), &[WALL]);
    assert_eq!(found, Some(Found { tri: 0, t: 4.0, u: 0.375, v: 0.25 }));
    let found = same(&ray([0.0, 9.0, 5.0], [0.0, 0.0, -3.0]), &[WALL]);
    assert_eq!(found, Some(Found { tri: 0, t: 1.0, u: 0.0, v: 1.0 }));
    assert_eq!(same(&ray([0.0, 9.000_001, 5.0], [0.0, 0.0, -3.0]), &[WALL]), None);
    // Away from it, and in its plane.
    assert_eq!(same(&ray([0.0, 0.0, 5.0], [0.0, 0.0, 1.0]), &[WALL]), None);
    assert_eq!(same(&ray([-20.0, 0.0, 2.0], [1.0, 0.0, 0.0]), &[WALL]), None);
    // A third is rounded once: t = 2/3, u and v are (1 - 2/9 ..)/2 and so on.
    let found = same(&ray([0.0, -3.0, 0.0], [0.0, 0.0, 3.0]), &[WALL]).unwrap();
    assert_eq!((found.t, found.v), (2.0 / 3.0, 1.0 / 3.0));
}

#[test]
fn both_ends_are_strict_and_ties_go_to_the_lower_number() {
    let at = |tmin, tmax| same(&Ray { tmin, tmax, ..ray([0.0; 3], [0.0, 0.0, 1.0]) }, &[WALL, WALL]).map(|found| found.tri);
    assert_eq!((at(0.0, 2.0), at(0.0, 2f32.next_up()), at(2.0, 9.0), at(2f32.next_down(), 9.0)), (None, Some(0), None, Some(0)));
    let on = |tmin| same(&Ray { tmin, ..ray([0.0, 0.0, 2.0], [0.0, 0.0, 1.0]) }, &[WALL]).map(|found| found.t.to_bits());
    // An origin on the triangle is not hit at t = 0, and T is then 0 without a sign.
    assert_eq!((on(0.0), on(-f32::from_bits(1))), (None, Some(0)));
    let reversed = [WALL[2], WALL[1], WALL[0]];
    let farther = WALL.map(|[x, y, _]| [x, y, 2f32.next_up()]);
    let down = ray([0.0; 3], [0.0, 0.0, 1.0]);
    assert_eq!(same(&down, &[farther, reversed, WALL]).map(|found| found.tri), Some(1));
    assert_eq!(plain::tied(&down, &[farther, reversed, WALL, farther]), [1, 2]);
    assert_eq!(plain::tied(&ray([99.0; 3], [0.0, 0.0, 1.0]), &[WALL]), [0u32; 0]);
}

#[test]
fn triangles_without_area_are_never_hit() {
    for flat in [[[1.0; 3]; 3], [[0.0; 3], [0.0; 3], [1.0; 3]], [[0.0; 3], [1.0; 3], [2.0; 3]]] {
        for direction in [[1.0; 3], [1.0, 0.0, 0.0]] {
            assert_eq!(same(&ray([-1.0; 3], direction), &[flat]), None);
        }
    }
}

#[test]
fn t_that_f64_gets_wrong_in_the_fourth_digit() {
    let corners = [
        [-4_181_166.0, -2_325_873.0, 2_636_640.0],
        [-3_520_566.0, -2_287_287.0, 2_458_607.0],
        [-3_158_845.0, -1_460_238.0, 1_776_593.0],
    ];
    let found = same(&ray([0.0; 3], [-1_393_722.0, -775_291.0, 878_880.0]), &[corners]).unwrap();
    assert_eq!(found.t, 3.0);
}

#[test]
fn the_ends_of_the_range() {
    for scale in [1e-44f32, 1e-38, 1e-20, 1e18, 1e30, 1e37] {
        let scaled = WALL.map(|corner| corner.map(|x| x * scale));
        let found = same(&ray([0.0; 3], [0.0, 0.0, 1.0]), &[scaled]).unwrap();
        assert_eq!(found.t, scaled[0][2], "{scale}");
    }
    // t beyond f32 is a hit with T infinite, and one below it has T 0.
    let found = same(&ray([0.0; 3], [0.0, 0.0, 1e-40]), &[WALL]).unwrap();
    assert_eq!(found.t, f32::INFINITY);
    let behind = Ray { tmin: -1.0, ..ray([0.0, 0.0, 2.0f64.next_up()], [0.0, 0.0, 3e38]) };
    assert_eq!(same(&behind, &[WALL]).unwrap().t.to_bits(), (-0.0f32).to_bits());
    let far = ray([2f64.powi(128), -(2f64.powi(128)), 2f64.powi(-150)], [-1.0, 1.0, 0.0]);
    let wide = [[-1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [0.0, 3.0, 0.5]];
    assert_eq!(same(&far, &[wide]).unwrap().t, f32::INFINITY);
}

/// The definition on small integers, in 128 bits: triangle, t, u and v as (numerator, denominator).
fn by_128_bits(o: [i64; 3], d: [i64; 3], triangles: &[[[i64; 3]; 3]]) -> Option<(u32, [(i128, i128); 3])> {
    let cross = |a: [i128; 3], b: [i128; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot = |a: [i128; 3], b: [i128; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let mut best: Option<(u32, [(i128, i128); 3])> = None;
    for (tri, corners) in (0..).zip(triangles) {
        let [a, b, c] = corners.map(|p| [0, 1, 2].map(|k| i128::from(p[k] - o[k])));
        let d = d.map(i128::from);
        let volumes = [dot(d, cross(b, c)), dot(d, cross(c, a)), dot(d, cross(a, b))];
        let (sum, m) = (volumes.iter().sum::<i128>(), dot(a, cross(b, c)));
        let s = sum.signum();
        if s != 0 && volumes.iter().all(|x| x * s >= 0) && m * s > 0 {
            let found = (tri, [m, volumes[1], volumes[2]].map(|x| (x * s, sum * s)));
            if best.is_none_or(|(_, [(n, d), ..])| found.1[0].0 * d < n * found.1[0].1) {
                best = Some(found);
            }
        }
    }
    best
}

#[test]
fn grids_full_of_ties_are_answered_as_128_bits_answer() {
    let mut lcg = Lcg(1);
    let (mut rays, mut hits) = (0, 0);
    for scene in 0..40 {
        let range = [2, 3, 6, 30][scene % 4];
        let mut point = |n: i64| -> [i64; 3] { std::array::from_fn(|_| lcg.within(n)) };
        let mut triangles: Vec<[[i64; 3]; 3]> = (0..30).map(|_| [point(range), point(range), point(range)]).collect();
        triangles.extend_from_within(0..4);
        let float = |p: [i64; 3]| p.map(|x| x as f32);
        let truth_triangles: Vec<Triangle> = triangles.iter().map(|t| t.map(float)).collect();
        let truth = Truth::new(&truth_triangles);
        for k in 0..250 {
            let o: [i64; 3] = std::array::from_fn(|_| lcg.within(range + 2));
            let t = triangles[lcg.below(triangles.len())];
            let target: [i64; 3] = match k % 3 {
                0 => t[0],
                1 => [0, 1, 2].map(|k| t[0][k] + t[1][k] - o[k]),
                _ => std::array::from_fn(|_| lcg.within(range)),
            };
            let d = [0, 1, 2].map(|k| target[k] - o[k]);
            if d == [0; 3] {
                continue;
            }
            let asked = ray(o.map(|x| x as f64), float(d));
            // Quotients of integers this small are never near a boundary of f32 without being on it.
            let expected = by_128_bits(o, d, &triangles).map(|(tri, numbers)| {
                let [t, u, v] = numbers.map(|(n, d)| (n as f64 / d as f64) as f32);
                Found { tri, t, u, v }
            });
            assert_eq!(truth.closest(&asked), expected, "{asked:?}");
            assert_eq!(plain::closest(&asked, &truth_triangles), expected, "{asked:?}");
            rays += 1;
            hits += u32::from(expected.is_some());
        }
    }
    assert!(rays > 9_000 && hits > 4_000, "{rays} rays, {hits} hits");
}

/// Triangles of all sorts around `offset`: soup, needles, copies, neighbours along edges.
fn mixed(lcg: &mut Lcg, n: usize, offset: f32, scale: f32) -> Vec<Triangle> {
    let mut triangles: Vec<Triangle> = Vec::new();
    while triangles.len() < n {
        let mut point = || -> [f32; 3] { std::array::from_fn(|_| (lcg.unit() + offset) * scale) };
        let [a, b, c, d] = [point(), point(), point(), point()];
        let near: [f32; 3] = std::array::from_fn(|k| a[k] + (b[k] - a[k]) * 1e-5);
        triangles.push([a, b, c]);
        triangles.push([b, a, d]);
        triangles.push([a, near, c]);
        if triangles.len().is_multiple_of(7) {
            triangles.push([a, b, c]);
        }
    }
    triangles
}

#[test]
fn the_quick_steps_leave_nothing_out() {
    let mut lcg = Lcg(2);
    let (mut hits, mut steps, mut rays) = (0, Steps::default(), 0);
    for scene in 0..30 {
        let (offset, scale) = [(0.0, 1.0), (-0.5, 1e-18), (1e2, 1.0), (1e4, 1e6), (1e6, 1.0), (-0.5, 1e18)][scene % 6];
        let triangles = mixed(&mut lcg, 60, offset, scale);
        let truth = Truth::new(&triangles);
        for k in 0..150 {
            let [a, b, c] = triangles[lcg.below(triangles.len())];
            let from = triangles[lcg.below(triangles.len())][0];
            let aim: [f32; 3] = match k % 4 {
                0 => a,
                1 => std::array::from_fn(|k| 0.5 * a[k] + 0.5 * b[k]),
                2 => std::array::from_fn(|k| a[k] / 3.0 + b[k] / 3.0 + c[k] / 3.0),
                _ => std::array::from_fn(|_| (lcg.unit() + offset) * scale),
            };
            let shift = if k % 5 == 0 { 0.0 } else { f64::from(scale) * 0.7 };
            let origin = from.map(|x| f64::from(x) - shift * 1.234_567_890_123);
            let direction = [0, 1, 2].map(|k| (f64::from(aim[k]) - origin[k]) as f32);
            let asked = Ray { tmin: if k % 6 == 0 { -1.0 } else { 0.0 }, ..ray(origin, direction) };
            let expected = plain::closest(&asked, &triangles);
            let bits = |found: Option<Found>| found.map(|f| (f.tri, f.t.to_bits(), f.u.to_bits(), f.v.to_bits()));
            let found = asked.line().and_then(|line| truth.closest_of(&line, &mut steps));
            assert_eq!(bits(found), bits(expected), "{asked:?} {triangles:?}");
            assert_eq!(truth.any(&asked), expected.is_some());
            rays += 1;
            hits += u32::from(expected.is_some());
        }
    }
    assert!(rays == 4500 && hits > 2000, "{rays} rays, {hits} hits");
    // They would be of no use if they left nothing out, and of no proof if the integers were never asked.
    assert!(
        steps.quick < rays * 60 && steps.bounded * 4 < steps.quick && steps.exact * 2 < steps.bounded && steps.exact > 100,
        "{steps:?}"
    );
}

#[test]
fn a_line_can_start_exactly_where_another_one_ends() {
    let mut lcg = Lcg(3);
    let mut blocked = [0, 0];
    for _ in 0..300 {
        let triangles = mixed(&mut lcg, 12, -0.5, 1.0);
        let truth = Truth::new(&triangles);
        let origin: [f64; 3] = std::array::from_fn(|_| f64::from(lcg.unit()) * 4.0 - 2.0);
        let asked = ray(origin, origin.map(|x| (-x) as f32 + 0.1 * lcg.unit()));
        let Some((tri, meeting)) = truth.meeting_of(&asked.line().unwrap()) else { continue };
        // The point is on the line, at t, and has the weights that the meeting says.
        let [a, b, c] = triangles[tri as usize];
        let (t, u, v) = (meeting.t.to_f64(), meeting.u.to_f64(), meeting.v.to_f64());
        for k in 0..3 {
            let point = meeting.point.coordinate(k).to_f64();
            let by_weights = (1.0 - u - v) * f64::from(a[k]) + u * f64::from(b[k]) + v * f64::from(c[k]);
            assert!((point - by_weights).abs() < 1e-15, "{point} {by_weights}");
            assert!((point - (origin[k] + t * f64::from(asked.direction[k]))).abs() < 1e-14);
        }
        // From there on it is on the plane of its triangle exactly: neither this nor a copy of it is met again, whatever the direction.
        for direction in [asked.direction, asked.direction.map(|x| -x), [0.3, 0.5, -0.2]] {
            let on = Line::from_point(meeting.point.clone(), direction, f32::INFINITY).unwrap();
            let all = plain::hits(&on, &triangles);
            assert!(all.iter().all(|(other, _)| triangles[*other as usize] != triangles[tri as usize]));
            assert_eq!(truth.any_of(&on, &mut Steps::default()), !all.is_empty());
            blocked[usize::from(all.is_empty())] += 1;
        }
        // Straight on it meets what comes next on the first line, that much later.
        let next = plain::hits(&asked.line().unwrap(), &triangles).into_iter().find(|(_, next)| next.t > meeting.t);
        let on = Line::from_point(meeting.point.clone(), asked.direction, f32::INFINITY).unwrap();
        let found = plain::hits(&on, &triangles);
        assert_eq!(next.as_ref().map(|(tri, _)| *tri), found.first().map(|(tri, _)| *tri));
        if let (Some((_, next)), Some((_, found))) = (next, found.first()) {
            assert!((next.t.to_f64() - meeting.t.to_f64() - found.t.to_f64()).abs() < 1e-14);
        }
    }
    assert!(blocked[0] > 30 && blocked[1] > 30, "{blocked:?}");
}

#[test]
fn sides_of_planes() {
    assert_eq!((side(&WALL, [0.0, 0.0, 1.0]), side(&WALL, [5.0, 1.0, -1e-40]), side(&WALL, [1.0, 2.0, 0.0])), (1, -1, 0));
    assert_eq!(side(&[[1.0; 3]; 3], [1.0, 2.0, 3.0]), 0);
    let far = WALL.map(|corner| corner.map(|x| x + 1e6));
    assert_eq!(side(&far, [0.0, 0.0, 1.0]), 1);
}

#[test]
fn numbers_of_a_part_of_the_triangles_are_kept() {
    let farther = WALL.map(|[x, y, _]| [x, y, 3.0]);
    let truth = Truth::of_some(&[WALL, farther, WALL], |tri| tri != 0);
    let asked = ray([0.0; 3], [0.0, 0.0, 1.0]);
    assert_eq!(truth.closest(&asked).map(|found| found.tri), Some(2));
    let (tri, meeting) = truth.meeting_of(&asked.line().unwrap()).unwrap();
    assert_eq!((tri, meeting.t.cmp_number(2.0)), (2, Ordering::Equal));
    assert_eq!(Truth::new(&[]).closest(&asked), None);
}
