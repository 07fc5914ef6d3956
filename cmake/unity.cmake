# With ISOWEAVE_UNITY, files are compiled that include some sources of one folder of the library, of the command line or of
# tests, so that what they all include is read once. It is on where all sources are compiled once, to be used or to be
# tested, and off in `dev`, where a change compiles one source. Names inside of two sources of a folder must differ then.
option(ISOWEAVE_UNITY "Compile the sources of a folder together: faster where most of them have changed" OFF)

if(ISOWEAVE_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-Wno-subobject-linkage)  # names without linkage are of a source, though a file includes it
endif()

# Sources at a time: as many as leave enough to do for every processor.
set(ISOWEAVE_UNITY_SIZE 8)

# The builds of a clone share these files: a cache of compiled files would take the same file in two places for two.
cmake_path(IS_PREFIX PROJECT_SOURCE_DIR ${PROJECT_BINARY_DIR} NORMALIZE ISOWEAVE_BUILT_INSIDE)
if(ISOWEAVE_BUILT_INSIDE)
  set(ISOWEAVE_UNITY_FOLDER ${PROJECT_SOURCE_DIR}/build/unity)
else()
  set(ISOWEAVE_UNITY_FOLDER ${PROJECT_BINARY_DIR}/unity)
endif()

# isoweave_gather(OUT NAME ROOT SOURCE...): what is to be compiled in place of the sources, which lie under ROOT, in files
# of a folder NAME. Sources with options of their own are compiled by themselves.
function(isoweave_gather out name root)
  set(gathered)
  set(folders)
  foreach(source ${ARGN})
    get_source_file_property(definitions ${source} COMPILE_DEFINITIONS)
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(NOT ISOWEAVE_UNITY OR definitions OR options)
      list(APPEND gathered ${source})
    else()
      file(RELATIVE_PATH path ${root} ${source})
      cmake_path(GET path PARENT_PATH folder)
      if(NOT folder)
        set(folder top)
      endif()
      list(APPEND folders ${folder})
      list(APPEND sources_of_${folder} ${path})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES folders)
  foreach(folder ${folders})
    isoweave_write_unity(files ${ISOWEAVE_UNITY_FOLDER}/${name}/${folder} ${sources_of_${folder}})
    list(APPEND gathered ${files})
  endforeach()
  set(${out} ${gathered} PARENT_SCOPE)
endfunction()

# isoweave_write_unity(OUT FOLDER SOURCE...): files are named by a hash, as another build may have other sources.
function(isoweave_write_unity out folder)
  set(files)
  set(text)
  set(count 0)
  list(LENGTH ARGN total)
  foreach(source ${ARGN})
    string(APPEND text "#include \"${source}\"  // NOLINT(bugprone-suspicious-include)\n")
    math(EXPR count "${count} + 1")
    math(EXPR rest "${count} % ${ISOWEAVE_UNITY_SIZE}")
    if(rest EQUAL 0 OR count EQUAL total)
      string(SHA1 hash "${text}")
      string(SUBSTRING ${hash} 0 12 hash)
      file(CONFIGURE OUTPUT ${folder}/${hash}.cpp CONTENT "${text}" @ONLY)
      list(APPEND files ${folder}/${hash}.cpp)
      set(text)
    endif()
  endforeach()
  set(${out} ${files} PARENT_SCOPE)
endfunction()
