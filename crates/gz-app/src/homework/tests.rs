//! The homework's calls, and that they make the pictures that scene files make.
#![allow(clippy::approx_constant, reason = "the course's directions have four digits")]

use super::*;
use gz_core::StackError;

fn renderer() -> GzRender {
    GzRender::new(GzDisplay::new(8, 8).unwrap(), CameraModel::Homework, ShadeRules::HOMEWORK)
}

fn square(render: &mut GzRender, half: f32) -> [Option<TriId>; 2] {
    let at = |x: f32, y: f32| GzCoord::new(x * half, y * half, 0.0);
    let (a, b, c, d) = (at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0));
    [[a, b, c], [a, c, d]].map(|p| render.gz_put_triangle(p, [GzCoord::NEG_Z; 3], [GzTextureIndex::ZERO; 3]).unwrap())
}

#[test]
fn calls_before_begin_render_fail() {
    let mut render = renderer();
    let put = render.gz_put_triangle([GzCoord::ZERO; 3], [GzCoord::Z; 3], [GzTextureIndex::ZERO; 3]);
    assert_eq!(put, Err(HomeworkError::NotBegun));
    assert_eq!(render.gz_ray_trace().unwrap_err(), HomeworkError::NotBegun);
    assert_eq!(render.gz_pop_matrix(), Err(HomeworkError::Stack(StackError::Empty)));
}

#[test]
fn attributes_that_make_no_sense_are_refused() {
    let mut render = renderer();
    let light = |direction| GzAttribute::DirectionalLight { direction, color: GzColor::ONE };
    assert_eq!(render.gz_put_attribute(light(DVec3::ZERO)), Err(HomeworkError::LightDirection));
    assert_eq!(render.gz_put_attribute(GzAttribute::DistributionCoefficient(f32::NAN)), Err(HomeworkError::Power));
    render.gz_put_attributes((0..MAX_LIGHTS).map(|_| light(DVec3::Y))).unwrap();
    assert_eq!(render.gz_put_attribute(light(DVec3::Y)), Err(HomeworkError::TooManyLights));
}

#[test]
fn a_square_in_front_shows_its_colour_over_the_default() {
    let mut render = renderer();
    render.gz_put_camera(View { position: DVec3::Z * -4.0, look_at: DVec3::ZERO, up: DVec3::Y, fov: 90.0 });
    render.gz_default(100, 5000, 16);
    render.gz_begin_render().unwrap();
    render.gz_put_attribute(GzAttribute::RgbColor(GzColor::new(1.0, 0.5, 0.0))).unwrap();
    assert_eq!(square(&mut render, 1.0), [Some(0), Some(1)]);
    render.gz_ray_trace().unwrap();
    let of = |i, j| render.display().get(i, j).map(|p| (p.red, p.green, p.blue));
    assert_eq!(of(4, 4), Some((4095, 2047, 0)));
    assert_eq!(of(0, 0), Some((100, 4095, 16)));
    assert_eq!(&render.gz_flush_display_to_framebuffer()[..3], [1, 255, 6]);
}

#[test]
fn a_triangle_with_a_corner_behind_the_view_plane_is_dropped() {
    let mut render = renderer();
    render.gz_put_camera(View { position: DVec3::Z * -4.0, look_at: DVec3::ZERO, up: DVec3::Y, fov: 90.0 });
    render.gz_begin_render().unwrap();
    render.gz_push_matrix(&GzMatrix::translate(DVec3::Z * -5.0)).unwrap();
    assert_eq!(square(&mut render, 1.0), [None, None]);
    render.gz_pop_matrix().unwrap();
    assert_eq!(square(&mut render, 1.0), [Some(0), Some(1)]);
}

#[test]
fn materials_are_counted_once_however_often_they_return() {
    let mut render = renderer();
    render.gz_begin_render().unwrap();
    for red in [0.1, 0.9, 0.1] {
        render.gz_put_attribute(GzAttribute::DiffuseCoefficient(GzColor::X * red)).unwrap();
        square(&mut render, 0.5);
    }
    assert_eq!((render.materials.len(), render.used.clone()), (2, vec![4, 2]));
}

/// HW4 with our own teapot, as a scene file says it.
const SCENE: &str = r#"
background = [0.502, 0.4393, 0.3765]
ambient = 0.3
[render]
size = [64, 64]
[camera]
model = "homework"
position = [-10, 5, -10]
look_at = [0, 0, 0]
fov = 35
[[light]]
direction = [-0.7071, 0.7071, 0]
color = [0.5, 0.5, 0.9]
[[light]]
direction = [0.7071, 0, -0.7071]
color = [0.2, 0.7, 0.3]
[[material]]
name = "pot"
ka = 0.1
kd = 0.7
ks = 0.3
power = 32
interpolate = "gouraud"
[[mesh]]
teapot = { segments = 3, bottom = false }
material = "pot"
place = [{ translate = [0.5, -1, 0] }, { rotate_y = 40 }]
"#;

#[test]
fn calls_and_scene_file_make_the_same_picture() {
    let mut render = GzRender::new(GzDisplay::new(64, 64).unwrap(), CameraModel::Homework, ShadeRules::HOMEWORK);
    render.gz_default(2055, 1798, 1541);
    render.gz_begin_render().unwrap();
    for (direction, color) in [([-0.7071, 0.7071, 0.0], [0.5, 0.5, 0.9]), ([0.7071, 0.0, -0.7071], [0.2, 0.7, 0.3])] {
        render.gz_put_attribute(GzAttribute::DirectionalLight { direction: direction.into(), color: color.into() }).unwrap();
    }
    render.gz_put_attribute(GzAttribute::AmbientLight(GzColor::splat(0.3))).unwrap();
    render.gz_put_attribute(GzAttribute::Interpolate(Interpolate::Gouraud)).unwrap();
    render.gz_push_matrix(&GzMatrix::translate(DVec3::new(0.5, -1.0, 0.0))).unwrap();
    render.gz_push_matrix(&GzMatrix::rotate_y(40.0)).unwrap();
    let mesh = crate::teapot::tessellate(3, false);
    for tri in &mesh.triangles {
        let of = |corners: [u32; 3], values: &[GzCoord]| corners.map(|k| values[k as usize]);
        let (positions, normals) = (of(tri.position, &mesh.positions), of(tri.normal.unwrap(), &mesh.normals));
        render.gz_put_triangle(positions, normals, tri.uv.unwrap().map(|k| mesh.uvs[k as usize])).unwrap();
    }
    let stats = render.gz_ray_trace().unwrap();

    let path = std::env::temp_dir().join(format!("gz-homework-{}.toml", std::process::id()));
    std::fs::write(&path, SCENE).unwrap();
    let draft = crate::load::scene(&path, &crate::load::Overrides::default()).unwrap();
    std::fs::remove_file(&path).unwrap();
    let needs = SceneNeeds::of(&draft.scene);
    let scene = draft.place(needs).unwrap();
    let frame = shade_frame(&scene, needs, &BruteForce::new(&scene.tris), &TileGrid::whole(64, 64, 32), &|_| ());
    assert_eq!(stats, frame.stats);
    let mut covered = 0;
    for ((i, j), color) in frame.area.pixels().zip(&frame.colors) {
        let pixel = render.display().get(i as i32, j as i32).unwrap();
        let expected = color.to_array().map(|c| course12_intensity(c) as i16);
        assert_eq!([pixel.red, pixel.green, pixel.blue], expected, "{i} {j}");
        covered += usize::from(expected != [2055, 1798, 1541]);
    }
    assert!(covered > 200 && covered < 64 * 64, "{covered}");
}
