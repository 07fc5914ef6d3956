# Two libraries in one: the core, which makes meshes in memory of volumes in memory and needs the standard library and
# threads only, and the formats, which need zlib, nlohmann-json and what cmake/readers.cmake finds. Both are compiled once,
# as objects; `isoweave` is made of both, `isoweave_core` of the first.
# The rooms of the core, and of the rooms that are not wholly in it the files that those need:
set(ISOWEAVE_CORE_ROOMS system parallel lattice extract select simplify cluster device measure output pipeline)
set(ISOWEAVE_CORE_FILES
    files/atomic_file.cpp files/crc32.cpp files/file_lock.cpp files/from_chars.cpp files/header_text.cpp files/input_file.cpp files/length_units.cpp
    files/output_file.cpp files/printable.cpp files/state_file.cpp
    mesh/mesh_in_memory.cpp mesh/read/match_place.cpp mesh/read/welder.cpp
    volume/axes.cpp volume/build_index.cpp volume/crossed_bricks.cpp volume/crossing_counts.cpp volume/fields.cpp volume/generate.cpp volume/histogram.cpp volume/histogram_counter.cpp volume/index_file.cpp volume/index_identity.cpp volume/indexed_source.cpp volume/label_box.cpp volume/label_numbers.cpp volume/labels.cpp
    volume/noise.cpp volume/part_of_volume.cpp volume/row_source.cpp volume/sample_type.cpp volume/samples.cpp volume/smaller.cpp
    volume/slice_window.cpp volume/smoothed_mask.cpp volume/thinned_labels.cpp volume/volume_in_memory.cpp volume/volume_index.cpp volume/volume_sizes.cpp)

# isoweave_split_sources(CORE FORMATS SOURCE...)
function(isoweave_split_sources core formats)
  set(in_core)
  set(in_formats)
  foreach(source ${ARGN})
    file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR}/src ${source})
    string(REGEX MATCH "^[^/]+" room ${name})
    if(room IN_LIST ISOWEAVE_CORE_ROOMS OR name IN_LIST ISOWEAVE_CORE_FILES)
      list(APPEND in_core ${source})
    else()
      list(APPEND in_formats ${source})
    endif()
  endforeach()
  set(${core} ${in_core} PARENT_SCOPE)
  set(${formats} ${in_formats} PARENT_SCOPE)
endfunction()

# isoweave_count_for_fuzzers(SOURCE...): what fuzzers go by is counted where files are read; in the loops of a run it would
# take as long as the run.
function(isoweave_count_for_fuzzers)
  if(NOT ISOWEAVE_FUZZ)
    return()
  endif()
  list(FILTER ARGN INCLUDE REGEX "/(src|unity/isoweave_(core|formats))/(capi|files|volume|mesh|output|pipeline)/")
  set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS -fsanitize=fuzzer-no-link)
endfunction()

# isoweave_plain_first(OUT SOURCE...): sources with options of their own come last. Of an inline function that several
# sources compile, a program gets the copy that its linker meets first. That copy is to run on every processor, to be
# watched by the sanitizer of the build, and to count nothing for fuzzers.
function(isoweave_plain_first out)
  set(plain)
  set(others)
  foreach(source ${ARGN})
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(options)
      list(APPEND others ${source})
    else()
      list(APPEND plain ${source})
    endif()
  endforeach()
  set(${out} ${plain} ${others} PARENT_SCOPE)
endfunction()

# isoweave_link_library_first(PROGRAM): for programs of tests, which compile inline functions of the library as well. The
# library comes first, and whole, as nothing asks for parts of it there: tests check what is shipped, as it was optimised.
function(isoweave_link_library_first program)
  if(CMAKE_EXECUTABLE_FORMAT STREQUAL ELF)
    target_link_options(${program} PRIVATE LINKER:--whole-archive $<TARGET_FILE:isoweave_inside> LINKER:--no-whole-archive)
  endif()
endfunction()

# isoweave_objects(NAME SOURCE...): what is compiled. Only what public headers declare is to be seen from outside of a
# shared library: those have a pragma for it.
function(isoweave_objects name)
  isoweave_count_for_fuzzers(${ARGN})
  isoweave_plain_first(sources ${ARGN})
  add_library(${name} OBJECT ${sources})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_link_libraries(${name} PRIVATE isoweave_options)
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
                                           VISIBILITY_INLINES_HIDDEN ON)
  isoweave_set_processor(${name})
endfunction()

# isoweave_library(NAME TYPE OBJECTS...): what users link.
function(isoweave_library name type)
  add_library(${name} ${type})
  foreach(objects ${ARGN})
    target_sources(${name} PRIVATE $<TARGET_OBJECTS:${objects}>)
  endforeach()
  target_include_directories(${name}
    PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${name} PUBLIC cxx_std_20)
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  isoweave_link_threads(${name})
  isoweave_link_cuda(${name})
endfunction()
