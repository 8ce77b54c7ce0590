//! `[[mesh]]`: where its triangles come from, how it is placed, what it is made of, and which triangles are changed.

use super::inline;
use super::keys::{MeshKeys, OverrideKeys, PlaceKeys, TeapotKeys};
use super::own_material::own_materials;
use super::part::{AppColor, Change, Part, PartMaterials, unit};
use super::source::{Absent, Finder, is_course_data};
use super::surfaces::{MaterialNames, Palette, named};
use super::values::OneOrMany;
use super::words::NormalsRule;
use super::{asc, obj};
use crate::error::LoadError;
use crate::mesh::Mesh;
use crate::teapot;
use gz_core::{CameraModel, GzMatrix, MatrixStack};
use gz_shade::Surface;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// The finest teapot: 10 million triangles.
const MAX_SEGMENTS: i64 = 400;

/// Reads the meshes of a scene.
pub(super) struct Entries<'a> {
    pub(super) finder: Finder<'a>,
    pub(super) names: &'a MaterialNames,
    pub(super) model: CameraModel,
    pub(super) palette: &'a mut Palette,
    pub(super) warnings: &'a mut Vec<String>,
}

/// A `[[mesh]]` or an `or` of one, with what it takes over from the mesh it stands in for.
#[derive(Clone, Copy)]
struct Entry<'k> {
    keys: &'k MeshKeys,
    stands_for: Option<&'k MeshKeys>,
}

impl<'k> Entry<'k> {
    fn inherited<T>(self, key: impl Fn(&'k MeshKeys) -> Option<T>) -> Option<T> {
        key(self.keys).or_else(|| self.stands_for.and_then(key))
    }
}

impl Entries<'_> {
    /// The parts that the entries of a scene make, in their order.
    pub(super) fn parts(&mut self, meshes: &[Spanned<MeshKeys>]) -> Result<Vec<Part>, LoadError> {
        let mut parts = Vec::with_capacity(meshes.len());
        for mesh in meshes {
            let (keys, span) = (mesh.get_ref(), mesh.span());
            match (self.source(keys, &span), &keys.or) {
                (Ok(source), _) => parts.push(self.part(Entry { keys, stands_for: None }, &span, source)?),
                (Err(Absent { error, is_course_data: true }), Some(or)) => {
                    self.warnings.push(format!("{error}; its stand-in is used"));
                    self.stand_ins(keys, or, &mut parts)?;
                }
                (Err(absent), _) => return Err(absent.error),
            }
        }
        Ok(parts)
    }

    /// The parts that stand in for the mesh of `keys`.
    fn stand_ins(&mut self, keys: &MeshKeys, or: &Spanned<OneOrMany<MeshKeys>>, parts: &mut Vec<Part>) -> Result<(), LoadError> {
        let stand_ins: Vec<(&MeshKeys, Range<usize>)> = match or.get_ref() {
            OneOrMany::One(one) => vec![(one, or.span())],
            OneOrMany::Many(many) => many.iter().map(|one| (one.get_ref(), one.span())).collect(),
        };
        for (stand_in, span) in stand_ins {
            if let Some(or) = &stand_in.or {
                return Err(self.finder.text.error(or.span(), "a stand-in cannot have one itself"));
            }
            let source = self.source(stand_in, &span).map_err(|absent| absent.error)?;
            parts.push(self.part(Entry { keys: stand_in, stands_for: Some(keys) }, &span, source)?);
        }
        Ok(())
    }

    /// The mesh of an entry and its name.
    fn source(&mut self, keys: &MeshKeys, span: &Range<usize>) -> Result<Loaded, Absent> {
        let text = self.finder.text;
        if let Some(or) = &keys.or
            && !keys.file.as_ref().is_some_and(|file| is_course_data(file.get_ref()))
        {
            return Err(text.error(or.span(), "or stands in for course data: file must begin with hw:").into());
        }
        let mesh = match (&keys.file, &keys.teapot, &keys.quad, &keys.triangles) {
            (Some(file), None, None, None) => {
                let path = self.finder.find(file)?;
                let mut mesh = load_mesh(&path, || text.error(file.span(), unknown_kind(file.get_ref())))?;
                self.warnings.append(&mut mesh.warnings);
                return Ok(Loaded { mesh, label: path.display().to_string(), path: Some(path) });
            }
            (None, Some(teapot), None, None) => self.teapot(teapot.get_ref())?,
            (None, None, Some(corners), None) => inline::quad(corners),
            (None, None, None, Some(triangles)) => inline::triangles(triangles),
            (None, None, None, None) => {
                return Err(text.error(span.clone(), "a mesh needs file, teapot, quad or triangles").into());
            }
            _ => return Err(text.error(span.clone(), "a mesh has only one of file, teapot, quad and triangles").into()),
        };
        let label = format!("{}:{}", text.path.display(), text.line(span.start));
        Ok(Loaded { mesh, label, path: None })
    }

    fn teapot(&self, keys: &TeapotKeys) -> Result<Mesh, LoadError> {
        let given = *keys.segments.get_ref();
        let segments = u32::try_from(given).ok().filter(|_| (1..=MAX_SEGMENTS).contains(&given)).ok_or_else(|| {
            self.finder.text.error(keys.segments.span(), format!("segments must be 1 to {MAX_SEGMENTS}, not {given}"))
        })?;
        Ok(teapot::tessellate(segments, keys.bottom.unwrap_or(true)))
    }

    fn part(&mut self, entry: Entry<'_>, span: &Range<usize>, loaded: Loaded) -> Result<Part, LoadError> {
        let text = self.finder.text;
        let app_color = entry.inherited(|keys| keys.app_color);
        let materials = match entry.inherited(|keys| keys.material.as_ref()) {
            Some(name) => PartMaterials::Given(named(&self.finder, self.names, name)?),
            None => {
                let path = loaded.path.as_deref().unwrap_or(text.path);
                let by_mesh = own_materials(self.palette, &loaded.mesh, path, self.warnings)?;
                let surface = if app_color.is_some() { Surface::AppColor } else { Surface::Shaded };
                let fallback = self.palette.fallback(surface).map_err(|why| text.error(span.clone(), why))?;
                PartMaterials::Own { by_mesh, fallback }
            }
        };
        let crease = match entry.inherited(|keys| keys.crease.as_ref()) {
            None => None,
            Some(angle) if (0.0..=180.0).contains(&angle.get_ref().0) => Some(angle.get_ref().0),
            Some(angle) => {
                let message = format!("crease must be 0 to 180 degrees, not {}", angle.get_ref().0);
                return Err(text.error(angle.span(), message));
            }
        };
        let place = entry.inherited(|keys| keys.place.as_deref()).unwrap_or_default();
        let world_from_model = self.placement(place, span)?;
        let changes = self.changes(&entry.keys.overrides, loaded.mesh.triangles.len())?;
        Ok(Part {
            mesh: loaded.mesh,
            path: text.path.to_owned(),
            line: Some(text.line(span.start)),
            label: loaded.label,
            world_from_model,
            normals: entry.inherited(|keys| keys.normals).map_or(NormalsRule::File, |word| word.0),
            crease,
            materials,
            app_color: app_color.map(|keys| AppColor { direction: keys.direction.0, color: keys.color.0 }),
            changes,
        })
    }

    /// The product of the steps, the last listed acting first.
    fn placement(&self, steps: &[Spanned<PlaceKeys>], mesh: &Range<usize>) -> Result<GzMatrix, LoadError> {
        let text = self.finder.text;
        let mut stack = MatrixStack::new();
        for step in steps {
            let matrix = step_matrix(step.get_ref()).map_err(|why| text.error(step.span(), why))?;
            if matrix.det3() == 0.0 {
                return Err(text.error(step.span(), "this step makes the mesh flat: it is singular"));
            }
            stack.push(&matrix).map_err(|why| text.error(step.span(), why.to_string()))?;
        }
        let matrix = stack.world_from_model();
        // Steps that are each sound can still leave the range of f64 together.
        if !matrix.is_finite() || matrix.det3() == 0.0 || !matrix.det3().is_finite() {
            return Err(text.error(mesh.clone(), "the steps of place together leave the range of f64"));
        }
        Ok(matrix)
    }

    fn changes(&self, overrides: &[Spanned<OverrideKeys>], triangles: usize) -> Result<BTreeMap<usize, Change>, LoadError> {
        let text = self.finder.text;
        let mut changes = BTreeMap::new();
        for keys in overrides.iter().map(Spanned::get_ref) {
            let given = *keys.triangle.get_ref();
            let Some(tri) = usize::try_from(given).ok().filter(|&tri| tri < triangles) else {
                let message = format!("triangle {given} does not exist: the mesh has {triangles}, counted from 0");
                return Err(text.error(keys.triangle.span(), message));
            };
            let image_space = matches!(self.model, CameraModel::Homework | CameraModel::Paper);
            let in_image_space = keys.image_vertices.as_ref().map(Spanned::span).or(keys.normal.as_ref().map(Spanned::span));
            if let Some(span) = in_image_space.filter(|_| !image_space) {
                return Err(text.error(span, "image_vertices and normal need the camera model homework or paper"));
            }
            let normal = match &keys.normal {
                None => None,
                Some(normal) => {
                    let direction = unit(normal.get_ref().0);
                    Some(direction.ok_or_else(|| text.error(normal.span(), "a normal must not be zero"))?)
                }
            };
            let change = Change {
                image_vertices: keys.image_vertices.as_ref().map(|corners| corners.get_ref().map(|p| p.0.as_vec3())),
                normal,
                material: keys.material.as_ref().map(|name| named(&self.finder, self.names, name)).transpose()?,
            };
            if changes.insert(tri, change).is_some() {
                return Err(text.error(keys.triangle.span(), format!("triangle {tri} is overridden twice")));
            }
        }
        Ok(changes)
    }
}

/// A mesh with its file, if it has one, and its name in warnings.
struct Loaded {
    mesh: Mesh,
    label: String,
    path: Option<PathBuf>,
}

/// Loads an `.obj` or `.asc` file; `other` makes the error for anything else.
pub(super) fn load_mesh(path: &Path, other: impl Fn() -> LoadError) -> Result<Mesh, LoadError> {
    match extension(path).as_str() {
        "obj" => obj::load(path),
        "asc" => asc::load(path),
        _ => Err(other()),
    }
}

/// The extension of a path in lower case, empty when it has none.
pub(super) fn extension(path: &Path) -> String {
    path.extension().map_or_else(String::new, |ext| ext.to_string_lossy().to_ascii_lowercase())
}

fn unknown_kind(name: &str) -> String {
    format!("\"{name}\" is not a mesh that can be read: .obj and .asc can")
}

fn step_matrix(keys: &PlaceKeys) -> Result<GzMatrix, &'static str> {
    let given = [
        keys.scale.map(|by| GzMatrix::scale(by.xyz())),
        keys.rotate_x.map(|angle| GzMatrix::rotate_x(angle.0)),
        keys.rotate_y.map(|angle| GzMatrix::rotate_y(angle.0)),
        keys.rotate_z.map(|angle| GzMatrix::rotate_z(angle.0)),
        keys.translate.map(|by| GzMatrix::translate(by.0)),
        keys.matrix.map(|rows| GzMatrix(rows.map(|row| row.map(|entry| entry.0)))),
    ];
    let mut steps = given.into_iter().flatten();
    let (Some(matrix), None) = (steps.next(), steps.next()) else {
        return Err("a step of place is one of scale, rotate_x, rotate_y, rotate_z, translate and matrix");
    };
    if matrix.0[3] != [0.0, 0.0, 0.0, 1.0] {
        return Err("the last row of matrix must be 0, 0, 0, 1");
    }
    Ok(matrix)
}
