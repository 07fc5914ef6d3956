"""Label maps that other programs write, of every type and with names: the labels that isoweave finds, and their meshes.

Usage: labels.py ISOWEAVE
Ids lie beyond 2^32 and 2^53, so that a number that is rounded anywhere is another label.
"""

import json
import os
import sys
import tempfile

from oracle import SKIP, Oracle, np

try:
    import h5py
    import nibabel
    import tifffile
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(SKIP)

SHAPE = (16, 20, 24)  # k, j, i


def label_map():
    """Two balls that touch as labels 1 and 2."""
    k, j, i = np.indices(SHAPE)
    labels = np.zeros(SHAPE, np.int64)
    labels[(i - 7) ** 2 + (j - 9) ** 2 + (k - 8) ** 2 < 36] = 1
    labels[(i - 16) ** 2 + (j - 9) ** 2 + (k - 7) ** 2 < 25] = 2
    return labels


def as_ids(labels, dtype):
    ids = {1: 7112614941, 2: 9007199254740993} if np.dtype(dtype).itemsize == 8 and dtype[0] != "f" else {1: 17, 2: 53}
    return np.choose(labels, [0, ids[1], ids[2]]).astype(dtype), [ids[1], ids[2]]


def write_nifti(folder, data):
    path = os.path.join(folder, "a.nii.gz")
    nibabel.save(nibabel.Nifti1Image(data.T, np.eye(4), dtype=data.dtype), path)
    return path


def write_tiff(folder, data):
    path = os.path.join(folder, "a.tif")
    tifffile.imwrite(path, data, photometric="minisblack", compression="zlib", predictor=False)
    return path


def write_hdf5(folder, data):
    path = os.path.join(folder, "a.h5")
    with h5py.File(path, "w") as file:
        file.create_dataset("labels", data=data, chunks=(4, 8, 8), compression="gzip", shuffle=True)
    return path


def write_vti(folder, data):
    image = vtk.vtkImageData()
    image.SetDimensions(*reversed(data.shape))
    array = numpy_to_vtk(data.ravel(), deep=True)
    array.SetName("labels")
    image.GetPointData().SetScalars(array)
    writer = vtk.vtkXMLImageDataWriter()
    path = os.path.join(folder, "a.vti")
    writer.SetFileName(path)
    writer.SetInputData(image)
    writer.Write()
    return path


def labels_of(oracle, folder, path, *options):
    report = os.path.join(folder, "report.json")
    oracle.run("mesh", path, "-o", os.path.join(folder, "seg.ply"), "--labels", "all", "--space", "index", "--quiet",
               "--report", report, *options)
    with open(report, encoding="utf-8") as file:
        return json.load(file)["labels"]


def expected_digests(oracle, folder):
    """Of the masks as files of their own."""
    digests = []
    for label in (1, 2):
        path = os.path.join(folder, "mask_24x20x16_uint8.raw")
        (label_map() == label).astype(np.uint8).tofile(path)
        digests.append(oracle.mesh(path, os.path.join(folder, "mask.ply"), "--iso", "0.5", "--space", "index")["digest"])
    return digests


def check_types(oracle, folder, digests):
    for write in (write_nifti, write_tiff, write_hdf5, write_vti):
        for dtype in ("uint8", "int64", "uint64", "float32", "float64"):
            data, ids = as_ids(label_map(), dtype)
            with oracle.file(f"{write.__name__} {dtype}"):
                path = write(folder, data)
                found = labels_of(oracle, folder, path)
                oracle.expect_equal([entry["label"] for entry in found], ids, f"{write.__name__} {dtype}: labels")
                oracle.expect_equal([entry["digest"] for entry in found], digests, f"{write.__name__} {dtype}: digests")
                oracle.expect_equal(oracle.info(path)["max"], ids[1], f"{write.__name__} {dtype}: largest")


def main():
    oracle = Oracle(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        check_types(oracle, folder, expected_digests(oracle, folder))
    oracle.finish()


if __name__ == "__main__":
    main()
