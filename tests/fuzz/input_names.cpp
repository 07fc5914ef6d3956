#include "input_files.hpp"

const char* const isoweave::fuzz::kInputNames = ISOWEAVE_FUZZ_FILES;
