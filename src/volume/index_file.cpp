// Indices in files: a format with a version, a checksum and numbers in little-endian order.
#include <cmath>
#include <string>
#include <string_view>

#include "files/input_file.hpp"
#include "files/state_file.hpp"
#include "isoweave/error.hpp"
#include "volume/index_identity.hpp"
#include "volume/volume_index.hpp"
#include "volume/volume_sizes.hpp"

namespace isoweave {
namespace {

constexpr std::string_view kFormat = "isoweave index 1";

void check_format(StateReader& reader) {
  const std::size_t length = reader.count(1);
  std::string format(std::min(length, kFormat.size()), '\0');
  for (char& letter : format) reader.value(letter);
  if (length != kFormat.size() || format != kFormat)
    bad_input(reader.path(), "a volume index of this version", "another file");
}

template <class T>
void check_bricks(const StateReader& reader, const BrickLevel& bricks) {
  const T* low = reinterpret_cast<const T*>(bricks.low.data());
  const T* high = reinterpret_cast<const T*>(bricks.high.data());
  for (std::size_t n = 0; n < bricks.count(); ++n) {
    const bool holds_numbers = low[n] <= high[n];
    const bool only_nan = !bricks.nan.empty() && bricks.nan[n] == 1 && low[n] > high[n];
    reader.require(holds_numbers || only_nan, "bricks whose least sample is not above their greatest");
    reader.require(bricks.nan.empty() || bricks.nan[n] <= 1, "marks of NaN that are 0 or 1");
  }
}

void read_bricks(StateReader& reader, SampleType type, BrickLevel& bricks) {
  for (std::vector<std::byte>* list : {&bricks.low, &bricks.high}) {
    const std::size_t expected = list->size();
    reader.list(*list);
    reader.require(list->size() == expected, "as many bricks as the volume has");
  }
  const std::size_t marks = bricks.nan.size();
  reader.list(bricks.nan);
  reader.require(bricks.nan.size() == marks, "a mark of NaN for each brick of floats");
  visit_sample_type(type, [&]<class T>() { check_bricks<T>(reader, bricks); });
}

std::vector<SliceFacts> read_slices(StateReader& reader, std::uint64_t samples) {
  constexpr std::uint64_t kBytesEach = 3 * sizeof(double) + sizeof(std::uint32_t);
  std::vector<SliceFacts> slices(reader.count(kBytesEach));
  for (SliceFacts& slice : slices) {
    reader.value(slice.range.min);
    reader.value(slice.range.max);
    reader.value(slice.range.nan);
    reader.value(slice.crc);
    reader.require(!std::isnan(slice.range.min) && !std::isnan(slice.range.max), "ranges of slices that are numbers");
    reader.require(slice.range.nan <= samples, "no more NaN in a slice than samples");
  }
  return slices;
}

// The part of the file that says which volume it is of, checked before anything is made of its numbers.
struct Header {
  std::string identity;
  VolumeInfo volume;  // its size and type alone
};

Header read_header(StateReader& reader) {
  check_format(reader);
  Header header;
  reader.list(header.identity);
  header.volume.path = reader.path();
  for (std::int64_t& size : header.volume.dims) reader.value(size);
  std::uint8_t type = 0;
  reader.value(type);
  reader.require(type <= static_cast<std::uint8_t>(SampleType::kFloat64), "a type of samples");
  header.volume.type = static_cast<SampleType>(type);
  checked_volume_bytes(header.volume);
  return header;
}

// The bricks of a volume take at least two bytes each in the file: no file makes the reader reserve more than that.
void require_plausible(StateReader& reader, const VolumeInfo& volume, std::uint64_t file_bytes) {
  std::int64_t bricks = 2;
  for (const std::int64_t size : volume.dims) {
    const bool overflow = __builtin_mul_overflow(bricks, bricks_along(size), &bricks);
    reader.require(!overflow && static_cast<std::uint64_t>(bricks) <= file_bytes, "as many bricks as the volume has");
  }
}

}  // namespace

void write_index(const VolumeIndex& index, const std::string& path) {
  if (index.identity().empty()) bad_input(path, "an index of a volume that lies in files", "another");
  StateWriter writer(path);
  writer.list(kFormat);
  writer.list(index.identity());
  for (const std::int64_t size : index.dims()) writer.value(size);
  writer.value(static_cast<std::uint8_t>(index.type()));
  writer.value(static_cast<std::uint64_t>(index.slices().size()));
  for (const SliceFacts& slice : index.slices()) {
    writer.value(slice.range.min);
    writer.value(slice.range.max);
    writer.value(slice.range.nan);
    writer.value(slice.crc);
  }
  const BrickLevel& bricks = index.levels().front();
  writer.list(bricks.low);
  writer.list(bricks.high);
  writer.list(bricks.nan);
  writer.commit();
}

std::shared_ptr<const VolumeIndex> read_index(const std::string& path, const VolumeInfo& volume) {
  const std::uint64_t file_bytes = open_file(path, "an index")->size();
  StateReader reader(path, "volume index");
  Header header = read_header(reader);
  const std::string now = volume_identity(volume);
  if (now.empty() || header.identity != now || header.volume.dims != volume.dims || header.volume.type != volume.type) {
    bad_input(path, "the index of " + volume.path + " as it is read now (" + (now.empty() ? "in no file" : now) + ")",
              "that of " + header.identity);
  }
  require_plausible(reader, header.volume, file_bytes);
  std::vector<SliceFacts> slices = read_slices(reader, static_cast<std::uint64_t>(header.volume.slice_samples()));
  reader.require(static_cast<std::int64_t>(slices.size()) == volume.dims[2], "as many slices as the volume has");
  BrickLevel bricks = empty_bricks(volume.dims, volume.type);
  read_bricks(reader, volume.type, bricks);
  reader.require_end();
  return std::make_shared<VolumeIndex>(volume.dims, volume.type, std::move(header.identity), std::move(slices),
                                       std::move(bricks));
}

}  // namespace isoweave
