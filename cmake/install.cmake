# What is installed: all of isoweave, or its core where nothing else is built.
include(CMakePackageConfigHelpers)
set(folder ${CMAKE_INSTALL_LIBDIR}/cmake/isoweave)
configure_package_config_file(cmake/isoweave-config.cmake.in isoweave-config.cmake INSTALL_DESTINATION ${folder})
write_basic_package_version_file(isoweave-config-version.cmake COMPATIBILITY SameMinorVersion)
set_target_properties(isoweave_core PROPERTIES EXPORT_NAME core)
if(ISOWEAVE_FORMATS)
  install(TARGETS isoweave EXPORT isoweave)
else()
  install(TARGETS isoweave_core EXPORT isoweave)
endif()
install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT isoweave NAMESPACE isoweave:: FILE isoweave-targets.cmake DESTINATION ${folder})
install(FILES ${PROJECT_BINARY_DIR}/isoweave-config.cmake ${PROJECT_BINARY_DIR}/isoweave-config-version.cmake
              cmake/FindIsoweaveCudart.cmake cmake/FindIsoweaveCharls.cmake cmake/FindIsoweaveOpenJpeg.cmake
              cmake/FindIsoweaveZstd.cmake cmake/FindIsoweaveBlosc.cmake cmake/FindIsoweaveLz4.cmake
  DESTINATION ${folder})
