"""Vertex clustering, `--preview`, beside isoweave at as many triangles: time, memory, distances, and what becomes of
edges and parts."""
import json
import statistics

from evaluation import method_runs
from evaluation.programs import write_volume

CELLS = ("2", "4")  # in voxels
ROUNDS = 3


def shape(programs, mesh, full):
    """Distances from the full surface and back, in voxels, and what `check` finds."""
    distance = json.loads(programs.run("isoweave", "compare", mesh, full, "--json"))
    check = json.loads(programs.run("isoweave", "check", mesh, "--json"))
    return {"rms": distance["both"]["rms"], "max": distance["both"]["max"],
            "edges": check["nonmanifold_edges"], "components": check["components"], "euler": check["euler"]}


def measure_cell(programs, volume, iso, cell, full):
    """The preview and the simplified mesh of as many triangles, in turns."""
    rounds = []
    for _ in range(ROUNDS):
        seconds, preview, of_preview = programs.processor_seconds(volume, iso, f"--preview={cell}vox", "--threads", "1")
        preview = preview.rename(programs.folder / "preview.ply")
        count = of_preview["triangles"]
        others, mesh, of_mesh = programs.processor_seconds(volume, iso, "--triangles", count, "--threads", "1")
        rounds.append((seconds, others))
    return {"cell": cell, "rounds": ROUNDS, "plane_rms": of_preview["preview"]["plane_rms"],
            "seconds per isoweave": statistics.median(seconds / others for seconds, others in rounds),
            "preview": shape(programs, preview, full) | {"triangles": count, "bytes": of_preview["memory"]["peak_bytes"]},
            "isoweave": shape(programs, mesh, full)
            | {"triangles": of_mesh["triangles"], "bytes": of_mesh["memory"]["peak_bytes"]}}


def measure_surface(programs, name, samples, iso):
    volume = programs.folder / "clustered.nrrd"
    write_volume(volume, samples)
    full, report = programs.mesh(volume, iso, "--error", "0", name="full.ply")
    return {"name": name, "iso": iso, "dims": samples.shape[::-1], "triangles": report["triangles"],
            "components": report["components"], "euler": report["euler"],
            "cells": [measure_cell(programs, volume, iso, cell, full) for cell in CELLS]}


def measure_all(programs, see):
    found = []
    for surface in method_runs.surfaces(programs):
        found.append(measure_surface(programs, *surface))
        see(found[-1])
    return found
