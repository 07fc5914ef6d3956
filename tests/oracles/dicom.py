#!/usr/bin/python3
"""DICOM as scanners and archives leave it, written by pydicom: uneven slices, scaling of each slice, frames without
groups, data sets without magic, exports. Right values are those of a formula.
"""

import os
import sys
import tempfile

from oracle import SKIP, Oracle, np, ply_vertices

try:
    import pydicom
    from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
    from pydicom.sequence import Sequence
    from pydicom.uid import ExplicitVRLittleEndian, ImplicitVRLittleEndian
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(SKIP)

CENTRE = np.array([64.0, 64.0, 60.0])
RADIUS = 40.0
SIZE = 64
STEP = 2.0


def slice_of_ball(z):
    """1000 on the surface of the ball, more inside."""
    y, x = np.mgrid[:SIZE, :SIZE] * STEP
    distance = np.sqrt((x - CENTRE[0]) ** 2 + (y - CENTRE[1]) ** 2 + (z - CENTRE[2]) ** 2)
    return ((80 - distance) * 25).clip(0, 2000)


def new_file(path, samples, syntax=ExplicitVRLittleEndian):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = "1.2.840.10008.5.1.4.1.1.2"
    meta.MediaStorageSOPInstanceUID = pydicom.uid.generate_uid()
    meta.TransferSyntaxUID = syntax
    data = FileDataset(path, {}, file_meta=meta, preamble=b"\0" * 128)
    data.is_little_endian = True
    data.is_implicit_VR = syntax == ImplicitVRLittleEndian
    data.SOPClassUID = meta.MediaStorageSOPClassUID
    data.SOPInstanceUID = meta.MediaStorageSOPInstanceUID
    data.SeriesInstanceUID = "1.2.3.4"
    data.Rows = data.Columns = SIZE
    data.BitsAllocated = data.BitsStored = 16
    data.HighBit = 15
    data.PixelRepresentation = 1
    data.SamplesPerPixel = 1
    data.PhotometricInterpretation = "MONOCHROME2"
    data.PixelSpacing = [STEP, STEP]
    data.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
    data.PixelData = np.round(samples).astype("<i2").tobytes()
    return data


def put_slice(folder, name, z, scaling=None, syntax=ExplicitVRLittleEndian):
    os.makedirs(folder, exist_ok=True)
    samples = slice_of_ball(z)
    if scaling:
        samples = (samples - scaling[1]) / scaling[0]
    data = new_file(os.path.join(folder, name), samples, syntax)
    data.ImagePositionPatient = [0, 0, float(z)]
    if scaling:
        data.RescaleSlope, data.RescaleIntercept = scaling
    return data


def save(data, **options):
    data.save_as(data.filename, **({"write_like_original": False} | options))


def put_frames(path, places):
    os.makedirs(os.path.dirname(path))
    data = new_file(path, np.array([slice_of_ball(z) for z in places]))
    data.NumberOfFrames = len(places)
    data.ImagePositionPatient = [0, 0, float(places[0])]
    return data


def check_ball(oracle, path, mesh, slack, *options):
    """The surface is the ball where it is, within a share of the distance between slices."""
    with oracle.file(path):
        oracle.mesh(path, mesh, "--iso", 1000, "--error", 0, *options)
        points = ply_vertices(mesh)
        distance = np.sqrt(((points - CENTRE) ** 2).sum(axis=1))
        oracle.expect_near(distance, RADIUS, slack, f"{path}: distance from the centre")
        oracle.expect_near([points[:, 2].min(), points[:, 2].max()], [20, 100], slack, f"{path}: ends along z")


def check_uneven(oracle, folder, mesh):
    even = np.arange(66) * 2.5
    series = {"even": (even, 0.2), "two": (np.r_[even[:33], 80 + 7.5 * np.arange(1, 12)], 0.4),
              "lost": (np.delete(even, 50), 0.2), "many": (np.delete(even, [7, 20, 21, 36]), 0.6),
              "drift": (np.r_[even[:33], 80 + 2.52 * np.arange(1, 33)], 0.2),
              "fine": (np.r_[even[:24], 57.5 + np.arange(1, 60)], 0.2)}
    for name, (places, slack) in series.items():
        for number, z in enumerate(places):
            save(put_slice(os.path.join(folder, name), f"{(7 * number) % 97:03d}.dcm", z))
        check_ball(oracle, os.path.join(folder, name), mesh, slack)
    info = oracle.info(os.path.join(folder, "two"))
    oracle.expect_equal((info["dims"][2], info["spacing"][2]), (66, 2.5), "two distances: slices and their distance")
    info = oracle.info(os.path.join(folder, "two"), "--even-spacing", "mean")
    oracle.expect_equal(info["dims"][2], 44, "two distances: slices as they are")
    path = os.path.join(folder, "enhanced", "a.dcm")
    places = series["lost"][0]
    data = put_frames(path, places)
    del data.ImagePositionPatient
    frames = []
    for z in places:
        frame, position = Dataset(), Dataset()
        position.ImagePositionPatient = [0, 0, float(z)]
        frame.PlanePositionSequence = Sequence([position])
        frames.append(frame)
    data.PerFrameFunctionalGroupsSequence = Sequence(frames)
    save(data)
    check_ball(oracle, path, mesh, 0.2)


def check_scaling(oracle, folder, mesh):
    """Each slice has a scaling of its own, as in PET; the values are those of the ball."""
    for number, z in enumerate(np.arange(55) * 2.5):
        save(put_slice(os.path.join(folder, "pet"), f"{number}.dcm", z, (0.0625 * (1 + number % 7), -3.5 * number)))
    path = os.path.join(folder, "pet")
    with oracle.file(path):
        info = oracle.info(path)
        oracle.expect_equal((info["type"], info["min"] >= -0.5, abs(info["max"] - 2000) < 0.5),
                            ("float32", True, True), f"{path}: values")
    check_ball(oracle, path, mesh, 0.2)


def check_stacks(oracle, folder, mesh):
    places = np.arange(55) * 2.5
    path = os.path.join(folder, "cbct", "a.dcm")
    data = put_frames(path, places)
    data.SpacingBetweenSlices = 2.5
    save(data)
    check_ball(oracle, path, mesh, 0.2)
    path = os.path.join(folder, "down", "a.dcm")
    data = put_frames(path, places[::-1])
    data.SpacingBetweenSlices = -2.5
    save(data)
    check_ball(oracle, path, mesh, 0.2)
    for name, offsets in (("relative", places - places[0]), ("absolute", places + 5)):
        path = os.path.join(folder, f"dose_{name}", "a.dcm")
        data = put_frames(path, places)
        data.FrameIncrementPointer = 0x3004000C
        data.GridFrameOffsetVector = [float(offset) for offset in offsets]
        data.DoseGridScaling = 0.5
        if name == "absolute":
            data.ImagePositionPatient = [0, 0, 5]
        save(data)
        with oracle.file(path):
            check = oracle.mesh(path, mesh, "--iso", 500, "--error", 0)
            oracle.expect(abs(check["volume"] - 4 / 3 * np.pi * RADIUS**3) < 500, f"{path}: volume {check['volume']}")


def check_bare_exports(oracle, folder, mesh):
    """Data sets without preamble, in folders of folders, with a scout among them."""
    top = os.path.join(folder, "export")
    for number, z in enumerate(np.arange(55) * 2.5):
        syntax = (ExplicitVRLittleEndian, ImplicitVRLittleEndian)[number % 2]
        place = os.path.join(top, "DICOM", f"IMG{number % 3}")
        data = put_slice(place, f"I{number}", z, syntax=syntax)
        if number % 4 == 0:
            save(data)
        else:
            del data.preamble
            data.preamble = None
            data.file_meta = FileMetaDataset()
            save(data, write_like_original=True)
    scout = put_slice(os.path.join(top, "DICOM"), "SCOUT", 60)
    scout.ImageOrientationPatient = [0, 1, 0, 0, 0, -1]
    scout.ImageType = ["ORIGINAL", "PRIMARY", "LOCALIZER"]
    save(scout)
    with oracle.file(top):
        notes = " ".join(oracle.info(top)["notes"])
        oracle.expect("SCOUT' (a localizer)" in notes, f"{top}: a note on the scout, found {notes}")
    check_ball(oracle, top, mesh, 0.2)


def main():
    oracle = Oracle(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        mesh = os.path.join(folder, "mesh.ply")
        for check in (check_uneven, check_scaling, check_stacks, check_bare_exports):
            check(oracle, folder, mesh)
    oracle.finish()


if __name__ == "__main__":
    main()
