#include "volume/formats/hdf5/hdf5_dataset.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <functional>

#include "files/input_file.hpp"
#include "volume/samples.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kMostObjects = 10000;
constexpr std::size_t kDeepest = 32;

struct Number {
  H5T_class_t kind = H5T_INTEGER;
  std::size_t bytes = 0;
  bool is_signed = false;
  bool big_endian = false;
};

bool is_ieee(const Hdf5Functions& h5, hid_t type, std::size_t bytes) {
  using Fields = std::array<std::size_t, 5>;  // of the sign; of the exponent and its size; of the mantissa and its size
  Fields fields{};
  if (h5.tget_fields(type, &fields[0], &fields[1], &fields[2], &fields[3], &fields[4]) < 0) return false;
  const std::size_t bias = h5.tget_ebias(type);
  return (bytes == 2 && fields == Fields{15, 10, 5, 0, 10} && bias == 15) ||
         (bytes == 4 && fields == Fields{31, 23, 8, 0, 23} && bias == 127) ||
         (bytes == 8 && fields == Fields{63, 52, 11, 0, 52} && bias == 1023);
}

// A number as machines have it, but for the order of its bytes; nothing for any other. libhdf5 would have to convert
// those, and does not survive all descriptions of them that are damaged.
std::optional<Number> plain_number(const Hdf5Functions& h5, hid_t type) {
  const H5T_class_t kind = h5.tget_class(type);
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) return std::nullopt;
  const std::size_t bytes = h5.tget_size(type);
  const H5T_order_t order = h5.tget_order(type);
  const bool whole = h5.tget_precision(type) == 8 * bytes && h5.tget_offset(type) == 0;
  if (!whole || (order != H5T_ORDER_LE && order != H5T_ORDER_BE)) return std::nullopt;
  if (kind == H5T_FLOAT && !is_ieee(h5, type, bytes)) return std::nullopt;
  return Number{kind, bytes, kind == H5T_INTEGER && h5.tget_sign(type) == H5T_SGN_2, order == H5T_ORDER_BE};
}

// "int16", "float32", ...
std::string name_of(const Number& number) {
  return (number.kind == H5T_FLOAT ? "float" : number.is_signed ? "int" : "uint") + std::to_string(8 * number.bytes);
}

// The name of a type in messages, where it is no number that machines have.
std::string text_of_class(const Hdf5Functions& h5, hid_t type) {
  const std::string bits = std::to_string(8 * h5.tget_size(type));
  switch (h5.tget_class(type)) {
    case H5T_FLOAT:
      return "float" + bits;
    case H5T_INTEGER:
      return "integers in " + bits + " bits";
    case H5T_COMPOUND:
      return "compounds";
    case H5T_STRING:
      return "texts";
    default:
      return "of another kind";
  }
}

// Reads the type of a dataset; h5py keeps truth values as enumerations of integers.
void take_type(const Hdf5Functions& h5, hid_t dataset, Hdf5Dataset& found) {
  const Hdf5Handle stored(h5.dget_type(dataset), h5.tclose);
  const bool enumeration = stored && h5.tget_class(stored.id()) == H5T_ENUM;
  const Hdf5Handle inner(enumeration ? h5.tget_super(stored.id()) : -1, h5.tclose);
  const hid_t type = enumeration ? inner.id() : stored.id();
  found.type_text = type < 0 ? "of another kind" : text_of_class(h5, type);
  const std::optional<Number> number = type < 0 ? std::nullopt : plain_number(h5, type);
  if (!number) return;
  found.type_text = name_of(*number);
  found.type = parse_stored_type(found.type_text);
  found.big_endian = number->big_endian;
}

bool take_shape(const Hdf5Functions& h5, hid_t dataset, Hdf5Dataset& found) {
  const Hdf5Handle space(h5.dget_space(dataset), h5.sclose);
  if (!space || h5.sget_simple_extent_type(space.id()) != H5S_SIMPLE) return false;
  const int rank = h5.sget_simple_extent_ndims(space.id());
  std::array<hsize_t, H5S_MAX_RANK> sizes{};
  if (rank < 1 || rank > H5S_MAX_RANK) return false;
  if (h5.sget_simple_extent_dims(space.id(), sizes.data(), nullptr) < 0) return false;
  for (std::size_t n = 0; n < static_cast<std::size_t>(rank); ++n) {
    found.shape.push_back(static_cast<std::int64_t>(std::min<hsize_t>(sizes.at(n), INT64_MAX)));
  }
  return true;
}

// Walks the groups of a file along its hard links. Others may lead into other files, or nowhere.
class Search {
 public:
  Search(const Hdf5Session& session, const std::string& path) : session_(session), h5_(session.h5()), path_(path) {}

  void visit(hid_t group, const std::string& path, std::size_t depth) {
    H5G_info_t info{};
    if (h5_.gget_info(group, &info) < 0) return;
    for (hsize_t n = 0; n < info.nlinks && visited_ < kMostObjects; ++n, ++visited_) {
      const auto [name, link] = link_at(group, n);
      std::string inner = path;
      inner.append("/").append(name);
      if (link == H5L_TYPE_EXTERNAL && contents.link_out.empty()) contents.link_out = inner;
      if (name.empty() || link != H5L_TYPE_HARD) continue;
      const Hdf5Handle object = session_.open_object(group, name, path_);
      if (!object) continue;
      const H5I_type_t kind = h5_.iget_type(object.id());
      if (kind == H5I_GROUP && depth < kDeepest) visit(object.id(), inner, depth + 1);
      if (kind == H5I_DATASET) take(object.id(), inner);
    }
  }

  Hdf5Contents contents;

 private:
  // The name and the kind of a link; no name where there is none, or a very long one.
  std::pair<std::string, H5L_type_t> link_at(hid_t group, hsize_t n) const {
    H5L_info_t link{};
    if (h5_.lget_info_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, n, &link, kDefaultProperties) < 0) {
      return {std::string(), H5L_TYPE_ERROR};
    }
    std::array<char, 1024> name{};
    const ssize_t length =
        h5_.lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, n, name.data(), name.size(), kDefaultProperties);
    const bool fits = length > 0 && static_cast<std::size_t>(length) < name.size();
    return {fits ? name.data() : std::string(), link.type};
  }

  void take(hid_t dataset, const std::string& path) {
    Hdf5Dataset entry;
    entry.name = path;
    if (!take_shape(h5_, dataset, entry) || entry.shape.size() < 2) return;
    take_type(h5_, dataset, entry);
    contents.datasets.push_back(std::move(entry));
  }

  const Hdf5Session& session_;
  const Hdf5Functions& h5_;
  const std::string& path_;
  std::size_t visited_ = 0;
};

constexpr hssize_t kMostValues = 64;

// Numbers of a type and a space; `read` fills the memory with them as they are stored.
std::optional<std::vector<double>> read_plain(const Hdf5Functions& h5, hid_t type, hid_t space, hssize_t most,
                                              const std::function<herr_t(void*)>& read) {
  const std::optional<Number> number = plain_number(h5, type);
  const hssize_t count = h5.sget_simple_extent_npoints(space);
  if (!number || count < 1 || count > most) return std::nullopt;
  const std::optional<SampleType> known = parse_sample_type(name_of(*number));
  if (!known) return std::nullopt;
  std::vector<std::byte> values(static_cast<std::size_t>(count) * number->bytes);
  if (read(values.data()) < 0) return std::nullopt;
  const bool swap = number->big_endian != (std::endian::native == std::endian::big);
  if (swap) swap_sample_bytes(values, number->bytes);
  return numbers_of_samples(values, *known);
}

std::optional<std::vector<double>> read_numbers(const Hdf5Functions& h5, hid_t attribute) {
  const Hdf5Handle type(h5.aget_type(attribute), h5.tclose);
  const Hdf5Handle space(h5.aget_space(attribute), h5.sclose);
  if (!type || !space) return std::nullopt;
  return read_plain(h5, type.id(), space.id(), kMostValues,
                    [&](void* to) { return h5.aread(attribute, type.id(), to); });
}

std::vector<std::string> read_texts(const Hdf5Functions& h5, hid_t attribute) {
  constexpr std::size_t kLongest = 1 << 16;
  const Hdf5Handle type(h5.aget_type(attribute), h5.tclose);
  const Hdf5Handle space(h5.aget_space(attribute), h5.sclose);
  if (!type || !space || h5.tget_class(type.id()) != H5T_STRING) return {};
  const hssize_t count = h5.sget_simple_extent_npoints(space.id());
  const std::size_t bytes = h5.tget_size(type.id());
  if (count < 1 || count > kMostValues || bytes < 1 || bytes > kLongest) return {};
  std::vector<std::string> texts;
  if (h5.tis_variable_str(type.id()) > 0) {
    std::vector<char*> values(static_cast<std::size_t>(count), nullptr);
    if (h5.aread(attribute, type.id(), values.data()) < 0) return {};
    for (char* const value : values) {
      texts.emplace_back(value == nullptr ? "" : value);
      if (value != nullptr) h5.free_memory(value);
    }
    return texts;
  }
  std::string values(static_cast<std::size_t>(count) * bytes, '\0');
  if (h5.aread(attribute, type.id(), values.data()) < 0) return {};
  for (std::size_t at = 0; at < values.size(); at += bytes) {
    const std::string value = values.substr(at, bytes);
    texts.push_back(value.substr(0, value.find('\0')));
  }
  return texts;
}

}  // namespace

Hdf5Contents find_datasets(const Hdf5Session& session, hid_t file, const std::string& path) {
  Search search(session, path);
  search.visit(file, "", 0);
  return std::move(search.contents);
}

Hdf5Dataset describe_dataset(const Hdf5Session& session, hid_t dataset, const std::string& name) {
  Hdf5Dataset described;
  described.name = name;
  take_type(session.h5(), dataset, described);
  take_shape(session.h5(), dataset, described);
  return described;
}

ArrayAttributes hdf5_attributes(const Hdf5Session& session, hid_t object) {
  const Hdf5Functions& h5 = session.h5();
  const auto open = [&h5, object](const std::string& name) {
    const bool there = h5.aexists(object, name.c_str()) > 0;
    return Hdf5Handle(there ? h5.aopen(object, name.c_str(), kDefaultProperties) : -1, h5.aclose);
  };
  const auto numbers = [&h5, open](const std::string& name) {
    const Hdf5Handle attribute = open(name);
    return attribute ? read_numbers(h5, attribute.id()) : std::nullopt;
  };
  const auto texts = [&h5, open](const std::string& name) {
    const Hdf5Handle attribute = open(name);
    return attribute ? read_texts(h5, attribute.id()) : std::vector<std::string>();
  };
  const auto has = [&h5, object](const std::string& name) { return h5.aexists(object, name.c_str()) > 0; };
  return {numbers, texts, has};
}

H5D_layout_t layout_in_file(const Hdf5Session& session, hid_t dataset, const std::string& path) {
  const Hdf5Functions& h5 = session.h5();
  const Hdf5Handle properties(h5.dget_create_plist(dataset), h5.pclose);
  if (!properties) session.refuse(path, "the layout of the dataset");
  const H5D_layout_t layout = h5.pget_layout(properties.id());
  if (layout == H5D_VIRTUAL) bad_input(path, "samples in the file", "a virtual dataset, which lies in other files");
  if (h5.pget_external_count(properties.id()) != 0) bad_input(path, "samples in the file", "external files");
  return layout;
}

std::optional<std::vector<double>> hdf5_numbers(const Hdf5Session& session, hid_t dataset, const std::string& path) {
  constexpr hssize_t kMostNumbers = 1 << 20;
  layout_in_file(session, dataset, path);
  const Hdf5Functions& h5 = session.h5();
  const Hdf5Handle type(h5.dget_type(dataset), h5.tclose);
  const Hdf5Handle space(h5.dget_space(dataset), h5.sclose);
  if (!type || !space) return std::nullopt;
  return read_plain(h5, type.id(), space.id(), kMostNumbers,
                    [&](void* to) { return h5.dread(dataset, type.id(), H5S_ALL, H5S_ALL, kDefaultProperties, to); });
}

void name_hdf5_axes(const ArrayAttributes& attributes, std::vector<ArrayAxis>& axes) {
  std::vector<std::string> names = attributes.texts("DIMENSION_LABELS");
  if (const std::vector<std::string> tags = attributes.texts("axistags"); tags.size() == 1) {
    // JSON, in which only the keys matter: {"axes": [{"key": "z", ...}, ...]}.
    names.clear();
    constexpr std::string_view kKey = "\"key\":";
    const std::string& text = tags[0];
    for (std::size_t at = text.find(kKey); at != std::string::npos; at = text.find(kKey, at + kKey.size())) {
      const std::size_t begin = text.find('"', at + kKey.size());
      const std::size_t end = begin == std::string::npos ? begin : text.find('"', begin + 1);
      if (end == std::string::npos) break;
      names.push_back(text.substr(begin + 1, end - begin - 1));
    }
  }
  if (names.size() != axes.size()) return;
  for (std::size_t n = 0; n < axes.size(); ++n) axes[n].name = names[n];
}

}  // namespace isoweave
