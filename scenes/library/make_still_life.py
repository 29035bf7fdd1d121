#!/usr/bin/env python3
"""Writes the files of still-life.json beside it: its sky, a torus and a cut diamond. Standard library only.

The sky (still-life-sky.hdr, 128x64, latitude-longitude, z up, linear sRGB) is, for a direction of elevation e and
longitude u in turns,

    ground (e < 0)      (0.05, 0.07, 0.09)
    air    (e >= 0)     lerp((0.62, 0.56, 0.50), (0.16, 0.24, 0.42), sqrt(sin e))
    windows             amplitude * colour * edge(|u - u0| / a) * edge(|e - e0| / b),  edge(x) = 1 / (1 + x^12)

summed, with the two windows of WINDOWS. The diamond is a brilliant with Tolkowsky's proportions (1919): table 0.53 of
the girdle, crown angle 34.5 degrees, pavilion angle 40.75 degrees; its girdle has radius 1.
"""
import math
import os
import struct

HERE = os.path.dirname(os.path.abspath(__file__))
# Longitude u0 in turns (0 is +x, a quarter is +y), half width a in turns, elevation e0 and half height b in degrees.
WINDOWS = [
    {"u0": 0.60, "a": 0.065, "e0": 42, "b": 26, "amplitude": 10, "colour": (1.0, 0.93, 0.82)},
    {"u0": 0.07, "a": 0.030, "e0": 35, "b": 25, "amplitude": 6, "colour": (0.72, 0.86, 1.0)},
]


def edge(x):
    return 1 / (1 + x**12)


def sky(u, elevation):
    s = math.sin(elevation)
    if s < 0:
        colour = [0.05, 0.07, 0.09]
    else:
        t = math.sqrt(s)
        colour = [a + (b - a) * t for a, b in zip((0.62, 0.56, 0.50), (0.16, 0.24, 0.42))]
    for w in WINDOWS:
        du = abs((u - w["u0"] + 0.5) % 1 - 0.5)
        weight = w["amplitude"] * edge(du / w["a"]) * edge(abs(math.degrees(elevation) - w["e0"]) / w["b"])
        colour = [c + weight * k for c, k in zip(colour, w["colour"])]
    return colour


def rgbe(colour):
    mantissa, exponent = math.frexp(max(colour))
    return bytes(int(c * 256 * mantissa / max(colour)) for c in colour) + bytes([exponent + 128])


def write_sky(width=128, height=64):
    with open(os.path.join(HERE, "still-life-sky.hdr"), "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width))
        for row in range(height):
            for column in range(width):
                file.write(rgbe(sky((column + 0.5) / width, math.pi * (0.5 - (row + 0.5) / height))))


def write_ply(name, comment, vertices, with_normals, faces):
    """Binary, little-endian; vertices are tuples of 3 or 6 floats."""
    with open(os.path.join(HERE, name), "wb") as file:
        names = ["x", "y", "z"] + (["nx", "ny", "nz"] if with_normals else [])
        header = ["ply", "format binary_little_endian 1.0", "comment " + comment, "element vertex %d" % len(vertices)]
        header += ["property float " + n for n in names]
        header += ["element face %d" % len(faces), "property list uchar ushort vertex_indices", "end_header", ""]
        file.write("\n".join(header).encode())
        for v in vertices:
            file.write(struct.pack("<%df" % len(v), *v))
        for f in faces:
            file.write(struct.pack("<B%dH" % len(f), len(f), *f))


def write_torus(major=1.0, minor=0.36, around=64, across=32):
    """Around the y axis."""
    vertices, faces = [], []
    for i in range(around):
        a = 2 * math.pi * i / around
        for j in range(across):
            b = 2 * math.pi * j / across
            normal = (math.cos(a) * math.cos(b), math.sin(b), math.sin(a) * math.cos(b))
            centre = (major * math.cos(a), 0, major * math.sin(a))
            vertices.append(tuple(c + minor * n for c, n in zip(centre, normal)) + normal)
            i1, j1 = (i + 1) % around, (j + 1) % across
            faces.append([i * across + j, i * across + j1, i1 * across + j1, i1 * across + j])
    write_ply("still-life-torus.ply", "torus, radii 1 and 0.36", vertices, True, faces)


def write_diamond():
    """Axis y, culet below; eight table corners, twice sixteen girdle corners, the culet."""
    ring = lambda n, radius, y: [
        (radius * math.cos(2 * math.pi * k / n), y, -radius * math.sin(2 * math.pi * k / n)) for k in range(n)
    ]
    girdle = 0.03
    crown = girdle + (1 - 0.53) * math.tan(math.radians(34.5))
    vertices = ring(8, 0.53, crown) + ring(16, 1, girdle) + ring(16, 1, 0)
    vertices.append((0, -math.tan(math.radians(40.75)), 0))
    upper, lower, culet = 8, 24, 40
    faces = [list(range(8))]
    for k in range(8):
        before, at, after = upper + (2 * k - 1) % 16, upper + 2 * k, upper + (2 * k + 1) % 16
        faces += [[k, before, at], [k, at, after], [k, after, (k + 1) % 8]]
    for k in range(16):
        k1 = (k + 1) % 16
        faces += [[lower + k, lower + k1, upper + k1, upper + k], [lower + k1, lower + k, culet]]
    write_ply("still-life-diamond.ply", "brilliant, girdle radius 1", vertices, False, faces)


if __name__ == "__main__":
    write_sky()
    write_torus()
    write_diamond()
