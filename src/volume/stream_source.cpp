#include "volume/stream_source.hpp"

#include <array>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "parallel/size.hpp"

namespace isoweave {
namespace {

std::uint16_t swapped(std::uint16_t word) { return __builtin_bswap16(word); }
std::uint32_t swapped(std::uint32_t word) { return __builtin_bswap32(word); }
std::uint64_t swapped(std::uint64_t word) { return __builtin_bswap64(word); }

template <class Word>
void swap_all(std::span<std::byte> samples) {
  for (std::size_t at = 0; at + sizeof(Word) <= samples.size(); at += sizeof(Word)) {
    Word word;
    std::memcpy(&word, samples.data() + at, sizeof(Word));
    word = swapped(word);
    std::memcpy(samples.data() + at, &word, sizeof(Word));
  }
}

}  // namespace

void swap_sample_bytes(std::span<std::byte> samples, std::size_t bytes_each) {
  if (bytes_each == 2) swap_all<std::uint16_t>(samples);
  if (bytes_each == 4) swap_all<std::uint32_t>(samples);
  if (bytes_each == 8) swap_all<std::uint64_t>(samples);
}

void check_plausible(std::string_view path, std::uint64_t bytes, std::uint64_t stored, std::uint64_t largest_ratio) {
  if (bytes / largest_ratio <= stored) return;
  bad_input(path, "compressed data of " + std::to_string(bytes) + " bytes of samples",
            std::to_string(stored) + " bytes, which cannot hold them");
}

std::unique_ptr<ByteStream> samples_in(const FilePtr& file, std::uint64_t begin, std::uint64_t bytes) {
  // Differences, not sums: the numbers may be as large as they like.
  if (begin > file->size() || bytes > file->size() - begin) {
    bad_input(file->path(), std::to_string(bytes) + " bytes of samples from byte " + std::to_string(begin) + " on",
              "a file of " + file->size_text());
  }
  return std::make_unique<FileStream>(file, begin, begin + bytes);
}

StreamSource::StreamSource(OpenedVolume volume) : volume_(std::move(volume)) {}

void StreamSource::read(std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  const VolumeInfo& info = volume_.info;
  const std::uint64_t slice = info.slice_bytes();
  const auto next = static_cast<std::int64_t>(place_ / slice + (place_ % slice > 0 ? 1 : 0));
  check_slice_range(info, next, first, count, out.size());
  if (count == 0) return;
  read_from(static_cast<std::uint64_t>(first) * slice,
            out.first(static_cast<std::size_t>(count) * static_cast<std::size_t>(slice)));
}

void StreamSource::read_rows(std::int64_t k, std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  const VolumeInfo& info = volume_.info;
  const std::size_t row = to_size(info.dims[0], sample_bytes(info.type));
  const bool inside = k >= 0 && k < info.dims[2] && first >= 0 && count >= 0 && count <= info.dims[1] - first;
  if (!inside || out.size() / row < static_cast<std::uint64_t>(count)) {
    throw std::invalid_argument(std::to_string(count) + " rows from " + std::to_string(first) + " of slice " +
                                std::to_string(k) + " are not all in the volume, or not in the memory given");
  }
  const std::uint64_t place =
      static_cast<std::uint64_t>(k) * info.slice_bytes() + static_cast<std::uint64_t>(first) * row;
  if (place < place_) throw std::invalid_argument("row " + std::to_string(first) + " lies behind the next to be read");
  read_from(place, out.first(static_cast<std::size_t>(count) * row));
}

void StreamSource::read_part_of_row(std::int64_t k, std::int64_t j, std::int64_t i, std::span<std::byte> out) {
  const VolumeInfo& info = volume_.info;
  const std::size_t sample = sample_bytes(info.type);
  const std::size_t row = to_size(info.dims[0], sample);
  const std::uint64_t place = static_cast<std::uint64_t>(k) * info.slice_bytes() + static_cast<std::uint64_t>(j) * row +
                              static_cast<std::uint64_t>(i) * sample;
  if (place < place_) throw std::invalid_argument("sample " + std::to_string(i) + " lies behind the next to be read");
  read_from(place, out);
}

bool StreamSource::narrow(const Region& box) {
  if (volume_.bands == nullptr) return false;
  volume_.held_bytes -= volume_.bands->held_bytes();
  volume_.bands->narrow(box);
  volume_.held_bytes += volume_.bands->held_bytes();
  return true;
}

void StreamSource::read_from(std::uint64_t place, std::span<std::byte> wanted) {
  const VolumeInfo& info = volume_.info;
  const std::uint64_t all = static_cast<std::uint64_t>(info.dims[2]) * info.slice_bytes();
  const std::uint64_t before = place_;
  const std::uint64_t behind = place - before;
  // After a failure nobody knows where the stream stands: nothing more is read from it.
  place_ = all;
  std::uint64_t got = volume_.samples->skip(behind);
  if (got == behind) got += volume_.samples->read(wanted);
  if (got < behind + wanted.size()) {
    bad_input(info.path, std::to_string(all) + " bytes of samples", std::to_string(before + got));
  }
  place_ = place + wanted.size();
  if (volume_.swap_bytes) swap_sample_bytes(wanted, sample_bytes(info.type));
  // One byte more makes a compressed stream check its sum.
  std::array<std::byte, 1> beyond;
  if (place_ == all) volume_.samples->read(beyond);
}

std::optional<SampleBytes> StreamSource::constant() const {
  std::optional<SampleBytes> sample = volume_.constant;
  const std::size_t bytes = sample_bytes(volume_.info.type);
  if (sample && volume_.swap_bytes) swap_sample_bytes(std::span(*sample).first(bytes), bytes);
  return sample;
}

void take_unit(OpenedVolume& volume, const CommonUnit& unit) {
  volume.info.geometry.unit = unit.unit;
  volume.info.notes.insert(volume.info.notes.end(), unit.notes.begin(), unit.notes.end());
  if (unit.conflict.empty()) return;
  volume.unit_conflict = unit.conflict;
  volume.info.notes.push_back("the units of the axes cannot be made one: " + unit.conflict);
}

}  // namespace isoweave
