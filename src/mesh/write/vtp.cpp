// VTP, VTK's XML polygons: a head that says where arrays lie, then the arrays in raw bytes, each behind its length.
// Sizes and indices have 64 bits, in the machine's byte order. Points are written as they come, behind a place kept for
// the head; normals and indices wait in files of their own.
#include "files/xml_text.hpp"
#include "mesh/write/mesh_file_sink.hpp"

namespace isoweave {
namespace {

constexpr std::uint64_t kWord = 8;
constexpr std::uint64_t kPointBytes = 12;
constexpr std::uint64_t kWidePointBytes = 24;
constexpr std::uint64_t kValueBytes = 4;
constexpr std::uint64_t kTriangleBytes = 24;

// VTK writes strings as the numbers of their characters, and a 0.
std::string string_array(const std::string& name, const std::string& value) {
  std::string text = "<Array type=\"String\" Name=\"" + name + "\" NumberOfTuples=\"1\" format=\"ascii\">";
  for (const char c : one_line(value)) text += std::to_string(static_cast<int>(static_cast<unsigned char>(c))) + " ";
  return text + "0</Array>\n";
}

std::string data_array(const std::string& type_and_name, int components, std::uint64_t offset) {
  return "<DataArray type=" + type_and_name + " NumberOfComponents=\"" + std::to_string(components) +
         "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
}

// The bytes of a vertex. With an offset its coordinates have 64 bits.
std::uint64_t vertex_bytes(const MeshFileOptions& options) {
  return has_offset(options) ? kWidePointBytes : kPointBytes;
}

std::string head_text(const MeshFileOptions& options, std::uint64_t vertices, std::uint64_t triangles) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"";
  text += std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  text += "\" header_type=\"UInt64\">\n";
  for (const std::string& comment : options.comments) text += "<!-- " + xml_comment(comment) + " -->\n";
  text += "<PolyData>\n<FieldData>\n" + string_array("SPACE", options.space) + string_array("UNIT", options.unit) +
          (has_offset(options) ? string_array("OFFSET", offset_text(options.offset)) : "") +
          "</FieldData>\n<Piece NumberOfPoints=\"" + std::to_string(vertices) +
          "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
          std::to_string(triangles) + "\">\n";
  std::uint64_t at = kWord + vertices * vertex_bytes(options);
  if (options.normals || options.values) {
    text += std::string("<PointData") + (options.normals ? " Normals=\"Normals\"" : "") +
            (options.values ? " Scalars=\"value\"" : "") + ">\n";
    if (options.normals) {
      text += data_array("\"Float32\" Name=\"Normals\"", 3, at);
      at += kWord + vertices * kPointBytes;
    }
    if (options.values) {
      text += data_array("\"Float32\" Name=\"value\"", 1, at);
      at += kWord + vertices * kValueBytes;
    }
    text += "</PointData>\n";
  }
  const std::string type = has_offset(options) ? "\"Float64\"" : "\"Float32\"";
  text += "<Points>\n" + data_array(type + " Name=\"Points\"", 3, 0) + "</Points>\n<Polys>\n" +
          data_array("\"Int64\" Name=\"connectivity\"", 1, at) +
          data_array("\"Int64\" Name=\"offsets\"", 1, at + kWord + triangles * kTriangleBytes) +
          "</Polys>\n</Piece>\n</PolyData>\n";
  return text;
}

// The head, filled up with blanks, up to the first array.
std::string padded_head(const MeshFileOptions& options, std::uint64_t vertices, std::uint64_t triangles) {
  constexpr std::uint64_t kMany = std::uint64_t{1} << 58;
  std::string text = head_text(options, vertices, triangles);
  text.resize(std::max(text.size(), head_text(options, kMany, kMany).size()), ' ');
  return text + "\n<AppendedData encoding=\"raw\">\n_";
}

class VtpSink final : public MeshFileSink {
 public:
  VtpSink(const MeshTarget& target, const MeshFileOptions& options)
      : MeshFileSink(target, options), faces_(open_side("faces.part")) {
    if (options.normals) normals_ = &open_side("normals.part");
    if (options.values) values_ = &open_side("values.part");
    const std::string head = padded_head(options, 0, 0);
    head_bytes_ = head.size();
    if (continued()) return;
    file().write(std::as_bytes(std::span(head)));
    write_word(0);
  }

 private:
  void write_word(std::uint64_t word) { file().write(std::as_bytes(std::span(&word, 1))); }

  void write_piece(const MeshPiece& piece) override {
    write_vertices(piece.vertices);
    if (normals_ != nullptr) normals_->write(std::as_bytes(piece.normals));
    if (values_ != nullptr) values_->write(std::as_bytes(piece.values));
    faces_.write(std::as_bytes(piece.triangles));
  }

  void write_vertices(std::span<const Point> vertices) {
    if (!has_offset()) return file().write(std::as_bytes(vertices));
    constexpr std::size_t kAtOnce = 4096;
    std::vector<std::array<double, 3>> wide;
    for (std::size_t first = 0; first < vertices.size(); first += kAtOnce) {
      const std::span<const Point> block = vertices.subspan(first, std::min(kAtOnce, vertices.size() - first));
      wide.clear();
      for (const Point& vertex : block) wide.push_back(placed(vertex));
      file().write(std::as_bytes(std::span(wide)));
    }
  }

  void complete() override {
    if (normals_ != nullptr) append_array(*normals_);
    if (values_ != nullptr) append_array(*values_);
    append_array(faces_);
    write_offsets();
    constexpr std::string_view kEnd = "\n</AppendedData>\n</VTKFile>";
    file().write(std::as_bytes(std::span(kEnd)));

    const std::string head = padded_head(options(), vertices(), triangles());
    const std::uint64_t points = vertices() * vertex_bytes(options());
    file().overwrite(0, std::as_bytes(std::span(head)));
    file().overwrite(head.size(), std::as_bytes(std::span(&points, 1)));
    std::uint64_t data = 3 * kWord + points + triangles() * (kTriangleBytes + kWord);
    if (normals_ != nullptr) data += kWord + vertices() * kPointBytes;
    if (values_ != nullptr) data += kWord + vertices() * kValueBytes;
    check_written(head_bytes_ + data + kEnd.size(), std::as_bytes(std::span(head)));
  }

  void append_array(OutputDescriptor& array) {
    write_word(array.size());
    file().append(array);
  }

  // Writes the end of each triangle among the corners: 3, 6, 9...
  void write_offsets() {
    constexpr std::uint64_t kAtOnce = 8192;
    write_word(triangles() * kWord);
    std::vector<std::uint64_t> offsets(kAtOnce);
    for (std::uint64_t done = 0; done < triangles(); done += kAtOnce) {
      offsets.resize(static_cast<std::size_t>(std::min(kAtOnce, triangles() - done)));
      for (std::uint64_t n = 0; n < offsets.size(); ++n) offsets[n] = 3 * (done + n + 1);
      file().write(std::as_bytes(std::span(offsets)));
    }
  }

  OutputDescriptor& faces_;
  OutputDescriptor* normals_ = nullptr;
  OutputDescriptor* values_ = nullptr;
  std::uint64_t head_bytes_ = 0;
};

}  // namespace

std::unique_ptr<MeshSink> open_vtp(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<VtpSink>(target, options);
}

}  // namespace isoweave
