# Makes the .tar.gz a program that runs without anything installed: the libraries that a system may lack go into a folder
# of their own, where no other program looks for them, with their licences. Of the system it takes libc and its parts,
# which a program must not bring along. cpack runs this file when the files of a package are in place.
if(NOT CPACK_GENERATOR STREQUAL "TGZ")
  return()
endif()
find_program(PATCHELF patchelf)
find_program(DPKG_QUERY dpkg-query)
if(NOT PATCHELF OR NOT DPKG_QUERY)
  message(FATAL_ERROR "the .tar.gz: expected patchelf and dpkg-query, found '${PATCHELF}' and '${DPKG_QUERY}'")
endif()
set(root ${CPACK_TEMPORARY_DIRECTORY})
set(program ${root}/bin/isoweave)
set(licences ${root}/share/doc/isoweave/libraries)
# Headers and libraries to link are of one compiler and one system.
file(REMOVE_RECURSE ${root}/include ${root}/lib)
file(MAKE_DIRECTORY ${root}/lib/isoweave ${licences})

file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${program} RESOLVED_DEPENDENCIES_VAR libraries
     PRE_EXCLUDE_REGEXES "^ld-linux" "^lib(c|m|dl|rt|pthread|resolv)\\.so")
foreach(library ${libraries})
  file(REAL_PATH ${library} file)
  cmake_path(GET library FILENAME name)
  file(COPY_FILE ${file} ${root}/lib/isoweave/${name})
  string(REGEX REPLACE "^/usr/" "*/" listed ${file})  # packages list it below /lib or below /usr/lib
  execute_process(COMMAND ${DPKG_QUERY} --search ${listed} OUTPUT_VARIABLE owner COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE ":.*" "" package "${owner}")
  file(REAL_PATH /usr/share/doc/${package}/copyright licence)
  file(COPY_FILE ${licence} ${licences}/${package}.copyright)
endforeach()
# A path of the older kind: the libraries find one another by it, too.
execute_process(COMMAND ${PATCHELF} --force-rpath --set-rpath "$ORIGIN/../lib/isoweave" ${program}
                COMMAND_ERROR_IS_FATAL ANY)
