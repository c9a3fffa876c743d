# What someone else's CMake project gets from `find_package(geoprior)`: the libraries without the runner.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY GEOPRIOR_TOPIC_LIBRARIES)
list(PREPEND libraries geoprior_flags geoprior_core geoprior_metrics)
set_target_properties(geoprior_flags PROPERTIES EXPORT_NAME flags)
# Eigen aligns fixed-size types (a quaternion, an affine transform) by the instruction set even when
# EIGEN_MAX_ALIGN_BYTES is given, so the layout of our types is that of the set the libraries were built for.
target_compile_options(geoprior_flags INTERFACE $<INSTALL_INTERFACE:-march=${GEOPRIOR_ARCH}>)
install(TARGETS ${libraries} EXPORT geoprior_targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(EXPORT geoprior_targets NAMESPACE geoprior:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/geoprior COMPONENT dev)
foreach(room core metrics models baselines solvers)
  install(DIRECTORY ${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/geoprior COMPONENT dev FILES_MATCHING PATTERN "*.h")
endforeach()
configure_package_config_file(cmake/geoprior-config.cmake.in ${PROJECT_BINARY_DIR}/geoprior-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/geoprior)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/geoprior-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/system_libraries.cmake ${PROJECT_BINARY_DIR}/geoprior-config.cmake ${PROJECT_BINARY_DIR}/geoprior-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/geoprior COMPONENT dev)
