# Options of our own targets; nothing here reaches a project that links isoweave.
add_library(isoweave_options INTERFACE)

# The result is defined bit for bit: no contraction into FMA, no reassociation (docs/determinism.md).
target_compile_options(isoweave_options INTERFACE -ffp-contract=off)

target_compile_options(isoweave_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast -Wnon-virtual-dtor
  $<$<CXX_COMPILER_ID:Clang>:-Wreserved-identifier>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # GCC 12 warns inside std::string (GCC bug 105651)
  $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>  # tells that arguments are passed as they were before GCC 10
  $<$<BOOL:${ISOWEAVE_WERROR}>:-Werror>)

# Internal checks (src/parallel/check.hpp), in builds that are made to find faults.
target_compile_definitions(isoweave_options INTERFACE $<$<BOOL:${ISOWEAVE_CHECKS}>:ISOWEAVE_CHECKS>)

if(ISOWEAVE_SANITIZE)
  add_compile_options(-fsanitize=${ISOWEAVE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${ISOWEAVE_SANITIZE})
endif()
