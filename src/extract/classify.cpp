#include "extract/classify.hpp"

#include <algorithm>

#include "volume/samples.hpp"
#include "volume/threshold.hpp"

namespace isoweave {
void classify_row(const std::byte* row, SampleType type, std::int64_t n, const IsoRule& rule,
                  std::span<std::uint64_t> words, const RowKernels& kernels) {
  visit_sample_type(type, [&]<class T>() {
    const Threshold<T> threshold = threshold_for<T>(rule.iso, rule.above);
    if (!threshold.reachable) return std::fill(words.begin(), words.end(), 0);
    const auto& compare = std::get<Comparison<T>>(kernels.compare);
    (rule.above ? compare.at_least : compare.at_most)(reinterpret_cast<const T*>(row), n, threshold.value, words);
  });
}

}  // namespace isoweave
