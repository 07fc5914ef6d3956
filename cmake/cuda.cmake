# The CUDA back end: an option of the build, like the readers. AUTO: where there is a CUDA compiler that works.
set(ISOWEAVE_CUDA AUTO CACHE STRING "Build the CUDA back end: AUTO, ON or OFF")
set_property(CACHE ISOWEAVE_CUDA PROPERTY STRINGS AUTO ON OFF)
set(ISOWEAVE_HAS_CUDA OFF)
# Instrumented code cannot be linked with what nvcc makes of it.
if(ISOWEAVE_CUDA STREQUAL "ON" OR (ISOWEAVE_CUDA STREQUAL "AUTO" AND NOT ISOWEAVE_SANITIZE))
  include(CheckLanguage)
  check_language(CUDA)
  if(CMAKE_CUDA_COMPILER)
    enable_language(CUDA)
    find_package(IsoweaveCudart REQUIRED)
    set(ISOWEAVE_HAS_CUDA ON)
    list(REMOVE_ITEM ISOWEAVE_SOURCES ${PROJECT_SOURCE_DIR}/src/device/no_cuda.cpp)
  elseif(ISOWEAVE_CUDA STREQUAL "ON")
    message(FATAL_ERROR "ISOWEAVE_CUDA=ON: expected a CUDA compiler, found none (set CMAKE_CUDA_COMPILER)")
  endif()
endif()
message(STATUS "isoweave: CUDA back end: ${ISOWEAVE_HAS_CUDA}")

# Adds the back end to a library, as objects with options of their own.
function(isoweave_link_cuda library)
  if(NOT ISOWEAVE_HAS_CUDA)
    return()
  endif()
  if(NOT TARGET isoweave_cuda)
    isoweave_cuda_objects()
  endif()
  target_sources(${library} PRIVATE $<TARGET_OBJECTS:isoweave_cuda>)
  target_link_libraries(${library} PRIVATE IsoweaveCudart::IsoweaveCudart)
endfunction()

function(isoweave_cuda_objects)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/device/*.cu)
  add_library(isoweave_cuda OBJECT ${sources})
  target_include_directories(isoweave_cuda PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  # The result is defined bit for bit: no contraction into FMA, on either side (docs/determinism.md).
  target_compile_options(isoweave_cuda PRIVATE -std=c++20 -fmad=false --expt-relaxed-constexpr -Xcompiler=-ffp-contract=off
                         $<$<BOOL:${ISOWEAVE_WERROR}>:-Werror=all-warnings>)
  # Ampere and Hopper as they are; what comes later from the intermediate code.
  set_target_properties(isoweave_cuda PROPERTIES CUDA_ARCHITECTURES "80-real;90" POSITION_INDEPENDENT_CODE ON)
endfunction()
