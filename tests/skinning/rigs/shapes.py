"""Closed surfaces of bones: tubes that run into one another, and boxes."""
import itertools

import numpy as np

BLEND = 0.35  # reach of the fillet between two tubes, over the smaller radius


def distances(points, bones):
    """Signed distance to each bone's tube, of radius r at its head and r at its tail; points x bones."""
    result = np.empty((len(points), len(bones)))
    for i, bone in enumerate(bones):
        axis = bone.tail - bone.head
        along = np.clip((points - bone.head) @ axis / max(axis @ axis, 1e-12), 0, 1)
        radius = bone.radii[0] + along * (bone.radii[1] - bone.radii[0])
        result[:, i] = np.linalg.norm(points - bone.head - along[:, None] * axis, axis=1) - radius
    return result


def tube_field(points, bones):
    """Smooth union of the tubes: negative inside."""
    reach = BLEND * min(min(bone.radii) for bone in bones)
    return -reach * np.log(np.exp(np.clip(-distances(points, bones) / reach, -80, 80)).sum(axis=1))


def gradient(points, bones, step):
    return np.stack([(tube_field(points + step * e, bones) - tube_field(points - step * e, bones)) / (2 * step)
                     for e in np.eye(3)], axis=1)


def without_pinches(inside):
    """Fills squares and cubes of the grid of which only opposite corners are inside (or outside): two sheets of the net
    would share an edge or a vertex there."""
    inside, pinched = inside.copy(), True
    while pinched:
        pinched = False
        for size in ((1, 1, 0), (1, 0, 1), (0, 1, 1), (1, 1, 1)):
            corners = list(itertools.product(*[range(d + 1) for d in size]))
            views = [inside[tuple(slice(c, n - d + c) for c, d, n in zip(corner, size, inside.shape))] for corner in corners]
            for i in range(len(corners) // 2):
                pair = (i, len(corners) - 1 - i)
                first, last = views[pair[0]], views[pair[1]]
                others = np.stack([view for k, view in enumerate(views) if k not in pair])
                bad = (first & last & ~others.any(axis=0)) | (~first & ~last & others.all(axis=0))
                pinched |= bool(bad.any())
                for view in views:
                    view |= bad
    return inside


def tubes(bones, cell):
    """Vertices and outward triangles of the union of the bones' tubes by a surface net on a grid of such cells,
    moved onto the surface."""
    radius = max(max(bone.radii) for bone in bones) + 2 * cell
    ends = np.array([end for bone in bones for end in (bone.head, bone.tail)])
    low = ends.min(axis=0) - radius
    counts = np.ceil((ends.max(axis=0) + radius - low) / cell).astype(int) + 1
    nodes = np.stack(np.meshgrid(*[np.arange(n) for n in counts], indexing="ij"), axis=-1)
    inside = without_pinches(tube_field((low + cell * nodes).reshape(-1, 3), bones).reshape(counts) < 0)
    corners = np.stack([inside[tuple(slice(d, n - 1 + d) for d, n in zip(offset, counts))]
                        for offset in itertools.product((0, 1), repeat=3)])
    mixed = corners.any(axis=0) & ~corners.all(axis=0)
    number = np.full(mixed.shape, -1)
    number[mixed] = np.arange(mixed.sum())
    vertices = low + cell * (np.argwhere(mixed) + 0.5)
    for _ in range(4):
        slope = gradient(vertices, bones, 0.05 * cell)
        length = np.maximum((slope * slope).sum(axis=1), 0.05)
        vertices = vertices - np.clip(tube_field(vertices, bones) / length, -cell, cell)[:, None] * slope
    return vertices, np.array(list(net_triangles(inside, number)))


def net_triangles(inside, number):
    """Two triangles for each edge of the grid that crosses the surface, between the cells about it."""
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        low = [slice(1, -1)] * 3
        low[axis] = slice(0, -1)
        high = list(low)
        high[axis] = slice(1, None)
        starts, ends = inside[tuple(low)], inside[tuple(high)]
        for place in np.argwhere(starts != ends):
            corner = place + [0 if k == axis else 1 for k in range(3)]
            ring = []
            for du, dv in ((1, 1), (0, 1), (0, 0), (1, 0)):
                cell = corner.copy()
                cell[u] -= du
                cell[v] -= dv
                ring.append(number[tuple(cell)])
            if not starts[tuple(place)]:
                ring.reverse()
            yield ring[0], ring[1], ring[2]
            yield ring[0], ring[2], ring[3]


def box(head, tail, width, depth, cuts):
    """A box about a bone, each face cut into cuts x cuts quads."""
    along = tail - head
    x = np.cross(along, [0.0, 0.0, 1.0] if abs(along[2]) < 0.8 * np.linalg.norm(along) else [1.0, 0.0, 0.0])
    x *= width / np.linalg.norm(x)
    z = np.cross(x, along)
    z *= depth / np.linalg.norm(z)
    frame = np.array([x, along, z])
    number, places, triangles = {}, [], []

    def vertex(place):
        if place not in number:
            number[place] = len(places)
            places.append(head + (np.array(place) / cuts - [0.5, 0, 0.5]) @ frame)
        return number[place]

    for axis, side in itertools.product(range(3), (0, cuts)):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for i, j in itertools.product(range(cuts), repeat=2):
            quad = []
            for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
                place = [0, 0, 0]
                place[axis], place[u], place[v] = side, i + di, j + dj
                quad.append(vertex(tuple(place)))
            if side == 0:
                quad.reverse()
            triangles += [(quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3])]
    return np.array(places), np.array(triangles)


def volume(vertices, triangles):
    """Enclosed by closed triangles that face outwards."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def open_edges(triangles):
    """Edges that do not have one triangle to each side."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    ways = {}
    for a, b in edges:
        ways.setdefault((min(a, b), max(a, b)), []).append(a < b)
    return [edge for edge, sides in ways.items() if sorted(sides) != [False, True]]
