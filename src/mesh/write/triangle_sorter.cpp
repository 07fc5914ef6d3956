#include "mesh/write/triangle_sorter.hpp"

#include <algorithm>

#include "files/atomic_folder.hpp"
#include "parallel/size.hpp"

namespace isoweave {

// A run on its way through a merge. What has been read gives its room back.
class TriangleSorter::Reader {
 public:
  Reader(WaitingFile& file, const Run& run, std::size_t ahead) : file_(&file), run_(run), ahead_(ahead) { read(); }

  const NodeTriangle& front() const { return block_[next_]; }

  // Returns false where there are no more.
  bool pop() {
    if (++next_ == block_.size()) read();
    return !block_.empty();
  }

 private:
  void read() {
    block_.resize(to_size(std::min<std::uint64_t>(ahead_, run_.count)));
    next_ = 0;
    const auto bytes = std::as_writable_bytes(std::span(block_));
    file_->read_back(run_.first, bytes);
    file_->free(run_.first, bytes.size());
    run_.first += bytes.size();
    run_.count -= block_.size();
  }

  WaitingFile* file_;
  Run run_;
  std::size_t ahead_;
  std::vector<NodeTriangle> block_;
  std::size_t next_ = 0;
};

TriangleSorter::TriangleSorter(const std::string& path, const Limits& limits)
    : file_(folder_of(without_slashes(path)), path), limits_(limits) {}

void TriangleSorter::add(std::span<const NodeTriangle> triangles) {
  held_.insert(held_.end(), triangles.begin(), triangles.end());
  if (held_.size() >= limits_.at_once) write_run();
}

void TriangleSorter::write_run() {
  if (held_.empty()) return;
  std::sort(held_.begin(), held_.end());
  runs_.push_back({file_.size(), held_.size()});
  write(held_);
  held_.clear();
}

void TriangleSorter::write(std::span<const NodeTriangle> triangles) { file_.append(std::as_bytes(triangles)); }

void TriangleSorter::take_all(const std::function<void(const NodeTriangle&)>& take) {
  if (runs_.empty()) {
    std::sort(held_.begin(), held_.end());
    for (const NodeTriangle& triangle : held_) take(triangle);
    held_ = {};
    return;
  }
  write_run();
  held_ = {};
  while (runs_.size() > limits_.ways) {
    const auto merged = runs_.begin() + static_cast<std::ptrdiff_t>(limits_.ways);
    runs_.push_back(merge_into_one({runs_.begin(), merged}));
    runs_.erase(runs_.begin(), runs_.begin() + static_cast<std::ptrdiff_t>(limits_.ways));
  }
  merge(runs_, take);
  runs_.clear();
}

TriangleSorter::Run TriangleSorter::merge_into_one(std::span<const Run> runs) {
  Run run{file_.size(), 0};
  std::vector<NodeTriangle> merged;
  const auto write_out = [&] {
    write(merged);
    run.count += merged.size();
    merged.clear();
  };
  merge(runs, [&](const NodeTriangle& triangle) {
    merged.push_back(triangle);
    if (merged.size() == limits_.ahead) write_out();
  });
  write_out();
  return run;
}

void TriangleSorter::merge(std::span<const Run> runs, const std::function<void(const NodeTriangle&)>& take) {
  std::vector<Reader> readers;
  readers.reserve(runs.size());
  for (const Run& run : runs) readers.emplace_back(file_, run, limits_.ahead);
  std::vector<Reader*> heap;
  heap.reserve(readers.size());
  for (Reader& reader : readers) heap.push_back(&reader);
  const auto later = [](const Reader* a, const Reader* b) { return b->front() < a->front(); };
  std::make_heap(heap.begin(), heap.end(), later);
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), later);
    take(heap.back()->front());
    if (heap.back()->pop()) {
      std::push_heap(heap.begin(), heap.end(), later);
    } else {
      heap.pop_back();
    }
  }
}

}  // namespace isoweave
