//! From the homework's Z-buffer to the T-value buffer: T under the screen camera is the homework's z; and secondary rays leave the
//! triangle that they start on for good.

use gz_app::load::{self, Overrides};
use gz_bsp::BspTree;
use gz_core::glam::{DVec2, DVec3};
use gz_core::{CameraModel, ClassMask, GzCoord, GzRay, Hit, RayQuery, TBuffer, Tile, TriBuffer, TriId, kernel};
use gz_shade::{Antialias, Scene, SceneNeeds};
use gz_tests::counting::{Asked, Recording};
use gz_tests::{needs_scenes, scenes};
use std::path::Path;

/// Our teapot in the view of HW5, which the course's own teapot has too.
const HOMEWORK_VIEW: &str = "
background = [1, 1, 1]
ambient = 0.3
[render]
size = [256, 256]
[camera]
model = \"homework\"
position = [-3, -25, -4]
look_at = [7.8, 0.7, 6.5]
up = [-0.2, 1, 0]
fov = 63.7
[[material]]
name = \"pot\"
[[mesh]]
teapot = { segments = 4, bottom = false }
material = \"pot\"
place = [
    { matrix = [[3.25, 0, 0, 0], [0, 3.25, 0, -3.25], [0, 0, 3.25, 3.5], [0, 0, 0, 1]] },
    { matrix = [[0.866, 0, -0.5, 0], [0, 1, 0, 0], [0.5, 0, 0.866, 0], [0, 0, 0, 1]] },
    { matrix = [[1, 0, 0, 0], [0, 0.7071, 0.7071, 0], [0, -0.7071, 0.7071, 0], [0, 0, 0, 1]] },
]
";

/// The scene under one camera model, for the test that is called `user`.
fn homework_view(user: &str, model: CameraModel) -> Scene {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pipeline");
    // A file for each user and model: tests run side by side.
    let path = needs_scenes::write(&folder, &format!("{user}-{model:?}"), HOMEWORK_VIEW).unwrap();
    let draft = load::scene(&path, &Overrides { camera: Some(model), ..Overrides::default() }).unwrap();
    let needs = SceneNeeds::of(&draft.scene);
    draft.place(needs).unwrap()
}

/// A point of image space after Xsp Xpi: column, row and z of the homework.
fn screen_from_image(scene: &Scene, point: DVec3) -> DVec3 {
    let camera = &scene.camera;
    let [x, y, z, w] = camera.screen_from_perspective().times(&camera.perspective_from_image()).homogeneous(point);
    DVec3::new(x / w, y / w, z / w)
}

/// Where a primary ray of `scene` meets `tri`, from weights in f64.
fn point_of(tris: &TriBuffer, tri: TriId, ray: &GzRay) -> DVec3 {
    let corners = tris.position(tri);
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let [wa, wb, wc] = kernel::hit_weights(ray, corners);
    a * wa + b * wb + c * wc
}

/// How much z changes with a pixel to the right or down, together, on a triangle in screen space.
fn steepness(corners: &[GzCoord; 3]) -> f64 {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let n = (b - a).cross(c - a);
    (n.x.abs() + n.y.abs()) / n.z.abs()
}

/// Distance in pixels from (x, y) to the nearest edge of a triangle in screen space.
fn edge_distance(corners: &[GzCoord; 3], at: DVec2) -> f64 {
    let [a, b, c] = corners.map(|p| p.as_dvec3().truncate());
    let to_edge = |p: DVec2, q: DVec2| {
        let along = ((at - p).dot(q - p) / (q - p).length_squared()).clamp(0.0, 1.0);
        (p + (q - p) * along).distance(at)
    };
    to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
}

/// One rounding of a screen coordinate: pixels below 256 have f32 steps of at most 2^-16.
const PIXEL_STEP: f64 = 1.0 / 65_536.0;
/// One step of z: the teapot lies between 2^30 and 2^31, where f32 counts in 128s.
const Z_STEP: f64 = 128.0;

/// How far z may differ between the two cameras on a triangle.
///
/// Screen corners are rounded once: half a step of z each, and half a step of x and y, which moves z by the steepness; T is rounded
/// once more. Image corners and the ray's direction are rounded too, 2^-24 of about 30 units and of 1, which at w = 20 or so is below
/// a step of x and y and of z together. A factor of 4 covers all of them.
fn z_tolerance(corners: &[GzCoord; 3]) -> f64 {
    2.0 * Z_STEP + 4.0 * PIXEL_STEP * steepness(corners)
}

#[test]
fn t_under_the_screen_camera_is_the_homeworks_z() {
    let (homework, screen) = (homework_view("z", CameraModel::Homework), homework_view("z", CameraModel::Screen));
    let (size, trees) = (homework.camera.width(), [&homework, &screen].map(|scene| BspTree::build(&scene.tris)));
    let [by_t, by_z] = [(&homework, &trees[0]), (&screen, &trees[1])].map(|(scene, tree)| TBuffer::trace(&scene.camera, tree));
    let (mut compared, mut at_edges, mut worst) = (0, 0, 0f64);
    for (i, j) in (Tile { x0: 0, y0: 0, x1: size, y1: size }).pixels() {
        let (t, z) = (by_t.at(i, j), by_z.at(i, j));
        if t.tri != z.tri {
            // Corners are rounded in either space: within that of an edge, the neighbour or nothing may be hit instead.
            let at = DVec2::new(f64::from(i), f64::from(j));
            let hit = [t, z].into_iter().filter(|hit| hit.is_hit());
            let nearest = hit.map(|hit| edge_distance(screen.tris.position(hit.tri), at)).fold(f64::INFINITY, f64::min);
            assert!(nearest < 4.0 * PIXEL_STEP, "({i}, {j}): {t:?} {z:?}, {nearest} pixels from an edge");
            at_edges += 1;
        } else if t.is_hit() {
            let ray = homework.camera.ray(i, j, DVec2::ZERO);
            let point = screen_from_image(&homework, point_of(&homework.tris, t.tri, &ray));
            assert!(
                (point.truncate() - DVec2::new(f64::from(i), f64::from(j))).length() < 4.0 * PIXEL_STEP,
                "({i}, {j}): {point}"
            );
            let (off, tolerance) = ((f64::from(z.t) - point.z).abs(), z_tolerance(screen.tris.position(t.tri)));
            assert!(off <= tolerance, "({i}, {j}): T {} and z {} are {off} apart, {tolerance} allowed", z.t, point.z);
            worst = worst.max(off / tolerance);
            compared += 1;
        }
    }
    println!("{compared} pixels compared, {at_edges} within rounding of an edge; at most {worst:.2} of the tolerance is used");
    assert!(compared > 8000 && at_edges < 20, "{compared} compared, {at_edges} at edges");
}

/// All hits of a ray from front to back, one at each T-value.
fn all_hits(query: &dyn RayQuery, mut ray: GzRay) -> Vec<Hit> {
    let mut hits = Vec::new();
    loop {
        let hit = query.closest_hit(&ray);
        if !hit.is_hit() {
            return hits;
        }
        hits.push(hit);
        ray.tmin = hit.t.next_up();
    }
}

#[test]
fn t_and_z_put_triangles_in_the_same_order() {
    let (homework, screen) = (homework_view("order", CameraModel::Homework), homework_view("order", CameraModel::Screen));
    let (by_t, by_z) = (BspTree::build(&homework.tris), BspTree::build(&screen.tris));
    let (mut layers, mut rays, mut at_edges) = (0, 0, 0);
    for (i, j) in (Tile { x0: 0, y0: 0, x1: 256, y1: 256 }).pixels().filter(|(i, j)| (i + j) % 2 == 0) {
        let ray = homework.camera.ray(i, j, DVec2::ZERO);
        let front_to_back = all_hits(&by_t, ray);
        let z_of = |hit: &Hit| screen_from_image(&homework, point_of(&homework.tris, hit.tri, &ray)).z;
        // Behind each other by T, behind each other by z; two triangles that meet at an edge may be a rounding apart.
        for pair in front_to_back.windows(2) {
            let tolerance = z_tolerance(screen.tris.position(pair[0].tri));
            assert!(z_of(&pair[1]) >= z_of(&pair[0]) - tolerance, "({i}, {j}): {pair:?}");
        }
        // And the screen camera meets the same triangles in the same order.
        let of = |hits: &[Hit]| hits.iter().map(|hit| hit.tri).collect::<Vec<_>>();
        let (ours, theirs) = (of(&front_to_back), of(&all_hits(&by_z, screen.camera.ray(i, j, DVec2::ZERO))));
        if ours != theirs {
            let at = DVec2::new(f64::from(i), f64::from(j));
            let odd = ours.iter().chain(&theirs).map(|&tri| edge_distance(screen.tris.position(tri), at));
            assert!(odd.fold(f64::INFINITY, f64::min) < 4.0 * PIXEL_STEP, "({i}, {j}): {ours:?} and {theirs:?}");
            at_edges += 1;
        }
        layers += front_to_back.len();
        rays += usize::from(front_to_back.len() > 1);
    }
    println!("{layers} hits in order, {rays} rays with more than one, {at_edges} within rounding of an edge");
    assert!(rays > 2000 && at_edges < 20, "{rays} rays, {at_edges} at edges");
}

/// A hit of the record: the triangle and the point, which is where secondary rays may start.
struct Source {
    tri: TriId,
    point: DVec3,
}

/// What became of the secondary rays of a picture.
#[derive(Debug, Default)]
struct Left {
    closest: usize,
    shadow: usize,
    /// Rays that start at no hit of an earlier batch.
    lost: usize,
    /// Rays that hit the triangle that they start on.
    returned: usize,
}

/// Follows the rays of one tile, in the order in which they were asked: each secondary ray starts at the hit of an earlier one.
fn follow(tris: &TriBuffer, asked: &[Asked]) -> Left {
    let (mut left, mut sources) = (Left::default(), Vec::<Source>::new());
    // Starting points are a few roundings of f64 from the point of the hit.
    let near = 1e-12 * f64::from(tris.bounds().reaches().max_element());
    for (k, batch) in asked.iter().enumerate().filter(|(_, batch)| batch.classes == ClassMask::ALL) {
        sources.sort_by(|a, b| a.point.x.total_cmp(&b.point.x));
        for (i, ray) in batch.rays.iter().enumerate().filter(|_| k > 0) {
            let from = sources.partition_point(|source| source.point.x < ray.origin.x - near);
            let candidates = sources[from..].iter().take_while(|source| source.point.x <= ray.origin.x + near);
            let at = candidates.min_by(|a, b| a.point.distance(ray.origin).total_cmp(&b.point.distance(ray.origin)));
            let Some(source) = at.filter(|source| source.point.distance(ray.origin) <= near) else {
                left.lost += 1;
                continue;
            };
            let answer = batch.hits.as_ref().map(|hits| hits[i].tri);
            left.returned += usize::from(answer == Some(source.tri) || kernel::is_hit(ray, tris.position(source.tri)));
            *if answer.is_some() { &mut left.closest } else { &mut left.shadow } += 1;
        }
        let hits = batch.hits.iter().flatten().zip(&batch.rays).filter(|(hit, _)| hit.is_hit());
        sources.extend(hits.map(|(hit, ray)| Source { tri: hit.tri, point: point_of(tris, hit.tri, ray) }));
    }
    left
}

#[test]
fn a_secondary_ray_never_hits_its_own_triangle() {
    let small = Overrides { size: Some((96, 72)), aa: Some(Antialias::None), ..Overrides::default() };
    let (mut closest, mut shadow) = (0, 0);
    for name in scenes::usable() {
        let (scene, needs) = scenes::placed(&name, &small);
        let tree = BspTree::build(&scene.tris);
        let query = Recording::new(&tree);
        // One tile, so that the record is in order.
        let stats = scenes::shade(&scene, needs, &query, 96).stats;
        let left = follow(&scene.tris, &query.into_asked());
        assert_eq!((left.returned, left.lost), (0, 0), "{name}: {left:?}");
        let told = (stats.mirror_rays + stats.glass_rays, stats.shadow_rays);
        assert_eq!((left.closest as u64, left.shadow as u64), told, "{name}");
        closest += left.closest;
        shadow += left.shadow;
    }
    println!("0 of {closest} mirror and glass rays and 0 of {shadow} shadow rays hit the triangle that they start on");
    assert!(closest > 5000 && shadow > 20_000, "{closest} and {shadow}");
}
