# Formats whose libraries may be missing. Each option is AUTO (take the format in if the library is there), ON (stop
# without it) or OFF. What is left out is compiled as an error that says so (src/volume/not_built.cpp and
# src/write/not_built.cpp).
list(APPEND CMAKE_MODULE_PATH ${PROJECT_SOURCE_DIR}/cmake)
set(ISOWEAVE_READERS)

# isoweave_reader(NAME SOURCE TARGET PACKAGE...): finds a package, and drops the source without it.
macro(isoweave_reader name source target package)
  set(ISOWEAVE_${name} AUTO CACHE STRING "${name} through ${package}: AUTO, ON or OFF")
  set_property(CACHE ISOWEAVE_${name} PROPERTY STRINGS AUTO ON OFF)
  set(ISOWEAVE_HAS_${name} FALSE)
  if(ISOWEAVE_${name} STREQUAL AUTO)
    find_package(${package} ${ARGN} QUIET)
  elseif(ISOWEAVE_${name})
    find_package(${package} ${ARGN} REQUIRED)
  endif()
  if(${package}_FOUND AND (ISOWEAVE_${name} STREQUAL AUTO OR ISOWEAVE_${name}))
    set(ISOWEAVE_HAS_${name} TRUE)
  endif()
  set(ISOWEAVE_${name}_TARGET ${target})
  list(APPEND ISOWEAVE_READERS ${name})
  if(NOT ISOWEAVE_HAS_${name})
    list(REMOVE_ITEM ISOWEAVE_SOURCES ${PROJECT_SOURCE_DIR}/src/volume/${source} ${PROJECT_SOURCE_DIR}/src/write/${source})
  endif()
endmacro()

# Messages of libtiff are taken per file since 4.5.
isoweave_reader(TIFF tiff.cpp TIFF::TIFF TIFF 4.5)
isoweave_reader(PNG png.cpp PNG::PNG PNG)
# Plain DICOM samples need no library.
isoweave_reader(DICOM dicom_unpack.cpp IsoweaveGdcm::IsoweaveGdcm IsoweaveGdcm)
# Packed meshes, which are written only.
isoweave_reader(MESHOPTIMIZER glb_packed.cpp meshoptimizer::meshoptimizer meshoptimizer)
isoweave_reader(DRACO precomputed_packed.cpp draco::draco draco)

# The libraries, and what tells the sources which of them are there.
function(isoweave_link_readers target)
  foreach(name ${ISOWEAVE_READERS})
    if(ISOWEAVE_HAS_${name})
      target_compile_definitions(${target} PRIVATE ISOWEAVE_HAS_${name})
      target_link_libraries(${target} PRIVATE ${ISOWEAVE_${name}_TARGET})
    endif()
  endforeach()
endfunction()

# Drops the tests that write files through a library that is not there.
function(isoweave_select_reader_tests sources)
  set(left ${${sources}})
  if(NOT ISOWEAVE_HAS_TIFF)
    list(FILTER left EXCLUDE REGEX "/volume_(tiff|slices)\\.cpp$")
  endif()
  if(NOT ISOWEAVE_HAS_PNG)
    list(FILTER left EXCLUDE REGEX "/volume_png\\.cpp$")
  endif()
  if(NOT ISOWEAVE_HAS_DICOM)
    list(FILTER left EXCLUDE REGEX "/volume_dicom\\.cpp$")
  endif()
  set(${sources} ${left} PARENT_SCOPE)
endfunction()
