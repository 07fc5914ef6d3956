#include "simplify/decide.hpp"

namespace isoweave {

template class BasicDecider<VectorArithmetic>;

}  // namespace isoweave
