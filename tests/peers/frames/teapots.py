#!/usr/bin/env python3
"""The scene of teapots.toml in Mitsuba 3: teapots.py FOLDER THREADS SIDE DEPTH, where FOLDER holds matte.ply and glass.ply.

Renders twice, writes FOLDER/mitsuba.png and prints the seconds of the second frame. Mitsuba has no Whitted integrator: `path`, to the same
depth and with one sample a pixel, asks for one shadow ray a hit, to a light taken by chance, takes reflection or refraction by chance at
glass and at the floor, and follows one ray more from every diffuse hit. So its picture is noisier, and its rays are fewer.
"""
import math
import os
import sys
import time

import mitsuba as mi

folder, (threads, side, depth) = sys.argv[1], map(int, sys.argv[2:])
mi.set_variant('scalar_rgb')
import drjit as dr
dr.set_thread_count(threads)
mi.logger().set_log_level(mi.LogLevel.Error)


def light(direction, strength):
    # A colour of 1 is what a white surface shows that faces the light.
    return {'type': 'directional', 'direction': [-x for x in direction],
            'irradiance': {'type': 'rgb', 'value': strength * math.pi}}


def teapot(name, surface):
    return {'type': 'ply', 'filename': os.path.join(folder, name), 'face_normals': True, 'bsdf': surface}


def colour(value):
    return {'type': 'rgb', 'value': value}


up = mi.ScalarTransform4f().rotate([1, 0, 0], -90)
scene = mi.load_dict({
    'type': 'scene',
    # To it the camera's ray and the light at the last hit are a step each.
    'integrator': {'type': 'path', 'max_depth': depth + 2, 'rr_depth': 100},
    'sensor': {
        'type': 'perspective', 'fov': 42,
        'to_world': mi.ScalarTransform4f().look_at(origin=[4.2, 5.2, 9.5], target=[0.6, 0.4, -0.3], up=[0, 1, 0]),
        'film': {'type': 'hdrfilm', 'width': side, 'height': side, 'rfilter': {'type': 'box'}},
        'sampler': {'type': 'independent', 'sample_count': 1},
    },
    'key': light([0.45, 0.8, 0.35], 0.6),
    'fill': light([-0.6, 0.7, 0.3], 0.35),
    'rim': light([0.1, 0.7, -0.7], 0.25),
    'sky': {'type': 'constant', 'radiance': colour([0.35, 0.5, 0.75])},
    'matte': teapot('matte.ply', {'type': 'twosided', 'bsdf': {'type': 'diffuse', 'reflectance': colour([0.64, 0.36, 0.16])}}),
    'glass': teapot('glass.ply', {'type': 'dielectric', 'int_ior': 1.5, 'specular_transmittance': colour([0.855, 0.9, 0.873])}),
    'floor': {
        'type': 'rectangle',
        'to_world': mi.ScalarTransform4f().translate([0, -0.001, 0]) @ up.scale(100),
        'bsdf': {'type': 'blendbsdf', 'weight': 0.5, 'a': {'type': 'diffuse', 'reflectance': colour(0.6)},
                 'b': {'type': 'conductor', 'material': 'none'}},
    },
})
seconds = []
for seed in range(2):
    start = time.perf_counter()
    picture = mi.render(scene, spp=1, seed=seed)
    dr.eval(picture)
    dr.sync_thread()
    seconds.append(time.perf_counter() - start)
mi.util.write_bitmap(os.path.join(folder, 'mitsuba.png'), picture)
print('trace', seconds[1])
