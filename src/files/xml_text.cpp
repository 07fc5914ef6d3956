#include "files/xml_text.hpp"

namespace isoweave {
namespace {

char printable(char c) { return static_cast<unsigned char>(c) < 0x20U ? ' ' : c < 0 || c == 0x7f ? '?' : c; }

}  // namespace

std::string xml_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += printable(c);
    }
  }
  return result;
}

std::string xml_comment(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '-' && result.ends_with('-')) result += ' ';
    result += printable(c);
  }
  return result.ends_with('-') ? result + ' ' : result;
}

}  // namespace isoweave
