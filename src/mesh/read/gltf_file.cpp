#include "mesh/read/gltf_file.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "mesh/read/gltf_packed.hpp"
#include "mesh/read/placement.hpp"
#include "parallel/size.hpp"
#include "volume/formats/vtk/vtk_streams.hpp"

namespace isoweave::mesh_io {
namespace {

// The extension of packed data, by its first name and by its present one.
constexpr const char* kOldPacking = "EXT_meshopt_compression";
constexpr const char* kPacking = "KHR_meshopt_compression";
constexpr std::uint64_t kLongestScene = std::uint64_t{256} << 20;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;
constexpr std::uint64_t kByte = 5120, kUbyte = 5121, kShort = 5122, kUshort = 5123, kUint = 5125, kFloat = 5126;

std::size_t component_bytes(std::uint64_t component) {
  if (component == kByte || component == kUbyte) return 1;
  if (component == kShort || component == kUshort) return 2;
  return component == kUint || component == kFloat ? 4 : 0;
}

// A number of up to 4 bytes, the least significant one first.
std::uint32_t load(const std::byte* bytes, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t n = count; n-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(bytes[n]);
  return value;
}

// Normalized integers stand for -1 to 1, or 0 to 1.
double real_of(std::uint32_t bits, std::uint64_t component, bool normalized) {
  if (component == kFloat) return double{std::bit_cast<float>(bits)};
  if (component == kByte) {
    const double value = static_cast<std::int8_t>(bits);
    return normalized ? std::max(value / 127, -1.0) : value;
  }
  if (component == kShort) {
    const double value = static_cast<std::int16_t>(bits);
    return normalized ? std::max(value / 32767, -1.0) : value;
  }
  const double most = component == kUbyte ? 255 : component == kUshort ? 65535 : 4294967295.0;
  return normalized ? bits / most : bits;
}

int hex_digit(char c) {
  return c >= '0' && c <= '9'   ? c - '0'
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                : -1;
}

// "a%20b" as "a b"; a % that no two digits follow stays.
std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const int high = text[n] == '%' && n + 2 < text.size() ? hex_digit(text[n + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[n + 2]) : -1;
    decoded += low >= 0 ? static_cast<char>(high * 16 + low) : text[n];
    if (low >= 0) n += 2;
  }
  return decoded;
}

GltfValue parse(const MeshInput& input, const std::string& text) {
  constexpr int kDeepest = 100;
  bool too_deep = false;
  const auto look = [&too_deep](int depth, GltfValue::parse_event_t, const GltfValue&) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  GltfValue scene = GltfValue::parse(text, look, false);
  if (too_deep || scene.is_discarded() || !scene.is_object()) {
    input.fail("expected a glTF scene in JSON, found other text, or a damaged one");
  }
  return scene;
}

}  // namespace

GltfFile::GltfFile(MeshInput& input) : input_(input), size_(input.size()) {
  const bool binary = input.head(4) == "glTF";
  std::string text = binary ? read_binary() : read_text();
  // Some programs fill a string up with zeros.
  text.resize(text.find_last_not_of('\0') + 1);
  scene_ = parse(input, text);
  const GltfValue asset = scene_.value("asset", GltfValue::object());
  const std::string version = asset.is_object() ? asset.value("version", "") : "";
  if (!version.starts_with("2.")) input.fail("expected glTF 2, found version '" + version.substr(0, 40) + "'");
  take_buffers();
}

std::uint32_t GltfFile::next_u32() {
  std::array<std::byte, 4> bytes{};
  input_.read(bytes);
  return load(bytes.data(), bytes.size());
}

std::string GltfFile::read_text() {
  if (input_.size() > kLongestScene) input_.fail("expected a scene of at most 256 MiB, found a longer one: use GLB");
  std::string text(static_cast<std::size_t>(input_.size()), '\0');
  input_.read(std::as_writable_bytes(std::span(text)));
  return text;
}

std::string GltfFile::read_binary() {
  next_u32();
  const std::uint32_t version = next_u32();
  if (version != 2) input_.fail("expected glTF 2, found version " + std::to_string(version));
  const std::uint32_t bytes = next_u32();
  if (bytes != input_.size()) {
    input_.fail("expected " + std::to_string(bytes) + " bytes, found " + std::to_string(input_.size()));
  }
  const std::uint32_t length = next_u32();
  if (next_u32() != kJsonChunk || length > input_.remaining() || length > kLongestScene) {
    input_.fail("expected a scene of at most 256 MiB at the beginning, found none");
  }
  std::string text(length, '\0');
  input_.read(std::as_writable_bytes(std::span(text)));
  if (input_.remaining() == 0) return text;
  const std::uint32_t data = next_u32();
  if (next_u32() != kBinChunk || data > input_.remaining()) {
    input_.fail("expected a chunk of data within the file, found another");
  }
  binary_ = input_.size() - input_.remaining();
  binary_bytes_ = data;
  return text;
}

void GltfFile::take_buffers() {
  for (const GltfValue& buffer : scene_.value("buffers", GltfValue::array())) {
    const std::string uri = buffer.value("uri", "");
    if (!uri.empty()) {
      buffers_.push_back(buffer_of(uri));
    } else {
      buffers_.push_back({{}, input_.file(), binary_, buffers_.empty() ? binary_bytes_ : 0});
    }
  }
}

GltfFile::Buffer GltfFile::buffer_of(const std::string& uri) {
  constexpr std::string_view kBase64 = ";base64,";
  const std::size_t colon = uri.substr(0, uri.find('/')).find(':');
  if (colon == std::string::npos) {
    const FilePtr data = open_file(input_.named_file(percent_decoded(uri)), "the data of a mesh");
    size_ += data->size();
    return {{}, data, 0, data->size()};
  }
  const std::size_t comma = uri.find(kBase64);
  if (!uri.starts_with("data:") || comma == std::string::npos) {
    input_.fail("expected data in base64 or the name of a file, found '" + uri.substr(0, 60) + "'");
  }
  std::vector<std::byte> text(uri.size() - comma - kBase64.size());
  std::transform(uri.begin() + static_cast<std::ptrdiff_t>(comma + kBase64.size()), uri.end(), text.begin(),
                 [](char c) { return static_cast<std::byte>(c); });
  Buffer buffer;
  buffer.bytes.resize((text.size() + 3) / 4 * 3);
  Base64Stream stream(std::make_unique<DecodedStream>([&] { return std::move(text); }), input_.path());
  buffer.bytes.resize(stream.read(buffer.bytes));
  buffer.size = buffer.bytes.size();
  return buffer;
}

std::uint64_t GltfFile::whole(const GltfValue& value, std::string_view what) const {
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  const double number = value.is_number() ? value.get<double>() : -1;
  constexpr double kMost = 9007199254740992.0;
  if (number < 0 || number > kMost || number != std::floor(number)) {
    input_.fail("expected a whole number as " + std::string(what) + " in the scene, found another value");
  }
  return static_cast<std::uint64_t>(number);
}

const GltfValue& GltfFile::element(const char* list, const GltfValue& number) const {
  const std::uint64_t n = whole(number, list);
  const auto found = scene_.find(list);
  if (found == scene_.end() || !found->is_array() || n >= found->size()) {
    input_.fail("expected number " + std::to_string(n) + " of '" + list + "' in the scene, found fewer");
  }
  return (*found)[static_cast<std::size_t>(n)];
}

std::vector<std::byte> GltfFile::bytes_of(std::uint64_t buffer, std::uint64_t offset, std::uint64_t bytes) {
  static const Buffer kNone;
  const Buffer& from = buffer < buffers_.size() ? buffers_[static_cast<std::size_t>(buffer)] : kNone;
  if (offset > from.size || bytes > from.size - offset) {
    input_.fail("expected " + std::to_string(bytes) + " bytes from byte " + std::to_string(offset) +
                " of a buffer, found " + std::to_string(from.size) + " bytes in all");
  }
  std::vector<std::byte> result(to_size(bytes));
  if (!from.file) {
    std::copy_n(from.bytes.begin() + static_cast<std::ptrdiff_t>(offset), result.size(), result.begin());
  } else if (from.file->read_at(from.begin + offset, result) < result.size()) {
    input_.fail("expected " + std::to_string(bytes) + " bytes of a buffer, found fewer");
  }
  return result;
}

// The items of a view that is packed; null for another one.
const std::vector<std::byte>* GltfFile::unpacked_view(const GltfValue& number) {
  const GltfValue extensions = element("bufferViews", number).value("extensions", GltfValue::object());
  const char* const name = extensions.contains(kOldPacking) ? kOldPacking : kPacking;
  if (!extensions.contains(name)) return nullptr;
  const std::uint64_t view = whole(number, "a view");
  if (const auto found = unpacked_.find(view); found != unpacked_.end()) return &found->second;
  const GltfValue& packed = extensions.at(name);
  const PackedForm form{whole(packed.at("count"), "count"), whole(packed.at("byteStride"), "byteStride"),
                        packed.at("mode").get<std::string>(), packed.value("filter", "NONE")};
  std::uint64_t bytes = 0;
  if (__builtin_mul_overflow(form.count, form.stride, &bytes) || bytes > kMostCopies * size_ - unpacked_bytes_) {
    input_.fail("expected packed data in proportion to the file, found more");
  }
  unpacked_bytes_ += bytes;
  const std::uint64_t begin = packed.contains("byteOffset") ? whole(packed.at("byteOffset"), "byteOffset") : 0;
  const std::vector<std::byte> stored =
      bytes_of(whole(packed.at("buffer"), "buffer"), begin, whole(packed.at("byteLength"), "byteLength"));
  return &unpacked_.emplace(view, unpacked(input_, form, stored)).first->second;
}

GltfFile::Stored GltfFile::stored(const GltfValue& number, std::string_view type, std::size_t components) {
  const GltfValue& accessor = element("accessors", number);
  if (accessor.contains("sparse")) input_.fail("expected plain accessors, found a sparse one");
  if (!accessor.contains("bufferView")) input_.fail("expected accessors with data, found one without");
  if (accessor.value("type", "") != type) {
    input_.fail("expected an accessor of type " + std::string(type) + ", found '" + accessor.value("type", "") + "'");
  }
  const GltfValue& view = element("bufferViews", accessor.at("bufferView"));
  const std::vector<std::byte>* const unpacked = unpacked_view(accessor.at("bufferView"));
  Stored stored;
  stored.component = whole(accessor.at("componentType"), "componentType");
  stored.count = whole(accessor.at("count"), "count");
  stored.normalized = accessor.value("normalized", false);
  const std::uint64_t each = component_bytes(stored.component) * components;
  stored.stride = view.contains("byteStride") ? whole(view.at("byteStride"), "byteStride") : each;
  const std::uint64_t first = accessor.contains("byteOffset") ? whole(accessor.at("byteOffset"), "byteOffset") : 0;
  const std::uint64_t begin = view.contains("byteOffset") ? whole(view.at("byteOffset"), "byteOffset") : 0;
  const std::uint64_t length = unpacked != nullptr ? unpacked->size() : whole(view.at("byteLength"), "byteLength");
  const std::uint64_t most = unpacked != nullptr ? unpacked->size() : size_;
  std::uint64_t bytes = 0;
  const bool wrong = each == 0 || stored.stride < each || stored.count > most ||
                     __builtin_mul_overflow(stored.count - 1, stored.stride, &bytes) ||
                     __builtin_add_overflow(bytes, each, &bytes) || first > length || bytes > length - first;
  if (wrong && stored.count > 0) {
    input_.fail("expected " + std::to_string(stored.count) + " numbers within their view of " + std::to_string(length) +
                " bytes, found others");
  }
  if (stored.count == 0) return stored;
  if (unpacked != nullptr) {
    const auto from = unpacked->begin() + static_cast<std::ptrdiff_t>(first);
    stored.bytes.assign(from, from + static_cast<std::ptrdiff_t>(bytes));
    return stored;
  }
  std::uint64_t at = 0;
  if (__builtin_add_overflow(begin, first, &at)) input_.fail("expected a view within its buffer, found another");
  stored.bytes = bytes_of(whole(view.at("buffer"), "buffer"), at, bytes);
  return stored;
}

template <std::size_t kCount>
std::vector<std::array<double, kCount>> GltfFile::rows(const GltfValue& accessor, std::string_view type) {
  const Stored numbers = stored(accessor, type, kCount);
  const std::size_t each = component_bytes(numbers.component);
  std::vector<std::array<double, kCount>> rows(to_size(numbers.count));
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const std::byte* const from = numbers.bytes.data() + n * numbers.stride;
    for (std::size_t axis = 0; axis < kCount; ++axis) {
      rows[n][axis] = real_of(load(from + axis * each, each), numbers.component, numbers.normalized);
    }
  }
  return rows;
}

template std::vector<WidePoint> GltfFile::rows<3>(const GltfValue& accessor, std::string_view type);
template std::vector<std::array<double, 4>> GltfFile::rows<4>(const GltfValue& accessor, std::string_view type);

std::vector<std::uint32_t> GltfFile::indices(const GltfValue& accessor) {
  const Stored numbers = stored(accessor, "SCALAR", 1);
  if (numbers.component != kUbyte && numbers.component != kUshort && numbers.component != kUint) {
    input_.fail("expected indices without a sign, found type " + std::to_string(numbers.component));
  }
  const std::size_t each = component_bytes(numbers.component);
  std::vector<std::uint32_t> all(to_size(numbers.count));
  for (std::size_t n = 0; n < all.size(); ++n) all[n] = load(numbers.bytes.data() + n * numbers.stride, each);
  return all;
}

}  // namespace isoweave::mesh_io
