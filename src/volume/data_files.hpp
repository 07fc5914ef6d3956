// Where the samples of a text header lie: behind the header, in another file, or in a series of files.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "files/byte_stream.hpp"
#include "volume/formats/formats.hpp"

namespace isoweave {

// How samples are kept in each file.
struct DataLayout {
  enum class Encoding { kRaw, kDeflate, kNumbers, kHex };
  Encoding encoding = Encoding::kRaw;    // as they are, gzip or zlib, numbers in text, two hexadecimal digits a byte
  SampleType type = SampleType::kUint8;  // of numbers in text, which become the machine's samples
  std::int64_t line_skip = 0;            // lines before the samples, in the file as stored
  std::int64_t byte_skip = 0;  // bytes before them, once inflated; -1: they end the file, -n: n - 1 bytes follow them
};

// A series of files of equal size; the names are made when they are needed.
struct DataFiles {
  std::int64_t count = 0;
  std::function<std::string(std::int64_t)> name;
};

DataFiles listed_files(const std::string& header_path, const std::vector<std::string>& names);

// Reads "slice%03d.raw 1 100 1" as a series; `numbers` are the words after the pattern: first, last, step.
// Throws BadInput for any pattern but one of a single %d, %i or %u with an optional width.
DataFiles numbered_files(const std::string& header_path, const std::string& pattern,
                         const std::vector<std::int64_t>& numbers);

// The samples in one file, from byte `begin` on. Throws BadInput when the file cannot hold `bytes` of them.
std::unique_ptr<ByteStream> open_samples(const FilePtr& file, std::uint64_t begin, const DataLayout& layout,
                                         std::uint64_t bytes);

// Opens the samples in the only file of a volume, which the header may have named. Bytes behind the samples, as where a
// header's sizes are wrong, are noted unless only reading would find them.
std::unique_ptr<ByteStream> open_only_file(VolumeInfo& info, const FilePtr& file, std::uint64_t begin,
                                           const DataLayout& layout, std::uint64_t bytes);

// The samples in a series that the header `info.path` names, `bytes` in all. Every file is looked at, so that a missing
// one is found now.
std::unique_ptr<ByteStream> open_samples(VolumeInfo& info, const DataFiles& files, const DataLayout& layout,
                                         std::uint64_t bytes);

}  // namespace isoweave
