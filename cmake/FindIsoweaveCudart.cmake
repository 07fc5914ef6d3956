# The CUDA runtime, to be linked statically. CMake's own module asks for more: that of 3.25 stops at CUDA 13, which has no
# nvToolsExt, and at the wheels of PyPI, which have no libcudart.so.
# Looked for beside the CUDA compiler, then where the environment says, then where NVIDIA's packages put it.
if(CMAKE_CUDA_COMPILER)
  file(REAL_PATH ${CMAKE_CUDA_COMPILER} compiler)
  cmake_path(GET compiler PARENT_PATH folder)
  cmake_path(GET folder PARENT_PATH folder)
endif()
find_library(IsoweaveCudart_LIBRARY cudart_static
  HINTS ${folder} ${CUDAToolkit_ROOT} ENV CUDAToolkit_ROOT ENV CUDA_PATH PATHS /usr/local/cuda
  PATH_SUFFIXES lib64 lib targets/${CMAKE_SYSTEM_PROCESSOR}-linux/lib)
mark_as_advanced(IsoweaveCudart_LIBRARY)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(IsoweaveCudart REQUIRED_VARS IsoweaveCudart_LIBRARY)
if(IsoweaveCudart_FOUND AND NOT TARGET IsoweaveCudart::IsoweaveCudart)
  find_package(Threads REQUIRED)
  add_library(IsoweaveCudart::IsoweaveCudart INTERFACE IMPORTED)
  target_link_libraries(IsoweaveCudart::IsoweaveCudart INTERFACE ${IsoweaveCudart_LIBRARY} Threads::Threads ${CMAKE_DL_LIBS} rt)
endif()
