// 3MF: a zip archive with the mesh as XML, in the volume's unit. Vertices are packed as they come, triangles into a
// file of their own; both are made of blocks that stand alone, so that they can be put together, and continued after a
// mark.
#include <zlib.h>

#include "files/xml_text.hpp"
#include "files/zip_archive.hpp"
#include "mesh/write/mesh_file_sink.hpp"
#include "mesh/write/mesh_format.hpp"
#include "mesh/write/mesh_text.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 19;  // of text that is packed at once

constexpr std::string_view kContentTypes =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
)";

constexpr std::string_view kRelationships =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
)";

// The format's name for the unit; there is none below a micron.
std::string_view unit_name(const std::string& unit) {
  if (unit == "m") return "meter";
  if (unit == "in") return "inch";
  return unit == "um" || unit == "nm" ? "micron" : "millimeter";
}

std::string model_begin(const MeshFileOptions& options) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"" +
                     std::string(unit_name(options.unit)) +
                     "\" xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n";
  std::string description;
  for (const std::string& line : comment_lines(options)) description += (description.empty() ? "" : "; ") + line;
  text += "<metadata name=\"Application\">isoweave</metadata>\n<metadata name=\"Description\">" +
          xml_text(description) + "</metadata>\n<resources>\n<object id=\"1\" type=\"model\">\n<mesh>\n<vertices>\n";
  return text;
}

std::string model_end(const MeshFileOptions& options) {
  const std::string scale = options.unit == "nm" ? " transform=\"0.001 0 0 0 0.001 0 0 0 0.001 0 0 0\"" : "";
  return "</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"1\"" + scale +
         "/>\n</build>\n</model>\n";
}

// Text that is packed into a file block by block.
class PackedText {
 public:
  explicit PackedText(OutputDescriptor& out) : out_(out) {}

  std::string text;  // not packed yet
  std::uint32_t crc = 0;
  std::uint64_t bytes = 0;

  void end_line() {
    text += '\n';
    if (text.size() >= kBlockBytes) pack(false);
  }

  void pack(bool last) {
    if (text.empty() && !last) return;
    crc = zip_crc(crc, text);
    bytes += text.size();
    out_.write(deflate_block(text, last));
    text.clear();
  }

 private:
  OutputDescriptor& out_;
};

class ThreeMfSink final : public MeshFileSink {
 public:
  ThreeMfSink(const MeshTarget& target, const MeshFileOptions& options)
      : MeshFileSink(target, without_normals(options)),
        faces_(open_side("faces.part")),
        vertex_text_(file()),
        face_text_(faces_) {
    set_entries();
    if (continued()) {
      load(saved_state(4));
    } else {
      begin();
    }
  }

 private:
  void set_entries() {
    std::uint64_t offset = 0;
    for (const auto& [name, text] : {std::pair<const char*, std::string_view>{"[Content_Types].xml", kContentTypes},
                                     {"_rels/.rels", kRelationships},
                                     {"3D/3dmodel.model", ""}}) {
      ZipEntry entry{name, text.empty(), zip_crc(0, text), text.size(), text.size(), offset};
      offset += zip_header(entry).size() + text.size();
      entries_.push_back(std::move(entry));
    }
    data_begin_ = offset;
  }

  void begin() {
    for (const auto& [entry, text] : {std::pair{entries_[0], kContentTypes}, {entries_[1], kRelationships}}) {
      file().write(zip_header(entry));
      file().write(std::as_bytes(std::span(text)));
    }
    file().write(zip_header(entries_[2]));
    vertex_text_.text = model_begin(options());
  }

  void load(const std::vector<std::uint64_t>& numbers) {
    vertex_text_.crc = static_cast<std::uint32_t>(numbers[0]);
    vertex_text_.bytes = numbers[1];
    face_text_.crc = static_cast<std::uint32_t>(numbers[2]);
    face_text_.bytes = numbers[3];
  }

  std::vector<std::uint64_t> state() const override {
    return {vertex_text_.crc, vertex_text_.bytes, face_text_.crc, face_text_.bytes};
  }

  void write_piece(const MeshPiece& piece) override {
    check_count_fits(path(), "vertices", this->vertices(), piece.vertices.size(), kMost3mfVertices);
    for (const Point& vertex : piece.vertices) {
      has_offset() ? print_element(vertex_text_.text, "<vertex x=\"", placed(vertex), "\" y=\"", "\" z=\"")
                   : print_element(vertex_text_.text, "<vertex x=\"", vertex, "\" y=\"", "\" z=\"");
      vertex_text_.end_line();
    }
    for (const Triangle64& triangle : piece.triangles) {
      print_element(face_text_.text, "<triangle v1=\"", triangle, "\" v2=\"", "\" v3=\"");
      face_text_.end_line();
    }
  }

  template <class Numbers>
  static void print_element(std::string& text, const char* first, const Numbers& numbers, const char* second,
                            const char* third) {
    text += first;
    print(text, numbers[0]);
    text += second;
    print(text, numbers[1]);
    text += third;
    print(text, numbers[2]);
    text += "\"/>";
  }

  void write_held_back() override {
    vertex_text_.pack(false);
    face_text_.pack(false);
  }

  void complete() override {
    vertex_text_.text += "</vertices>\n<triangles>\n";
    vertex_text_.pack(false);
    face_text_.text += model_end(options());
    face_text_.pack(true);
    file().append(faces_);

    ZipEntry& model = entries_[2];
    model.packed_bytes = file().size() - data_begin_;
    model.bytes = vertex_text_.bytes + face_text_.bytes;
    model.crc = static_cast<std::uint32_t>(
        ::crc32_combine(vertex_text_.crc, face_text_.crc, static_cast<z_off_t>(face_text_.bytes)));
    const std::vector<std::byte> header = zip_header(model);
    file().overwrite(model.offset, header);
    const std::uint64_t end = file().size();
    const std::vector<std::byte> directory = zip_directory(entries_, end);
    file().write(directory);
    check_written(end + directory.size(), zip_header(entries_[0]));
  }

  OutputDescriptor& faces_;
  PackedText vertex_text_;
  PackedText face_text_;
  std::vector<ZipEntry> entries_;
  std::uint64_t data_begin_ = 0;  // of the packed model
};

}  // namespace

std::unique_ptr<MeshSink> open_3mf(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<ThreeMfSink>(target, options);
}

}  // namespace isoweave
