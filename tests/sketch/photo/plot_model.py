#!/usr/bin/env python3
"""A picture of a reconstruction by another program's renderer, which stands for a photograph that is not ours.

Matplotlib (its Agg rasteriser) draws the triangles of a model.obj from far to near, each group in a colour of its own, lit
from above, before a green cloth that none of the colours is near to. Then come what a camera adds: a lens that is a little
soft, noise, and JPEG. The drawing is that of the model with its picture moved by two pixels, to the right and upwards.

  geoprior run sketch/bag --out RUN
  python3 tests/sketch/photo/plot_model.py RUN/artifacts/default/refined/model.obj experiments/sketch/bag.svg \
      experiments/sketch/bag-plotted

writes bag-plotted.jpg and bag-plotted.svg. Matplotlib 3.6, NumPy 1.24, Pillow 9.4 (Debian 12).
"""
import re
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from PIL import Image, ImageFilter

PIXELS = 480
BACKGROUND = np.array([0x2C, 0xA0, 0x5A]) / 255
COLOURS = np.array([[0.80, 0.45, 0.25], [0.55, 0.18, 0.16], [0.90, 0.72, 0.48], [0.42, 0.30, 0.50], [0.86, 0.36, 0.30],
                    [0.66, 0.52, 0.62]])
LIGHT = np.array([0.35, 0.8, 0.5]) / np.linalg.norm([0.35, 0.8, 0.5])
LARGEST_EDGE = 0.006  # m


def read_obj(file):
    points, triangles, groups, group = [], [], [], -1
    for line in open(file):
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            points.append([float(x) for x in words[1:4]])
        elif words[0] == "g":
            group += 1
        elif words[0] == "f":
            triangles.append([int(w.split("/")[0]) - 1 for w in words[1:4]])
            groups.append(group)
    return np.array(points)[np.array(triangles)], np.array(groups)


def subdivided(triangles, groups):
    """Halves the longest edges until all are short: painting from far to near then sorts well."""
    while True:
        edges = np.linalg.norm(triangles - np.roll(triangles, -1, axis=1), axis=2)
        long = edges.max(axis=1) > LARGEST_EDGE
        if not long.any():
            return triangles, groups
        kept, split, first = triangles[~long], triangles[long], edges[long].argmax(axis=1)
        rows = np.arange(len(split))
        a, b, c = (split[rows, (first + k) % 3] for k in range(3))
        middle = (a + b) / 2
        halves = [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        groups = np.concatenate([groups[~long], groups[long], groups[long]])
        triangles = np.concatenate([kept] + halves)


def painted(triangles, groups, page):
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    normals[normals[:, 2] < 0] *= -1
    light = 0.55 + 0.45 * np.clip(normals @ LIGHT, 0, 1)
    colours = COLOURS[groups % len(COLOURS)] * light[:, None]
    order = np.argsort(triangles[:, :, 2].mean(axis=1), kind="stable")
    figure = plt.figure(figsize=(PIXELS / 100, PIXELS / 100), dpi=100)
    axes = figure.add_axes([0, 0, 1, 1])
    axes.set_axis_off()
    cloth = BACKGROUND * (1 + 0.06 * np.linspace(1, -1, 64))[:, None, None]
    axes.imshow(np.repeat(cloth, 2, axis=1), extent=[0, page, 0, page], interpolation="bilinear")
    axes.add_collection(
        PolyCollection(triangles[order][:, :, :2], facecolors=colours[order], edgecolors=colours[order], linewidths=0.25))
    axes.set_xlim(0, page)
    axes.set_ylim(0, page)
    figure.canvas.draw()
    return np.asarray(figure.canvas.buffer_rgba())[:, :, :3]


def main(model, drawing, out):
    text = open(drawing).read()
    size = float(re.search(r'width="([0-9.]+)mm"', text).group(1))
    triangles, groups = subdivided(*read_obj(model))
    soft = Image.fromarray(painted(triangles, groups, size / 1000)).filter(ImageFilter.GaussianBlur(0.5))
    noise = np.random.default_rng(1).normal(0, 2.0, (PIXELS, PIXELS, 3))
    noisy = np.clip(np.asarray(soft) + noise, 0, 255).round().astype(np.uint8)
    Image.fromarray(noisy).save(out + ".jpg", quality=90, subsampling=0)
    shift = np.sqrt(2) * size / PIXELS
    name = out.rsplit("/", 1)[-1]
    moved = f'<image href="{name}.jpg" x="{shift:.3f}" y="{-shift:.3f}"'
    text, count = re.subn(r'<image href="[^"]*" x="0" y="0"', moved, text)
    if count != 1:
        sys.exit(drawing + ": no picture at x 0, y 0")
    text = re.sub(r"<!--.*?-->", "<!-- bag.svg over a picture by another program, moved by two of its pixels: made by\n"
                  "     tests/sketch/photo/plot_model.py. -->", text, count=1, flags=re.S)
    open(out + ".svg", "w").write(text)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
