# libisoweave_c: the C interface (include/isoweave/isoweave.h) as a shared library of its own, of the same objects. It shows
# the calls of that header only, so it goes beside any C++ in a process, also another isoweave or another version of its
# libraries. Sanitizers look at the same calls in the static library.
if(NOT ISOWEAVE_SANITIZE)
  # The types of the calls, for abidiff (tests/capi).
  set_property(SOURCE src/capi/mesh_calls.cpp src/capi/run_calls.cpp src/capi/volume_calls.cpp APPEND PROPERTY
               COMPILE_OPTIONS -g)
  isoweave_library(isoweave_c SHARED isoweave_core_objects isoweave_formats_objects)
  isoweave_link_formats(isoweave_c)
  set(map ${PROJECT_SOURCE_DIR}/src/capi/isoweave_c.map)
  target_link_options(isoweave_c PRIVATE LINKER:--version-script=${map} LINKER:--exclude-libs,ALL LINKER:-z,defs)
  # SOVERSION is IW_ABI_VERSION.
  set_target_properties(isoweave_c PROPERTIES SOVERSION 1 LINK_DEPENDS ${map})
endif()
