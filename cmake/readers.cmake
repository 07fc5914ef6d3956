# Volume formats whose libraries may be missing. Each option is AUTO (read the format if the library is there), ON (stop
# without it) or OFF. What is not read is compiled as an error that says so (src/volume/not_built.cpp).

# isoweave_reader(NAME LIBRARY SOURCE PACKAGE...): finds a package, and drops the reader's source without it.
function(isoweave_reader name library source)
  set(ISOWEAVE_${name} AUTO CACHE STRING "Read ${name} through ${library}: AUTO, ON or OFF")
  set_property(CACHE ISOWEAVE_${name} PROPERTY STRINGS AUTO ON OFF)
  set(found FALSE)
  if(ISOWEAVE_${name} STREQUAL AUTO)
    find_package(${ARGN} QUIET)
    set(found ${${ARGV3}_FOUND})
  elseif(ISOWEAVE_${name})
    find_package(${ARGN} REQUIRED)
    set(found TRUE)
  endif()
  if(found)
    set(ISOWEAVE_HAS_${name} TRUE PARENT_SCOPE)
  else()
    set(ISOWEAVE_HAS_${name} FALSE PARENT_SCOPE)
    list(REMOVE_ITEM ISOWEAVE_SOURCES ${PROJECT_SOURCE_DIR}/src/volume/${source})
    set(ISOWEAVE_SOURCES ${ISOWEAVE_SOURCES} PARENT_SCOPE)
  endif()
endfunction()

# Messages of libtiff are taken per file since 4.5.
isoweave_reader(TIFF libtiff tiff.cpp TIFF 4.5)
isoweave_reader(PNG libpng png.cpp PNG)

# The libraries, and what tells the sources which of them are there.
function(isoweave_link_readers target)
  foreach(name TIFF PNG)
    if(ISOWEAVE_HAS_${name})
      target_compile_definitions(${target} PRIVATE ISOWEAVE_HAS_${name})
      target_link_libraries(${target} PRIVATE ${name}::${name})
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
  set(${sources} ${left} PARENT_SCOPE)
endfunction()
