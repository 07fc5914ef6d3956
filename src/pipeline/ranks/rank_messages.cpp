#include "pipeline/ranks/rank_messages.hpp"

#include <chrono>
#include <new>
#include <stdexcept>
#include <utility>

#include "isoweave/error.hpp"

namespace isoweave {
namespace {

RankError::Type type_of(const std::exception& error) {
  using Type = RankError::Type;
  const auto is = [&]<class E>(const E*) { return dynamic_cast<const E*>(&error) != nullptr; };
  if (is(static_cast<EmptySurface*>(nullptr))) return Type::kEmpty;
  if (is(static_cast<BadInput*>(nullptr))) return Type::kBadInput;
  if (is(static_cast<CannotWrite*>(nullptr))) return Type::kCannotWrite;
  if (is(static_cast<OverMemory*>(nullptr)) || is(static_cast<std::bad_alloc*>(nullptr))) return Type::kOverMemory;
  if (is(static_cast<Interrupted*>(nullptr))) return Type::kInterrupted;
  if (is(static_cast<std::invalid_argument*>(nullptr))) return Type::kArgument;
  return Type::kOther;
}

// The error that rank 0 has named in a message that has arrived.
std::optional<RankError> named_error(RankLink& link) {
  while (std::optional<RankMessage> message = link.receive()) {
    MessageReader reader(std::move(*message));
    if (reader.kind() != MessageKind::kFailed) continue;
    RankError error;
    error.read(reader);
    return error;
  }
  return std::nullopt;
}

}  // namespace

RankError RankError::of(const std::exception& error) { return {type_of(error), error.what()}; }

std::vector<std::byte> RankError::message() const {
  MessageWriter message(MessageKind::kFailed);
  message.value(type);
  message.list(text);
  return message.take();
}

void RankError::read(MessageReader& reader) {
  reader.value(type);
  reader.list(text);
}

void RankError::raise() const {
  switch (type) {
    case Type::kEmpty:
      throw EmptySurface(text);
    case Type::kBadInput:
      throw BadInput(text);
    case Type::kCannotWrite:
      throw CannotWrite(text);
    case Type::kOverMemory:
      throw OverMemory(text);
    case Type::kInterrupted:
      throw Interrupted(text);
    case Type::kArgument:
      throw std::invalid_argument(text);
    case Type::kOther:
      break;
  }
  throw std::runtime_error(text);
}

void tell_all(RankLink& link, const RankError& error) {
  for (int rank = 1; rank < link.ranks(); ++rank) link.send(rank, error.message());
}

RankError agreed_error(RankLink& link, const RankError& own) {
  if (link.rank() == 0) {
    tell_all(link, own);
    return own;
  }
  link.send(0, own.message());
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  while (std::chrono::steady_clock::now() < end) {
    if (std::optional<RankError> error = named_error(link)) return *error;
    link.pause();
  }
  return own;
}

}  // namespace isoweave
