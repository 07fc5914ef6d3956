#include "pipeline/parts/part_scratch.hpp"

#include "parallel/size.hpp"

namespace isoweave {

PartScratch::Place PartScratch::put(std::span<const std::byte> bytes) {
  const Place place{file_.size(), bytes.size()};
  file_.write(bytes);
  return place;
}

std::vector<std::byte> PartScratch::take(const Place& place) {
  std::vector<std::byte> bytes(to_size(place.count));
  file_.read_back(place.first, bytes);
  file_.free(place.first, place.count);
  return bytes;
}

}  // namespace isoweave
