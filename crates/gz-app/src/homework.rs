//! The homework's calls by name, on top of the renderer: begin, put, push, pop, ray trace, flush.
//!
//! The course's `GzRender` scan-converted in `GzPutTriangle`; here, as in the paper (its section 2.2.1), that call transforms a
//! triangle and stores it, and one more call, [`GzRender::gz_ray_trace`], makes the picture. Token and value lists become
//! [`GzAttribute`], status codes become errors.

mod attribute;
mod course;

pub use attribute::{GzAttribute, HomeworkError};
pub use course::{course_lights, course_placement};

use crate::display::{DisplayPixel, GzDisplay};
use glam::DVec3;
use gz_core::{
    Attributes, BruteForce, CameraModel, CameraSpec, GzCamera, GzColor, GzCoord, GzMatrix, GzTextureIndex, GzTri, MatrixStack,
    TileGrid, TriBuffer, TriId, View,
};
use gz_shade::color::{course12_channel, course12_intensity};
use gz_shade::{
    Background, FrameStats, GzLight, Interpolate, LightKind, Material, Scene, SceneNeeds, ShadeRules, Surface, Texture,
    shade_frame,
};
use std::io::{self, Write};

/// The course's `MAX_LIGHTS`: directional lights beside the ambient one.
pub const MAX_LIGHTS: usize = 10;

/// The homework's `GzRender`: display, camera, matrix stack, attributes and, since the paper, the triangle buffer.
#[derive(Clone, Debug)]
pub struct GzRender {
    display: GzDisplay,
    background: [i16; 3],
    model: CameraModel,
    rules: ShadeRules,
    view: View,
    camera: Option<GzCamera>,
    stack: MatrixStack,
    lights: Vec<GzLight>,
    ambient: GzColor,
    current: Material,
    color: GzColor,
    materials: Vec<Material>,
    used: Vec<u64>,
    textures: Vec<Texture>,
    tris: TriBuffer,
}

impl GzRender {
    /// A renderer onto `display`, with the course's default camera and material. The homework's `GzNewRender`.
    ///
    /// `model` and `rules` say whose renderer it is: [`CameraModel::Homework`] with [`ShadeRules::HOMEWORK`] for HW3 to HW6,
    /// [`CameraModel::Paper`] with [`ShadeRules::PAPER`] for the paper's.
    pub fn new(display: GzDisplay, model: CameraModel, rules: ShadeRules) -> Self {
        // The course's default camera, that of HW3's and HW4's reference pictures.
        let view = View { position: DVec3::new(-10.0, 5.0, -10.0), look_at: DVec3::ZERO, up: DVec3::Y, fov: 35.0 };
        Self {
            display,
            background: [0; 3],
            model,
            rules,
            view,
            camera: None,
            stack: MatrixStack::new(),
            lights: Vec::new(),
            ambient: GzColor::splat(0.1),
            current: Material { interpolate: Interpolate::Flat, ..Material::default() },
            color: GzColor::ONE,
            materials: Vec::new(),
            used: Vec::new(),
            textures: Vec::new(),
            tris: TriBuffer::with_attributes(Attributes::ALL, 0),
        }
    }

    /// Clears the display to a colour of 12-bit intensities, which is also what a missed ray sees. The homework's `GzDefault`.
    pub fn gz_default(&mut self, red: i16, green: i16, blue: i16) {
        self.background = [red, green, blue];
        self.display.clear(red, green, blue);
    }

    /// Sets the camera; call it before [`Self::gz_begin_render`]. The homework's `GzPutCamera`.
    pub fn gz_put_camera(&mut self, view: View) {
        self.view = view;
    }

    /// Makes the camera's matrices and empties matrix stack and triangle buffer. The homework's `GzBeginRender`.
    ///
    /// # Errors
    ///
    /// If the camera does not define a view.
    pub fn gz_begin_render(&mut self) -> Result<(), HomeworkError> {
        let (width, height) = (u32::from(self.display.width()), u32::from(self.display.height()));
        self.camera = Some(GzCamera::new(CameraSpec { model: self.model, view: Some(self.view), width, height })?);
        self.stack = MatrixStack::new();
        self.tris = TriBuffer::with_attributes(Attributes::ALL, 0);
        (self.materials, self.used) = (Vec::new(), Vec::new());
        Ok(())
    }

    /// Puts a model matrix on the stack; it acts before those pushed earlier. The homework's `GzPushMatrix`.
    ///
    /// # Errors
    ///
    /// If 100 are there already or an entry is not finite.
    pub fn gz_push_matrix(&mut self, matrix: &GzMatrix) -> Result<(), HomeworkError> {
        Ok(self.stack.push(matrix)?)
    }

    /// Takes back the last push. The homework's `GzPopMatrix`.
    ///
    /// # Errors
    ///
    /// If nothing was pushed.
    pub fn gz_pop_matrix(&mut self) -> Result<(), HomeworkError> {
        Ok(self.stack.pop()?)
    }

    /// Sets one attribute for the triangles that follow; lights hold for all. The homework's `GzPutAttribute`.
    ///
    /// # Errors
    ///
    /// If there are ten directional lights already, a light has no direction, or a power is negative.
    pub fn gz_put_attribute(&mut self, attribute: GzAttribute) -> Result<(), HomeworkError> {
        match attribute {
            GzAttribute::RgbColor(color) => {
                self.color = color;
                self.current.surface = Surface::AppColor;
            }
            GzAttribute::Interpolate(mode) => {
                self.current.interpolate = mode;
                self.current.surface = Surface::Shaded;
            }
            GzAttribute::DirectionalLight { direction, color } => {
                if self.lights.len() == MAX_LIGHTS {
                    return Err(HomeworkError::TooManyLights);
                }
                if !direction.is_finite() || direction == DVec3::ZERO {
                    return Err(HomeworkError::LightDirection);
                }
                self.lights.push(GzLight { kind: LightKind::Directional(direction), color });
            }
            GzAttribute::AmbientLight(color) => self.ambient = color,
            GzAttribute::AmbientCoefficient(ka) => self.current.ka = ka,
            GzAttribute::DiffuseCoefficient(kd) => self.current.kd = kd,
            GzAttribute::SpecularCoefficient(ks) => self.current.ks = ks,
            GzAttribute::DistributionCoefficient(power) => {
                if power < 0.0 || power.is_nan() {
                    return Err(HomeworkError::Power);
                }
                self.current.power = power;
            }
            GzAttribute::TextureMap(texture) => self.current.texture = texture.map(|texture| self.texture_number(texture)),
            GzAttribute::Kind(kind) => self.current.kind = kind,
        }
        Ok(())
    }

    /// Sets several attributes in order, as the homework's calls did.
    ///
    /// # Errors
    ///
    /// As [`Self::gz_put_attribute`]; those before the failing one stay set.
    pub fn gz_put_attributes(&mut self, attributes: impl IntoIterator<Item = GzAttribute>) -> Result<(), HomeworkError> {
        attributes.into_iter().try_for_each(|attribute| self.gz_put_attribute(attribute))
    }

    /// Transforms a triangle given in model space and stores it with the current attributes. The homework's `GzPutTriangle` with
    /// `GZ_POSITION`, `GZ_NORMAL` and `GZ_TEXTURE_INDEX`.
    ///
    /// Returns its number; `None` for a triangle with a corner behind the homework's view plane, which is dropped whole.
    ///
    /// # Errors
    ///
    /// If rendering was not begun, a coordinate is not finite, or there are too many triangles or materials.
    pub fn gz_put_triangle(
        &mut self,
        positions: [GzCoord; 3],
        normals: [GzCoord; 3],
        uvs: [GzTextureIndex; 3],
    ) -> Result<Option<TriId>, HomeworkError> {
        let camera = self.camera.as_ref().ok_or(HomeworkError::NotBegun)?;
        let place = self.stack.world_from_model();
        let corners = positions.map(|p| camera.trace_from_world(place.point(p.as_dvec3())));
        let [Some(a), Some(b), Some(c)] = corners else { return Ok(None) };
        let (xnorm, shading) = (self.stack.normal_matrix(), camera.shading_from_world());
        let normal = |n: GzCoord| shading.vector(xnorm.vector(n.as_dvec3())).normalize_or_zero().as_vec3();

        let number = self.material_number()?;
        let tri = GzTri {
            positions: [a, b, c].map(|p| p.as_vec3()),
            normals: normals.map(normal),
            uvs,
            color: self.color,
            material: number,
            class: self.materials[usize::from(number)].class(),
        };
        let id = self.tris.push(&tri)?;
        self.used[usize::from(number)] += 1;
        Ok(Some(id))
    }

    /// Traces the stored triangles and fills the display. The paper's `GzRaytracing`, between the last `GzPutTriangle` and the
    /// flushes. Returns what was traced.
    ///
    /// # Errors
    ///
    /// If rendering was not begun.
    pub fn gz_ray_trace(&mut self) -> Result<FrameStats, HomeworkError> {
        let camera = self.camera.clone().ok_or(HomeworkError::NotBegun)?;
        let default_material = self.materials.is_empty().then(Material::default);
        let scene = Scene {
            tris: std::mem::take(&mut self.tris),
            camera,
            lights: self.lights.clone(),
            ambient: self.ambient,
            background: Background::Plain(self.background.map(|c| course12_channel(u16::try_from(c).unwrap_or(0))).into()),
            used: if default_material.is_some() { vec![0] } else { self.used.clone() },
            materials: default_material.map_or_else(|| self.materials.clone(), |material| vec![material]),
            textures: self.textures.clone(),
            rules: self.rules,
        };
        let grid = TileGrid::whole(u32::from(self.display.width()), u32::from(self.display.height()), 32);
        let frame = shade_frame(&scene, SceneNeeds::of(&scene), &BruteForce::new(&scene.tris), &grid, &|_| ());
        for ((i, j), color) in frame.area.pixels().zip(&frame.colors) {
            // A display has at most 1024 pixels a side and intensities of 12 bits.
            let [red, green, blue] = color.to_array().map(|c| course12_intensity(c) as i16);
            self.display.put(i as i32, j as i32, DisplayPixel::of(red, green, blue));
        }
        self.tris = scene.tris;
        Ok(frame.stats)
    }

    /// What was rendered.
    pub fn display(&self) -> &GzDisplay {
        &self.display
    }

    /// Writes the display as a PPM. The homework's `GzFlushDisplay2File`.
    ///
    /// # Errors
    ///
    /// If `out` cannot be written.
    pub fn gz_flush_display_to_file(&self, out: &mut impl Write) -> io::Result<()> {
        self.display.flush_to_file(out)
    }

    /// The display as bytes for a window, blue first. The homework's `GzFlushDisplay2FrameBuffer`.
    pub fn gz_flush_display_to_framebuffer(&self) -> Vec<u8> {
        self.display.flush_to_framebuffer()
    }

    /// The number of `texture`, which joins the list when it is new.
    fn texture_number(&mut self, texture: Texture) -> usize {
        if let Some(number) = self.textures.iter().position(|known| *known == texture) {
            return number;
        }
        self.textures.push(texture);
        self.textures.len() - 1
    }

    /// The number of the current material, which joins the list when it is new.
    fn material_number(&mut self) -> Result<u16, HomeworkError> {
        // Attributes change rarely: the last material is nearly always the right one.
        let known = self.materials.iter().rposition(|known| *known == self.current);
        let number = u16::try_from(known.unwrap_or(self.materials.len())).map_err(|_| HomeworkError::TooManyMaterials)?;
        if known.is_none() {
            self.materials.push(self.current.clone());
            self.used.push(0);
        }
        Ok(number)
    }
}

#[cfg(test)]
mod tests;
