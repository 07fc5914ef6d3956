#include "pipeline/ranks/result_writer.hpp"

#include <utility>

namespace isoweave {

void ResultWriter::take(std::uint64_t task, TaskResult result) {
  ++tasks_;
  collector_.count(task, result.facts);
  if (result.kept) return collector_.keep(std::move(*result.kept));
  waiting_.push_back({task, std::move(result.pieces)});
  while (write_some()) {
  }
}

// Writes all results that nothing stands before. Returns whether there were any.
bool ResultWriter::write_some() {
  const std::size_t before = waiting_.size();
  std::erase_if(waiting_, [&](Waiting& result) {
    if (!collector_.can_write(result.task, result.pieces)) return false;
    collector_.write(result.task, std::move(result.pieces));
    return true;
  });
  return waiting_.size() < before && !waiting_.empty();
}

}  // namespace isoweave
