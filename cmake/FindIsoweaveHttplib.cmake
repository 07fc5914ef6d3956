# cpp-httplib 0.11 or newer as a compiled library, for --watch. What it was compiled with decides the layout of its
# classes, and its pkg-config file says so.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(IsoweaveHttplib QUIET IMPORTED_TARGET cpp-httplib>=0.11)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(IsoweaveHttplib REQUIRED_VARS IsoweaveHttplib_LINK_LIBRARIES
                                  VERSION_VAR IsoweaveHttplib_VERSION)
if(IsoweaveHttplib_FOUND AND NOT TARGET IsoweaveHttplib::IsoweaveHttplib)
  add_library(IsoweaveHttplib::IsoweaveHttplib INTERFACE IMPORTED)
  target_link_libraries(IsoweaveHttplib::IsoweaveHttplib INTERFACE PkgConfig::IsoweaveHttplib)
endif()
