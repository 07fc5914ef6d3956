// The DDS coding of PVM files, for tests.
#pragma once

#include "volume_helpers.hpp"

namespace isoweave::testing::pvm_files {

class BitWriter {
 public:
  void put(unsigned value, unsigned count) {
    for (unsigned n = count; n-- > 0;) {
      if (used_ % 8 == 0) bytes_ += '\0';
      const unsigned bit = (value >> n) & 1;
      bytes_.back() = static_cast<char>(static_cast<unsigned char>(bytes_.back()) | (bit << (7 - used_ % 8)));
      ++used_;
    }
  }
  // Padded with zeros to whole words.
  std::string padded() const { return bytes_ + std::string((4 - bytes_.size() % 4) % 4, '\0'); }

 private:
  std::string bytes_;
  std::size_t used_ = 0;
};

// Sorts the bytes of each block of `block` samples of `skip` bytes by their place in the sample.
inline std::string sorted(const std::string& data, std::size_t skip, std::size_t block) {
  std::string result;
  for (std::size_t begin = 0; begin < data.size(); begin += skip * block) {
    const std::size_t end = std::min(data.size(), begin + skip * block);
    for (std::size_t place = 0; place < skip; ++place) {
      for (std::size_t at = begin + place; at < end; at += skip) result += data[at];
    }
  }
  return result;
}

// The differences of the sorted bytes to their predictions, in runs of up to `longest` of equal width.
inline std::string dds_encoded(const std::string& data, unsigned skip, std::size_t strip, std::size_t block,
                               std::size_t longest = 127) {
  const std::string bytes = sorted(data, skip, block);
  const auto at = [&](std::size_t n) { return static_cast<unsigned char>(bytes[n]); };
  std::vector<int> differences;
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    int predicted = n == 0 ? 0 : at(n - 1);
    if (strip > 1 && n > strip) predicted += at(n - strip) - at(n - strip - 1);
    differences.push_back(((at(n) - predicted + 128) & 255) - 128);
  }
  const auto width_of = [](int difference) {
    unsigned width = 2;
    while (difference < -(1 << (width - 1)) || difference >= (1 << (width - 1))) ++width;
    return difference == 0 ? 0u : width;
  };
  BitWriter bits;
  bits.put(skip - 1, 2);
  bits.put(static_cast<unsigned>(strip - 1), 16);
  for (std::size_t n = 0; n < differences.size();) {
    const unsigned width = width_of(differences[n]);
    std::size_t count = 1;
    while (n + count < differences.size() && count < longest && width_of(differences[n + count]) == width) ++count;
    bits.put(static_cast<unsigned>(count), 7);
    bits.put(width == 0 ? 0 : width - 1, 3);
    for (; count > 0; --count, ++n) bits.put(static_cast<unsigned>(differences[n] + (1 << width) / 2), width);
  }
  bits.put(0, 7);
  return bits.padded();
}

inline std::string dds_v3d(const std::string& data, unsigned skip, std::size_t strip) {
  return "DDS v3d\n" + dds_encoded(data, skip, strip, data.size());
}

inline const std::string kStrings("a\0b\0c\0d\0", 8);

}  // namespace isoweave::testing::pvm_files
