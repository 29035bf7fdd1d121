#!/usr/bin/env python3
"""Writes metamers.json: squares with a disc that vanishes in daylight.

    python3 make_metamers.py path/to/metamer

`metamer metamers` makes the pairs of reflectances; this script places them. Two halves of a board, parted by a black
screen, show the same four squares. CIE D65 lights the left half and CIE A the right one.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

bases = [("skin", "colorchecker.light_skin"), ("leaf", "colorchecker.foliage"),
         ("flower", "colorchecker.blue_flower"), ("grey", "0.25")]
places = [(-0.5, 0.52), (0.5, 0.52), (-0.5, -0.52), (0.5, -0.52)]  # of the squares, in a half, metres
halves = [("daylight", -1.05, "D65"), ("bulb", 1.05, "A")]
side, radius = 0.84, 0.27

head = """// Metamers. Every square carries a disc of another paint. In the left half, lit by CIE D65, square and disc have the
// same colour for the CIE 1931 observer, and no disc is to be seen; in the right half the same paints are lit by CIE A.
// Made by make_metamers.py; the spectra are those of `metamer metamers`.
"""


def pair_of(program, name, base):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "pair.json")
        subprocess.run([program, "metamers", base, "-o", path], check=True, stdout=subprocess.DEVNULL)
        spectra = list(json.loads(path.read_text())["spectra"].values())
    return {f"{name} square": spectra[0], f"{name} disc": spectra[1]}


def number(x):
    return f"{x:.10g}"


def table_text(spectrum):
    rows = [f"[{number(nm)}, {number(value)}]" for nm, value in spectrum["table"]]
    lines = [", ".join(rows[i:i + 5]) for i in range(0, len(rows), 5)]
    return '{ "table": [\n        ' + ",\n        ".join(lines) + "\n      ] }"


def entities():
    yield """{
      "name": "eye",
      "transform": { "look_at": { "from": [0, 0, 9], "to": [0, 0, 0] } },
      "camera": { "type": "perspective", "fov": 14.2 }
    }"""
    yield """{
      "name": "screen between the halves",
      "transform": [{ "rotate": { "axis": [0, 1, 0], "degrees": 90 } }, { "translate": [0, 0, 4] }],
      "geometry": { "type": "rectangle", "width": 8, "depth": 16 },
      "material": "black"
    }"""
    yield """{
      "name": "board",
      "geometry": { "type": "rectangle", "width": 6, "depth": 4 },
      "material": "board paint"
    }"""
    for half, x, lamp in halves:
        yield f"""{{
      "name": "{half}",
      "transform": {{ "look_at": {{ "from": [{2 * x}, 3, 6], "to": [{x}, 0, 0] }} }},
      "geometry": {{ "type": "rectangle", "width": 1.6, "depth": 1.6, "flip_normal": true }},
      "material": "black",
      "light": {{ "type": "area", "luminance": 62, "spectrum": "{lamp}" }}
    }}"""
        for (name, _), (px, py) in zip(bases, places):
            yield f"""{{
      "name": "{name} square in {half}",
      "transform": {{ "translate": [{number(x + px)}, {py}, 0.0002] }},
      "geometry": {{ "type": "rectangle", "width": {side}, "depth": {side} }},
      "material": "{name} square"
    }}"""
            yield f"""{{
      "name": "{name} disc in {half}",
      "transform": {{ "translate": [{number(x + px)}, {py}, 0.0004] }},
      "geometry": {{ "type": "disk", "radius": {radius} }},
      "material": "{name} disc"
    }}"""


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2] / "build/metamer"
    spectra = {}
    for name, base in bases:
        spectra.update(pair_of(program, name, base))
    paints = ['"black": { "type": "diffuse", "reflectance": 0 }', '"board paint": { "type": "diffuse", "reflectance": 0.1 }']
    paints += [f'"{name}": {{ "type": "diffuse", "reflectance": "{name}" }}' for name in spectra]
    tables = [f'"{name}": {table_text(spectrum)}' for name, spectrum in spectra.items()]
    text = head + """{
  "$schema": "../native/metamer-scene.schema.json",
  "metamer": 1,
  "settings": {
    "size": [640, 340],
    "samples": 256,
    "max_depth": 2
  },
  "spectra": {
    """ + ",\n    ".join(tables) + """
  },
  "materials": {
    """ + ",\n    ".join(paints) + """
  },
  "entities": [
    """ + ",\n    ".join(entities()) + """
  ]
}
"""
    Path(__file__).with_name("metamers.json").write_text(text)


if __name__ == "__main__":
    main()
