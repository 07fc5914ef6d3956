#!/usr/bin/python3
"""DICOM as scanners and archives leave it, written by pydicom: uneven slices, scaling of each slice, frames without
groups, data sets without magic, exports, segmentations. Right values are those of a formula.
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


def check_times(oracle, folder, mesh):
    """Two echoes in a series, the second half as bright: the ball is in both."""
    places = np.arange(55) * 2.5
    top = os.path.join(folder, "echoes")
    for number in range(110):
        n = (37 * number) % 110
        data = put_slice(top, f"{number}.dcm", places[n % 55])
        data.EchoTime = "4.9" if n < 55 else "12.1"
        data.PixelData = np.round(slice_of_ball(places[n % 55]) / (1 + n // 55)).astype("<i2").tobytes()
        save(data)
    path = os.path.join(folder, "echoes_in_frames", "a.dcm")
    data = put_frames(path, np.repeat(places, 2))
    data.PixelData = np.round([slice_of_ball(z) / echo for z in places for echo in (1, 2)]).astype("<i2").tobytes()
    del data.ImagePositionPatient
    data.PerFrameFunctionalGroupsSequence = Sequence([item_of(
        MREchoSequence=Sequence([item_of(EffectiveEchoTime=echo)]),
        PlanePositionSequence=Sequence([item_of(ImagePositionPatient=[0, 0, float(z)])]))
        for z in places for echo in (4.9, 12.1)])
    save(data)
    for volume in (top, path):
        check_ball(oracle, volume, mesh, 0.2)
        with oracle.file(volume):
            oracle.mesh(volume, mesh, "--iso", 500, "--error", 0, "--time", 1)
            distance = np.sqrt(((ply_vertices(mesh) - CENTRE) ** 2).sum(axis=1))
            oracle.expect_near(distance, RADIUS, 0.2, f"{volume}: the ball of the second echo")
            notes = " ".join(oracle.info(volume)["notes"])
            oracle.expect("Echo Time (4.9, 12.1)" in notes, f"{volume}: a note on echoes, found {notes}")


def item_of(**fields):
    data = Dataset()
    for name, value in fields.items():
        setattr(data, name, value)
    return data


def put_segmentation(path, frames, names, turn):
    """frames: (segment, place along the normal, mask), in any order."""
    os.makedirs(os.path.dirname(path), exist_ok=True)
    data = new_file(path, np.zeros(1))
    data.SOPClassUID = data.file_meta.MediaStorageSOPClassUID = "1.2.840.10008.5.1.4.1.1.66.4"
    data.BitsAllocated = data.BitsStored = 1
    data.HighBit = data.PixelRepresentation = 0
    del data.PixelSpacing, data.ImageOrientationPatient
    data.NumberOfFrames = len(frames)
    data.SegmentationType = "BINARY"
    data.SegmentSequence = Sequence([item_of(SegmentNumber=n, SegmentLabel=name) for n, name in names.items()])
    data.SharedFunctionalGroupsSequence = Sequence([item_of(
        PixelMeasuresSequence=Sequence([item_of(PixelSpacing=[STEP, STEP], SliceThickness=STEP)]),
        PlaneOrientationSequence=Sequence([item_of(ImageOrientationPatient=[*turn[0], *turn[1]])]))])
    data.PerFrameFunctionalGroupsSequence = Sequence([item_of(
        PlanePositionSequence=Sequence([item_of(ImagePositionPatient=[float(x) for x in z * turn[2]])]),
        SegmentIdentificationSequence=Sequence([item_of(ReferencedSegmentNumber=segment)]))
        for segment, z, _ in frames])
    data.PixelData = np.packbits(np.concatenate([mask.ravel() for _, _, mask in frames]), bitorder="little").tobytes()
    if len(data.PixelData) % 2:
        data.PixelData += b"\0"
    return data


def check_segmentation(oracle, folder, mesh):
    """Two balls in planes that are turned, each without its empty frames, the planes between them without any."""
    turn = np.array([[0.8, 0.6, 0], [-0.48, 0.64, 0.6], [0.36, -0.48, 0.8]])
    balls = {1: ("Left ball", [50, 60, 40], 25), 4: ("Right ball", [70, 64, 130], 30)}
    places = np.arange(90) * STEP
    z, y, x = np.meshgrid(places, np.arange(SIZE) * STEP, np.arange(SIZE) * STEP, indexing="ij")
    frames = []
    for segment, (_, centre, radius) in balls.items():
        inside = (x - centre[0]) ** 2 + (y - centre[1]) ** 2 + (z - centre[2]) ** 2 <= radius**2
        frames += [(segment, places[n], plane) for n, plane in enumerate(inside) if plane.any()]
    frames = [frames[(37 * n) % len(frames)] for n in range(len(frames))]
    path = os.path.join(folder, "segments", "a.dcm")
    save(put_segmentation(path, frames, {n: name for n, (name, _, _) in balls.items()}, turn))
    with oracle.file(path):
        oracle.run("mesh", path, "--labels", "all", "-o", mesh, "--error", 0, "--quiet")
        for segment, (name, centre, radius) in balls.items():
            file = mesh.replace(".ply", f"_{name.replace(' ', '_')}.ply")
            points = ply_vertices(file)
            oracle.expect_near(points.mean(axis=0), np.array(centre) @ turn, 0.2, f"{name}: its middle")
            distance = np.sqrt(((points - np.array(centre) @ turn) ** 2).sum(axis=1))
            oracle.expect_near(distance, radius, STEP, f"{name}: its radius")
            check = oracle.check(file)
            oracle.expect_equal((check["euler"], check["open_edges"]), (2, 0), f"{name}: one closed ball")


def main():
    oracle = Oracle(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        mesh = os.path.join(folder, "mesh.ply")
        for check in (check_uneven, check_scaling, check_stacks, check_bare_exports, check_times,
                      check_segmentation):
            check(oracle, folder, mesh)
    oracle.finish()


if __name__ == "__main__":
    main()
