# The pages for the browser, bundled from viewer/ and put into the command line. ISOWEAVE_VIEWER is AUTO (take it in where
# node, npm, its packages and meshoptimizer can be had), ON (stop without it) or OFF. Without it `--html` and `view` are
# errors that say so.
set(ISOWEAVE_VIEWER AUTO CACHE STRING "The page for the browser, through node and npm: AUTO, ON or OFF")
set_property(CACHE ISOWEAVE_VIEWER PROPERTY STRINGS AUTO ON OFF)
set(ISOWEAVE_VIEWER_SOURCES ${PROJECT_SOURCE_DIR}/viewer)
set(ISOWEAVE_VIEWER_BUILD ${PROJECT_BINARY_DIR}/viewer)

# isoweave_get_viewer_packages(PROBLEM): npm's packages into the build folder, as package-lock.json has them; again only
# when that changes. Those that only tests need are left out where there are none.
function(isoweave_get_viewer_packages problem)
  set(${problem} "" PARENT_SCOPE)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ISOWEAVE_VIEWER_SOURCES}/package-lock.json)
  file(SHA256 ${ISOWEAVE_VIEWER_SOURCES}/package-lock.json wanted)
  set(kinds --include=dev)
  if(NOT ISOWEAVE_TESTS)
    set(kinds --omit=dev)
  endif()
  string(APPEND wanted " ${kinds}")
  set(stamp ${ISOWEAVE_VIEWER_BUILD}/packages)
  if(EXISTS ${stamp})
    file(READ ${stamp} present)
    if(present STREQUAL wanted)
      return()
    endif()
  endif()
  message(STATUS "Getting the viewer's packages")
  file(COPY ${ISOWEAVE_VIEWER_SOURCES}/package.json ${ISOWEAVE_VIEWER_SOURCES}/package-lock.json
       DESTINATION ${ISOWEAVE_VIEWER_BUILD})
  execute_process(COMMAND ${ISOWEAVE_NPM} ci ${kinds} --ignore-scripts --no-audit --no-fund
                  WORKING_DIRECTORY ${ISOWEAVE_VIEWER_BUILD}
                  RESULT_VARIABLE failed OUTPUT_VARIABLE log ERROR_VARIABLE log)
  if(failed)
    set(${problem} "npm ci failed: ${log}" PARENT_SCOPE)
  else()
    file(WRITE ${stamp} ${wanted})
  endif()
endfunction()

# isoweave_find_viewer(PROBLEM): what the viewer lacks, or nothing.
function(isoweave_find_viewer problem)
  find_program(ISOWEAVE_NODE NAMES node nodejs)
  find_program(ISOWEAVE_NPM npm)
  set(lack "")
  if(NOT ISOWEAVE_HAS_MESHOPTIMIZER)
    set(lack "meshoptimizer is not there")
  elseif(NOT ISOWEAVE_NODE OR NOT ISOWEAVE_NPM)
    set(lack "node or npm is not there")
  else()
    execute_process(COMMAND ${ISOWEAVE_NODE} --version OUTPUT_VARIABLE version OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(REGEX REPLACE "^v" "" version "${version}")
    if(version VERSION_LESS 18)
      set(lack "node 18 or later is needed, ${ISOWEAVE_NODE} is '${version}'")
    else()
      isoweave_get_viewer_packages(lack)
    endif()
  endif()
  set(${problem} "${lack}" PARENT_SCOPE)
endfunction()

# One of the pages of build.mjs as a source of `target`, in which the function NAME returns it.
function(isoweave_add_page target page_of name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${ISOWEAVE_VIEWER_SOURCES}/src/*)
  set(page ${ISOWEAVE_VIEWER_BUILD}/${name}.html)
  set(embedded ${ISOWEAVE_VIEWER_BUILD}/${name}.cpp)
  set(embed ${PROJECT_SOURCE_DIR}/cmake/embed.cmake)
  add_custom_command(OUTPUT ${page}
    COMMAND ${ISOWEAVE_NODE} ${ISOWEAVE_VIEWER_SOURCES}/build.mjs ${page_of} ${page} ${ISOWEAVE_VIEWER_BUILD}/node_modules
    DEPENDS ${sources} ${ISOWEAVE_VIEWER_SOURCES}/build.mjs ${ISOWEAVE_VIEWER_BUILD}/packages VERBATIM)
  add_custom_command(OUTPUT ${embedded}
    COMMAND ${CMAKE_COMMAND} -DFROM=${page} -DTO=${embedded} -DNAME=${name} -P ${embed}
    DEPENDS ${page} ${embed} VERBATIM)
  target_sources(${target} PRIVATE ${embedded})
endfunction()

set(ISOWEAVE_HAS_VIEWER FALSE)
if(ISOWEAVE_VIEWER STREQUAL AUTO OR ISOWEAVE_VIEWER)
  isoweave_find_viewer(ISOWEAVE_VIEWER_PROBLEM)
  if(NOT ISOWEAVE_VIEWER_PROBLEM)
    set(ISOWEAVE_HAS_VIEWER TRUE)
  elseif(ISOWEAVE_VIEWER STREQUAL AUTO)
    message(STATUS "No --html and no view: ${ISOWEAVE_VIEWER_PROBLEM}")
  else()
    message(FATAL_ERROR "ISOWEAVE_VIEWER=ON: ${ISOWEAVE_VIEWER_PROBLEM}")
  endif()
endif()
