// The header of NRRD: lines "field: value", and what they say of the axes.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "volume/axes.hpp"

namespace isoweave {

// The header as text: names of fields in lower case and without blanks.
struct NrrdFields {
  std::map<std::string, std::string> values;
  std::map<std::string, std::string> pairs;  // of lines "key:=value"
  std::vector<std::string> listed;           // the lines behind "data file: LIST"
  std::size_t end = 0;                       // bytes of the header, blank line included
  bool blank_line = false;

  std::string_view get(const std::string& name) const {
    const auto found = values.find(name);
    return found == values.end() ? std::string_view() : std::string_view(found->second);
  }
};

struct NrrdVector {
  Vector3 space{0, 0, 0};
  double time = 0;
};

struct NrrdAxis {
  std::int64_t size = 0;
  std::string kind;
  std::optional<Vector3> step;
  double spacing = std::numeric_limits<double>::quiet_NaN();
  double least = std::numeric_limits<double>::quiet_NaN();  // "axis mins"
  double most = std::numeric_limits<double>::quiet_NaN();   // "axis maxs"
  bool node_centred = false;
  std::string unit;
};

// Throws BadInput for text that is no header.
NrrdFields parse_nrrd_fields(const std::string& text, const std::string& path);

// Whether a data file is a list of names on the lines that follow.
bool is_nrrd_list(std::string_view value);

// Throws BadInput where the field is not there.
std::string_view required_nrrd_field(const NrrdFields& fields, const std::string& name, std::string_view path);

// A whole number, or `missing` where the field is not there. Throws BadInput for anything else.
std::int64_t nrrd_integer(const NrrdFields& fields, const std::string& name, std::int64_t missing,
                          std::string_view path);

// The axes from the fastest to the slowest. An axis that lies in time, as a vector of four numbers may say, gets that
// kind.
std::vector<NrrdAxis> parse_nrrd_axes(const NrrdFields& fields, const std::string& path);

// "(1,0,0) none (0,1,0)"; a vector of NaN says none, too.
std::vector<std::optional<NrrdVector>> parse_nrrd_vectors(std::string_view text, std::string_view path);

// The words between double quotes; between blanks where there is no quote.
std::vector<std::string> quoted_words(std::string_view text);

}  // namespace isoweave
