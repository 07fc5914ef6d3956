include(GoogleTest)

# isoweave_discover_tests(PROGRAM PART FILTER [PROPERTY VALUE...]): the tests of a program that googletest's filter
# names, each by its own name. Names have no spaces, as ctest keeps the times of no others. A process with sanitizers takes
# a sixth of a second to begin and to end, so there the tests share processes: PROGRAM.PART.1 and so on are lots that
# googletest itself deals out.
function(isoweave_discover_tests program part filter)
  if(NOT ISOWEAVE_SANITIZE)
    gtest_discover_tests(${program} DISCOVERY_MODE PRE_TEST NO_PRETTY_VALUES TEST_FILTER "${filter}" PROPERTIES TIMEOUT 300
                         ${ARGN})
    return()
  endif()
  set(lots 32)
  if(part STREQUAL threads)
    set(lots 8)
  endif()
  foreach(lot RANGE 1 ${lots})
    set(name ${program}.${part}.${lot})
    math(EXPR index "${lot} - 1")
    add_test(NAME ${name} COMMAND ${program} --gtest_brief=1 "--gtest_filter=${filter}")
    set_tests_properties(${name} PROPERTIES TIMEOUT 900
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${lots};GTEST_SHARD_INDEX=${index}" ${ARGN})
  endforeach()
endfunction()
