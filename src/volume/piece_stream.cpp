#include "volume/piece_stream.hpp"

#include <algorithm>
#include <utility>

#include "files/input_file.hpp"
#include "parallel/size.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {
namespace {

bool is_empty(const Region& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (box.first[axis] >= box.end[axis]) return true;
  }
  return false;
}

std::string text_of(const Region& box) {
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    text += (axis == 0 ? "" : ", ") + std::to_string(box.first[axis]) + " to " + std::to_string(box.end[axis] - 1);
  }
  return text;
}

// Adds the part of `from` outside `taken` to `left`, in boxes. Returns whether `taken` took anything.
bool subtract(Region from, const Region& taken, std::vector<Region>& left) {
  Region common;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    common.first[axis] = std::max(from.first[axis], taken.first[axis]);
    common.end[axis] = std::min(from.end[axis], taken.end[axis]);
  }
  if (is_empty(common)) {
    left.push_back(from);
    return false;
  }
  // Cuts off the parts below and above `taken`, one axis after the other. The part between them goes on to the next
  // axis.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Region below = from;
    Region above = from;
    below.end[axis] = common.first[axis];
    above.first[axis] = common.end[axis];
    if (!is_empty(below)) left.push_back(below);
    if (!is_empty(above)) left.push_back(above);
    from.first[axis] = common.first[axis];
    from.end[axis] = common.end[axis];
  }
  return true;
}

void check_inside(const Region& box, const Region& whole, const std::string& path) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (box.first[axis] >= 0 && box.end[axis] <= whole.end[axis]) continue;
    bad_input(path, "pieces within the samples " + text_of(whole), text_of(box));
  }
}

}  // namespace

std::vector<VolumePiece> filling_pieces(std::vector<VolumePiece> pieces, const std::array<std::int64_t, 3>& dims,
                                        const std::string& path) {
  constexpr std::size_t kMostBoxes = 1 << 16;
  const Region whole{{0, 0, 0}, dims};
  std::vector<Region> missing{whole};
  std::vector<VolumePiece> filling;
  for (VolumePiece& piece : pieces) {
    if (is_empty(piece.box)) continue;
    check_inside(piece.box, whole, path);
    std::vector<Region> left;
    bool fills = false;
    for (const Region& box : missing) fills = subtract(box, piece.box, left) || fills;
    if (left.size() > kMostBoxes) bad_input(path, "pieces that lie side by side", "scattered ones");
    missing = std::move(left);
    if (fills) filling.push_back(std::move(piece));
  }
  if (!missing.empty()) {
    bad_input(path, "pieces that hold all samples, " + text_of(whole), "none for " + text_of(missing.front()));
  }
  return filling;
}

PieceStream::PieceStream(std::vector<VolumePiece> pieces, const std::array<std::int64_t, 3>& dims,
                         std::size_t bytes_each, std::string path)
    : dims_(dims), bytes_each_(bytes_each), path_(std::move(path)) {
  for (VolumePiece& piece : pieces) pieces_.push_back({std::move(piece)});
}

void PieceStream::add_piece(OpenPiece& open) {
  const Region& box = open.piece.box;
  if (next_ < box.first[2] || next_ >= box.end[2]) return;
  if (!open.samples.stream) open.samples = open.piece.open();
  const std::size_t row = static_cast<std::size_t>(box.end[0] - box.first[0]) * bytes_each_;
  part_.resize(row * static_cast<std::size_t>(box.end[1] - box.first[1]));
  if (open.samples.stream->read(part_) < part_.size()) {
    bad_input(path_, "all samples of a piece", "the end of its data in slice " + std::to_string(next_));
  }
  if (open.samples.swap_bytes) swap_sample_bytes(part_, bytes_each_);
  for (std::int64_t j = box.first[1]; j < box.end[1]; ++j) {
    const auto from = part_.begin() + static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(j - box.first[1]));
    const std::size_t to = static_cast<std::size_t>(j * dims_[0] + box.first[0]) * bytes_each_;
    std::copy_n(from, row, slice_.begin() + static_cast<std::ptrdiff_t>(to));
  }
  if (next_ + 1 < box.end[2]) return;
  // One byte more makes a compressed stream check its sum.
  std::array<std::byte, 1> beyond;
  open.samples.stream->read(beyond);
  open.samples.stream.reset();
}

void PieceStream::fill_slice() {
  slice_.resize(to_size(dims_[0] * dims_[1], bytes_each_));
  for (OpenPiece& open : pieces_) add_piece(open);
  ++next_;
  used_ = 0;
}

std::size_t PieceStream::read(std::span<std::byte> out) {
  std::size_t done = 0;
  while (done < out.size()) {
    if (used_ == slice_.size()) {
      if (next_ == dims_[2]) break;
      fill_slice();
    }
    const std::size_t step = std::min(out.size() - done, slice_.size() - used_);
    std::copy_n(slice_.begin() + static_cast<std::ptrdiff_t>(used_), step,
                out.begin() + static_cast<std::ptrdiff_t>(done));
    done += step;
    used_ += step;
  }
  return done;
}

}  // namespace isoweave
