#!/usr/bin/python3
"""Renders one cloud with metamer and with Cycles, on the processor: time, means and both pictures.

usage: bench/cloud_against_cycles.py CLOUD.vdb [--metamer build/metamer] [--blender blender] [--size 320x240] [--spp 64]
                                     [--threads N] [--max-depth 64] [--scale 40] [--folder .]

CLOUD.vdb holds a grid "density" with z up, as scenes/library/cloud.vdb. Both
renderers get the same file, camera, sun (half a degree wide), even sky, scale of density, albedo of 1, g of 0.5, size,
samples, threads and most scatterings. Cycles marches through volumes in steps of its own choice and renders RGB; metamer follows
free paths on four wavelengths. Times are those of rendering alone, without start and reading; Blender is a Debian
package. Prints the times, their ratio, both mean luminances and the noise of each: the standard deviation between
neighbours, relative to the mean. At equal noise the time would be time * noise^2, whose ratio is printed last.
"""
import argparse
import json
import os
import subprocess
import sys

FROM, TO, FOV_DEG = (2.4, -4.2, 0.9), (0.0, 0.0, 0.5), 32.0
SUN_FROM, SUN_LUX, SUN_DEG, SKY = (3.0, -2.0, 4.0), 20.0, 0.53, 1.0

IN_BLENDER = r"""
import bpy, json, math, sys, time
from mathutils import Vector
o = json.loads(sys.argv[sys.argv.index("--") + 1])
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
bpy.ops.object.volume_import(filepath=o["cloud"])
cloud = bpy.context.object
cloud.matrix_world.identity()
matter = bpy.data.materials.new("cloud")
matter.use_nodes = True
nodes = matter.node_tree.nodes
nodes.clear()
volume, out = nodes.new("ShaderNodeVolumePrincipled"), nodes.new("ShaderNodeOutputMaterial")
volume.inputs["Color"].default_value = (1, 1, 1, 1)
volume.inputs["Density"].default_value = o["scale"]
volume.inputs["Anisotropy"].default_value = 0.5
matter.node_tree.links.new(volume.outputs["Volume"], out.inputs["Volume"])
cloud.data.materials.clear()
cloud.data.materials.append(matter)


def place(data, start, end):
    item = bpy.data.objects.new("item", data)
    item.location = start
    item.rotation_euler = (Vector(end) - Vector(start)).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(item)
    return item


camera = bpy.data.cameras.new("eye")
camera.sensor_fit = "VERTICAL"
camera.angle = math.radians(o["fov_deg"])
scene.camera = place(camera, o["from"], o["to"])
sun = bpy.data.lights.new("sun", "SUN")
sun.energy, sun.angle = o["sun_lux"], math.radians(o["sun_deg"])
place(sun, o["sun_from"], (0, 0, 0))
scene.world = bpy.data.worlds.new("sky")
scene.world.use_nodes = True
background = scene.world.node_tree.nodes["Background"].inputs
background["Color"].default_value, background["Strength"].default_value = (1, 1, 1, 1), o["sky"]
render, cycles = scene.render, scene.cycles
render.engine = "CYCLES"
cycles.device, cycles.samples = "CPU", o["spp"]
cycles.use_adaptive_sampling = cycles.use_denoising = False
cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
cycles.max_bounces = cycles.volume_bounces = o["max_depth"]
cycles.pixel_filter_type = "BOX"
render.resolution_x, render.resolution_y, render.resolution_percentage = o["width"], o["height"], 100
render.threads_mode, render.threads = "FIXED", o["threads"]
render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
render.filepath = o["picture"]
# The first picture, of one sample, loads the volume and compiles the shaders.
cycles.samples = 1
bpy.ops.render.render()
cycles.samples = o["spp"]
start = time.time()
bpy.ops.render.render(write_still=True)
print("SECONDS", time.time() - start)
"""


def metamer_scene(o):
    corners = [[x, y, z] for z in (-0.6, 2) for y in (-2, 2) for x in (-2, 2)]
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return {
        "metamer": 1,
        "settings": {"size": [o["width"], o["height"]], "samples": o["spp"], "max_depth": o["max_depth"],
                     "filter": {"type": "box"}},
        "materials": {"air": {"type": "interface"}},
        "media": {"cloud": {"type": "grid", "albedo": 1, "sigma_t": 1, "scale": o["scale"], "g": 0.5,
                            "density": {"file": o["cloud"], "grid": "density"}}},
        "meshes": {"box": {"positions": corners,
                           "indices": [t for f in faces for t in (f[:3], [f[0], f[2], f[3]])]}},
        "entities": [
            {"camera": {"type": "perspective", "fov": o["fov_deg"]},
             "transform": {"look_at": {"from": o["from"], "to": o["to"], "up": [0, 0, 1]}}},
            {"light": {"type": "directional", "lux": o["sun_lux"], "angular_diameter": o["sun_deg"]},
             "transform": {"look_at": {"from": o["sun_from"], "to": [0, 0, 0], "up": [0, 0, 1]}}},
            {"light": {"type": "environment", "luminance": o["sky"]}},
            {"geometry": {"type": "mesh", "mesh": "box"}, "material": "air", "media": {"inside": "cloud"}},
        ],
    }


def luminance(path):
    import numpy
    import OpenImageIO as oiio
    image = oiio.ImageBuf(path)
    names = list(image.spec().channelnames)
    # Blender's channels may carry the name of their layer.
    channels = [next(i for i, n in enumerate(names) if n == c or n.endswith("." + c)) for c in "RGB"]
    return numpy.asarray(image.get_pixels(oiio.FLOAT), float)[..., channels] @ numpy.array([0.2126, 0.7152, 0.0722])


def noise(y):
    # Of second differences, which a smooth picture does not have; 1 + 4 + 1 parts of the pixels' variance.
    second = y[:, :-2] - 2 * y[:, 1:-1] + y[:, 2:]
    return float((second ** 2).mean() / 6) ** 0.5 / float(y.mean())


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1].removeprefix("usage: "))
    parser.add_argument("cloud")
    parser.add_argument("--metamer", default="build/metamer")
    parser.add_argument("--blender", default="blender")
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--max-depth", type=int, default=64)
    parser.add_argument("--scale", type=float, default=40)
    parser.add_argument("--folder", default=".")
    a = parser.parse_args()
    width, height = (int(n) for n in a.size.split("x"))
    os.makedirs(a.folder, exist_ok=True)
    file_of = lambda name: os.path.abspath(os.path.join(a.folder, name))
    o = {"cloud": os.path.abspath(a.cloud), "width": width, "height": height, "spp": a.spp, "threads": a.threads,
         "max_depth": a.max_depth, "scale": a.scale, "from": FROM, "to": TO, "fov_deg": FOV_DEG, "sun_from": SUN_FROM,
         "sun_lux": SUN_LUX, "sun_deg": SUN_DEG, "sky": SKY, "picture": file_of("cloud-cycles.exr")}
    with open(file_of("cloud.json"), "w") as out:
        json.dump(metamer_scene(o), out, indent=1)
    with open(file_of("cloud-in-blender.py"), "w") as out:
        out.write(IN_BLENDER)

    ours, stats = file_of("cloud-metamer.exr"), file_of("cloud-metamer-stats.json")
    subprocess.run([a.metamer, "render", file_of("cloud.json"), "-q", "-o", ours, "--stats", stats,
                    "--threads", str(a.threads)], check=True)
    with open(stats) as text:
        seconds = {"metamer": json.load(text)["render_seconds"]}
    try:
        done = subprocess.run([a.blender, "-b", "--factory-startup", "--python", file_of("cloud-in-blender.py"), "--",
                               json.dumps(o)], capture_output=True, text=True)
    except FileNotFoundError:
        sys.exit(f"metamer {seconds['metamer']:.2f} s; {a.blender} is not installed, nothing to compare with")
    said = [line for line in done.stdout.splitlines() if line.startswith("SECONDS")]
    if not said:
        sys.exit(f"{a.blender} failed:\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
    seconds["Cycles"] = float(said[0].split()[1])

    pictures = {"metamer": luminance(ours), "Cycles": luminance(o["picture"])}
    cost = {}
    for name, y in pictures.items():
        cost[name] = seconds[name] * noise(y) ** 2
        print(f"{name:8} {seconds[name]:8.2f} s   mean {y.mean():.4f}   noise {noise(y):.4f}")
    print(f"Cycles / metamer: time {seconds['Cycles'] / seconds['metamer']:.2f}, "
          f"time at equal noise {cost['Cycles'] / cost['metamer']:.2f}")


if __name__ == "__main__":
    main()
