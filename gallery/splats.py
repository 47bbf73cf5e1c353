"""Spheres, boxes and a floor with light, shadow and ambient occlusion, by numpy alone: no display, no graphics card."""
import numpy as np


class Camera:
    """A parallel projection. azimuth and elevation, in degrees, say where it stands; target is in the middle of the
    picture, which is width wide in the scene's units; size is that of the picture in pixels."""

    def __init__(self, azimuth, elevation, target, width, size):
        a, e = np.radians([azimuth, elevation])
        self.forward = -np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        self.right = np.array([-np.sin(a), np.cos(a), 0.0])
        self.up = np.cross(self.right, self.forward)
        self.target, self.size, self.scale = np.asarray(target, float), size, size[0] / width
        self.azimuth = azimuth

    def project(self, x):
        """Column, row and depth of points, (n, 3)."""
        y = x - self.target
        return (self.size[0] / 2 + self.scale * (y @ self.right), self.size[1] / 2 - self.scale * (y @ self.up),
                y @ self.forward)

    def light(self):
        """Where light comes from, as azimuth and elevation, and as a direction: from the left behind who looks."""
        turned, above = self.azimuth - 38, 52
        a, e = np.radians([turned, above])
        return turned, above, np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])

    def rays(self):
        """Where the pixels lie in the plane through the target, (rows, columns, 3)."""
        columns = (np.arange(self.size[0]) - self.size[0] / 2) / self.scale
        rows = (self.size[1] / 2 - np.arange(self.size[1])) / self.scale
        return self.target + columns[None, :, None] * self.right + rows[:, None, None] * self.up


def _seen(column, row, depth, reach, radius):
    """Which points are not far behind others, by a coarse depth buffer."""
    i, j = (np.floor(v / reach).astype(int) for v in (row, column))
    i, j = i - i.min() + 1, j - j.min() + 1
    nearest = np.full((i.max() + 2, j.max() + 2), np.inf)
    np.minimum.at(nearest, (i, j), depth)
    about = np.max([nearest[i + a, j + b] for a in (-1, 0, 1) for b in (-1, 0, 1)], axis=0)
    return depth < about + 3 * radius


def splat(camera, x, radius):
    """Depths of spheres, and whose they are: (rows, columns), infinite and -1 where there is none."""
    width, height = camera.size
    depth, owner = np.full(width * height, np.inf), np.full(width * height, -1)
    if not len(x):
        return depth.reshape(height, width), owner.reshape(height, width)
    column, row, z = camera.project(x)
    r = max(radius * camera.scale, 0.8)
    kept = np.flatnonzero(_seen(column, row, z, max(r, 1.0), radius))
    kept = kept[np.argsort(-z[kept])]  # the nearest last: of several that meet at a pixel it stays
    column, row, z = column[kept], row[kept], z[kept]
    i, j, reach = np.rint(row).astype(int), np.rint(column).astype(int), int(np.ceil(r))
    for a in range(-reach, reach + 1):
        for b in range(-reach, reach + 1):
            off = (i + a - row) ** 2 + (j + b - column) ** 2
            at = np.flatnonzero((off < r * r) & (i + a >= 0) & (i + a < height) & (j + b >= 0) & (j + b < width))
            near = z[at] - np.sqrt(r * r - off[at]) / camera.scale
            pixel = (i[at] + a) * width + j[at] + b
            closer = near < depth[pixel]
            depth[pixel[closer]], owner[pixel[closer]] = near[closer], kept[at[closer]]
    return depth.reshape(height, width), owner.reshape(height, width)


def _box(camera, lower, upper):
    """Depth and normals of a box."""
    start = camera.rays()
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.sort([(np.asarray(face) - start) / camera.forward for face in (lower, upper)], axis=0)
    axis = ends[0].argmax(axis=-1)
    depth = np.where(ends[0].max(axis=-1) < ends[1].min(axis=-1), ends[0].max(axis=-1), np.inf)
    return depth, np.eye(3)[axis] * -np.sign(camera.forward)[axis][..., None]


def _ball(camera, centre, radius):
    """Depth and normals of a large sphere."""
    start = camera.rays() - np.asarray(centre)
    along = start @ camera.forward
    root = along ** 2 - (start ** 2).sum(axis=-1) + radius ** 2
    depth = np.where(root > 0, -along - np.sqrt(np.maximum(root, 0)), np.inf)
    return depth, (start + np.where(np.isfinite(depth), depth, 0)[..., None] * camera.forward) / radius


def _shift(a, rows, columns):
    return np.roll(a, (rows, columns), (0, 1))


def _smooth(depth, near, rounds):
    """Depths averaged with those of neighbours within a distance, farther neighbours in each round."""
    for k in range(rounds):
        total, weight = depth.copy(), np.ones_like(depth)
        for a, b in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            other = _shift(depth, a * 2 ** k, b * 2 ** k)
            close = np.abs(other - depth) < near
            total[close] += other[close]
            weight[close] += 1
        depth = total / weight
    return depth


def _occlusion(depth, unit):
    """How much of their surroundings points do not see, by what stands out beside them; unit: length of a pixel. Pairs of
    opposite places cancel the slope of a plane, and what is far in front does not count."""
    total = 0.0
    for reach in (depth.shape[1] // 160, depth.shape[1] // 55):
        for a, b in ((1, 0), (0, 1), (0.7, 0.7), (0.7, -0.7)):
            a, b = round(a * reach), round(b * reach)
            behind = (depth - 0.5 * (_shift(depth, a, b) + _shift(depth, -a, -b))) / (unit * reach)
            total = total + np.clip(behind, 0, 1) * np.clip(1.6 - 0.5 * behind, 0, 1)
    return total / 8


def _lit(camera, point, x, radius, solids):
    """How much light reaches points: a depth buffer seen from the light, read at several places for a soft edge."""
    turned, above, _ = camera.light()
    light = Camera(turned, above, camera.target, 2.2 * camera.size[0] / camera.scale, (700, 700))
    depth = splat(light, x, radius)[0]
    for solid in solids:
        depth = np.minimum(depth, solid(light)[0])
    column, row, z = light.project(point.reshape(-1, 3))
    bias, total = 2.5 * radius + 1.5 / light.scale, 0
    offsets, inside = (-2, 2), (row > 3) & (row < 696) & (column > 3) & (column < 696)
    for a in offsets:
        for b in offsets:
            i, j = (np.clip(np.rint(v + o).astype(int), 0, 699) for v, o in ((row, a), (column, b)))
            total = total + ((z < depth[i, j] + bias) | ~inside)
    return (total / len(offsets) ** 2).reshape(point.shape[:2])


def render(camera, x, colour, radius, floor=None, boxes=(), balls=(), grain=0.3):
    """A picture (rows, columns, 3) from 0 to 1 of particles x (n, 3) with colour (n, 3). floor is the height of a white
    plane; boxes are (lower, upper, colour), balls (centre, radius, colour). grain says how much single particles show."""
    depth, owner = splat(camera, x, radius)
    there = owner >= 0
    solids = [lambda c, box=box: _box(c, *box[:2]) for box in boxes] + [lambda c, ball=ball: _ball(c, *ball[:2]) for ball in balls]
    far = np.nanmax(np.where(there, depth, np.nan)) + 1 if there.any() else 1.0
    surface = np.where(there, depth, far)
    shape = (1 - grain) * _smooth(surface, 3 * radius, 4) + grain * _smooth(surface, 3 * radius, 1)
    slope = [np.clip(g * camera.scale, -2.5, 2.5) for g in np.gradient(shape)]
    normal = slope[1][..., None] * camera.right - slope[0][..., None] * camera.up - camera.forward
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    albedo = np.where(there[..., None], colour[owner] if len(colour) else 1.0, 1.0)
    ground = np.zeros_like(there)
    for solid, what in zip(solids, [b[2] for b in (*boxes, *balls)]):
        d, n = solid(camera)
        closer = d < depth
        depth[closer], normal[closer], albedo[closer] = d[closer], n[closer], what
        there |= closer
    if floor is not None:
        start = camera.rays()
        d = (floor - start[..., 2]) / camera.forward[2]
        ground = d < depth
        depth[ground], normal[ground], albedo[ground] = d[ground], (0, 0, 1), 1.0
    shown = np.isfinite(depth)
    depth = np.where(shown, depth, depth[shown].max())
    point = camera.rays() + depth[..., None] * camera.forward
    lit, sun = _lit(camera, point, x, radius, solids), camera.light()[2]
    dark = 0.75 * _occlusion(depth, 1 / camera.scale)
    shade = (0.44 + 0.14 * normal[..., 2] + 0.58 * lit * np.clip(normal @ sun, 0, 1)) * (1 - dark)
    half = (sun - camera.forward) / np.linalg.norm(sun - camera.forward)
    picture = albedo * shade[..., None] + (0.08 * lit * np.clip(normal @ half, 0, 1) ** 24)[..., None]
    picture = np.where(ground[..., None], (1 - 0.22 * (1 - lit) - 0.6 * dark)[..., None], picture)
    return np.clip(np.where(shown[..., None], picture, 1.0), 0, 1)
