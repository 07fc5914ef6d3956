# Packages by cpack in the build folder: for Debian, and with -G TGZ an archive for any Linux of this processor.
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/package_options.cmake)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/tarball.cmake)
set(CPACK_PACKAGE_NAME isoweave)
set(CPACK_PACKAGE_VENDOR isoweave)
set(ISOWEAVE_PACKAGER "isoweave packagers <packages@isoweave.invalid>" CACHE STRING "Who answers for the packages")
set(CPACK_PACKAGE_CONTACT ${ISOWEAVE_PACKAGER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "turns large 3-D volumes into simplified triangle meshes")
set(CPACK_PACKAGE_DESCRIPTION "isoweave reads scans and simulations (DICOM, NIfTI, NRRD, TIFF, HDF5, Zarr,
and others) and writes the surface at an iso-value, or of each label, as a
simplified mesh (PLY, STL, OBJ, GLB, 3MF, VTP). Memory stays bounded,
however large the volume is.")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_FILE_NAME isoweave-${PROJECT_VERSION}-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The library with the C interface is found by other programs.
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
file(WRITE ${PROJECT_BINARY_DIR}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/triggers)
# Loaded when the first URL or the first HDF5 file is met: apt installs the one unless it is told not to, as URLs are
# volumes of several formats, and names the other.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libcurl4")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libhdf5-103-1")
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
# A changelog in the form that Debian wants; the changes themselves are in NEWS.
if(ISOWEAVE_GZIP)
  string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)
  set(changelog ${PROJECT_BINARY_DIR}/changelog)
  file(WRITE ${changelog} "isoweave (${PROJECT_VERSION}) unstable; urgency=medium

  * See NEWS.gz.

 -- ${ISOWEAVE_PACKAGER}  ${now}
")
  execute_process(COMMAND ${ISOWEAVE_GZIP} -9nkf ${changelog} COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${changelog}.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})
endif()
include(CPack)
