#include "verbs/mesh_label_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "isoweave/label_names.hpp"
#include "options/values.hpp"

namespace isoweave::cli {
namespace {

std::vector<std::int64_t> layers_of(std::span<const LabelName> segments) {
  std::set<std::int64_t> layers;
  for (const LabelName& segment : segments) layers.insert(segment.layer);
  if (layers.empty()) layers.insert(0);
  return {layers.begin(), layers.end()};
}

// Adds the numbers of a range such as "1-10". False for anything else.
bool add_numbers(std::string_view word, std::vector<std::string>& words) {
  const std::size_t dash = word.find('-');
  if (dash == std::string_view::npos || word.find_first_not_of("0123456789-") != std::string_view::npos) return false;
  const auto first = to_number<std::uint64_t>(word.substr(0, dash));
  const auto last = to_number<std::uint64_t>(word.substr(dash + 1));
  if (!first || !last || *last < *first || *last - *first >= kMostLabels) return false;
  for (std::uint64_t label = *first; label <= *last; ++label) words.push_back(std::to_string(label));
  return true;
}

}  // namespace

LabelChoice parse_labels(std::string_view text) {
  LabelChoice choice;
  choice.insists = text == "all!";
  choice.all = text == "all" || choice.insists;
  if (choice.all) return choice;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    if (word.empty()) wrong_value("--labels", "all, or whole numbers or names such as 1,2,5 or 1-10", text);
    if (!add_numbers(word, choice.words)) choice.words.emplace_back(word);
    begin = end + 1;
  }
  if (choice.words.size() > kMostLabels) {
    wrong_value("--labels", fmt::format("at most {} labels", kMostLabels), std::to_string(choice.words.size()));
  }
  return choice;
}

LabelBook::LabelBook(const std::string& path, const VolumeInfo& map, const std::string& channel)
    : of_map_(path.empty()), names_(path.empty() ? map.labels : read_label_names(path)), segments_(map.labels) {
  const std::optional<Label> layer = parse_label(channel);
  if (layer) std::erase_if(segments_, [&](const LabelName& segment) { return segment.layer != *layer; });
  if (of_map_) names_ = segments_;
  layers_ = layers_of(segments_);
  number_names();
}

// Names of a file are for the labels of all layers. The first of several names counts.
void LabelBook::number_names() {
  for (std::size_t n = 0; n < names_.size(); ++n)
    numbers_.emplace(std::pair(names_[n].label, of_map_ ? names_[n].layer : 0), n);
}

LabelName LabelBook::entry(Label label, std::int64_t layer) const {
  const auto found = numbers_.find({label, of_map_ ? layer : 0});
  LabelName entry = found == numbers_.end() ? LabelName{label, {}, {}, layer} : names_[found->second];
  entry.layer = layer;
  return entry;
}

std::vector<LabelName> LabelBook::segments(std::int64_t layer) const {
  std::vector<LabelName> segments;
  for (const LabelName& segment : segments_) {
    if (segment.layer == layer) segments.push_back(entry(segment.label, layer));
  }
  return segments;
}

// The labels that a word names. A number names itself, in the layers whose segments have it; a name stands for all
// labels that have it.
std::vector<LabelName> LabelBook::matches(const std::string& word) const {
  std::vector<LabelName> found;
  if (const std::optional<Label> label = parse_label(word)) {
    for (const LabelName& segment : segments_) {
      if (segment.label == *label) found.push_back(entry(*label, segment.layer));
    }
    if (found.empty()) found.push_back(entry(*label, layers_.front()));
    return found;
  }
  for (const LabelName& name : names_) {
    if (name.name == word) found.push_back(entry(name.label, of_map_ ? name.layer : layers_.front()));
  }
  if (found.empty()) {
    wrong_value("--labels", names_.empty() ? "all, or whole numbers such as 1,2,5" : "all, numbers, or names of labels",
                word);
  }
  return found;
}

std::vector<LabelName> LabelBook::chosen(const LabelChoice& choice) const {
  std::vector<LabelName> list;
  std::set<std::pair<Label, std::int64_t>> known;
  for (const std::string& word : choice.words) {
    for (LabelName& name : matches(word)) {
      if (!known.emplace(name.label, name.layer).second) wrong_value("--labels", "each label once", word);
      list.push_back(std::move(name));
    }
  }
  return list;
}

}  // namespace isoweave::cli
