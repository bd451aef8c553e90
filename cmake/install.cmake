# `find_package(collarmesh)` gives collarmesh::mesher, its parts collarmesh::core and collarmesh::io, and, when built, collarmesh::files and collarmesh::openmesh_io.
include(CMakePackageConfigHelpers)

set(COLLARMESH_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/collarmesh)
set(COLLARMESH_HAS_OPENMESH OFF)
install(TARGETS collarmesh_mesher collarmesh_io collarmesh_both EXPORT collarmesh_targets)
install(DIRECTORY mesher/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
if(TARGET collarmesh_openmesh_io)
  set(COLLARMESH_HAS_OPENMESH ON)
  install(TARGETS collarmesh_openmesh_io EXPORT collarmesh_targets)
  install(DIRECTORY openmesh_io/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
endif()
set(COLLARMESH_HAS_FILES OFF)
if(TARGET collarmesh_files)
  set(COLLARMESH_HAS_FILES ON)
  install(TARGETS collarmesh_files EXPORT collarmesh_targets)
endif()
install(EXPORT collarmesh_targets NAMESPACE collarmesh:: FILE collarmesh-targets.cmake
  DESTINATION ${COLLARMESH_PACKAGE_DIR})

configure_package_config_file(cmake/collarmesh-config.cmake.in ${PROJECT_BINARY_DIR}/collarmesh-config.cmake
  INSTALL_DESTINATION ${COLLARMESH_PACKAGE_DIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/collarmesh-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/collarmesh-config.cmake ${PROJECT_BINARY_DIR}/collarmesh-config-version.cmake
  cmake/FindLibDeflate.cmake cmake/FindLZ4.cmake
  DESTINATION ${COLLARMESH_PACKAGE_DIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
