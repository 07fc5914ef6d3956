// The labels of a map that mesh --labels asks for, and their names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "isoweave/volume.hpp"

namespace isoweave::cli {

// The value of --labels, parsed.
struct LabelChoice {
  bool all = false;                // labels that occur, but 0
  bool insists = false;            // also where the map looks like a grey image
  std::vector<std::string> words;  // numbers and names
};

// Parses --labels. Throws std::invalid_argument for a word that is neither a number nor a name.
LabelChoice parse_labels(std::string_view text);

// The names of labels: those of a file or, without one, those in the map itself.
class LabelBook {
 public:
  // `path` may be empty. `channel`, if any, is the one layer that is read.
  LabelBook(const std::string& path, const VolumeInfo& map, const std::string& channel);

  // The layers of the map, ascending: one, but for a segmentation whose segments overlap.
  const std::vector<std::int64_t>& layers() const { return layers_; }

  // The entry of a label: its number at least.
  LabelName entry(Label label, std::int64_t layer) const;

  // The labels that are asked for one by one. Throws std::invalid_argument for a name that is not known and for a
  // label that is asked for twice.
  std::vector<LabelName> chosen(const LabelChoice& choice) const;

  // The segments of a layer of the map, whether they occur in it or not.
  std::vector<LabelName> segments(std::int64_t layer) const;

 private:
  std::vector<LabelName> matches(const std::string& word) const;
  void number_names();

  bool of_map_ = false;
  std::vector<LabelName> names_;
  std::map<std::pair<Label, std::int64_t>, std::size_t> numbers_;  // of names, by label and layer
  std::vector<LabelName> segments_;
  std::vector<std::int64_t> layers_;
};

}  // namespace isoweave::cli
