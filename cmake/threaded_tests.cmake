# Which tests ThreadSanitizer runs is said where they are. A source of tests that speaks of threads has a line
#   // Threads: FILTER        googletest's filter for those that it runs: threads work together, on little data; or several
#   // Threads: none, REASON
# Such tests have a label that ends in `threads` in every build; the build for ThreadSanitizer has no other sources.

# isoweave_threaded_tests(FILTER THREADED SOURCE...): the filter of all of them, and the sources that have some.
function(isoweave_threaded_tests filter threaded)
  set(filters)
  set(found)
  foreach(source ${ARGN})
    file(STRINGS ${source} said REGEX "^// Threads: ")
    if(NOT said)
      file(STRINGS ${source} threads REGEX "threads|std::j?thread|std::async|parallel/")
      if(threads)
        message(FATAL_ERROR "${source} speaks of threads: expected a line '// Threads: FILTER' with what ThreadSanitizer "
                            "runs of it, or '// Threads: none, REASON', found neither")
      endif()
    elseif(NOT said MATCHES "^// Threads: none, .")
      list(TRANSFORM said REPLACE "^// Threads: " "")
      list(APPEND filters ${said})
      list(APPEND found ${source})
    endif()
  endforeach()
  # What a line says, and what speaks of threads, may change without any list of files.
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${ARGN})
  list(JOIN filters ":" filters)
  set(${filter} ${filters} PARENT_SCOPE)
  set(${threaded} ${found} PARENT_SCOPE)
endfunction()
