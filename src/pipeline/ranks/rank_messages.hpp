// The messages of a run by ranks. Each begins with its kind, and ends with a checksum.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "files/state_file.hpp"
#include "isoweave/ranks.hpp"
#include "pipeline/parts/task_file.hpp"
#include "simplify/zone_part.hpp"

namespace isoweave {

enum class MessageKind : std::uint32_t {
  kWeights,  // of blocks of a rank, for rank 0
  kPlan,     // the owners of all tasks, and the head start of a run to a number of triangles, from rank 0
  kPart,     // what a task has left for another one, if anything
  kResult,   // of a task, for rank 0
  kDone,     // a rank has done all of its tasks, for rank 0
  kAgain,    // a lower head start, with which all tasks are to be done again, from rank 0
  kFailed,   // an error: of a rank, for rank 0; of the run, from rank 0
  kEnd,      // the mesh is complete, from rank 0
};

// A message that is being made.
class MessageWriter : public StateWriter {
 public:
  explicit MessageWriter(MessageKind kind) { value(kind); }
};

// A message that has arrived. Throws BadInput for one that is damaged.
class MessageReader : public StateReader {
 public:
  explicit MessageReader(RankMessage message)
      : StateReader(std::move(message.bytes), "message of rank " + std::to_string(message.from), "message"),
        from_(message.from) {
    value(kind_);
  }

  MessageKind kind() const { return kind_; }
  int from() const { return from_; }

 private:
  MessageKind kind_{};
  int from_;
};

// An error on its way to other ranks: its type, as far as callers tell types apart, and its text.
struct RankError {
  enum class Type : std::uint32_t { kOther, kEmpty, kBadInput, kCannotWrite, kOverMemory, kInterrupted, kArgument };

  static RankError of(const std::exception& error);

  std::vector<std::byte> message() const;
  void read(MessageReader& reader);
  [[noreturn]] void raise() const;

  Type type = Type::kOther;
  std::string text;
};

// Tells all others an error that ends the run. From rank 0.
void tell_all(RankLink& link, const RankError& error);

// The error that ends the run, where this rank has failed. Rank 0 tells all others its own; another rank asks rank 0,
// and keeps its own where rank 0 is silent.
RankError agreed_error(RankLink& link, const RankError& own);

}  // namespace isoweave
