#!/usr/bin/env python3
"""Writes docs/pictures/fresnel-gold-copper.svg: F(theta) of gold and copper at 611, 549 and 464 nm.

    python3 scenes/library/plot_fresnel.py

Reads the measured n and kappa that metamer itself uses and evaluates Fresnel's equations for unpolarised light
on a boundary between air and a medium of index n + i kappa (Born & Wolf, Principles of Optics, section 14.2).
"""
import cmath
import math
import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
WAVELENGTHS = ((611, "#c62b20"), (549, "#2b8a2b"), (464, "#2850c8"))  # nm, colour of the curve
METALS = (("Au", "gold", ""), ("Cu", "copper", "6 4"))  # name, label, dashes

LEFT, TOP, WIDTH, HEIGHT = 60, 20, 540, 340


def index_of(metal):
    rows = []
    for line in (ROOT / "engine/spectrum/data/nk" / f"{metal}.csv").read_text().splitlines():
        if line and line[0].isdigit():
            rows.append([float(x) for x in line.split(",")])
    return rows


def interpolated(rows, nm):
    for (x0, n0, k0), (x1, n1, k1) in zip(rows, rows[1:]):
        if x0 <= nm <= x1:
            t = (nm - x0) / (x1 - x0)
            return complex(n0 + t * (n1 - n0), k0 + t * (k1 - k0))
    raise ValueError(f"{nm} nm is outside the table")


def fresnel(index, degrees):
    c = math.cos(math.radians(degrees))
    transmitted = cmath.sqrt(index * index - (1 - c * c))  # index times the cosine inside
    r_s = (c - transmitted) / (c + transmitted)
    r_p = (index * index * c - transmitted) / (index * index * c + transmitted)
    return (abs(r_s) ** 2 + abs(r_p) ** 2) / 2


def x_of(degrees):
    return LEFT + WIDTH * degrees / 90


def y_of(reflectance):
    return TOP + HEIGHT * (1 - reflectance)


def axes():
    for degrees in range(0, 91, 15):
        x = x_of(degrees)
        yield f'<line x1="{x:.1f}" y1="{TOP}" x2="{x:.1f}" y2="{TOP + HEIGHT}" stroke="#ddd"/>'
        yield f'<text x="{x:.1f}" y="{TOP + HEIGHT + 18}" text-anchor="middle">{degrees}°</text>'
    for tenths in range(0, 11, 2):
        y = y_of(tenths / 10)
        yield f'<line x1="{LEFT}" y1="{y:.1f}" x2="{LEFT + WIDTH}" y2="{y:.1f}" stroke="#ddd"/>'
        yield f'<text x="{LEFT - 8}" y="{y + 4:.1f}" text-anchor="end">{tenths / 10:.1f}</text>'
    yield f'<text x="{LEFT + WIDTH / 2}" y="{TOP + HEIGHT + 38}" text-anchor="middle">theta</text>'
    yield f'<text x="16" y="{TOP + HEIGHT / 2}" text-anchor="middle" transform="rotate(-90 16 {TOP + HEIGHT / 2})">F</text>'


def curves():
    legend = TOP + HEIGHT - 118
    for metal, label, dashes in METALS:
        rows = index_of(metal)
        for nm, colour in WAVELENGTHS:
            index = interpolated(rows, nm)
            points = " ".join(f"{x_of(d):.1f},{y_of(fresnel(index, d)):.2f}" for d in range(0, 91))
            style = f'stroke="{colour}" stroke-width="2" stroke-dasharray="{dashes}"'
            yield f'<polyline points="{points}" fill="none" {style}/>'
            yield f'<line x1="{LEFT + 20}" y1="{legend}" x2="{LEFT + 60}" y2="{legend}" {style}/>'
            text = f"{label}, {nm} nm: n = {index.real:.2f}, kappa = {index.imag:.2f}, F(0) = {fresnel(index, 0):.3f}"
            yield f'<text x="{LEFT + 68}" y="{legend + 4}">{text}</text>'
            legend += 19


def main():
    size = f'width="{LEFT + WIDTH + 20}" height="{TOP + HEIGHT + 50}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="sans-serif" font-size="13">'
    lines = [head, '<rect width="100%" height="100%" fill="white"/>', *axes(), *curves(), "</svg>"]
    (ROOT / "docs/pictures/fresnel-gold-copper.svg").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
