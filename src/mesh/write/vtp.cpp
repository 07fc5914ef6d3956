// VTP, VTK's XML polygons: a head that says where arrays lie, then the arrays in raw bytes, each behind its length.
// Sizes and indices have 64 bits, in the machine's byte order. Points are written as they come, behind a place kept for
// the head; normals and indices wait in files of their own.
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "files/xml_text.hpp"
#include "mesh/write/joined_meshes.hpp"
#include "mesh/write/mesh_file_sink.hpp"
#include "mesh/write/mesh_format.hpp"

namespace isoweave {
namespace {

constexpr std::uint64_t kWord = 8;
constexpr std::uint64_t kNarrowPointBytes = 12;
constexpr std::uint64_t kWidePointBytes = 24;
constexpr std::uint64_t kValueBytes = 4;
constexpr std::uint64_t kPolygonBytes = 24;
constexpr std::uint64_t kPartBytes = 4, kColorBytes = 3;  // of a triangle in a part

// VTK writes strings as the numbers of their characters, and a 0 behind each.
std::string string_array(const std::string& name, std::span<const std::string> values) {
  std::string text = "<Array type=\"String\" Name=\"" + name + "\" NumberOfTuples=\"" + std::to_string(values.size()) +
                     "\" format=\"ascii\">";
  const char* separator = "";
  for (const std::string& value : values) {
    text += separator;
    separator = " ";
    for (const char c : one_line(value)) text += std::to_string(static_cast<int>(static_cast<unsigned char>(c))) + " ";
    text += "0";
  }
  return text + "</Array>\n";
}

std::string data_array(const std::string& type_and_name, int components, std::uint64_t offset) {
  return "<DataArray type=" + type_and_name + " NumberOfComponents=\"" + std::to_string(components) +
         "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
}

// The bytes of a vertex. With an offset its coordinates have 64 bits.
std::uint64_t vertex_bytes(const MeshFileOptions& options) {
  return has_offset(options) ? kWidePointBytes : kNarrowPointBytes;
}

// One piece of the file: its counts, and whether it is a part among others.
struct VtpPiece {
  std::uint64_t vertices = 0, triangles = 0;
  bool is_part = false;
};

// The text of a piece whose first array lies at byte `at` of the data; moves `at` behind its arrays.
std::string piece_text(const MeshFileOptions& options, const VtpPiece& piece, std::uint64_t& at) {
  const auto array = [&](const std::string& type_and_name, int components, std::uint64_t bytes) {
    const std::uint64_t begin = std::exchange(at, at + kWord + bytes);
    return data_array(type_and_name, components, begin);
  };
  const std::string type = has_offset(options) ? "\"Float64\"" : "\"Float32\"";
  const std::string points = array(type + " Name=\"Points\"", 3, piece.vertices * vertex_bytes(options));
  std::string text = "<Piece NumberOfPoints=\"" + std::to_string(piece.vertices) +
                     "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
                     std::to_string(piece.triangles) + "\">\n";
  if (options.normals || options.values) {
    text += std::string("<PointData") + (options.normals ? " Normals=\"Normals\"" : "") +
            (options.values ? " Scalars=\"value\"" : "") + ">\n";
    if (options.normals) text += array("\"Float32\" Name=\"Normals\"", 3, piece.vertices * kNarrowPointBytes);
    if (options.values) text += array("\"Float32\" Name=\"value\"", 1, piece.vertices * kValueBytes);
    text += "</PointData>\n";
  }
  if (piece.is_part) {
    text += "<CellData Scalars=\"part\">\n" + array("\"Int32\" Name=\"part\"", 1, piece.triangles * kPartBytes);
    text += array("\"UInt8\" Name=\"color\"", 3, piece.triangles * kColorBytes) + "</CellData>\n";
  }
  text += "<Points>\n" + points + "</Points>\n<Polys>\n" +
          array("\"Int64\" Name=\"connectivity\"", 1, piece.triangles * kPolygonBytes);
  return text + array("\"Int64\" Name=\"offsets\"", 1, piece.triangles * kWord) + "</Polys>\n</Piece>\n";
}

// The head of a file: `fields` are more arrays of its field data. Arrays lie in the data in the order of their tags,
// but for the points, which come first in each piece.
std::string head_text(const MeshFileOptions& options, std::span<const VtpPiece> pieces, const std::string& fields) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"";
  text += std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  text += "\" header_type=\"UInt64\">\n";
  for (const std::string& comment : options.comments) text += "<!-- " + xml_comment(comment) + " -->\n";
  const std::string offset = offset_text(options.offset);
  text += "<PolyData>\n<FieldData>\n" + string_array("SPACE", {&options.space, 1}) +
          string_array("UNIT", {&options.unit, 1}) + (has_offset(options) ? string_array("OFFSET", {&offset, 1}) : "") +
          fields + "</FieldData>\n";
  std::uint64_t at = 0;
  for (const VtpPiece& piece : pieces) text += piece_text(options, piece, at);
  return text + "</PolyData>\n";
}

constexpr std::string_view kDataBegin = "\n<AppendedData encoding=\"raw\">\n_";
constexpr std::string_view kDataEnd = "\n</AppendedData>\n</VTKFile>";

// The head of a single mesh, filled up with blanks, up to the first array.
std::string padded_head(const MeshFileOptions& options, std::uint64_t vertices, std::uint64_t triangles) {
  constexpr std::uint64_t kMany = std::uint64_t{1} << 58;
  const VtpPiece piece{vertices, triangles};
  const VtpPiece longest{kMany, kMany};
  std::string text = head_text(options, {&piece, 1}, "");
  text.resize(std::max(text.size(), head_text(options, {&longest, 1}, "").size()), ' ');
  return text.append(kDataBegin);
}

// The data of a file, behind its head.
class VtpData {
 public:
  explicit VtpData(OutputDescriptor& file) : file_(file) {}

  void write_word(std::uint64_t word) { file_.write(std::as_bytes(std::span(&word, 1))); }

  void append_array(OutputDescriptor& array) {
    write_word(array.size());
    file_.append(array);
  }

  void write_places(std::span<const Point> points, const std::array<double, 3>& offset) {
    constexpr std::size_t kAtOnce = 4096;
    std::vector<std::array<double, 3>> wide;
    for (std::size_t first = 0; first < points.size(); first += kAtOnce) {
      wide.clear();
      for (const Point& point : points.subspan(first, std::min(kAtOnce, points.size() - first))) {
        wide.push_back(placed(point, offset));
      }
      file_.write(std::as_bytes(std::span(wide)));
    }
  }

  // Writes the end of each triangle among the corners: 3, 6, 9...
  void write_offsets(std::uint64_t triangles) {
    write_array<std::uint64_t>(triangles, [](std::uint64_t n) { return 3 * (n + 1); });
  }

  // Writes an array of so many items; item(n) is the n-th.
  template <class Item, class Make>
  void write_array(std::uint64_t count, const Make& item) {
    constexpr std::uint64_t kAtOnce = 8192;
    write_word(count * sizeof(Item));
    std::vector<Item> items(kAtOnce);
    for (std::uint64_t done = 0; done < count; done += kAtOnce) {
      items.resize(static_cast<std::size_t>(std::min(kAtOnce, count - done)));
      for (std::uint64_t n = 0; n < items.size(); ++n) items[n] = item(done + n);
      file_.write(std::as_bytes(std::span(items)));
    }
  }

 private:
  OutputDescriptor& file_;
};

class VtpSink final : public MeshFileSink {
 public:
  VtpSink(const MeshTarget& target, const MeshFileOptions& options)
      : MeshFileSink(target, options), data_(file()), faces_(open_side("faces.part")) {
    if (options.normals) normals_ = &open_side("normals.part");
    if (options.values) values_ = &open_side("values.part");
    const std::string head = padded_head(options, 0, 0);
    head_bytes_ = head.size();
    if (continued()) return;
    file().write(std::as_bytes(std::span(head)));
    data_.write_word(0);
  }

 private:
  void write_piece(const MeshPiece& piece) override {
    if (has_offset()) {
      data_.write_places(piece.vertices, options().offset);
    } else {
      file().write(std::as_bytes(piece.vertices));
    }
    if (normals_ != nullptr) normals_->write(std::as_bytes(piece.normals));
    if (values_ != nullptr) values_->write(std::as_bytes(piece.values));
    faces_.write(std::as_bytes(piece.triangles));
  }

  void complete() override {
    if (normals_ != nullptr) data_.append_array(*normals_);
    if (values_ != nullptr) data_.append_array(*values_);
    data_.append_array(faces_);
    data_.write_offsets(triangles());
    file().write(std::as_bytes(std::span(kDataEnd)));

    const std::string head = padded_head(options(), vertices(), triangles());
    const std::uint64_t points = vertices() * vertex_bytes(options());
    file().overwrite(0, std::as_bytes(std::span(head)));
    file().overwrite(head.size(), std::as_bytes(std::span(&points, 1)));
    std::uint64_t data = 3 * kWord + points + triangles() * (kPolygonBytes + kWord);
    if (normals_ != nullptr) data += kWord + vertices() * kNarrowPointBytes;
    if (values_ != nullptr) data += kWord + vertices() * kValueBytes;
    check_written(head_bytes_ + data + kDataEnd.size(), std::as_bytes(std::span(head)));
  }

  VtpData data_;
  OutputDescriptor& faces_;
  OutputDescriptor* normals_ = nullptr;
  OutputDescriptor* values_ = nullptr;
  std::uint64_t head_bytes_ = 0;
};

// Named parts: a piece each, which VTK's readers join.
class VtpParts final : public JoinedFile {
 public:
  VtpParts(const std::string& path, std::span<const MeshPart> parts)
      : JoinedFile(path, options_of(parts), JoinedForm::kWide), parts_(parts.begin(), parts.end()), file_(path) {
    constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
    check_count_fits(path, "parts", 0, parts.size(), kMost);
  }

  void check_room(const JoinedMesh&, std::uint64_t, std::uint64_t) override {}

 private:
  void write() override {
    std::vector<VtpPiece> pieces;
    std::vector<std::string> names;
    for (std::size_t n = 0; n < parts_.size(); ++n) {
      names.push_back(parts_[n].name);
      pieces.push_back({mesh(n).vertices(), mesh(n).triangles(), true});
    }
    MeshFileOptions all = options();
    all.comments = comments();
    const std::string head = head_text(all, pieces, string_array("PartNames", names)).append(kDataBegin);
    file_.write(std::as_bytes(std::span(head)));
    for (std::size_t n = 0; n < parts_.size(); ++n) write_part(n);
    file_.write(std::as_bytes(std::span(kDataEnd)));
    file_.commit();
  }

  // The comments of all parts, each once.
  std::vector<std::string> comments() const {
    std::vector<std::string> lines;
    std::set<std::string> known;
    for (const MeshPart& part : parts_) {
      for (const std::string& comment : part.options.comments) {
        if (known.insert(comment).second) lines.push_back(comment);
      }
    }
    return lines;
  }

  void write_part(std::size_t n) {
    VtpData data(file_.descriptor());
    JoinedMesh& part = mesh(n);
    write_points(data, part);
    if (part.normals() != nullptr) data.append_array(*part.normals());
    if (part.values() != nullptr) data.append_array(*part.values());
    data.write_array<std::int32_t>(part.triangles(), [&](std::uint64_t) { return static_cast<std::int32_t>(n); });
    std::array<std::uint8_t, 3> color{};
    for (std::size_t c = 0; c < 3; ++c) color[c] = static_cast<std::uint8_t>(std::lround(255 * parts_[n].color[c]));
    data.write_array<std::array<std::uint8_t, 3>>(part.triangles(), [&](std::uint64_t) { return color; });
    data.append_array(part.faces());
    data.write_offsets(part.triangles());
  }

  void write_points(VtpData& data, JoinedMesh& part) {
    if (!has_offset(options())) return data.append_array(part.positions());
    constexpr std::uint64_t kAtOnce = 8192;
    data.write_word(part.vertices() * kWidePointBytes);
    std::vector<Point> points;
    for (std::uint64_t done = 0; done < part.vertices(); done += kAtOnce) {
      points.resize(static_cast<std::size_t>(std::min(kAtOnce, part.vertices() - done)));
      part.positions().read_back(done * kNarrowPointBytes, std::as_writable_bytes(std::span(points)));
      data.write_places(points, options().offset);
    }
  }

  std::vector<MeshPart> parts_;
  AtomicFile file_;
};

}  // namespace

std::unique_ptr<JoinedFile> open_vtp_parts(const std::string& path, std::span<const MeshPart> parts) {
  return std::make_unique<VtpParts>(path, parts);
}

std::unique_ptr<MeshSink> open_vtp(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<VtpSink>(target, options);
}

}  // namespace isoweave
