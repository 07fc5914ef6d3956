#!/usr/bin/python3
"""Channels, times and units of stacks that tifffile, nibabel and h5py wrote, chosen and read as those read them."""

import itertools
import os
import sys
import tempfile

from oracle import SKIP, Oracle, affine_of, np

try:
    import h5py
    import nibabel
    import tifffile
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(SKIP)

SIZES = {"T": 2, "C": 3, "Z": 4, "Y": 5, "X": 6}
SPACING = (25, 30, 50)  # nanometres


def stack(axes):
    """Samples that all differ, along axes from the slowest to the fastest."""
    shape = [SIZES[axis] for axis in axes]
    return np.arange(np.prod(shape), dtype=np.uint16).reshape(shape)


def check_volume(oracle, path, expected, *options):
    """`expected`: samples [z, y, x], all different, so that their range tells which were read."""
    info = oracle.info(path, *options)
    what = " ".join(map(str, (os.path.basename(path),) + options))
    oracle.expect_equal(tuple(info["dims"]), expected.shape[::-1], f"{what}: dims")
    oracle.expect_near((info["min"], info["max"]), (expected.min(), expected.max()), 1e-6, f"{what}: range")
    return info


def check_choices(oracle, path, data, axes):
    for time, channel in itertools.product(range(SIZES["T"]), range(SIZES["C"])):
        at = tuple({"T": time, "C": channel}.get(axis, slice(None)) for axis in axes)
        check_volume(oracle, path, data[at], "--time", time, "--channel", channel)


def check_spacing(oracle, path, spacing, unit, *options):
    info = oracle.info(path, *options)
    oracle.expect_near(info["spacing"], spacing, 1e-4 * min(spacing), f"{path}: spacing")
    oracle.expect_equal(info["unit"], unit, f"{path}: unit")


def check_tiff(oracle, folder):
    data = stack("TZCYX")
    resolution = (1 / SPACING[0], 1 / SPACING[1])
    path = os.path.join(folder, "imagej.tif")
    tifffile.imwrite(path, data, imagej=True, resolution=resolution,
                     metadata={"axes": "TZCYX", "spacing": SPACING[2] / 1000, "unit": "nm", "zunit": "um"})
    with oracle.file(path):
        check_choices(oracle, path, data, "TZCYX")
        check_spacing(oracle, path, SPACING, "nm")
    for order in itertools.permutations("TCZ"):
        axes = "".join(order) + "YX"
        data = stack(axes)
        path = os.path.join(folder, f"{axes}.ome.tif")
        units = {"PhysicalSizeXUnit": "nm", "PhysicalSizeYUnit": "nm", "PhysicalSizeZUnit": "µm"}
        sizes = {f"PhysicalSize{axis}": size for axis, size in zip("XYZ", (SPACING[0], SPACING[1], SPACING[2] / 1000))}
        tifffile.imwrite(path, data, metadata={"axes": axes, **sizes, **units})
        with oracle.file(path):
            check_choices(oracle, path, data, axes)
            check_spacing(oracle, path, SPACING, "nm")
    # Pages in an order of their own, which TiffData says.
    path = os.path.join(folder, "turned.ome.tif")
    planes = "".join(f'<TiffData IFD="{SIZES["T"] - 1 - time}" FirstT="{time}"/>' for time in range(SIZES["T"]))
    text = (f'<OME><Image><Pixels DimensionOrder="XYZCT" SizeX="{SIZES["X"]}" SizeY="{SIZES["Y"]}" SizeZ="1" SizeC="1" '
            f'SizeT="{SIZES["T"]}" Type="uint16">{planes}</Pixels></Image></OME>')
    with tifffile.TiffWriter(path) as writer:
        for time, page in enumerate(stack("TYX")):
            writer.write(page, contiguous=False, metadata=None, description=text if time == 0 else None)
    with oracle.file(path):
        for time, page in enumerate(tifffile.imread(path)):
            check_volume(oracle, path, page[np.newaxis], "--time", time)
    for axes, metadata in (("TCZYX", {"axes": "TCZYX"}), ("TCZYX", {}), ("ZCTYX", {"axes": "ZCTYX"})):
        data = stack(axes)
        path = os.path.join(folder, f"{axes}{len(metadata)}.tif")
        tifffile.imwrite(path, data, photometric="minisblack", metadata=metadata)
        with oracle.file(path):
            check_choices(oracle, path, data, axes)
    # What tifffile writes without names of axes: slices as channels or frames.
    path = os.path.join(folder, "frames.tif")
    tifffile.imwrite(path, stack("ZYX"), imagej=True)
    with oracle.file(path):
        named = dict(line.split("=", 1) for line in tifffile.TiffFile(path).pages[0].description.splitlines() if "=" in line)
        axis = next((word for word, key in (("channel", "channels"), ("time", "frames")) if key in named), None)
        check_volume(oracle, path, stack("ZYX"), *(["--slices-from", axis] if axis else []))


def check_nifti(oracle, folder):
    data = stack("CTZYX")
    affine = np.diag([*SPACING, 1.0])
    for name, header in (("a.nii", nibabel.Nifti1Image), ("a.nii.gz", nibabel.Nifti2Image)):
        path = os.path.join(folder, name)
        nibabel.save(header(data.T.astype(np.int16), affine), path)
        with oracle.file(path):
            check_choices(oracle, path, data, "CTZYX")


def box(affine, last):
    """The least and the largest coordinates of the corners of a volume."""
    corners = [(affine @ [*(last * np.array(corner)), 1])[:3] for corner in itertools.product((0, 1), repeat=3)]
    return np.array([np.min(corners, axis=0), np.max(corners, axis=0)])


def check_minc(oracle, path):
    image = nibabel.load(path)
    values = image.get_fdata()
    while values.ndim > 3:
        values = values[0]
    info = oracle.info(path)
    oracle.expect_near((info["min"], info["max"]), (values.min(), values.max()), 1e-3, f"{path}: range")
    # nibabel's axes are those of the file; ours are x, y and z, wherever they run. Both fill the same box.
    ours = box(affine_of(info), np.array(info["dims"]) - 1)
    oracle.expect_near(ours, box(image.affine, np.array(values.shape) - 1), 1e-3, f"{path}: corners")
    oracle.expect_equal(info["space"], "ras", f"{path}: space")


def check_minc_files(oracle):
    folder = os.path.join(os.path.dirname(nibabel.__file__), "tests", "data")
    for name in ("minc2_1_scale.mnc", "minc2_4d.mnc", "minc2-4d-d.mnc", "small.mnc"):
        path = os.path.join(folder, name)
        if not os.path.exists(path):
            continue
        with oracle.file(path):
            check_minc(oracle, path)


def check_imaris(oracle, folder):
    path = os.path.join(folder, "a.ims")
    data = stack("TCZYX")
    def letters(text):
        return np.frombuffer(text.encode(), "S1")
    with h5py.File(path, "w") as file:
        image = file.create_group("DataSetInfo/Image")
        for axis, (name, size) in enumerate(zip("XYZ", (SIZES["X"], SIZES["Y"], SIZES["Z"]))):
            image.attrs[name] = letters(str(size))
            image.attrs[f"ExtMin{axis}"] = letters("10.5")
            image.attrs[f"ExtMax{axis}"] = letters(str(10.5 + size * SPACING[axis]))
        image.attrs["Unit"] = letters("nm")
        for time, channel in itertools.product(range(SIZES["T"]), range(SIZES["C"])):
            group = file.create_group(f"DataSet/ResolutionLevel 0/TimePoint {time}/Channel {channel}")
            for axis in "XYZ":
                group.attrs[f"ImageSize{axis}"] = letters(str(SIZES[axis]))
            padded = np.zeros((8, 8, 8), np.uint16)
            padded[:SIZES["Z"], :SIZES["Y"], :SIZES["X"]] = data[time, channel]
            group.create_dataset("Data", data=padded, chunks=(4, 8, 8), compression="gzip")
    with oracle.file(path):
        check_choices(oracle, path, data, "TCZYX")
        check_spacing(oracle, path, SPACING, "nm")
        oracle.expect_near(oracle.info(path)["origin"], np.array(SPACING) / 2 + 10.5, 1e-6, "imaris: origin")


def main():
    oracle = Oracle(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        check_tiff(oracle, folder)
        check_nifti(oracle, folder)
        check_imaris(oracle, folder)
    check_minc_files(oracle)
    oracle.finish()


if __name__ == "__main__":
    main()
