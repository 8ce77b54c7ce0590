//! HW5's application, call by call: `GZ_HW_DATA=... cargo run --release -p gz-app --example application5 [output.ppm]`.
//!
//! With the course's data it makes the homework's picture; without, our own teapot and texture stand in for it.

use gz_app::display::GzDisplay;
use gz_app::homework::{GzAttribute, GzRender, course_lights, course_placement};
use gz_app::load::{asc, picture};
use gz_app::teapot;
use gz_core::glam::DVec3;
use gz_core::{CameraModel, GzColor, View};
use gz_shade::{Interpolate, ShadeRules, Texture, TextureLookup};
use std::path::{Path, PathBuf};

const OWN_TEXTURE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/textures/porcelain.png");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The course's data, whose loader reads every texel one place late, or ours.
    let (mesh, file, late) = match std::env::var_os("GZ_HW_DATA").map(PathBuf::from) {
        Some(folder) => (asc::load(&folder.join("ppot.asc"))?, folder.join("texture.ppm"), true),
        None => (teapot::tessellate(4, false), Path::new(OWN_TEXTURE).to_owned(), false),
    };
    let texture = picture::texture(&file, TextureLookup::Homework, false, late)?;

    // GzNewDisplay, GzNewRender, GzPutCamera, GzBeginRender
    let mut render = GzRender::new(GzDisplay::new(256, 256)?, CameraModel::Homework, ShadeRules::HOMEWORK);
    render.gz_default(3992, 3992, 3992);
    let (position, look_at) = (DVec3::new(-3.0, -25.0, -4.0), DVec3::new(7.8, 0.7, 6.5));
    render.gz_put_camera(View { position, look_at, up: DVec3::new(-0.2, 1.0, 0.0), fov: 63.7 });
    render.gz_begin_render()?;

    // GzPutAttribute: lights in image space, then the shader and its coefficients, then the texture.
    render.gz_put_attributes(course_lights())?;
    render.gz_put_attributes([
        GzAttribute::Interpolate(Interpolate::Phong),
        GzAttribute::AmbientCoefficient(GzColor::splat(0.1)),
        GzAttribute::DiffuseCoefficient(GzColor::splat(0.7)),
        GzAttribute::SpecularCoefficient(GzColor::splat(0.3)),
        GzAttribute::DistributionCoefficient(32.0),
        GzAttribute::TextureMap(Some(Texture::Image(texture))),
    ])?;

    // GzPushMatrix: scale, rotate about y, rotate about x
    for matrix in course_placement() {
        render.gz_push_matrix(&matrix)?;
    }

    // GzPutTriangle, GzRaytracing, GzFlushDisplay2File
    for tri in &mesh.triangles {
        let positions = tri.position.map(|k| mesh.positions[k as usize]);
        let normals = tri.normal.ok_or("the mesh has no normals")?.map(|k| mesh.normals[k as usize]);
        let uvs = tri.uv.ok_or("the mesh has no texture coordinates")?.map(|k| mesh.uvs[k as usize]);
        render.gz_put_triangle(positions, normals, uvs)?;
    }
    render.gz_ray_trace()?;
    let path = std::env::args().nth(1).unwrap_or_else(|| "out/application5.ppm".to_owned());
    if let Some(folder) = Path::new(&path).parent() {
        std::fs::create_dir_all(folder)?;
    }
    let mut file = Vec::new();
    render.gz_flush_display_to_file(&mut file)?;
    std::fs::write(&path, file)?;
    println!("{path}");
    Ok(())
}
