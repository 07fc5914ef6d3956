"""Measures of the triangles of a mesh: the directions that they prefer, their angles, and where along z they lie. All
take corners, triangles x 3 x 3.

The bias along an axis compares the sides of triangles along the axis and across it. In a triangle, u is the direction
of its plane nearest to the axis and v is the one at right angles; the sums of squared extents of the three sides along
u and along v have a difference, divided by the sum of both. The bias is the mean of that, each triangle weighted by
area and by the squared sine between axis and normal: 0 without a preferred direction, 1 for needles along the axis, -1
for needles across it.
"""
import numpy as np


def read_triangles(path):
    """The corners of the triangles of a PLY file of isoweave."""
    data = path.read_bytes()
    begin = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:begin].decode()
    count = {kind: int(header.split(f"element {kind} ")[1].split()[0]) for kind in ("vertex", "face")}
    number = np.float64 if "property double x" in header else np.float32
    places = np.frombuffer(data, number, 3 * count["vertex"], begin).reshape(-1, 3).astype(float)
    face = np.dtype([("size", "u1"), ("corners", "<i4", 3)])
    faces = np.frombuffer(data, face, count["face"], begin + 3 * number().nbytes * count["vertex"])
    return places[faces["corners"]]


def in_order(triangles):
    """The same triangles in an order that depends on nothing but where they lie, each from its least corner on. Sums
    over equal meshes have equal bits then."""
    ranks = [np.unique(triangles[:, :, axis], return_inverse=True)[1].reshape(-1, 3) for axis in range(3)]
    sizes = [int(rank.max(initial=0)) + 1 for rank in ranks]
    corner = (ranks[0] * sizes[1] + ranks[1]) * sizes[2] + ranks[2]
    first = corner.argmin(axis=1)
    turned = (first[:, None] + np.arange(3)) % 3
    corner = np.take_along_axis(corner, turned, 1)
    return np.take_along_axis(triangles, turned[:, :, None], 1)[np.lexsort(corner.T[::-1])]


def biases(triangles):
    """The bias along x, y and z."""
    sides = np.roll(triangles, -1, axis=1) - triangles
    normals = np.cross(sides[:, 0], sides[:, 1])
    areas = np.linalg.norm(normals, axis=1)
    sides, normals, areas = sides[areas > 0], normals[areas > 0], areas[areas > 0]
    normals /= areas[:, None]
    found = []
    for axis in range(3):
        along = np.eye(3)[axis] - normals * normals[:, axis : axis + 1]
        sine = np.linalg.norm(along, axis=1)
        keep = sine > 1e-3
        u = along[keep] / sine[keep, None]
        v = np.cross(normals[keep], u)
        squares = [(np.einsum("nsc,nc->ns", sides[keep], w) ** 2).sum(axis=1) for w in (u, v)]
        weights = areas[keep] * sine[keep] ** 2
        found.append(float((weights * (squares[0] - squares[1]) / (squares[0] + squares[1])).sum() / weights.sum()))
    return found


def angles(triangles):
    """Of the smallest angles of all triangles, in degrees: the least and the mean."""
    sides = np.roll(triangles, -1, axis=1) - triangles
    with np.errstate(invalid="ignore", divide="ignore"):
        unit = sides / np.linalg.norm(sides, axis=2, keepdims=True)
        cosines = -(unit * np.roll(unit, 1, axis=1)).sum(axis=2)
    smallest = np.degrees(np.arccos(np.clip(np.nan_to_num(cosines, nan=1), -1, 1))).min(axis=1)
    return float(smallest.min()), float(smallest.mean())


def heights(triangles):
    """The z of the centre of each triangle."""
    return triangles[:, :, 2].mean(axis=1)


def comb(triangles, period):
    """The rhythm of the triangles along z: a where their number goes as 1 + a cos(2 pi z / period + any phase)."""
    return float(2 * abs(np.exp(2j * np.pi * heights(triangles) / period).mean()))


def beside_fronts(triangles, period):
    """How many triangles lie 0 to 1, 1 to 2, ... from the nearest multiple of the period."""
    place = heights(triangles) % period
    counts = np.histogram(np.minimum(place, period - place), bins=np.arange(period / 2 + 1))[0]
    return counts.tolist()


def below_front(triangles, front, distances):
    """How many triangles lie between the distances below a front that follow one another."""
    return np.histogram(front - heights(triangles), bins=distances)[0].tolist()
