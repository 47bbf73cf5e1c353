"""What all programs of the gallery share: the command line, the look of a picture, and the files they write.

    PROGRAM.py [--quick] [--threads N] [directory]

writes PROGRAM.png, and where the scene moves PROGRAM.apng, into the directory (default: here). --quick is for checks: few
particles and pictures."""
import argparse
import io
import pathlib
import sys
import time
import zlib

import numpy as np
from PIL import Image, ImageDraw, ImageFont

import mpm
from splats import Camera, render

INK, GREY = (45, 52, 60), (0.86, 0.87, 0.89)
SIZE, LARGE, STRIP = (560, 350), 12 / 7, 30  # pixels of one that moves, those of stills to them, and a strip for text
BODIES = ("#d9573f", "#2f7fb8", "#e8a33d", "#4f9d69", "#7b5ea7")
RAMPS = {  # one family of colours: from the rest to the most
    "water": ("#123a63", "#2f7fb8", "#8fc9e4", "#f2fafd"),
    "sand": ("#8a5a2b", "#c98f4e", "#e9c88f", "#f8ecd2"),
    "snow": ("#f3f7fb", "#a9cbe8", "#4f8cc4", "#1c3f73"),
    "strain": ("#d8dde3", "#efc07a", "#dd6b3f", "#8e1f35"),
    "layers": ("#8a5a2b", "#e9c88f", "#2f7fb8", "#123a63"),
}


def rgb(text):
    """A colour "#rrggbb" as three numbers from 0 to 1."""
    return np.array([int(text[k:k + 2], 16) for k in (1, 3, 5)]) / 255


def colours(ramp, values, limits):
    """Colours (n, 3) of values by a ramp."""
    stops = np.array([rgb(c) for c in RAMPS[ramp]])
    at = np.clip((np.asarray(values, float) - limits[0]) / (limits[1] - limits[0]), 0, 1) * (len(stops) - 1)
    return np.stack([np.interp(at, np.arange(len(stops)), stops[:, k]) for k in range(3)], axis=-1)


def mises(particles):
    s = particles["stress"]
    d = s[:, :3] - s[:, :3].mean(axis=1, keepdims=True)
    return np.sqrt(1.5 * ((d ** 2).sum(axis=1) + 2 * (s[:, 3:] ** 2).sum(axis=1)))


def speed(particles):
    return np.linalg.norm(particles["velocity"], axis=1)


def _font(height):
    try:
        return ImageFont.truetype("DejaVuSans.ttf", height)
    except OSError:
        return ImageFont.load_default()


class View3:
    """How a scene in space is seen; see splats.Camera and splats.render."""

    def __init__(self, azimuth, elevation, target, width, **options):
        self.camera, self.options = (azimuth, elevation, target, width), options

    def draw(self, size, x, colour, radius, **more):
        fine = tuple(round(1.6 * s) for s in size)  # drawn larger, so that edges become smooth
        picture = render(Camera(*self.camera, fine), x, colour, radius, **{**self.options, **more})
        return Image.fromarray((255 * picture).astype(np.uint8)).resize(size, Image.LANCZOS)


class View2:
    """How a scene in the plane is seen: lower left corner and width of what is shown."""

    def __init__(self, lower, width):
        self.lower, self.width = lower, width

    def draw(self, size, sets, shapes=()):
        """sets: (particles, colours); shapes: (corners, colour) that lie under them."""
        fine = tuple(3 * s for s in size)
        scale = fine[0] / self.width
        image = Image.new("RGB", fine, "white")
        pen = ImageDraw.Draw(image)
        pixels = lambda corners: [tuple(p) for p in np.stack([(corners[:, 0] - self.lower[0]) * scale,
                                                               fine[1] - (corners[:, 1] - self.lower[1]) * scale], axis=1)]
        for corners, colour in shapes:
            pen.polygon(pixels(np.asarray(corners, float)), fill=tuple(int(255 * c) for c in colour))
        for one, colour in sets:
            for corners, c in zip(domains(one), (255 * np.broadcast_to(colour, (len(one), 3))).astype(int)):
                pen.polygon(pixels(corners), fill=tuple(c), outline=tuple(c))
        return image.resize(size, Image.LANCZOS)


def domains(particles):
    """Corners of the domains in the plane: squares of the first size, deformed by F; of what flows, where F tells nothing of
    the present shape, squares that overlap a little."""
    edges = particles["size"][:, :, None] * np.eye(2)
    flows = particles.material.model not in ("neo_hookean", "j2", "mohr_coulomb")
    F = 1.25 * np.eye(2)[None] if flows else particles["deformation_gradient"][:, :2, :2]
    corners = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
    return particles["position"][:, None] + np.einsum("nij,njl,kl->nki", np.broadcast_to(F, edges.shape), edges, corners)


def disc(centre, radius):
    """Corners of a disc, for View2.draw."""
    angle = np.linspace(0, 2 * np.pi, 90)
    return np.asarray(centre) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def box(lower, upper):
    """Corners of a rectangle, for View2.draw."""
    return np.array([lower, (upper[0], lower[1]), upper, (lower[0], upper[1])], float)


class Run:
    """A run of one program: its options, its times, its pictures."""

    def __init__(self):
        self.name = pathlib.Path(sys.argv[0]).stem
        parser = argparse.ArgumentParser(description=sys.modules["__main__"].__doc__)
        parser.add_argument("--quick", action="store_true", help="few particles and pictures, for checks")
        parser.add_argument("--threads", type=int, default=0, help="default: one for each core")
        parser.add_argument("directory", nargs="?", default=".", type=pathlib.Path)
        options = parser.parse_args()
        self.quick, self.directory = options.quick, options.directory
        self.threads = options.threads
        self.context = mpm.Context(concurrency=options.threads)
        self.start, self.frames, self.still = time.time(), [], None

    def pick(self, full, quick):
        return quick if self.quick else full

    def advance(self, stepper, t_end, frames, draw, still=1.0, moving=True, **options):
        """Steps to t_end and calls draw(size) for each picture; still is the share of time of the picture that stays."""
        frames = 3 if self.quick else frames
        chosen = round(still * (frames - 1))
        for k in range(frames):
            t = (0.02 if self.quick else 1.0) * t_end * k / (frames - 1)
            if k:
                stepper.advance(t, **options)
            if moving:
                self.frames.append(self.framed(self.size, draw, t))
            if k == chosen:
                self.still = self.framed(self.large(), draw, t)
        self.count(stepper)

    def panels(self, stepper, times, draw, columns, **options):
        """Steps to some times and draws a picture at each, in columns; all have one scale. Before each, before(t) is
        called if it is there."""
        pictures = []
        width, height = self.large()
        size = (width // columns, (height - self.strip()) // -(-len(times) // columns) - self.strip())
        for t in times:
            if t > 0:
                stepper.advance(0.02 * t if self.quick else t, **options)
            pictures.append(self.caption(self.padded(draw(size)), stepper.t, bar=False))
        self.count(stepper)
        self.still = self.sheet(pictures, columns)

    def sheet(self, pictures, columns):
        """Pictures of one size side by side, above the bar of colours."""
        wide, tall = pictures[0].size
        image = Image.new("RGB", (columns * wide, -(-len(pictures) // columns) * tall + self.strip() * bool(self.bar)), "white")
        for k, one in enumerate(pictures):
            image.paste(one, (wide * (k % columns), tall * (k // columns)))
        return self.caption(image)

    def count(self, *steppers):
        self.particles = sum(len(one) for s in steppers for one in s.sets)
        self.steps = sum(s.info.step for s in steppers)

    size = SIZE
    bar = None  # (ramp, text, low, high): a bar of colours
    milli = False  # whether times are told in milliseconds

    def large(self):
        return tuple(round(LARGE * s) for s in self.size)

    def strip(self):
        return round(LARGE * STRIP)

    def padded(self, image):
        """A picture with a strip for text under it."""
        out = Image.new("RGB", (image.width, image.height + self.strip()), "white")
        out.paste(image, (0, 0))
        return out

    def framed(self, size, draw, t):
        """A picture of a size: what draw(size) gives, above a strip with the time and the bar of colours."""
        strip = round(STRIP * size[0] / self.size[0])
        image = Image.new("RGB", size, "white")
        image.paste(draw((size[0], size[1] - strip)), (0, 0))
        return self.caption(image, t, unit=size[0] / self.size[0])

    def caption(self, image, t=None, text=None, bar=True, unit=LARGE):
        """Puts the time, or a text, and the bar of colours on the lowest strip of a picture."""
        pen, font = ImageDraw.Draw(image), _font(round(12 * unit))
        base = image.height - round(10 * unit)
        text = text or (None if t is None else f"t = {1e3 * t:.3g} ms" if self.milli else f"t = {t:.2f} s")
        if text:
            pen.text((round(14 * unit), base), text, INK, font, anchor="ls")
        if self.bar and bar:
            ramp, label, low, high = self.bar
            wide, tall = round(110 * unit), round(8 * unit)
            right = image.width - round(16 * unit)
            pen.text((right, base), f"{high:g}", INK, font, anchor="rs")
            right -= round(font.getlength(f"{high:g}") + 6 * unit)
            strip = colours(ramp, np.linspace(0, 1, wide), (0, 1))[None].repeat(tall, axis=0)
            image.paste(Image.fromarray((255 * strip).astype(np.uint8)), (right - wide, base - tall))
            right -= wide + round(6 * unit)
            pen.text((right, base), f"{low:g}", INK, font, anchor="rs")
            right -= round(font.getlength(f"{low:g}") + 12 * unit)
            pen.text((right, base), label, INK, font, anchor="rs")
        return image

    def save(self, still=None, most=800_000):
        """Writes the pictures, and says what the run was."""
        self.directory.mkdir(parents=True, exist_ok=True)
        seconds = time.time() - self.start
        still = still or self.still
        for tints in (256, 128, 64):
            data = io.BytesIO()
            still.quantize(tints, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(data, "PNG", optimize=True)
            if data.tell() <= 200_000:
                break
        (self.directory / f"{self.name}.png").write_bytes(whitened(data.getvalue()))
        if self.frames:
            (self.directory / f"{self.name}.apng").write_bytes(moving(self.frames, most))
        print(f"{self.name}: {self.particles} particles, {self.steps} steps, {seconds:.0f} s with {self.threads or 'all'} threads")


def whitened(png):
    """A PNG whose tints that are all but white are white, as the page is."""
    at = png.index(b"PLTE")
    length = int.from_bytes(png[at - 4:at], "big")
    tints = np.frombuffer(png, np.uint8, length, at + 4).reshape(-1, 3).copy()
    tints[tints.min(axis=1) >= 248] = 255
    chunk = b"PLTE" + tints.tobytes()
    return png[:at] + chunk + zlib.crc32(chunk).to_bytes(4, "big") + png[at + 8 + length:]


def moving(frames, most):
    """An animation in the format of animated PNG, with as many tints and pictures as fit into a number of bytes; the last
    picture stays a while."""
    columns = 4
    sheet = Image.new("RGB", (frames[0].width * columns, frames[0].height * -(-len(frames) // columns)), "white")
    for k, frame in enumerate(frames):
        sheet.paste(frame, (frame.width * (k % columns), frame.height * (k // columns)))
    for every in (1, 2):
        for tints in (128, 64, 40, 24):
            palette = sheet.quantize(tints, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
            flat = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames[::every]]
            data = io.BytesIO()
            flat[0].save(data, "PNG", save_all=True, append_images=flat[1:], loop=0,
                         duration=[80 * every] * (len(flat) - 1) + [1200])
            if data.tell() <= most:
                return whitened(data.getvalue())
    raise RuntimeError(f"an animation of {data.tell()} bytes: fewer or smaller pictures are needed")
