#include "volume/formats/images/ome_planes.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "files/xml_tag.hpp"

namespace isoweave {
namespace {

// A TiffData element and the file that it names, if any.
struct TiffData {
  std::string_view tag;
  std::string uuid, file;

  bool is_named() const { return !uuid.empty() || !file.empty(); }
};

struct OmeText {
  std::string uuid;                                                        // of this file
  std::vector<std::pair<std::string_view, std::vector<TiffData>>> images;  // Pixels and what stands in them
};

// The next tag without its brackets; empty behind the last. Comments are passed over, and `at` moves behind the tag.
std::string_view next_tag(std::string_view text, std::size_t& at) {
  constexpr std::string_view kComment = "<!--", kCommentEnd = "-->";
  std::size_t begin = text.find('<', at);
  while (begin != std::string_view::npos && text.substr(begin).starts_with(kComment)) {
    const std::size_t end = text.find(kCommentEnd, begin + kComment.size());
    begin = end == std::string_view::npos ? end : text.find('<', end);
  }
  if (begin == std::string_view::npos) return {};
  char quote = '\0';
  for (at = begin + 1; at < text.size(); ++at) {
    const char c = text[at];
    if (quote == '\0' && c == '>') break;
    if (quote == '\0' && (c == '"' || c == '\'')) {
      quote = c;
    } else if (c == quote) {
      quote = '\0';
    }
  }
  return text.substr(begin + 1, at - begin - 1);
}

// The name of a tag, without that of its namespace.
std::string_view name_of_tag(std::string_view tag) {
  const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
  return name.substr(name.find(':') + 1);
}

OmeText parse_ome_text(std::string_view text) {
  OmeText ome;
  std::size_t at = 0;
  for (std::string_view tag = next_tag(text, at); !tag.empty(); tag = next_tag(text, at)) {
    const std::string_view name = name_of_tag(tag);
    if (name == "OME") ome.uuid = xml_attribute(tag, "UUID");
    if (name == "Pixels") ome.images.push_back({tag, {}});
    if (ome.images.empty()) continue;
    std::vector<TiffData>& data = ome.images.back().second;
    if (name == "TiffData") data.push_back({tag, {}, {}});
    if (name != "UUID" || data.empty() || tag.starts_with('/')) continue;
    data.back().file = xml_attribute(tag, "FileName");
    const std::size_t begin = std::min(at + 1, text.size());
    if (!tag.ends_with('/')) data.back().uuid = trimmed(text.substr(begin, text.find('<', begin) - begin));
  }
  return ome;
}

// Tells which planes lie in this file: by its identifier or, where no plane has that, by its name. Where all planes lie
// in one file, which may go by another name now, that is this one.
class ThisFile {
 public:
  ThisFile(const OmeText& ome, const std::string& path)
      : uuid_(ome.uuid), name_(std::filesystem::path(path).filename().string()) {
    const TiffData* first = nullptr;
    for (const auto& [pixels, data] : ome.images) {
      for (const TiffData& part : data) {
        if (!part.is_named()) continue;
        if (first == nullptr) first = &part;
        only_ = only_ && part.uuid == first->uuid && part.file == first->file;
        by_uuid_ = by_uuid_ || (!uuid_.empty() && part.uuid == uuid_);
      }
    }
  }

  bool has(const TiffData& part) const {
    if (!part.is_named() || only_) return true;
    return by_uuid_ ? part.uuid == uuid_ : part.file == name_;
  }

 private:
  std::string uuid_, name_;
  bool by_uuid_ = false, only_ = true;
};

OmeImage image_in(const ThisFile& file, std::string_view pixels, const std::vector<TiffData>& data) {
  OmeImage image{pixels, {}, {}};
  for (const TiffData& part : data) (file.has(part) ? image.here : image.elsewhere).push_back(part.tag);
  return image;
}

constexpr std::int64_t kMostPlanes = std::int64_t{1} << 40;

// A count or an index as an attribute; nothing where there is none.
std::optional<std::int64_t> number_in(std::string_view tag, const std::string& name, std::string_view path) {
  const std::string text = xml_attribute(tag, name);
  if (text.empty()) return std::nullopt;
  const auto number = parse_integer(trimmed(text));
  if (!number || *number < 0 || *number > kMostPlanes) {
    bad_input(path, "a number of at least 0 as " + name + " of TiffData", in_quotes(text));
  }
  return number;
}

std::int64_t first_plane(std::string_view tag, const std::vector<ArrayAxis>& axes, std::string_view path) {
  constexpr std::array<std::pair<std::string_view, const char*>, 3> kFirst{
      {{"z", "FirstZ"}, {"channel", "FirstC"}, {"time", "FirstT"}}};
  std::int64_t plane = 0;
  for (const ArrayAxis& axis : axes) {
    for (const auto& [name, attribute] : kFirst) {
      if (axis.name != name) continue;
      const std::int64_t index = number_in(tag, attribute, path).value_or(0);
      if (index >= axis.size) {
        bad_input(path, std::string(attribute) + " below " + std::to_string(axis.size), std::to_string(index));
      }
      plane = plane * axis.size + index;
    }
  }
  return plane;
}

constexpr std::int64_t kNoPage = -1;

// The directory of each plane, kNoPage where none is said.
std::vector<std::int64_t> pages_by_runs(const std::vector<PlaneRun>& runs, std::size_t planes, std::string_view path) {
  std::vector<std::int64_t> pages(planes, kNoPage);
  std::vector<bool> goes_on(planes, false);
  for (const PlaneRun& run : runs) {
    for (std::int64_t n = 0; n < run.count.value_or(1); ++n) {
      const auto plane = static_cast<std::size_t>(run.plane + n);
      if (plane >= planes) bad_input(path, std::to_string(planes) + " planes in TiffData", "more");
      if (pages[plane] != kNoPage) {
        bad_input(path, "one page for each plane in TiffData", "two for plane " + std::to_string(plane));
      }
      pages[plane] = run.page + n;
      goes_on[plane] = !run.count;
    }
  }
  for (std::size_t plane = 1; plane < planes; ++plane) {
    if (pages[plane] != kNoPage || !goes_on[plane - 1]) continue;
    pages[plane] = pages[plane - 1] + 1;
    goes_on[plane] = true;
  }
  return pages;
}

}  // namespace

OmeImage find_ome_image(std::string_view text, const std::string& path) {
  const OmeText ome = parse_ome_text(text);
  if (ome.images.empty()) bad_input(path, "Pixels in its OME description", "none");
  const ThisFile file(ome, path);
  std::vector<OmeImage> found;
  for (const auto& [pixels, data] : ome.images) {
    OmeImage image = image_in(file, pixels, data);
    const bool is_here = data.empty() || !image.here.empty() || ome.images.size() == 1;
    if (is_here) found.push_back(std::move(image));
  }
  if (found.size() == 1) return found.front();
  bad_input(path, "one image in its OME description",
            std::to_string(ome.images.size()) +
                " (each can be read from a file of its own, which bfconvert -series N writes)");
}

std::vector<PlaneRun> plane_runs(const OmeImage& image, const std::vector<ArrayAxis>& axes, std::string_view path) {
  std::vector<PlaneRun> runs;
  for (const std::string_view tag : image.here) {
    PlaneRun run{first_plane(tag, axes, path), number_in(tag, "IFD", path).value_or(0),
                 number_in(tag, "PlaneCount", path)};
    // The name in schemas before 2008.
    if (!run.count) run.count = number_in(tag, "NumPlanes", path);
    runs.push_back(run);
  }
  return runs;
}

std::vector<std::size_t> places_of_planes(const std::vector<PlaneRun>& runs, const std::vector<std::int64_t>& pages,
                                          std::string_view path) {
  std::vector<std::size_t> places;
  std::vector<bool> is_used(pages.size(), false);
  for (const std::int64_t page : pages_by_runs(runs, pages.size(), path)) {
    const auto found = std::lower_bound(pages.begin(), pages.end(), page);
    if (found == pages.end() || *found != page) {
      bad_input(path, "a page for plane " + std::to_string(places.size()) + " in TiffData",
                page == kNoPage ? "none" : "IFD " + std::to_string(page) + ", which is none of the slices");
    }
    const auto place = static_cast<std::size_t>(found - pages.begin());
    if (is_used[place])
      bad_input(path, "a page for each plane in TiffData", "IFD " + std::to_string(page) + " for two");
    is_used[place] = true;
    places.push_back(place);
  }
  return places;
}

}  // namespace isoweave
