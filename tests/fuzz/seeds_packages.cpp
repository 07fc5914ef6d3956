// Seeds in packages and scenes: meshes in VTP, VTU, legacy VTK, 3MF and GLB, volumes in VTR and NPZ.
#include "foreign_meshes.hpp"
#include "header_helpers.hpp"
#include "seeds.hpp"

namespace isoweave::fuzz {
namespace {

std::string little(std::uint32_t number) {
  std::string bytes;
  for (int n = 0; n < 4; ++n) bytes += static_cast<char>(number >> (8 * n) & 0xffU);
  return bytes;
}

// Three points as floats: (0, 0, 0), (1, 0, 0), (0, 1, 0).
std::string points() {
  const std::string one("\0\0\x80?", 4);
  const std::string nought(4, '\0');
  return nought + nought + nought + one + nought + nought + nought + one + nought;
}

void put_vtp(Seeds& seeds) {
  const std::string head =
      "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" header_type=\"UInt32\"><PolyData><FieldData><Array "
      "type=\"String\" Name=\"SPACE\" format=\"ascii\">82 65 83 0</Array></FieldData><Piece NumberOfPoints=\"3\" "
      "NumberOfLines=\"1\" NumberOfStrips=\"1\" NumberOfPolys=\"1\"><PointData Scalars=\"s\"><DataArray type=\"UInt8\" "
      "Name=\"s\" format=\"ascii\">1 2 3</DataArray></PointData><Points><DataArray type=\"Float32\" Name=\"Points\" "
      "NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points>";
  std::string cells;
  for (const std::string section : {"Lines", "Strips", "Polys"}) {
    cells += "<" + section + "><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray>" +
             "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray></" + section + ">";
  }
  seeds.put("vtp", head + cells + "</Piece></PolyData><AppendedData encoding=\"raw\">_" + little(36) + points() +
                       "</AppendedData></VTKFile>");
  seeds.put("pvtp",
            "<VTKFile type=\"PPolyData\"><PPolyData><Piece Source=\"a_0.vtp\"/><Piece Source=\"a_0.vtp\"/></PPolyData>"
            "</VTKFile>" +
                kNext + head + cells + "</Piece></PolyData><AppendedData encoding=\"raw\">_" + little(36) + points() +
                "</AppendedData></VTKFile>");
  const std::string base64 = "JAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAA==";
  seeds.put("vtp", head + cells + "</Piece></PolyData><AppendedData encoding=\"base64\">_" + base64 +
                       "</AppendedData></VTKFile>");
}

// Triangle, pixel and line.
void put_vtu(Seeds& seeds) {
  const auto array = [](const std::string& attributes, const std::string& numbers) {
    return "<DataArray " + attributes + " format=\"ascii\">" + numbers + "</DataArray>";
  };
  const std::string grid =
      "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"3\"><Points>" +
      array("type=\"Float64\" NumberOfComponents=\"3\"", "0 0 0 1 0 0 0 1 0 1 1 0") + "</Points><Cells>" +
      array("type=\"Int32\" Name=\"connectivity\"", "0 1 2 0 1 2 3 0 1") +
      array("type=\"Int32\" Name=\"offsets\"", "3 7 9") + array("type=\"UInt8\" Name=\"types\"", "5 8 3") +
      "</Cells></Piece></UnstructuredGrid></VTKFile>";
  seeds.put("vtu", grid);
  seeds.put("pvtp",
            "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece Source=\"a_1.vtu\"/></PUnstructuredGrid>"
            "</VTKFile>" +
                kNext + kNext + grid);
}

void put_legacy(Seeds& seeds) {
  const std::string head = "# vtk DataFile Version 5.1\nx\nASCII\nDATASET ";
  const std::string points = "POINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\nMETADATA\nINFORMATION 0\n\n";
  seeds.put("vtk_mesh",
            head + "POLYDATA\n" + points +
                "POLYGONS 2 4\nOFFSETS vtktypeint64\n0 4\nCONNECTIVITY vtktypeint64\n0 1 2 3\nLINES 1 3\n2 "
                "0 1\nTRIANGLE_STRIPS 1 5\n4 0 1 3 2\nCELL_DATA 3\nSCALARS c int\nLOOKUP_TABLE t\n1 2 "
                "3\nLOOKUP_TABLE t 1\n0 0 0 1\nPOINT_DATA 4\nSCALARS s float 1\nLOOKUP_TABLE "
                "default\n1 2 3 4\nNORMALS n float\n0 0 1 0 0 1 0 0 1 0 0 1\nFIELD f 1\nt 1 4 string\na\nb\n\nc\n");
  seeds.put("vtk_mesh", head + "UNSTRUCTURED_GRID\n" + points + "CELLS 2 9\n4 0 1 2 3\n3 0 1 2\nCELL_TYPES 2\n9\n5\n");
  seeds.put("vtk", head +
                       "RECTILINEAR_GRID\nDIMENSIONS 2 2 1\nX_COORDINATES 2 float\n0 1\nY_COORDINATES 2 double\n3 "
                       "5\nZ_COORDINATES 1 int\n7\nCELL_DATA 1\nFIELD f 1\na 1 1 unsigned_char\n7\nPOINT_DATA "
                       "4\nVECTORS v float\n1 2 3 4 5 6 7 8 9 10 11 12\nCOLOR_SCALARS c 1\n0 0.25 0.5 1\n");
}

// A grid whose slices lie at 0, 1 and 3, and one in two pieces.
void put_grids(Seeds& seeds) {
  const auto array = [](const std::string& type, const std::string& numbers) {
    return "<DataArray type=\"" + type + "\" Name=\"s\" format=\"ascii\">" + numbers + "</DataArray>";
  };
  const auto piece = [&](const std::string& extent, const std::string& z, const std::string& samples) {
    return "<Piece Extent=\"" + extent + "\"><PointData>" + array("Int16", samples) + "</PointData><Coordinates>" +
           array("Float32", "0 1") + array("Int32", "0") + array("Float64", z) + "</Coordinates></Piece>";
  };
  const std::string head =
      "<VTKFile type=\"RectilinearGrid\" byte_order=\"BigEndian\"><RectilinearGrid WholeExtent=\"0 1 0 0 0 2\">";
  const std::string end = "</RectilinearGrid></VTKFile>";
  seeds.put("vtr", head + piece("0 1 0 0 0 2", "0 1 3", "1 2 3 4 5 6") + end);
  seeds.put("vtr", head + piece("0 1 0 0 0 1", "5 4", "1 2 3 4") + piece("0 1 0 0 1 2", "4 3", "3 4 5 6") + end);
}

// Arrays of NumPy in an archive: one, and two of which one has three axes.
void put_archives(Seeds& seeds) {
  const std::string samples(60, '\7');
  const std::string volume = testing::npy_header("<i2", "(5, 2, 3)") + samples;
  const std::string plane = testing::npy_header("<f8", "(2, 3)") + samples.substr(0, 48);
  seeds.put("npz", foreign::zip_of({{"ct.npy", volume}}));
  seeds.put("npz", foreign::zip_of({{"affine.npy", plane}, {"ct.npy", volume}}));
  const std::string text = testing::npy_header("<f2", "(2, 5, 2, 3)", true) + samples + samples;
  const std::string packed = testing::deflated(text, -15);
  const ZipEntry entry{"v.npy", true, zip_crc(0, text), packed.size(), text.size(), 0};
  std::string archive;
  const auto append = [&archive](const std::vector<std::byte>& bytes) {
    archive.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  append(zip_header(entry));
  archive += packed;
  append(zip_directory({&entry, 1}, archive.size()));
  seeds.put("npz", archive);
}

void put_models(Seeds& seeds) {
  seeds.put(
      "3mf_model",
      "<model unit=\"inch\" requiredextensions=\"p\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/"
      "2015/02\" xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\"><metadata "
      "name=\"Description\">UNIT=nm</metadata><resources><object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" "
      "z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles><triangle "
      "v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object><object id=\"2\" type=\"model\"><components>"
      "<component objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 5 6 7\"/><component objectid=\"1\" "
      "p:path=\"/3D/3dmodel.model\"/></components></object></resources><build><item objectid=\"2\" "
      "transform=\"2 0 0 0 2 0 0 0 2 0 0 1\"/><!-- > --></build></model>");
}

void put_scenes(Seeds& seeds) {
  const std::string scene =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"children":[1],"matrix":)"
      R"([1,0,0,0,0,1,0,0,0,0,1,0,5,6,7,1]},{"mesh":0,"scale":[2,2,-2],"rotation":[0,0,1,0],"translation":[1,2,3]}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":0},"indices":1},)"
      R"({"attributes":{"POSITION":0},"mode":5}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,)"
      R"("type":"VEC3"},{"bufferView":0,"byteOffset":0,"componentType":5121,"count":3,"type":"SCALAR"}],)"
      R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36,"byteStride":12}],"buffers":[{"byteLength":36)";
  std::string binary = scene + "}]}";
  binary.resize((binary.size() + 3) / 4 * 4, ' ');
  const auto length = static_cast<std::uint32_t>(binary.size());
  seeds.put("glb", "glTF" + little(2) + little(28 + length + 36) + little(length) + "JSON" + binary + little(36) +
                       std::string("BIN\0", 4) + points());
  seeds.put("gltf", scene + R"(,"uri":"%61.bin"}]})" + kNext + points());
  seeds.put("gltf", scene + R"(,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
}

}  // namespace

void put_packages(Seeds& seeds) {
  put_vtp(seeds);
  put_vtu(seeds);
  put_legacy(seeds);
  put_grids(seeds);
  put_archives(seeds);
  put_models(seeds);
  put_scenes(seeds);
}

}  // namespace isoweave::fuzz
