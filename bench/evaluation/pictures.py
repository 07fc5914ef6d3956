"""The pictures of docs/evaluation.md: one region by three methods, and a sweep in the middle by two."""
from evaluation import stand_ins
from evaluation.programs import write_volume

ISO, ERROR = 99.5, "1"
LOOK = ("--view", "35,25", "--shading", "flat", "--wireframe", "--quiet")
COLOURS = 64
# Name, region of the engine from its first samples by x, y and z to its last, methods, layers after which the sweeps
# stop, or none, and the size of each of the pictures beside one another.
PICTURES = (
    ("methods", (0, 20, 0), (110, 130, 72), ("isoweave:12", "tandem:0", "frozen:12"), (), "420x400"),
    ("half", (0, 20, 0), (200, 220, 128), ("isoweave:1", "tandem:0"), (64,), "640x420"),
)


def write_region(programs, path, first, end):
    """A part of the engine, or a formula of its size where that is not there. Returns the iso-value."""
    engine = stand_ins.scan(stand_ins.ENGINE)
    if engine is not None:
        write_volume(path, programs.part(engine, first, end))
        return ISO
    size = "x".join(str(e - f) for f, e in zip(first, end))
    programs.run("isoweave", "generate", "smooth", "--size", size, "--type", "uint8", "-o", path, "--quiet")
    return 127.5


def join(pictures, path):
    """Pictures of one height beside one another, as one of few colours."""
    from PIL import Image  # not needed for the rest

    pictures = [Image.open(picture).convert("RGB") for picture in pictures]
    joined = Image.new("RGB", (sum(picture.width for picture in pictures), pictures[0].height))
    left = 0
    for picture in pictures:
        joined.paste(picture, (left, 0))
        left += picture.width
    joined.quantize(COLOURS).save(path, optimize=True)


def draw(programs, name, iso, method, stop, size):
    """The picture of a method's mesh, and its triangles."""
    path = programs.folder / f"{name}.png"
    mesh, counts = programs.by_method(programs.folder / "region.nrrd", iso, ERROR, method, *stop)
    programs.run("isoweave", "render", mesh, "-o", path, "--size", size, *LOOK)
    return path, counts["triangles"]


def draw_all(programs, folder):
    """Writes the pictures, and returns the triangles of their parts."""
    found = {}
    for name, first, end, methods, stop, size in PICTURES:
        iso = write_region(programs, programs.folder / "region.nrrd", first, end)
        parts = [draw(programs, f"{name}-{number}", iso, method, stop, size) for number, method in enumerate(methods)]
        join([path for path, _ in parts], folder / f"{name}.png")
        found[name] = {method: triangles for method, (_, triangles) in zip(methods, parts)}
    return found
