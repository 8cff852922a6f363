# cmake --install puts headers, libraries, the program and a package file for find_package(plisse) in place.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
get_property(folders GLOBAL PROPERTY PLISSE_FOLDERS)
install(TARGETS plisse_interface ${folders} EXPORT plisse ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/plisse DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT plisse NAMESPACE plisse:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/plisse FILE plisse-targets.cmake)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/FindMETIS.cmake ${PROJECT_SOURCE_DIR}/cmake/FindOpenSubdiv.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/plisse)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/plisse-config.cmake.in
  ${CMAKE_BINARY_DIR}/plisse-config.cmake INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/plisse)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/plisse-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/plisse-config.cmake ${CMAKE_BINARY_DIR}/plisse-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/plisse)
if(TARGET plisse)
  install(TARGETS plisse RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
