# Formats whose libraries may be missing. Each option is AUTO (take the format in if the library is there), ON (stop
# without it) or OFF. What is left out is compiled as an error that says so (missing_formats.cpp in src/volume/formats,
# missing_http.cpp in src/files, missing_packers.cpp in src/mesh/write, missing_unpackers.cpp in src/mesh/read and
# missing_png.cpp in src/render).
list(APPEND CMAKE_MODULE_PATH ${PROJECT_SOURCE_DIR}/cmake)
set(ISOWEAVE_READERS)

# isoweave_reader(NAME SOURCES TARGET PACKAGE...): finds a package, and drops the sources that need it without it.
macro(isoweave_reader name sources target package)
  set(ISOWEAVE_${name} AUTO CACHE STRING "${name} through ${package}: AUTO, ON or OFF")
  set_property(CACHE ISOWEAVE_${name} PROPERTY STRINGS AUTO ON OFF)
  set(ISOWEAVE_HAS_${name} FALSE)
  if(ISOWEAVE_${name} STREQUAL AUTO)
    find_package(${package} ${ARGN} QUIET)
  elseif(ISOWEAVE_${name})
    find_package(${package} ${ARGN} REQUIRED)
  endif()
  if(${package}_FOUND AND (ISOWEAVE_${name} STREQUAL AUTO OR ISOWEAVE_${name}))
    set(ISOWEAVE_HAS_${name} TRUE)
  endif()
  set(ISOWEAVE_${name}_TARGET ${target})
  list(APPEND ISOWEAVE_READERS ${name})
  if(NOT ISOWEAVE_HAS_${name})
    foreach(source ${sources})
      list(FILTER ISOWEAVE_SOURCES EXCLUDE REGEX "/${source}$")
    endforeach()
  endif()
endmacro()

# Messages of libtiff are taken per file since 4.5.
isoweave_reader(TIFF "tiff.cpp;tiff_file.cpp;tiff_pages.cpp;tiff_stream.cpp" TIFF::TIFF TIFF 4.5)
isoweave_reader(PNG "png.cpp;write_png.cpp" PNG::PNG PNG)
# Of DICOM, two kinds of packed samples need a library.
isoweave_reader(JPEGLS dicom_jpegls.cpp IsoweaveCharls::IsoweaveCharls IsoweaveCharls)
isoweave_reader(JPEG2000 dicom_jpeg2000.cpp IsoweaveOpenJpeg::IsoweaveOpenJpeg IsoweaveOpenJpeg)
# Loaded when it is needed; headers only.
set(hdf5_sources hdf5.cpp hdf5_dataset.cpp hdf5_dream3d.cpp hdf5_imaris.cpp hdf5_itk.cpp hdf5_library.cpp hdf5_minc.cpp
    hdf5_place.cpp hdf5_scales.cpp hdf5_vtk.cpp)
isoweave_reader(HDF5 "${hdf5_sources}" $<BUILD_INTERFACE:IsoweaveHdf5::IsoweaveHdf5> IsoweaveHdf5)
# Zarr, OME-Zarr and N5: their metadata are JSON (headers only); of the codecs of their chunks, gzip is always there.
isoweave_reader(ZARR "json_file.cpp;zarr_node.cpp;zarr_coordinates.cpp;zarr2.cpp;zarr3.cpp;n5.cpp;ome_multiscale.cpp;zarr_folder.cpp;precomputed_info.cpp"
                $<BUILD_INTERFACE:nlohmann_json::nlohmann_json> nlohmann_json)
isoweave_reader(ZSTD codec_zstd.cpp IsoweaveZstd::IsoweaveZstd IsoweaveZstd)
isoweave_reader(BLOSC codec_blosc.cpp IsoweaveBlosc::IsoweaveBlosc IsoweaveBlosc)
isoweave_reader(LZMA vtk_lzma.cpp LibLZMA::LibLZMA LibLZMA)
isoweave_reader(LZ4 "codec_lz4.cpp;vtk_lz4.cpp" IsoweaveLz4::IsoweaveLz4 IsoweaveLz4)
# Volumes on servers. Loaded when it is needed; headers only.
isoweave_reader(HTTP "curl_library.cpp;http_client.cpp;remote_store.cpp" $<BUILD_INTERFACE:IsoweaveCurl::IsoweaveCurl>
                IsoweaveCurl 7.87)
# Packed meshes: GLB is written and read, precomputed is written.
isoweave_reader(MESHOPTIMIZER "glb_packed.cpp;gltf_packed.cpp" meshoptimizer::meshoptimizer meshoptimizer)
isoweave_reader(DRACO "packed_object.cpp;precomputed_packed.cpp" draco::draco draco)

# The libraries, and what tells the sources which of them are there.
function(isoweave_link_readers target)
  foreach(name ${ISOWEAVE_READERS})
    if(ISOWEAVE_HAS_${name})
      target_compile_definitions(${target} PRIVATE ISOWEAVE_HAS_${name})
      target_link_libraries(${target} PRIVATE ${ISOWEAVE_${name}_TARGET})
    endif()
  endforeach()
endfunction()

# What the formats need, whether there are options for it or not.
function(isoweave_link_formats target)
  target_link_libraries(${target} PRIVATE ZLIB::ZLIB $<BUILD_INTERFACE:nlohmann_json::nlohmann_json>)
  isoweave_link_readers(${target})
endfunction()

# Drops the tests that write files through a library that is not there.
function(isoweave_select_reader_tests sources)
  set(left ${${sources}})
  if(NOT ISOWEAVE_HAS_TIFF)
    list(FILTER left EXCLUDE REGEX "/volume_(tiff|slices)\\.cpp$")
  endif()
  if(NOT ISOWEAVE_HAS_PNG)
    list(FILTER left EXCLUDE REGEX "/volume_png\\.cpp$")
  endif()
  if(NOT (IsoweaveGdcm_FOUND AND ISOWEAVE_HAS_JPEGLS AND ISOWEAVE_HAS_JPEG2000))
    list(FILTER left EXCLUDE REGEX "/volume_dicom[a-z_]*\\.cpp$")
  endif()
  if(NOT IsoweaveGdcm_FOUND)
    list(FILTER left EXCLUDE REGEX "/volume_jpeg\\.cpp$")
  endif()
  if(NOT ISOWEAVE_HAS_HDF5)
    list(FILTER left EXCLUDE REGEX "/volume_hdf5[a-z_]*\\.cpp$")
  endif()
  if(NOT ISOWEAVE_HAS_ZARR)
    list(FILTER left EXCLUDE REGEX "/volume_(zarr|n5|ome_zarr)\\.cpp$")
  endif()
  set(${sources} ${left} PARENT_SCOPE)
endfunction()
