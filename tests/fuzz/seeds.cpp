// Small valid files, which are seeds for the fuzzer.
#include "seeds.hpp"

#include <filesystem>
#include <string>

#include "header_helpers.hpp"
#include "isoweave/generate.hpp"
#include "isoweave/index.hpp"
#include "isoweave/mesh.hpp"
#include "isoweave/pipeline.hpp"
#include "meshes.hpp"
#include "pipeline/checkpoint.hpp"
#include "pvm_helpers.hpp"
#include "volume/formats/formats.hpp"
#include "volume/volume_index.hpp"
#include "vti_helpers.hpp"
#ifdef ISOWEAVE_HAS_GDCM
#include "dicom_segment_helpers.hpp"
#endif
#ifdef ISOWEAVE_HAS_PNG
#include "png_helpers.hpp"
#endif
#ifdef ISOWEAVE_HAS_TIFF
#include "tiff_helpers.hpp"
#endif

namespace {

using namespace isoweave;
using namespace isoweave::testing;

using fuzz::kNext;
using fuzz::Seeds;

const std::string kWords = stored(ramp<std::int16_t>(3 * 2 * 5));
const std::string kHalves = kNext + kWords.substr(0, 30) + kNext + kWords.substr(30);

void put_raw(Seeds& seeds) { seeds.put("raw", kWords); }

void put_nrrd(Seeds& seeds) {
  const std::string sizes = "NRRD0005\n# text\ntype: short\ndimension: 3\nsizes: 3 2 5\nendian: little\n";
  seeds.put("nrrd",
            sizes + "encoding: raw\nspacings: 1 2 3.5\naxis mins: 1 2 3\nunits: \"mm\" \"mm\" \"mm\"\n\n" + kWords);
  const std::string placed = sizes +
                             "space: left-posterior-superior\nspace units: \"um\" \"um\" \"um\"\nspace directions: "
                             "(0,-0.5,0) (2,0,0.25) (0,0,1)\nspace origin: (1,-2,3e1)\nkinds: domain domain domain\n";
  seeds.put("nrrd", placed + "encoding: gzip\nkey:=value\n\n" + gzipped(kWords));
  seeds.put("nrrd", placed + "encoding: raw\nbyte skip: -1\ndata file: a1.raw\n" + kNext + "abc" + kWords);
  seeds.put("nrrd", placed + "encoding: gz\nline skip: 1\nbyte skip: 2\ndatafile: a1.raw\n" + kNext + "x\n" +
                        gzipped("ab" + kWords));
  seeds.put("nrrd", sizes + "encoding: raw\ndata file: a%d.raw 1 2 1\n" + kHalves);
  seeds.put("nrrd", sizes + "encoding: raw\ndata file: LIST\na1.raw\na2.raw\n" + kHalves);
  seeds.put("nrrd",
            "NRRD0004\ntype: float\ndimension: 4\nsizes: 1 2 2 2\nendian: big\nencoding: raw\nspace dimension: 3\n"
            "space directions: none (1,0,0) (0,1,0) (0,0,1)\n\n" +
                std::string(32, '\x3f'));
  seeds.put("nrrd",
            "NRRD0005\ntype: short\ndimension: 5\nsizes: 2 3 1 5 1\nkinds: list domain domain domain time\n"
            "endian: little\nencoding: raw\nspacings: nan 1 2 3 nan\nunits: \"\" \"nm\" \"um\" \"nm\" \"s\"\n\n" +
                kWords);
  seeds.put("nrrd",
            "NRRD0005\ntype: short\ndimension: 4\nsizes: 3 1 5 2\nspace: left-posterior-superior-time\n"
            "space directions: (1,0,0,0) (0,2,0,0) (0,0,3,0) (0,0,0,1)\nspace origin: (1,2,3,0)\nencoding: text\n\n"
            "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30\n");
  seeds.put("nrrd",
            "NRRD0004\ntype: longlong\ndimension: 4\nsizes: 2 1 2 1\nkinds: list domain domain domain\nendian: little\n"
            "encoding: raw\nSegment0_Name:=a\\nb\nSegment0_LabelValue:=2\nSegment0_Layer:=1\n"
            "Segment0_Color:=1 0 0.5\nSegment1_Name:=c\n\n" +
                std::string(32, '\2'));
  seeds.put("nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: hex\n\n00 7fFF\n12345678 9a");
}

void put_metaimage(Seeds& seeds) {
  const std::string head =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nDimSize = 3 2 5\n"
      "ElementType = MET_SHORT\n";
  const std::string place =
      "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 1 -2 3.5\nCenterOfRotation = 0 0 0\nAnatomicalOrientation = RAI\n"
      "ElementSpacing = 0.5 1 2e0\n";
  seeds.put("metaimage", head + place + "ElementDataFile = LOCAL\n" + kWords);
  const std::string packed = zlibbed(kWords);
  seeds.put("metaimage", head + place + "CompressedData = True\nCompressedDataSize = " + std::to_string(packed.size()) +
                             "\nElementDataFile = LOCAL\n" + packed);
  seeds.put("metaimage", head + "HeaderSize = -1\nElementDataFile = a1.raw\n" + kNext + "abc" + kWords);
  seeds.put("metaimage", head + "HeaderSize = 5\nElementDataFile = a1.raw\n" + kNext + "abcde" + kWords);
  seeds.put("metaimage", head + "CompressedData = True\nElementDataFile = a1.raw\n" + kNext + zlibbed(kWords));
  seeds.put("metaimage", head + "ElementDataFile = LIST\na1.raw\na2.raw\n" + kHalves);
  seeds.put("metaimage", head + "ElementDataFile = a%d.raw 1 2 1\n" + kHalves);
  seeds.put("metaimage",
            "NDims = 4\nDimSize = 3 1 1 5\nElementNumberOfChannels = 2\nElementType = MET_SHORT\n"
            "DistanceUnits = cm\nElementSpacing = 1 2 3 4\nElementSize = 1 2 4 4\nElementDataFile = LOCAL\n" +
                kWords);
}

void put_nifti(Seeds& seeds) {
  for (const int version : {1, 2}) {
    for (const bool big : {false, true}) {
      NiftiFields fields;
      fields.version = version;
      fields.big = big;
      fields.slope = 2;
      fields.sform = big ? 1 : 0;
      fields.qform = big ? 0 : 1;
      fields.quaternion = {0.5, 0.5, 0.5, 1, 2, 3};
      const std::string file = nifti_header(fields) + stored(ramp<std::int16_t>(3 * 2 * 5), big);
      seeds.put("nifti", file);
      seeds.put("nifti", gzipped(file));
      fields.dim = {5, 3, 1, 1, 5, 2, 1, 1};
      seeds.put("nifti", nifti_header(fields) + kWords);
      fields.dim = {3, 3, 2, 5, 1, 1, 1, 1};
      fields.pair = true;
      seeds.put("nifti_pair", nifti_header(fields) + kNext + kWords);
    }
  }
}

// Headers of numbers at fixed places, and NumPy's.
void put_plain_headers(Seeds& seeds) {
  for (const bool big : {false, true}) {
    const std::string samples = stored(ramp<std::int16_t>(3 * 2 * 5), big);
    seeds.put("analyze", analyze_header({.big = big, .scale = 0.5, .origin = {1, 2, 3}}) + kNext + samples);
    seeds.put("mrc", mrc_header({.big = big, .start = {1, 2, 3}, .extended = 4}) + "ext " + samples);
    seeds.put("mrc", mrc_header({.big = big,
                                 .angles = {60, 70, 80},
                                 .axes = {3, 1, 2},
                                 .imod_flags = 0,
                                 .origin = {1, 2, 3},
                                 .magic = false}) +
                         samples);
    seeds.put("npy", npy_header(big ? ">i2" : "<i2", "(5, 2, 3)", big) + samples);
    seeds.put("npy", npy_header(big ? ">f2" : "<f2", "(5, 2, 3)", big) + samples);
    seeds.put("npy", npy_header(big ? ">i2" : "<i2", "(1L, 10, 3,)", false, big ? 2 : 3) + samples);
    seeds.put("mgh", mgh_header({.placed = big, .centre = {1, 2, 3}}) + stored(ramp<std::int16_t>(3 * 2 * 5), true));
  }
  const std::string amira =
      " 2.1\ndefine Lattice 3 2 5\nParameters {\n    BoundingBox 1 2 -4 -2 10 30,\n    CoordType "
      "\"uniform\"\n}\nLattice { ";
  seeds.put("amira", "# AmiraMesh BINARY-LITTLE-ENDIAN" + amira + "short Data } @1\n@1\n" + kWords);
  seeds.put("amira", "# Avizo BINARY" + amira + "byte Data } @1(HxByteRLE,4)\n@1\n\x1c\x07\x82z");
  const std::string zipped = zlibbed(kWords);
  seeds.put("amira", "# AmiraMesh BINARY" + amira + "ushort Data } @1(HxZip," + std::to_string(zipped.size()) +
                         ")\n@1\n" + zipped);
  const std::string slc = "11111\n4 3 2 8\n0.5 0.75 2\n1 0 0\n";
  seeds.put("slc", slc + "0\n2 1 Xrrggbb" + kWords.substr(0, 24));
  seeds.put("slc", slc + "1\n0 0 X" +
                       std::string("3 X\x0c\x07\0"
                                   "4 X\x08\x07\x84zzzz",
                                   16));
  std::string fits;
  for (std::string card : {"SIMPLE  = T", "BITPIX  = 16 / bits", "NAXIS   = 3", "NAXIS1  = 3", "NAXIS2  = 2",
                           "NAXIS3  = 5", "BSCALE  = 2.5", "BZERO   = 1e3", "END"}) {
    card.resize(80, ' ');
    fits += card;
  }
  fits.resize(2880, ' ');
  seeds.put("fits", fits + kWords);
  seeds.put("mgh", gzipped(mgh_header({}) + kWords));
  for (const std::string& content :
       {npy_header("<i2", "(5, 2, 3)") + kWords, npy_header("<i2", "(5, 2, 3)", true) + kWords, mrc_header({}) + kWords,
        std::string("II*\0", 4), std::string("PVM\n1 1 1\n1\nx")}) {
    seeds.put("gzip", gzipped(content));
  }
}

void put_pvm(Seeds& seeds) {
  const std::string bytes = stored(ramp<std::uint8_t>(4 * 3 * 5));
  seeds.put("pvm", "PVM\n# text\n4 3 5\n1\n" + bytes);
  seeds.put("pvm", "PVM2\n4 3 5\n1 2 0.5\n1\n" + bytes);
  const std::string third = "PVM3\n4 3 5\n1 2 0.5\n2\n" + bytes + bytes + pvm_files::kStrings;
  seeds.put("pvm", third);
  seeds.put("pvm", pvm_files::dds_v3d(third, 1, 1));
  seeds.put("pvm", pvm_files::dds_v3d(third, 2, 5));
  seeds.put("pvm", "DDS v3e\n" + pvm_files::dds_encoded(third, 2, 5, 1 << 24));
}

void put_vtk(Seeds& seeds) {
  for (const std::size_t block : {0U, 50U}) {
    for (const bool wide : {false, true}) {
      vti_files::VtiForm form;
      form.block = block;
      form.wide = wide;
      form.big = wide;
      seeds.put("vti", whole(form));
      form.lz4 = true;
      seeds.put("vti", whole(form));
      form.lz4 = false;
      form.appended = true;
      form.base64 = false;
      form.place = R"(WholeExtent="1 4 0 2 -1 3" Origin="1 2 3" Spacing="1 .5 2" Direction="0 1 0 1 0 0 0 0 -1")";
      form.extent = "1 4 0 2 -1 3";
      seeds.put("vti", whole(form));
    }
  }
  seeds.put("vti",
            "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 0 0 1\"><Piece><PointData><DataArray "
            "type=\"Float32\" format=\"ascii\"> 1 -2e3\n3 4.5 </DataArray></PointData></Piece></ImageData></VTKFile>");
  const std::string head = "# vtk DataFile Version 3.0\na title\n";
  const std::string set =
      "DATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 5\nORIGIN 1 -2 3\nSPACING 0.5 1 2\nPOINT_DATA 30\nSCALARS s short\n"
      "LOOKUP_TABLE default\n";
  seeds.put("vtk", head + "BINARY\n" + set + kWords);
  std::string numbers;
  for (const std::int16_t sample : ramp<std::int16_t>(30)) numbers += std::to_string(sample) + "\n";
  seeds.put("vtk", head + "ASCII\n" + set + numbers);
}

#ifdef ISOWEAVE_HAS_TIFF
void put_tiff(Seeds& seeds) {
  const TempFolder folder;
  const std::string two = stored(ramp<std::uint16_t>(5 * 4 * 2));
  const auto add = [&](const TiffPage& page, const std::string& samples, const std::string& mode) {
    seeds.put("tiff", get(write_stack(folder / "a", page, samples, mode)));
  };
  for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS,
                                COMPRESSION_ZSTD, COMPRESSION_LZMA}) {
    TiffPage page;
    page.compression = static_cast<std::uint16_t>(compression);
    if (TIFFIsCODECConfigured(page.compression) == 0) continue;
    add(page, two, compression == COMPRESSION_NONE ? "wb" : "w");
    page.predictor = compression == COMPRESSION_LZW || compression == COMPRESSION_ADOBE_DEFLATE ? 2 : 1;
    page.tile = 16;
    add(page, two, "w8");
  }
  TiffPage eight;
  eight.bits = 8;
  eight.compression = COMPRESSION_JPEG;
  eight.width = eight.height = eight.rows_per_strip = 16;
  add(eight, std::string(256, 'x'), "w");
  TiffPage real;
  real.bits = 32;
  real.format = SAMPLEFORMAT_IEEEFP;
  real.compression = COMPRESSION_ADOBE_DEFLATE;
  real.predictor = 3;
  add(real, stored(ramp<float>(20)), "w");
  TiffPage described;
  described.description = "ImageJ=1.53\nimages=2\nslices=2\nunit=\\u00B5m\nspacing=2.5\ncf=0\nc0=-32768\nc1=1\n";
  described.resolution = 4;
  add(described, two, "wb");
  described.description =
      "<?xml version=\"1.0\"?><OME><Image><Pixels DimensionOrder=\"XYCZT\" SizeX=\"5\" SizeY=\"4\" SizeZ=\"1\" "
      "SizeC=\"2\" "
      "SizeT=\"1\" PhysicalSizeX=\"0.5\" PhysicalSizeY=\"0.5\" PhysicalSizeZ=\"2\" PhysicalSizeXUnit=\"nm\" "
      "PhysicalSizeYUnit=\"nm\" PhysicalSizeZUnit=\"nm\"/></Image></OME>";
  add(described, two, "w");
  HandMade contiguous;
  contiguous.description = "ImageJ=1.53\nimages=2\nslices=2\n";
  seeds.put("tiff", hand_made(contiguous, two));
  contiguous.description = "ImageJ=1.53\nimages=2\nframes=2\nslices=1\nunit=nm\nzunit=pixel\nspacing=2\n";
  seeds.put("tiff", hand_made(contiguous, two));
  const std::string one = get(write_stack(folder / "a", {}, two.substr(0, 40)));
  seeds.put("tiff_series", one + kNext + one + kNext + one);
}
#endif

#ifdef ISOWEAVE_HAS_PNG
void put_png(Seeds& seeds) {
  using namespace png_files;
  const TempFolder folder;
  const std::string samples = stored(ramp<std::uint16_t>(kWidth * kHeight));
  for (const int bits : {8, 16}) {
    for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
      seeds.put("png", get(write_png(folder / "a", {bits, PNG_COLOR_TYPE_GRAY, interlace}, samples)));
    }
  }
  seeds.put("png", get(write_png(folder / "a", {8, PNG_COLOR_TYPE_RGB}, samples)));
}
#endif

#ifdef ISOWEAVE_HAS_GDCM
// Without magic, without groups, at uneven distances, with another scaling on each slice, and in folders of folders.
void put_dicom_as_found(Seeds& seeds) {
  using namespace dicom_files;
  DicomFields fields;
  const std::string plain = dicom(fields, slice(0));
  seeds.put("dicom", plain.substr(kDicomMagicEnd));
  seeds.put("dicom", plain.substr(plain.find(element(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2"))));
  fields.frames = "2";
  const std::string two = slice(0) + slice(1);
  for (const std::string& more :
       {element(0x18, 0x88, "DS", "1.5"), element(0x3004, 0xc, "DS", "30\\33") + element(0x3004, 0xe, "DS", "0.1"),
        element(0x28, 9, "AT", stored<std::uint16_t>({0x54, 0x80})) +
            element(0x54, 0x80, "US", stored<std::uint16_t>({2, 1}))}) {
    fields.more = more;
    seeds.put("dicom", dicom(fields, two));
  }
  fields = {};
  std::string series;
  for (const double z : {1.0, 2.0, 4.0}) {
    fields.position = at(z);
    fields.slope = std::to_string(z);
    series += (series.empty() ? "" : kNext) + dicom(fields, slice(0));
  }
  seeds.put("dicom_series", series);
  seeds.put("dicom_export", plain + kNext + series);
}

void put_dicom_segments(Seeds& seeds) {
  using namespace dicom_files;
  const std::vector<SegmentFrame> apart{{1, 30, {0, 34}}, {2, 32.5, {1}}, {2, 40, {33}}};
  const std::vector<SegmentFrame> shared{{1, 30, {0, 1}}, {300, 30, {1, 2}}};
  const std::vector<NamedSegment> names{{1, "a"}, {2, "b"}};
  seeds.put("dicom", segmentation(apart, {.segments = names}));
  seeds.put("dicom", segmentation(shared, {.segments = names}));
  seeds.put("dicom", segmentation(apart, {.type = "FRACTIONAL", .segments = names, .more = segment_number(0xe, 200)}));
  seeds.put("dicom", segmentation({{0, 30, {1}, 2}, {0, 31, {2}, 1}}, {.type = "LABELMAP", .segments = names}));
}

void put_dicom(Seeds& seeds) {
  using namespace dicom_files;
  const TempFolder folder;
  DicomFields fields;
  fields.slope = "0.5";
  fields.intercept = "-1024";
  fields.thickness = "3";
  const std::string plain = dicom(fields, slice(0));
  seeds.put("dicom", plain);
  std::string series;
  for (std::size_t n = 0; n < 3; ++n) {
    fields.position = at(30 + 2.5 * static_cast<double>(n));
    series += (n == 0 ? "" : kNext) + dicom(fields, slice(n));
  }
  seeds.put("dicom_series", series);
  const std::string frames = enhanced({frame_at(1), frame_at(2)}, slice(0) + slice(1));
  seeds.put("dicom", frames);
  seeds.put("dicom", deflated_file(frames));
  put_dicom_as_found(seeds);
  put_dicom_segments(seeds);
  seeds.put("dicom", deflated_file(plain));
  const std::string lengths = run_lengths(slice(0));
  const std::string table = item(bytes_of(0U) + bytes_of(static_cast<std::uint32_t>(lengths.size() + 8)));
  seeds.put("dicom", packed_frames({frame_at(1), frame_at(2)}, table + item(lengths) + item(lengths)));
  // GDCM cannot write smaller JPEG 2000 images.
  fields.columns = fields.rows = 32;
  folder.put("a", dicom(fields, stored(ramp<std::uint16_t>(32 * 32))));
  for (const auto syntax : {gdcm::TransferSyntax::ImplicitVRLittleEndian, gdcm::TransferSyntax::ExplicitVRBigEndian,
                            gdcm::TransferSyntax::JPEGLosslessProcess14_1, gdcm::TransferSyntax::JPEGLSLossless,
                            gdcm::TransferSyntax::JPEG2000Lossless, gdcm::TransferSyntax::RLELossless}) {
    if (transcode(folder / "a", folder / "b", syntax)) seeds.put("dicom", get(folder / "b"));
  }
  fields.bits = 8;
  folder.put("a", dicom(fields, stored(ramp<std::uint8_t>(32 * 32))));
  if (transcode(folder / "a", folder / "b", gdcm::TransferSyntax::JPEGBaselineProcess1)) {
    seeds.put("dicom", get(folder / "b"));
  }
}
#endif

void put_meshes(Seeds& seeds) {
  const TempFolder folder;
  TriangleMesh mesh = meshes::tetrahedron();
  mesh.normals.assign(mesh.vertices.size(), {0, 0, 1});
  std::vector<std::array<std::uint64_t, 3>> triangles;
  for (const auto& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
  const auto write = [&](MeshSink& sink) {
    sink.append({.vertices = mesh.vertices, .normals = mesh.normals, .triangles = triangles});
    sink.finish();
  };
  for (const std::string name : {"vtp", "glb"}) {
    MeshPart part{"part", {1, 0.5, 0, 0.5}, {true, {"a comment"}}};
    for (const auto& sink : open_mesh_parts(folder / ("parts." + name), std::vector{part, part})) write(*sink);
    seeds.put(name, get(folder / ("parts." + name)));
  }
  for (const std::string name : {"ply", "stl", "obj", "off", "vtp", "glb", "3mf"}) {
    write(*open_mesh_file(folder / ("a." + name), {true, {"a comment"}}));
    seeds.put(name, get(folder / ("a." + name)));
    seeds.put("mesh_gzip", gzipped(get(folder / ("a." + name))));
  }
#ifdef ISOWEAVE_HAS_MESHOPTIMIZER
  MeshFileOptions packed{true, {"a comment"}};
  packed.compress = true;
  write(*open_mesh_file(folder / "packed.glb", packed));
  seeds.put("glb", get(folder / "packed.glb"));
#endif
  mesh.offset = {500000.1, 4649776.7, 120.3};
  mesh.unit = "m";
  mesh.space = "RAS";
  for (const std::string name : {"ply", "stl", "obj", "off", "vtp", "glb", "3mf"}) {
    write_mesh(folder / ("far." + name), mesh);
    seeds.put(name, get(folder / ("far." + name)));
  }
  const std::string header =
      " 1.0\ncomment c\nobj_info o\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\nproperty uchar red\nend_header\n";
  seeds.put("ply", "ply\nformat ascii" + header + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 7\n3 0 2 1 9\n");
  seeds.put("ply", "ply\nformat binary_big_endian" + header + std::string(64, '\0') +
                       std::string("\3\0\0\0\0\0\0\0\1\0\0\0\2\7\3\0\0\0\0\0\0\0\2\0\0\0\3\7", 28));
  seeds.put("stl",
            "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\n"
            "endfacet\nendsolid s\n");
  seeds.put("obj",
            "# c\nmtllib m\no a\nv 0 0 0 1\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl m\ns off\n"
            "f 1/1/1 2/1/1 3/1/1\nf -4 -2 -1\nf 1//1 2//1 3//1 4//1\n");
  seeds.put(
      "ply",
      "\xEF\xBB\xBFPLY\rformat ascii 1.0\relement vertex 4\rproperty float x\rproperty float y\rproperty float z\r"
      "property uchar red\rproperty float scalar_a\relement edge 1\rproperty list uint64 int8 l\relement tristrips "
      "1\rproperty list int int64 vertex_index\rend_header\r0 0 0 9 1\r1 0 0 9 2\r0 1 0 9 3\r0 0 1 9 4\r2 1 2\r"
      "8 0 1 2 3 -1 3 2 1\r");
  seeds.put(
      "stl",
      "\n SOLID s facet normal nan 0 0 outer loop vertex 0D0 0 0\rvertex 1 0 0\rVERTEX 0 1 0 end loop\nend facet\n"
      "end solid\nsolid\nendsolid");
  seeds.put("stl", std::string(80, 's') + std::string("\0\0\0\0", 4) + std::string(100, '\1'));
  seeds.put("stl", std::string(80, 's') + std::string("\1\0\0\0", 4) + std::string(70, '\0'));
  seeds.put("obj",
            "\xEF\xBB\xBF# c\\\nV 0 0 0 1 # w\r\nv 1 0 0 .5 .5 .5\rv 0 1 \\ \n 1e-400\nfo 1 \\\n2 3\nl 1 2\np 1\n"
            "cstype bezier\ndeg 1\nsurf 0 1 0 1 1 2\nparm u 0 1\nend\nf 1 2\nplugin 3\nf\n");
  seeds.put(
      "obj",
      "f 1 2 3 4\nv 0 0 0\nv 2 1 0\nv 4 0 0\nv 2 4 0\nv 1 1 0\nf 1 2 3 4\nf 1 2 3 4 5\nf 5 1 3 2 4\nf 1 3 2 4 1 5\n");
  seeds.put("off", "STCNOFF4 2\n0 0 0 0 0 1\n1 0 0 1 1 1 1\n0 1\n0 7\n0 0 1\n3 0 1 2 7\n4 0 1\n3 2 7\n");
  seeds.put("off", "# c\nnoff # d\n3 2 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n2 0 1\n");
  seeds.put("off", "3 1 0\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2 0.5 0.5 1\r");
  seeds.put("off", "OFF # one line\n4 2 0\n0 0 0\n1 0 0\n\n0 1 0\n0 0 1\n4 0 1 2 3 255 0 0\n3 1 2 3\n");
  seeds.put(
      "3mf_model",
      "<?xml version=\"1.0\"?><model unit=\"micron\"><resources><object id=\"1\" type=\"model\"><mesh><vertices>"
      "<vertex x=\"0\" y=\"0\" z=\"1e-1\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\" />"
      "</vertices><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object></resources></model>");
}

void put_label_names(Seeds& seeds) {
  seeds.put("label_names", "#No. Label Name: R G B A\n0 Unknown 0 0 0 0\n17  Left-Hippocampus 220 216 20 0\n");
  seeds.put("label_names", "0 0 0 0 0 0 0 \"Clear Label\"\n1 255 0 0 1 1 1 \"a/b\"\n2 0 255 0 1 1 1 \"A/B\"\n");
  seeds.put("label_names", "index\tname\tcolor\n1\tGray Matter\t#ff00fe\n-2\tGray Matter\tn/a\n");
}

void put_options(Seeds& seeds) {
  for (const char* text :
       {"512x512x300:int16:big:skip=1024", "a/foot_256x256x256_uint8.raw", "0.2vox", "30um", "float32"}) {
    seeds.put("options", text);
  }
  for (const char* text :
       {"https://ann:word@host:80/a%20b/?sig=x#y", "s3://bucket/key", "gs://b.c/k", "bytes 5-7/100", "bytes 0-0/*"}) {
    seeds.put("remote", text);
  }
}

void put_state(Seeds& seeds) {
  const TempFolder folder;
  CheckpointFolder states(folder / "");
  states.begin_state({"", "a note", {"a mark", "another"}, 3, 8}, {"a volume", "options"})->commit();
  for (const char* name : {"state-0", "state-1"}) {
    if (!std::filesystem::exists(folder / name)) continue;
    const std::string state = get(folder / name);
    seeds.put("state", state.substr(0, state.size() - sizeof(std::uint32_t)));
  }
}

// The bytes behind the format and the identity of an index, and a whole index.
void put_indices(Seeds& seeds) {
  const TempFolder folder;
  const std::string volume = folder.put("a_18x2x20_float32.raw", std::string(18 * 2 * 20 * sizeof(float), '\x3f'));
  const auto index = build_index(*open_volume(volume));
  write_index(*index, folder / "i");
  const std::string whole = get(folder / "i");
  const std::string content = whole.substr(0, whole.size() - sizeof(std::uint32_t));
  const std::size_t lengths = 2 * sizeof(std::uint64_t);
  const std::size_t head = lengths + std::string("isoweave index 1").size() + index->identity().size();
  seeds.put("index", '\0' + content);
  seeds.put("index", '\1' + content.substr(head));
}

}  // namespace

void isoweave::fuzz::put_files(Seeds& seeds) {
  put_raw(seeds);
  put_nrrd(seeds);
  put_metaimage(seeds);
  put_nifti(seeds);
  put_plain_headers(seeds);
  put_pvm(seeds);
  put_vtk(seeds);
#ifdef ISOWEAVE_HAS_TIFF
  put_tiff(seeds);
#endif
#ifdef ISOWEAVE_HAS_PNG
  put_png(seeds);
#endif
#ifdef ISOWEAVE_HAS_GDCM
  put_dicom(seeds);
#endif
#ifdef ISOWEAVE_HAS_ZARR
  put_arrays(seeds);
#endif
  put_meshes(seeds);
  put_packages(seeds);
}

void isoweave::fuzz::put_others(Seeds& seeds) {
  put_options(seeds);
  put_c_interface(seeds);
  put_label_names(seeds);
  put_state(seeds);
  put_state_bodies(seeds);
  put_task_bodies(seeds);
  put_indices(seeds);
}
