#include "page/page_script.hpp"

#include <fmt/format.h>

#include <span>

namespace isoweave::cli {

std::string script_start(std::string_view id) {
  return fmt::format("<script type=\"application/json\" id=\"{}\">", id);
}

std::string script_text(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, nlohmann::detail::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

void write_text(OutputFile& file, std::string_view text) { file.write(std::as_bytes(std::span(text))); }

void write_script(OutputFile& file, std::string_view id, const Json& json) {
  write_text(file, script_start(id));
  write_text(file, script_text(json));
  write_text(file, kScriptEnd);
}

}  // namespace isoweave::cli
