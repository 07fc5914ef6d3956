#include "page_files.hpp"

#include <gtest/gtest.h>

#ifdef ISOWEAVE_HAS_VIEWER
#include <meshoptimizer.h>
#endif

namespace isoweave::pages {

using Json = nlohmann::json;

Json json_in(const std::string& page, const std::string& id) {
  const std::string begin = "<script type=\"application/json\" id=\"" + id + "\">";
  const std::size_t at = page.find(begin);
  if (at == std::string::npos) return nullptr;
  const std::size_t from = at + begin.size();
  Json json = Json::parse(page.substr(from, page.find("</script>", from) - from), nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << id;
  return json;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

#ifdef ISOWEAVE_HAS_VIEWER
namespace {

std::vector<unsigned char> decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6U | static_cast<std::uint32_t>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<unsigned char>(word >> static_cast<unsigned>(bits)));
  }
  return bytes;
}

}  // namespace

Surface unpacked(const Json& packed) {
  Surface surface;
  surface.origin = packed.at("origin");
  surface.step = packed.at("step");
  surface.vertices.resize(packed.at("vertices").get<std::size_t>());
  surface.triangles.resize(packed.at("triangles").get<std::size_t>());
  const std::vector<unsigned char> vertices = decoded(packed.at("vertex_data"));
  const std::vector<unsigned char> indices = decoded(packed.at("index_data"));
  EXPECT_EQ(
      meshopt_decodeVertexBuffer(surface.vertices.data(), surface.vertices.size(), 8, vertices.data(), vertices.size()),
      0);
  EXPECT_EQ(meshopt_decodeIndexBuffer(surface.triangles.data(), surface.triangles.size() * 3, 4, indices.data(),
                                      indices.size()),
            0);
  return surface;
}
#endif

}  // namespace isoweave::pages
