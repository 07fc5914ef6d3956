"""Volumes that stand in for those of the paper, which are not to be had.

A stand-in has the paper's size and 8 bits. Its field is a part of a scan, and the value on the surface is found by
bisection: as many cells are crossed as in table 3, within half a percent. The field is rounded to 8 bits so that this
value lies half way between two of them. A formula is the field where there is no scan.
"""
import os
import pathlib
import sys
from typing import NamedTuple

import numpy as np

from evaluation.programs import write_volume

WITHIN = 0.005
ABDOMEN = "fnndsc_abdomen"
ENGINE = "engine_256x256x128/engine.nii.gz"


class Field(NamedTuple):
    """Samples by [z, y, x], the source, and two values between which the number of crossed cells only falls."""
    samples: np.ndarray
    source: str
    many: float
    few: float


class StandIn(NamedTuple):
    path: pathlib.Path
    iso: float
    crossed: int
    source: str


def crossed_cells(inside):
    """The cells with corners on both sides."""
    some, all_of = inside, inside
    for axis in range(3):
        low, high = (slice(None),) * axis + (slice(None, -1),), (slice(None),) * axis + (slice(1, None),)
        some, all_of = some[low] | some[high], all_of[low] & all_of[high]
    return int(np.count_nonzero(some) - np.count_nonzero(all_of))


def magnified(samples, size, axis):
    """So many samples along an axis, linear between those that are there."""
    places = np.linspace(0, samples.shape[axis] - 1, size)
    low = np.minimum(places.astype(int), samples.shape[axis] - 2)
    part = (places - low).astype(np.float32).reshape([-1 if other == axis else 1 for other in range(3)])
    return np.take(samples, low, axis) * (1 - part) + np.take(samples, low + 1, axis) * part


def scan(name):
    """The path of a scan, or None where it is not there."""
    folder = os.environ.get("ISOWEAVE_DATA_DIR")
    path = pathlib.Path(folder or "", name)
    return path if folder and path.exists() else None


def formula_fields(programs, dims):
    yield Field(programs.formula("smooth", dims), "formula: `isoweave generate smooth`", 0.5, 1)


def abdomen_fields(programs, first, end):
    """Slices of the CT of an abdomen. Its values are whole numbers: where none of them fits, other slices are tried."""
    path = scan(ABDOMEN)
    if path is None:
        yield from formula_fields(programs, (512, 512, end - first))
        return
    samples = programs.part(path, (0, 0, 0), (512, 512, 275)).astype(np.float32)
    for shift in sorted(range(-40, 41), key=abs):
        part = samples[first + shift : end + shift]
        yield Field(part, f"scan: {ABDOMEN}, slices {first + shift} to {end + shift - 1}", 50, 1800)


def engine_fields(programs):
    """Four CTs of an engine, every other one mirrored, magnified."""
    path = scan(ENGINE)
    if path is None:
        yield from formula_fields(programs, (1023, 559, 347))
        return
    engine = programs.part(path, (0, 0, 0), (256, 256, 128)).astype(np.float32)
    row = np.concatenate([engine, engine[:, :, ::-1]] * 2, axis=2)
    for axis, size in ((2, 1023), (1, 559), (0, 347)):
        row = magnified(row, size, axis)
    yield Field(row, f"scan: {ENGINE}, four in a row, every other one mirrored, magnified linearly", 140, 60)


FIELDS = {"bonsai #2": lambda programs: abdomen_fields(programs, 43, 232),
          "CTA head": lambda programs: abdomen_fields(programs, 60, 180), "Porsche": engine_fields}


def value_with(field, cells):
    """The value that crosses nearly so many cells, and how many it does."""
    many, few = field.many, field.few
    tried = {}
    while abs(many - few) > abs(field.many - field.few) / 2**14:
        value = (many + few) / 2
        tried[value] = found = crossed_cells(field.samples >= value)
        if abs(found - cells) <= WITHIN * cells / 5:
            break
        many, few = (value, few) if found > cells else (many, value)
    return min(tried.items(), key=lambda item: abs(item[1] - cells))


def stand_in(fields, cells, path):
    """Writes the volume whose surface crosses so many cells, of the first field that has one."""
    for field in fields:
        value, found = value_with(field, cells)
        if abs(found - cells) <= WITHIN * cells:
            return write_stand_in(field, value, found, path)
    sys.exit(f"{field.source}: expected a value that crosses {cells} cells, found {found} at {value}")


def write_stand_in(field, value, found, path):
    lowest, highest = float(field.samples.min()), float(field.samples.max())
    scale = 254 / (highest - lowest)
    level = np.floor((value - lowest) * scale) + 1
    write_volume(path, np.clip(np.floor((field.samples - value) * scale) + level, 0, 255).astype(np.uint8))
    return StandIn(path, float(level) - 0.5, found, field.source)
