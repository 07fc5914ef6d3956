// Legacy VTK files: lines of text, and between them arrays in text, or in binary with the most significant byte first.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/input_file.hpp"
#include "volume/formats/vtk/vtk_arrays.hpp"

namespace isoweave {

struct LegacyArray {
  std::string name;
  std::string type;  // by the names of VTK's XML files: "Float32", "Bit", ...
  std::uint64_t components = 1, tuples = 0;
  std::uint64_t at = 0;     // the byte where it begins
  bool is_colours = false;  // of 8 bits; in text they are parts of 1
  bool is_normals = false;
  bool is_scalars = false;  // SCALARS or COLOR_SCALARS

  std::uint64_t numbers() const { return components * tuples; }
};

// Arrays at points, or in cells.
struct LegacyArrays {
  std::uint64_t tuples = 0;
  std::vector<LegacyArray> all;

  // Active are scalars of one component.
  VtkArrayNames names() const;
};

// The first word in capitals: keywords may be written in small letters.
std::string legacy_key(const std::vector<std::string>& words);

class LegacyFile {
 public:
  // Reads the first three lines. Throws BadInput, as all of this does.
  explicit LegacyFile(std::shared_ptr<const InputFile> file);

  const std::string& path() const { return file_->path(); }
  const std::shared_ptr<const InputFile>& file() const { return file_; }
  bool is_text() const { return is_text_; }
  std::uint64_t position() const { return position_; }
  void move_to(std::uint64_t position) { position_ = position; }

  // The words of the next line that has some, behind the last array; none at the end of the file.
  std::vector<std::string> next_words();

  // Whether these characters come next, behind blanks.
  bool is_next(std::string_view text);

  // An array that begins here. `type` is VTK's name for it in this kind of file.
  LegacyArray array_here(const std::string& name, std::string_view type, std::uint64_t components,
                         std::uint64_t tuples);

  // Moves behind it.
  void skip(const LegacyArray& array);

  // Takes what a line begins, if it belongs to arrays: a section, arrays, a look-up table, metadata. False if it does
  // not. Arrays are kept in the list of their section; those of fields before all sections nowhere.
  bool take_arrays(const std::vector<std::string>& words);

  // A whole number of up to 2^48.
  std::uint64_t count_of(const std::vector<std::string>& words, std::size_t word) const;

  LegacyArrays points, cells;

 private:
  int take();
  bool next_line(std::string& line);
  std::string type_here(std::string_view type, std::uint64_t numbers);
  bool ends_after(std::uint64_t bytes);
  void skip_words(std::uint64_t count);
  void skip_strings(std::uint64_t count);
  void skip_metadata();
  void take_array(LegacyArray array);
  void take_scalars(const std::vector<std::string>& words);
  bool take_attribute(const std::vector<std::string>& words);
  void take_field(std::uint64_t arrays);

  std::shared_ptr<const InputFile> file_;
  bool is_text_ = false;
  LegacyArrays* section_ = nullptr;
  std::optional<LegacyArray> pending_;  // to be passed over
  std::uint64_t position_ = 0, begin_ = 0;
  std::size_t filled_ = 0;
  std::array<std::byte, 64 * 1024> buffer_;
};

}  // namespace isoweave
