#!/usr/bin/env python3
"""Writes tumbler-glass.ply, tumbler-water.ply and tea-body.ply, the bodies of revolution of tumbler.json and tea.json: a
drinking glass, water that reaches half into its wall, and what is within both. Lengths in centimetres, y up."""
import math
import pathlib

SEGMENTS = 96
FLOOR, WALL, HEIGHT, LEVEL = 0.8, 0.25, 10, 7.8


def outer(y):
    """Radius of the outside at height y: a little wider above."""
    return 3.2 + 0.06 * y


def revolve(profile):
    """A closed profile [(r, y), ...] from axis to axis, the outside on its right. Every edge is a band of its own, with
    the normals of a cone, so that its rims are sharp."""
    vertices, faces = [], []
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        length = math.hypot(r1 - r0, y1 - y0)
        nr, ny = (y1 - y0) / length, (r0 - r1) / length
        base = len(vertices)
        for k in range(SEGMENTS):
            c, s = math.cos(2 * math.pi * k / SEGMENTS), math.sin(2 * math.pi * k / SEGMENTS)
            for r, y in ((r0, y0), (r1, y1)):
                vertices.append((r * c, y, -r * s, nr * c, ny, -nr * s))
        for k in range(SEGMENTS):
            a, b = base + 2 * k, base + 2 * ((k + 1) % SEGMENTS)
            if r0 > 0:
                faces.append((a, b, b + 1) if r1 == 0 else (a, b, a + 1))
            if r1 > 0:
                faces.append((a, b + 1, a + 1) if r0 == 0 else (b, b + 1, a + 1))
    return vertices, faces


def write(name, profile):
    vertices, faces = revolve(profile)
    lines = ["ply", "format ascii 1.0", "comment written by make_tumbler.py", f"element vertex {len(vertices)}"]
    lines += [f"property float {p}" for p in ("x", "y", "z", "nx", "ny", "nz")]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(f"{x:.6g}" for x in vertex) for vertex in vertices]
    lines += [f"3 {a} {b} {c}" for a, b, c in faces]
    (pathlib.Path(__file__).parent / name).write_text("\n".join(lines) + "\n")


def inner(y):
    return outer(y) - WALL


write(
    "tumbler-glass.ply",
    [(0, 0), (outer(0), 0), (outer(HEIGHT), HEIGHT), (inner(HEIGHT), HEIGHT), (inner(FLOOR), FLOOR), (0, FLOOR)],
)
middle = WALL / 2
write("tumbler-water.ply", [(0, FLOOR / 2), (inner(FLOOR) + middle, FLOOR / 2), (inner(LEVEL) + middle, LEVEL), (0, LEVEL)])
gap = 0.002
write(
    "tea-body.ply",
    [(0, FLOOR + gap), (inner(FLOOR) - gap, FLOOR + gap), (inner(LEVEL) - gap, LEVEL - gap), (0, LEVEL - gap)],
)
