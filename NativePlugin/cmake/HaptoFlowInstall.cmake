# `cmake --install` installs the library, its public header, the default model, and a CMake package `haptoflow` with the
# target haptoflow::haptoflow. ONNX Runtime is not included: the application passes its path at run time.
include(CMakePackageConfigHelpers)

install(TARGETS audioplugin_haptoflow EXPORT haptoflow-targets
        RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT haptoflow
        LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT haptoflow
        ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT haptoflow)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/NativePlugin/include/haptoflow" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
        COMPONENT haptoflow)
install(FILES "${PROJECT_SOURCE_DIR}/Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow"
        DESTINATION "${CMAKE_INSTALL_DATADIR}/haptoflow" COMPONENT haptoflow)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/THIRD-PARTY-NOTICES.md"
        DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT haptoflow)
if(HAPTOFLOW_BUILD_CLI)
  install(TARGETS haptoflow_cli RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT haptoflow-cli)
endif()

set(haptoflow_package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/haptoflow")
install(EXPORT haptoflow-targets NAMESPACE haptoflow:: DESTINATION "${haptoflow_package_folder}" COMPONENT haptoflow)
configure_package_config_file(
  "${CMAKE_CURRENT_LIST_DIR}/haptoflow-config.cmake.in" "${CMAKE_BINARY_DIR}/haptoflow-config.cmake"
  INSTALL_DESTINATION "${haptoflow_package_folder}" PATH_VARS CMAKE_INSTALL_DATADIR)
write_basic_package_version_file("${CMAKE_BINARY_DIR}/haptoflow-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_BINARY_DIR}/haptoflow-config.cmake" "${CMAKE_BINARY_DIR}/haptoflow-config-version.cmake"
        DESTINATION "${haptoflow_package_folder}" COMPONENT haptoflow)
