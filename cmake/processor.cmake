# Processors from 2009 on have this baseline: bits are counted by one instruction. Sources for more are chosen among
# when the program starts.
set(ISOWEAVE_X86 OFF)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(ISOWEAVE_X86 ON)
  set_source_files_properties(src/simplify/kernels_avx2.cpp PROPERTIES COMPILE_OPTIONS "-fno-math-errno;-mavx2")
  set_source_files_properties(src/simplify/kernels_avx512.cpp PROPERTIES
    COMPILE_OPTIONS "-fno-math-errno;-mavx512f;-mavx512dq;-mprefer-vector-width=512")
  set_source_files_properties(src/extract/row_kernels_avx2.cpp PROPERTIES COMPILE_OPTIONS "-mavx2")
  set_source_files_properties(src/extract/row_kernels_avx512.cpp PROPERTIES
    COMPILE_OPTIONS "-mavx512f;-mavx512bw;-mavx512dq;-mprefer-vector-width=512")
  set_source_files_properties(src/extract/cell_kernels_avx2.cpp PROPERTIES COMPILE_OPTIONS "-mavx2;-mbmi;-mbmi2")
  set_source_files_properties(src/extract/cell_kernels_avx512.cpp PROPERTIES
    COMPILE_OPTIONS "-mavx512f;-mavx512bw;-mavx512dq;-mavx512vbmi;-mavx512vpopcntdq")
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # warns of its own headers (GCC bug 105593)
    set_property(SOURCE src/extract/cell_kernels_avx512.cpp APPEND PROPERTY
      COMPILE_OPTIONS -Wno-uninitialized -Wno-maybe-uninitialized)
  endif()
else()
  list(FILTER ISOWEAVE_SOURCES EXCLUDE REGEX "_avx(2|512)\\.cpp$")
endif()

function(isoweave_set_processor target)
  if(ISOWEAVE_X86)
    target_compile_options(${target} PRIVATE -march=x86-64-v2)
    target_compile_definitions(${target} PRIVATE ISOWEAVE_X86)
  endif()
endfunction()
