// Volumes computed when they are read.
#include "isoweave/generate.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "isoweave/error.hpp"
#include "isoweave/printable.hpp"
#include "parallel/size.hpp"
#include "volume/axes.hpp"
#include "volume/fields.hpp"
#include "volume/row_source.hpp"
#include "volume/samples.hpp"
#include "volume/volume_sizes.hpp"

namespace isoweave {
namespace {

const FieldKind& kind_named(std::string_view name) {
  for (const FieldKind& kind : field_kinds()) {
    if (kind.name == name) return kind;
  }
  std::string known;
  for (const FieldKind& kind : field_kinds()) known += (known.empty() ? "" : ", ") + std::string(kind.name);
  throw std::invalid_argument("generated volume: expected a kind of " + known + ", found '" + printable(name) + "'");
}

// How the value of a formula is stored: as scale * value + shift, in [0, 255] + base for integers.
struct Mapping {
  double scale = 1;
  double shift = 0;
  double base = 0;
};

Mapping mapping_of(const FieldKind& kind, SampleType type) {
  if (!is_integer(type)) return {};
  Mapping mapping;
  mapping.scale = 255 / (kind.high - kind.low);
  mapping.shift = -kind.low * mapping.scale;
  // The type holds the same 256 steps, where they fit.
  mapping.base = type == SampleType::kInt8 ? -128 : 0;
  return mapping;
}

template <class Sample>
void store_row(std::span<const double> row, const Mapping& mapping, std::byte* out) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    double value = row[i];
    if constexpr (std::is_integral_v<Sample>) {
      value = std::clamp(value * mapping.scale + mapping.shift, 0.0, 255.0);
      // The operand is not negative, so cutting off the fraction rounds to the nearest.
      value = static_cast<double>(static_cast<int>(value + 0.5)) + mapping.base;
    }
    const auto sample = static_cast<Sample>(value);
    std::memcpy(out + i * sizeof(Sample), &sample, sizeof(Sample));
  }
}

void store_row_as(SampleType type, std::span<const double> row, const Mapping& mapping, std::byte* out) {
  switch (type) {
    case SampleType::kUint8:
      return store_row<std::uint8_t>(row, mapping, out);
    case SampleType::kInt8:
      return store_row<std::int8_t>(row, mapping, out);
    case SampleType::kUint16:
      return store_row<std::uint16_t>(row, mapping, out);
    case SampleType::kInt16:
      return store_row<std::int16_t>(row, mapping, out);
    case SampleType::kUint32:
      return store_row<std::uint32_t>(row, mapping, out);
    case SampleType::kInt32:
      return store_row<std::int32_t>(row, mapping, out);
    case SampleType::kUint64:
      return store_row<std::uint64_t>(row, mapping, out);
    case SampleType::kInt64:
      return store_row<std::int64_t>(row, mapping, out);
    case SampleType::kFloat32:
      return store_row<float>(row, mapping, out);
    case SampleType::kFloat64:
      return store_row<double>(row, mapping, out);
  }
}

class GeneratedSource final : public RowSource {
 public:
  GeneratedSource(VolumeInfo info, const FieldKind& kind, std::uint64_t seed)
      : info_(std::move(info)), field_(kind.make(info_.dims, seed)), mapping_(mapping_of(kind, info_.type)) {}

  const VolumeInfo& info() const override { return info_; }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    check_slice_range(info_, next_, first, count, out.size());
    if (count == 0) return;
    for (std::int64_t k = first; k < first + count; ++k) {
      begin(k);
      fill_rows(k, 0, info_.dims[1], out.subspan(static_cast<std::size_t>(k - first) * info_.slice_bytes()));
    }
  }

  bool reads_parts_of_rows() const override { return true; }
  std::size_t long_row() const override { return 0; }

  void read_part_of_row(std::int64_t k, std::int64_t j, std::int64_t i, std::span<std::byte> out) override {
    begin(k);
    fill_part(k, j, i, to_size(out.size() / sample_bytes(info_.type)), out.data());
  }

  void read_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    begin(k);
    fill_rows(k, first, count, out);
  }

 private:
  void begin(std::int64_t k) {
    if (k != begun_) field_->begin_slice(k);
    begun_ = k;
    next_ = k + 1;
  }

  void fill_part(std::int64_t k, std::int64_t j, std::int64_t first, std::size_t count, std::byte* out) {
    row_.resize(count);
    field_->fill_row(j, k, first, row_);
    store_row_as(info_.type, row_, mapping_, out);
  }

  void fill_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) {
    std::byte* to = out.data();
    for (std::int64_t j = first; j < first + count; ++j) {
      fill_part(k, j, 0, to_size(info_.dims[0]), to);
      to += info_.slice_bytes() / to_size(info_.dims[1]);
    }
  }

  VolumeInfo info_;
  std::unique_ptr<Field> field_;
  Mapping mapping_;
  std::vector<double> row_;
  std::int64_t next_ = 0;
  std::int64_t begun_ = -1;  // the slice of which rows were read last
};

}  // namespace

std::vector<std::string> generator_kinds() {
  std::vector<std::string> names;
  for (const FieldKind& kind : field_kinds()) names.emplace_back(kind.name);
  return names;
}

double suggested_iso(std::string_view kind, SampleType type) {
  const FieldKind& facts = kind_named(kind);
  const Mapping mapping = mapping_of(facts, type);
  return facts.iso * mapping.scale + mapping.shift + mapping.base;
}

std::unique_ptr<SliceSource> generate_volume(const GenerateOptions& options) {
  const FieldKind& kind = kind_named(options.kind);
  VolumeInfo info;
  info.path = "generated " + options.kind;
  info.format = "generated";
  info.dims = options.dims;
  info.type = options.type;
  try {
    checked_volume_bytes(info);
  } catch (const BadInput& error) {
    throw std::invalid_argument(error.what());
  }
  require_usable_steps(options.spacing);
  info.geometry.spacing = options.spacing;
  return std::make_unique<GeneratedSource>(std::move(info), kind, options.seed);
}

}  // namespace isoweave
