#!/usr/bin/python3
"""One volume, written in every format by other people's programs, is read alike.

Equal digests: where a format holds the whole geometry, in the world; elsewhere in index space. Info: the affine, the
least and the largest value that an independent reader finds. Surfaces lie where VTK has them.
"""

import gzip
import os
import shutil
import subprocess
import sys
import tempfile

from oracle import SKIP, Oracle, affine_of, np, ply_vertices, ras

try:
    import nibabel
    import pydicom
    import tifffile
    import vtk
    from PIL import Image
    from pydicom.dataset import Dataset, FileDataset, FileMetaDataset
    from pydicom.uid import (DeflatedExplicitVRLittleEndian, ExplicitVRBigEndian, ExplicitVRLittleEndian,
                             ImplicitVRLittleEndian, RLELossless)
    from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(SKIP)

ISO = 500.5
DIMS = (23, 19, 16)
# Oblique; steps along the axes that are exact in single precision, as NIfTI keeps them.
SPACING = np.array([1.125, 0.75, 2.25])
DIRECTION = np.array([[2, -1, 2], [2, 2, -1], [-1, 2, 2]]) / 3
ORIGIN = np.array([-31.25, 12.5, 104.75])


def affine(direction):
    matrix = np.eye(4)
    matrix[:3, :3] = direction * SPACING
    matrix[:3, 3] = ORIGIN
    return matrix


def samples():
    """A lopsided blob that touches one side, [k, j, i], 16 bits."""
    k, j, i = np.meshgrid(*(np.arange(n) for n in DIMS[::-1]), indexing="ij")
    distance = np.sqrt(((i - 10.3) / 7) ** 2 + ((j - 8.1) / 6) ** 2 + ((k - 4.7) / 6) ** 2)
    values = 1000 - 480 * distance + 40 * np.sin(0.9 * i) * np.cos(0.7 * j + 0.4 * k)
    return np.clip(np.round(values), 3, 1000).astype(np.uint16)


VALUES = samples()


def vtk_image(direction):
    image = vtk.vtkImageData()
    image.SetDimensions(DIMS)
    image.SetSpacing(SPACING)
    image.SetOrigin(ORIGIN)
    image.SetDirectionMatrix(direction.flatten())
    array = numpy_to_vtk(VALUES.ravel(), deep=True, array_type=vtk.VTK_UNSIGNED_SHORT)
    array.SetName("values")
    image.GetPointData().SetScalars(array)
    return image


def write_vtk(writer, image, path):
    writer.SetFileName(path)
    writer.SetInputData(image)
    writer.Write()
    return path


# Writers of the whole geometry: each takes a folder and a direction, and gives paths with their affine as an
# independent reader has it, in LPS, or nothing.


def write_nifti(folder, direction):
    for kind, name in ((nibabel.Nifti1Image, "a1.nii"), (nibabel.Nifti1Image, "a1.nii.gz"),
                       (nibabel.Nifti2Image, "a2.nii"), (nibabel.Nifti1Pair, "pair.hdr")):
        path = os.path.join(folder, name)
        nibabel.save(kind(VALUES.T, ras(affine(direction))), path)
        yield path, ras(nibabel.load(path).affine)


def write_vti(folder, direction):
    for mode in ("Appended", "Binary", "Ascii"):
        for compressor in ("None", "ZLib", "LZ4"):
            for bits in (32, 64):
                writer = vtk.vtkXMLImageDataWriter()
                getattr(writer, f"SetDataModeTo{mode}")()
                getattr(writer, f"SetCompressorTypeTo{compressor}")()
                getattr(writer, f"SetHeaderTypeToUInt{bits}")()
                writer.SetEncodeAppendedData(bits == 32)
                writer.SetBlockSize(4096)
                path = write_vtk(writer, vtk_image(direction), os.path.join(folder, f"{mode}{compressor}{bits}.vti"))
                reader = vtk.vtkXMLImageDataReader()
                reader.SetFileName(path)
                reader.Update()
                yield path, vtk_affine(reader.GetOutput())


def vtk_affine(image):
    matrix = np.eye(4)
    for axis in range(3):
        step = [0, 0, 0]
        step[axis] = 1
        origin = np.array(image.GetOrigin())
        point = [0, 0, 0]
        image.TransformContinuousIndexToPhysicalPoint(step, point)
        matrix[:3, axis] = np.array(point) - origin
    matrix[:3, 3] = image.GetOrigin()
    return matrix


def write_metaimage(folder, direction):
    """By VTK, but for the direction, which its writer leaves out."""
    for compressed in (False, True):
        writer = vtk.vtkMetaImageWriter()
        writer.SetCompression(compressed)
        path = write_vtk(writer, vtk_image(np.eye(3)), os.path.join(folder, f"{compressed}.mha"))
        with open(path, "rb") as file:
            content = file.read()
        identity = b"TransformMatrix = 1 0 0 0 1 0 0 0 1\n"
        assert identity in content
        columns = " ".join(f"{number:.17g}" for number in direction.T.flatten())
        with open(path, "wb") as file:
            file.write(content.replace(identity, f"TransformMatrix = {columns}\n".encode()))
        yield path, None


def write_nrrd(folder, direction):
    program = shutil.which("teem-unu") or shutil.which("unu")
    if not program:
        return
    raw = os.path.join(folder, "a.raw")
    VALUES.tofile(raw)
    vectors = [direction[:, axis] * SPACING[axis] for axis in range(3)]
    text = " ".join("(" + ",".join(f"{number:.17g}" for number in vector) + ")" for vector in vectors)
    for encoding, name in (("raw", "raw.nrrd"), ("gzip", "gzip.nrrd"), ("raw", "detached.nhdr")):
        path = os.path.join(folder, name)
        made = os.path.join(folder, "made.nrrd")
        subprocess.run([program, "make", "-i", raw, "-t", "ushort", "-s", *map(str, DIMS), "-e", "raw", "-en", "little",
                        "-spc", "LPS", "-dirs", text, "-orig", "(" + ",".join(map(str, ORIGIN)) + ")", "-o", made],
                       check=True, capture_output=True)
        subprocess.run([program, "save", "-f", "nrrd", "-e", encoding, "-i", made, "-o", path], check=True,
                       capture_output=True)
        yield path, None


def dicom_file(path, syntax, direction):
    meta = FileMetaDataset()
    meta.MediaStorageSOPClassUID = "1.2.840.10008.5.1.4.1.1.2"
    meta.MediaStorageSOPInstanceUID = pydicom.uid.generate_uid()
    meta.TransferSyntaxUID = syntax
    data = FileDataset(path, {}, file_meta=meta, preamble=b"\0" * 128)
    data.is_little_endian = syntax != ExplicitVRBigEndian
    data.is_implicit_VR = syntax == ImplicitVRLittleEndian
    data.SOPClassUID = meta.MediaStorageSOPClassUID
    data.SOPInstanceUID = meta.MediaStorageSOPInstanceUID
    data.SeriesInstanceUID = "1.2.3.4"
    data.Columns, data.Rows, _ = DIMS
    data.BitsAllocated = data.BitsStored = 16
    data.HighBit = 15
    data.PixelRepresentation = 0
    data.SamplesPerPixel = 1
    data.PhotometricInterpretation = "MONOCHROME2"
    return data


def decimal(numbers):
    return [pydicom.valuerep.DSfloat(float(number), auto_format=True) for number in numbers]


def place(data, direction, slices):
    """Puts orientation, spacing and position where a slice, or a frame's groups, have them."""
    orientation, measures, position = slices[1:]
    orientation.ImageOrientationPatient = decimal(direction[:, :2].T.flatten())
    measures.PixelSpacing = decimal([SPACING[1], SPACING[0]])
    position.ImagePositionPatient = decimal(ORIGIN + slices[0] * SPACING[2] * direction[:, 2])


def write_dicom(folder, direction):
    for number, syntax in enumerate((ExplicitVRLittleEndian, ImplicitVRLittleEndian, ExplicitVRBigEndian, RLELossless,
                                     DeflatedExplicitVRLittleEndian)):
        series = os.path.join(folder, str(number))
        os.mkdir(series)
        for k in range(DIMS[2]):
            path = os.path.join(series, f"{(7 * k) % DIMS[2]}.dcm")
            data = dicom_file(path, syntax, direction)
            place(data, direction, (k, data, data, data))
            order = ">u2" if syntax == ExplicitVRBigEndian else "<u2"
            data.PixelData = VALUES[k].astype(order).tobytes()
            if syntax == RLELossless:
                data.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
                data.compress(RLELossless)
            data.save_as(path, write_like_original=False)
        yield series, dicom_affine(series)
    for syntax in (ExplicitVRLittleEndian, DeflatedExplicitVRLittleEndian, RLELossless):
        place_of_file = os.path.join(folder, f"enhanced{syntax}")
        os.mkdir(place_of_file)
        path = os.path.join(place_of_file, "a.dcm")
        data = dicom_file(path, syntax, direction)
        data.NumberOfFrames = DIMS[2]
        shared = Dataset()
        shared.PixelMeasuresSequence = [Dataset()]
        shared.PlaneOrientationSequence = [Dataset()]
        data.SharedFunctionalGroupsSequence = [shared]
        frames = []
        for k in range(DIMS[2]):
            frame = Dataset()
            frame.PlanePositionSequence = [Dataset()]
            place(frame, direction, (k, shared.PlaneOrientationSequence[0], shared.PixelMeasuresSequence[0],
                                     frame.PlanePositionSequence[0]))
            frames.append(frame)
        data.PerFrameFunctionalGroupsSequence = frames
        data.PixelData = VALUES.tobytes()
        if syntax == RLELossless:
            data.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
            data.compress(RLELossless)
        data.save_as(path, write_like_original=False)
        yield path, None


def dicom_affine(series):
    """By pydicom: the columns of the standard's equation, and slices in the order of their distance."""
    slices = [pydicom.dcmread(os.path.join(series, name)) for name in os.listdir(series)]
    cosines = np.reshape([float(number) for number in slices[0].ImageOrientationPatient], (2, 3))
    normal = np.cross(*cosines)
    places = sorted(([float(number) for number in one.ImagePositionPatient] for one in slices),
                    key=lambda place: np.dot(place, normal))
    matrix = np.eye(4)
    matrix[:3, 0] = cosines[0] * float(slices[0].PixelSpacing[1])
    matrix[:3, 1] = cosines[1] * float(slices[0].PixelSpacing[0])
    matrix[:3, 2] = (np.array(places[-1]) - places[0]) / (len(places) - 1)
    matrix[:3, 3] = places[0]
    return matrix


# Writers of formats that keep spacing only, or nothing at all: paths with the spacing that the file says.


def write_tiff(folder):
    calibrated = {"resolution": (1 / SPACING[0], 1 / SPACING[1])}
    path = os.path.join(folder, "imagej.tif")
    tifffile.imwrite(path, VALUES, imagej=True, metadata={"axes": "ZYX", "spacing": SPACING[2], "unit": "mm"}, **calibrated)
    yield path, SPACING
    path = os.path.join(folder, "a.ome.tif")
    sizes = {"PhysicalSizeX": SPACING[0], "PhysicalSizeY": SPACING[1], "PhysicalSizeZ": SPACING[2]}
    tifffile.imwrite(path, VALUES, metadata={"axes": "ZYX", **sizes})
    yield path, SPACING
    for options in ({}, {"bigtiff": True}, {"byteorder": ">"}, {"compression": "deflate"},
                    {"compression": "deflate", "predictor": True}, {"compression": "deflate", "tile": (16, 16)}):
        path = os.path.join(folder, "".join(f"{value}" for value in options.values()).replace(" ", "") + "plain.tif")
        try:
            tifffile.imwrite(path, VALUES, photometric="minisblack", metadata=None, **options)
        except (ImportError, ValueError, KeyError):
            continue  # this tifffile lacks the codec
        yield path, None
    series = os.path.join(folder, "series")
    os.mkdir(series)
    for k in range(DIMS[2]):
        tifffile.imwrite(os.path.join(series, f"z{k}.tif"), VALUES[k], metadata=None)
    yield series, None
    writer = vtk.vtkTIFFWriter()
    writer.SetCompressionToPackBits()
    yield write_vtk(writer, vtk_image(np.eye(3)), os.path.join(folder, "vtk.tif")), None


def write_png(folder):
    series = os.path.join(folder, "png")
    os.mkdir(series)
    for k in range(DIMS[2]):
        Image.fromarray(VALUES[k].astype(np.int32), "I").save(os.path.join(series, f"{k}.png"))
    yield series, None


def write_legacy_vtk(folder):
    for binary in (True, False):
        writer = vtk.vtkStructuredPointsWriter()
        writer.SetFileType(vtk.VTK_BINARY if binary else vtk.VTK_ASCII)
        yield write_vtk(writer, vtk_image(np.eye(3)), os.path.join(folder, f"{binary}.vtk")), SPACING


def write_raw(folder):
    path = os.path.join(folder, "a_{}x{}x{}_uint16.raw".format(*DIMS))
    VALUES.tofile(path)
    yield path, None
    with gzip.open(path + ".gz", "wb") as file:
        file.write(VALUES.tobytes())
    yield path + ".gz", None


def write_npy(folder):
    """The same array is the same volume, however NumPy stores it."""
    for name, array in (("c", VALUES), ("f", np.asfortranarray(VALUES)), ("big", VALUES.astype(">u2")),
                        ("float", VALUES.astype(float)), ("four", VALUES[None])):
        path = os.path.join(folder, f"{name}.npy")
        np.save(path, array)
        yield path, None
    for version in ((1, 0), (2, 0), (3, 0)):
        path = os.path.join(folder, f"{version[0]}.npy.gz")
        with gzip.open(path, "wb") as file:
            np.lib.format.write_array(file, VALUES, version)
        yield path, None


def write_npz(folder):
    """Stored and deflated, alone and beside an array of fewer axes."""
    for name, write, arrays in (("s", np.savez, {}), ("c", np.savez_compressed, {}),
                                ("two", np.savez_compressed, {"affine": np.eye(4)}),
                                ("f", np.savez, {"ids": np.arange(4)})):
        path = os.path.join(folder, f"{name}.npz")
        write(path, ct=np.asfortranarray(VALUES) if name == "f" else VALUES, **arrays)
        yield path, None
    path = os.path.join(folder, "unnamed.npz")
    np.savez(path, VALUES)
    yield path, None


def write_analyze(folder):
    """By nibabel, in its three dialects; all but the first keep a scale, which is 1 here."""
    for kind in (nibabel.AnalyzeImage, nibabel.Spm99AnalyzeImage, nibabel.Spm2AnalyzeImage):
        for order in "<>":
            path = os.path.join(folder, f"{kind.__name__}{'big' if order == '>' else 'little'}.hdr")
            header = kind.header_class(endianness=order)
            header.set_data_dtype(np.int16)
            image = kind(VALUES.T.astype(np.int16), np.diag([*SPACING, 1]), header)
            nibabel.save(image, path)
            yield path, SPACING
            yield path[:-3] + "img", SPACING


def check_values(oracle, info, path):
    oracle.expect_equal(tuple(info["dims"]), DIMS, f"{path}: dims")
    oracle.expect_equal((info["min"], info["max"]), (VALUES.min(), VALUES.max()), f"{path}: range")


def check_placed_file(oracle, path, expected, independent, mesh, digests, sign):
    info = oracle.info(path)
    check_values(oracle, info, path)
    found = affine_of(info) if info["space"] != "ras" else ras(affine_of(info))
    oracle.expect_near(found, expected, 1e-6, f"{path}: affine")
    if independent is not None:
        oracle.expect_near(found, independent, 1e-6, f"{path}: affine of an independent reader")
    check = oracle.mesh(path, mesh, "--iso", ISO, "--space", "lps")
    digests.setdefault((sign, check["digest"]), []).append(path)
    oracle.expect(check["volume"] > 0 and check["open_edges"] == 0, f"{path}: closed, and facing outwards")
    in_index_space(oracle, path, mesh, digests)


def check_placed(oracle, folder, mesh):
    """Formats with the whole geometry: right-handed, and left-handed where a format can be that."""
    digests = {}
    for sign, writers in ((1, (write_nifti, write_vti, write_metaimage, write_nrrd, write_dicom)),
                          (-1, (write_nifti, write_vti, write_metaimage, write_nrrd))):
        direction = DIRECTION * [1, sign, 1]
        for write in writers:
            place = os.path.join(folder, f"{write.__name__}{sign}")
            os.mkdir(place)
            for path, independent in write(place, direction):
                with oracle.file(path):
                    check_placed_file(oracle, path, affine(direction), independent, mesh, digests, sign)
    return digests


def check_mgh(oracle, folder, mesh, digests):
    """FreeSurfer's directions are rounded to single precision, so that only places in index space are bit for bit."""
    for sign in (1, -1):
        for name in ("a.mgh", "a.mgz"):
            path = os.path.join(folder, f"{sign}{name}")
            nibabel.save(nibabel.MGHImage(VALUES.T.astype(np.int16), ras(affine(DIRECTION * [1, sign, 1]))), path)
            with oracle.file(path):
                info = oracle.info(path)
                check_values(oracle, info, path)
                oracle.expect_equal(info["space"], "ras", f"{path}: space")
                oracle.expect_near(affine_of(info), nibabel.load(path).affine, 1e-5, f"{path}: affine")
                oracle.expect_near(ras(affine_of(info)), affine(DIRECTION * [1, sign, 1]), 1e-4, f"{path}: as written")
                in_index_space(oracle, path, mesh, digests)


def in_index_space(oracle, path, mesh, digests):
    check = oracle.mesh(path, mesh, "--iso", ISO, "--space", "index", "--spacing", "1,1,1")
    digests.setdefault(("index", check["digest"]), []).append(path)


def check_unplaced(oracle, folder, mesh, digests):
    for write in (write_tiff, write_png, write_legacy_vtk, write_raw, write_npy, write_npz, write_analyze):
        place = os.path.join(folder, write.__name__)
        os.mkdir(place)
        for path, spacing in write(place):
            with oracle.file(path):
                info = oracle.info(path)
                check_values(oracle, info, path)
                if spacing is not None:
                    oracle.expect_near(info["spacing"], spacing, 1e-6, f"{path}: spacing")
                in_index_space(oracle, path, mesh, digests)


def surface_of_vtk(direction, contour):
    """Vertices in the world: VTK's in index space, moved there by the affine."""
    image = vtk_image(np.eye(3))
    image.SetSpacing(1, 1, 1)
    image.SetOrigin(0, 0, 0)
    contour.SetInputData(image)
    contour.SetValue(0, ISO)
    contour.ComputeNormalsOff()
    contour.Update()
    points = vtk_to_numpy(contour.GetOutput().GetPoints().GetData()).astype(float)
    return points @ (direction * SPACING).T + ORIGIN


def farthest(a, b):
    """The largest distance from a point of one list to the nearest of the other."""
    return max(np.sqrt(((b - point) ** 2).sum(axis=1).min()) for point in a)


def check_surface(oracle, folder, mesh):
    for sign in (1, -1):
        direction = DIRECTION * [1, sign, 1]
        place = os.path.join(folder, f"surface{sign}")
        os.mkdir(place)
        path = next(write_nifti(place, direction))[0]
        oracle.mesh(path, mesh, "--iso", ISO, "--error", "0", "--open", "--space", "lps")
        ours = ply_vertices(mesh)
        for contour in (vtk.vtkFlyingEdges3D(), vtk.vtkMarchingCubes()):
            theirs = surface_of_vtk(direction, contour)
            slack = 1e-4 * SPACING.min()
            for a, b, way in ((ours, theirs, "to VTK"), (theirs, ours, "from VTK")):
                distance = farthest(a, b)
                oracle.expect(distance <= slack, f"{contour.GetClassName()}, determinant {sign}: {distance} {way}")


def main():
    oracle = Oracle(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        mesh = os.path.join(folder, "mesh.ply")
        digests = check_placed(oracle, folder, mesh)
        check_mgh(oracle, folder, mesh, digests)
        check_unplaced(oracle, folder, mesh, digests)
        for group in (1, -1, "index"):
            found = {digest: paths for (which, digest), paths in digests.items() if which == group}
            oracle.expect(len(found) == 1, f"one digest in group {group}, found {found}")
            print(f"group {group}: {sum(map(len, found.values()))} files, digest {', '.join(found)}")
        check_surface(oracle, folder, mesh)
    oracle.finish()


if __name__ == "__main__":
    main()
