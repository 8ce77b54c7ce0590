//! A pixel told to programs. Numbers are in full; what is infinite or missing is null.

use super::facts::{Facts, bits};
use super::text::kind;
use super::walk::{Place, Tried, name};
use crate::{args, output};
use gz_bsp::VisitCount;
use gz_core::glam::DVec3;
use gz_core::{GzColor, GzRay, Hit};
use gz_shade::{ExplainNode, LightPart, Sight};
use serde_json::{Value, json};

impl Facts<'_> {
    /// All of it.
    pub(super) fn json(&self) -> Value {
        let colors: Vec<Value> = self.frame.colors.iter().map(|&c| color(c)).collect();
        let byte = |channel| output::byte(channel, self.scene.rules.color_code);
        let bytes: Vec<[u8; 3]> = self.frame.colors.iter().map(|c| c.to_array().map(byte)).collect();
        json!({
            "pixel": [self.x, self.y],
            "camera": args::camera_name(self.scene.camera.model()),
            "ray": ray(&self.ray),
            "hit": self.hit_json(&self.hit),
            "compare": self.compared.map(|(other, hit)| json!({
                "with": other,
                "same_bits": self.agrees(),
                "hit": self.hit_json(&hit),
            })),
            "visits": self.visits.as_ref().map(visits),
            "walk": self.places.iter().map(place).collect::<Vec<_>>(),
            "tested": self.tried.iter().map(tried).collect::<Vec<_>>(),
            "on_ray": self.on_ray.iter().map(|hit| self.hit_json(hit)).collect::<Vec<_>>(),
            "rays": (0..self.nodes.len()).map(|k| self.node(k)).collect::<Vec<_>>(),
            "color": colors.first(),
            "bytes": bytes.first(),
        })
    }

    fn node(&self, k: usize) -> Value {
        let ExplainNode { sample, sample_weight, parent, depth, keep, .. } = self.nodes[k];
        let node = &self.nodes[k];
        json!({
            "sample": sample,
            "sample_weight": sample_weight,
            "parent": parent,
            "kind": kind(node.kind),
            "depth": depth,
            "ray": ray(&node.ray),
            "hit": self.hit_json(&node.hit),
            "visits": self.walks[k].as_ref().map(visits),
            "factor": color(node.factor),
            "share": color(self.shares[k]),
            "ambient": color(node.ambient),
            "lights": node.lights.iter().map(|part| self.light(part)).collect::<Vec<_>>(),
            "local": color(node.local),
            "keep": keep,
            "color": color(node.color),
        })
    }

    fn light(&self, part: &LightPart) -> Value {
        let (sight, cast) = match part.sight {
            Sight::Behind => ("behind", None),
            Sight::Nothing => ("nothing", None),
            Sight::InPlane => ("in_plane", None),
            Sight::Unasked => ("unasked", None),
            Sight::Cast { ray, share, blocker } => ("cast", Some((ray, share, blocker))),
        };
        let shadow = cast.map(|(ray, share, blocker)| {
            json!({
                "origin": point(ray.origin),
                "direction": point(ray.direction.as_dvec3()),
                "tmax": ray.tmax,
                "share": color(share),
                "blocker": self.hit_json(&blocker),
            })
        });
        json!({ "light": part.light, "color": color(part.color), "sight": sight, "shadow_ray": shadow })
    }

    fn hit_json(&self, hit: &Hit) -> Value {
        if !hit.is_hit() {
            return Value::Null;
        }
        let [t, _, u, v] = bits(hit).map(|bits| format!("{bits:08x}"));
        json!({
            "triangle": hit.tri,
            "material": self.material(hit),
            "t": hit.t,
            "u": hit.u,
            "v": hit.v,
            "bits": [t, u, v],
            "point": point(self.point(hit)),
        })
    }
}

fn place(place: &Place) -> Value {
    let step = &place.step;
    let (min, max) = (step.bounds.min.as_dvec3(), step.bounds.max.as_dvec3());
    let triangles = step.triangles.as_ref().map(|_| place.tried.iter().map(tried).collect::<Vec<_>>());
    json!({
        "number": step.number,
        "enter": step.enter,
        "leave": step.leave,
        "min": point(min),
        "max": point(max),
        "triangles": triangles,
    })
}

fn tried(it: &Tried) -> Value {
    json!({ "triangle": it.tri, "t": it.t, "by": it.by.map(name) })
}

fn visits(visits: &VisitCount) -> Value {
    let VisitCount { nodes, leaves, groups, tests, .. } = *visits;
    json!({ "nodes": nodes, "leaves": leaves, "groups": groups, "tests": tests })
}

fn ray(ray: &GzRay) -> Value {
    let (origin, direction) = (point(ray.origin), point(ray.direction.as_dvec3()));
    json!({ "origin": origin, "direction": direction, "tmin": ray.tmin, "tmax": ray.tmax })
}

fn point(of: DVec3) -> Value {
    json!(of.to_array())
}

fn color(of: GzColor) -> Value {
    json!(of.to_array())
}
