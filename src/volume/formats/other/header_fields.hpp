// Numbers at fixed places of a binary header.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace isoweave {

class HeaderFields {
 public:
  // `swapped`: the byte order is not the machine's. The bytes must outlive the fields.
  HeaderFields(std::string_view bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}

  // The field must lie in the header.
  template <class Field>
  Field at(std::size_t offset) const {
    std::array<char, sizeof(Field)> raw;
    std::memcpy(raw.data(), bytes_.data() + offset, sizeof(Field));
    if (swapped_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<Field>(raw);
  }

  template <class Field, class Value, std::size_t kCount>
  void fill(std::array<Value, kCount>& values, std::size_t offset) const {
    for (std::size_t n = 0; n < kCount; ++n) values[n] = static_cast<Value>(at<Field>(offset + n * sizeof(Field)));
  }

 private:
  std::string_view bytes_;
  bool swapped_;
};

}  // namespace isoweave
