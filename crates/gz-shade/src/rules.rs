//! The rules of shading: physics by default, the course's and the paper's by name.

use gz_core::LeavePolicy;

/// How colours are computed, where the course, the paper and physics differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadeRules {
    /// Mirror and glass bounces after the primary ray, 0 to 32. At the limit a hit keeps its local colour.
    pub depth: u32,
    /// The reflected share at glass and at mirrors with an index.
    pub fresnel: Fresnel,
    /// What shadow rays do.
    pub shadow: ShadowRule,
    /// Samples a pixel.
    pub antialias: Antialias,
    /// Where the viewer is, for highlights.
    pub eye: Eye,
    /// Local colours are clamped to [0, 1] at each level, as the course does.
    pub clamp_levels: bool,
    /// Gouraud colours and Phong normals are interpolated linearly in screen space at primary hits, as the homework does.
    pub screen_interpolation: bool,
    /// The triangle itself decides sides: a light on the other side of it than the viewer gives nothing, mirror rays stay on the
    /// viewer's side and glass rays go to the other, and a ray enters glass where corner normals (or the winding) say outside.
    /// Otherwise interpolated normals decide alone, as in the course and in the paper's program.
    pub geometric_sides: bool,
    /// Flat shading takes its colour from the texture too. The course's flat mode ignores textures.
    pub flat_textures: bool,
    /// How a mirror's colour joins the local one.
    pub mirror_blend: MirrorBlend,
    /// How glass joins.
    pub glass_blend: GlassBlend,
    /// The mistakes behind the paper's refraction figure: at a mirror the direction to the last light stands in for the ray's own, in
    /// the reflected share and in the direction d - 2 |d.n| n, in which the normal is not turned against the ray.
    pub reflect_last_light: bool,
    /// How colours are written to a picture.
    pub color_code: ColorCode,
    /// Where shadow, mirror and glass rays start. All but the exact one are for comparison.
    pub leave: LeavePolicy,
}

/// The reflected share at a boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fresnel {
    /// Unpolarised Fresnel equations.
    Exact,
    /// Schlick's approximation, the paper's equations 2 and 3.
    Schlick,
}

/// What shadow rays do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadowRule {
    /// No shadow rays: every light reaches every surface that faces it.
    Off,
    /// Whatever is in the way blocks, glass too (the paper).
    Opaque,
    /// Opaque triangles block, each glass triangle in the way multiplies by its tint.
    Tinted,
}

/// Samples a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Antialias {
    /// One, at the pixel itself.
    None,
    /// HW6's six weighted samples.
    Hw6,
    /// This many samples of equal weight, at least 1.
    Samples(u32),
}

/// Where the viewer is, for highlights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Eye {
    /// Against the ray that sees the surface.
    Ray,
    /// (0, 0, -1) of shading space for every ray: the homework's viewer, infinitely far away.
    Fixed,
}

/// How a mirror's reflected colour joins the local one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MirrorBlend {
    /// local * (1 - R) + tint * R * reflected with R from Fresnel, or R = 1 without an index; a missed ray shows the background.
    Physical,
    /// tint * reflected replaces the local colour; a ray that misses leaves the local one (the paper's demonstration).
    Replace,
    /// local + tint * R * reflected, R without media as in [`GlassBlend::Add`]; a ray that misses adds nothing (the paper's refraction
    /// program).
    Add,
}

/// How the refracted colour joins the local one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlassBlend {
    /// R * reflected + (1 - R) * tint * refracted, on top of the local colour.
    Physical,
    /// local + tint * refracted, nothing reflected; a ray that misses adds nothing, total internal reflection neither (the paper's
    /// refraction program). No media are kept: a ray along the normal goes from air into the glass, one against it comes out, which
    /// is the wrong way round for normals that point outside.
    Add,
}

/// How colours are written to a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorCode {
    /// sRGB, rounded to nearest.
    Srgb,
    /// The course's: c * 4095 cut to 12 bits, the upper 8 kept.
    Course12,
}

impl ShadeRules {
    /// What physics says.
    pub const PHYSICAL: Self = Self {
        depth: 3,
        fresnel: Fresnel::Exact,
        shadow: ShadowRule::Tinted,
        antialias: Antialias::None,
        eye: Eye::Ray,
        clamp_levels: false,
        screen_interpolation: false,
        geometric_sides: true,
        flat_textures: true,
        mirror_blend: MirrorBlend::Physical,
        glass_blend: GlassBlend::Physical,
        reflect_last_light: false,
        color_code: ColorCode::Srgb,
        leave: LeavePolicy::Exact,
    };

    /// What the homework does, HW2 to HW6.
    pub const HOMEWORK: Self = Self {
        shadow: ShadowRule::Off,
        eye: Eye::Fixed,
        clamp_levels: true,
        screen_interpolation: true,
        geometric_sides: false,
        flat_textures: false,
        color_code: ColorCode::Course12,
        ..Self::PHYSICAL
    };

    /// What the paper's program does, minus its mistakes.
    pub const PAPER: Self = Self {
        shadow: ShadowRule::Opaque,
        clamp_levels: true,
        geometric_sides: false,
        flat_textures: false,
        mirror_blend: MirrorBlend::Replace,
        glass_blend: GlassBlend::Add,
        color_code: ColorCode::Course12,
        ..Self::PHYSICAL
    };
}
