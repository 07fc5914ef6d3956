# libcurl, of which only the headers are used: the library is loaded when the first URL is met.
find_path(IsoweaveCurl_INCLUDE_DIR curl/curl.h)
if(IsoweaveCurl_INCLUDE_DIR)
  file(STRINGS ${IsoweaveCurl_INCLUDE_DIR}/curl/curlver.h facts REGEX "define LIBCURL_VERSION \"")
  string(REGEX MATCH "[0-9.]+" IsoweaveCurl_VERSION "${facts}")
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(IsoweaveCurl REQUIRED_VARS IsoweaveCurl_INCLUDE_DIR
                                  VERSION_VAR IsoweaveCurl_VERSION)
if(IsoweaveCurl_FOUND AND NOT TARGET IsoweaveCurl::IsoweaveCurl)
  add_library(IsoweaveCurl::IsoweaveCurl INTERFACE IMPORTED)
  target_include_directories(IsoweaveCurl::IsoweaveCurl INTERFACE ${IsoweaveCurl_INCLUDE_DIR})
  target_link_libraries(IsoweaveCurl::IsoweaveCurl INTERFACE ${CMAKE_DL_LIBS})
endif()
