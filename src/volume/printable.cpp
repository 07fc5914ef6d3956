#include "volume/printable.hpp"

namespace isoweave {

std::string printable(std::string_view text) {
  constexpr std::size_t kLongest = 4096;
  std::string result(text.substr(0, kLongest));
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  if (text.size() > kLongest) result += "...";
  return result;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t kShown = 60;
  return "'" + printable(text.substr(0, kShown)) + "'";
}

}  // namespace isoweave
