#include "ranks.hpp"

namespace isoweave::cli {
namespace {

RankLink* used_link = nullptr;

}  // namespace

RankLink* rank_link() { return used_link; }

void use_ranks(RankLink& link) { used_link = &link; }

bool speaks() { return used_link == nullptr || used_link->rank() == 0; }

}  // namespace isoweave::cli
