# Cross builds use the header-only libraries of the build machine. Its include folder itself must not be on the include
# path, because it contains the build machine's C library; therefore each library is linked into a separate folder.

set(haptoflow_borrowed_headers "${CMAKE_BINARY_DIR}/borrowed-headers")

# haptoflow_borrow_headers(TARGET FOLDER PROBE): an imported target for one header-only library.
function(haptoflow_borrow_headers target folder probe)
  find_path(HAPTOFLOW_${folder}_INCLUDE_DIR "${folder}/${probe}" PATHS /usr/include /usr/local/include
            NO_CMAKE_FIND_ROOT_PATH REQUIRED
            DOC "The build machine's include folder of ${folder}/${probe}")
  if(CMAKE_HOST_WIN32)
    # That folder contains no C library on Windows, where links need a privilege.
    set(haptoflow_borrowed_headers "${HAPTOFLOW_${folder}_INCLUDE_DIR}")
  else()
    file(MAKE_DIRECTORY "${haptoflow_borrowed_headers}")
    file(CREATE_LINK "${HAPTOFLOW_${folder}_INCLUDE_DIR}/${folder}" "${haptoflow_borrowed_headers}/${folder}" SYMBOLIC)
  endif()
  if(target AND NOT TARGET ${target})
    add_library(${target} INTERFACE IMPORTED GLOBAL)
    target_include_directories(${target} SYSTEM INTERFACE "${haptoflow_borrowed_headers}")
  endif()
endfunction()

if(HAPTOFLOW_BUILD_CLI OR HAPTOFLOW_BUILD_TESTS OR HAPTOFLOW_BUILD_WEB)
  haptoflow_borrow_headers(glm::glm glm glm.hpp)
endif()
haptoflow_borrow_headers(nlohmann_json::nlohmann_json nlohmann json.hpp)

# Compiles GoogleTest from the sources that its package installs.
function(haptoflow_add_googletest)
  set(HAPTOFLOW_GOOGLETEST_SOURCES "/usr/src/googletest" CACHE PATH "GoogleTest's sources, for cross builds")
  if(NOT EXISTS "${HAPTOFLOW_GOOGLETEST_SOURCES}/CMakeLists.txt")
    message(FATAL_ERROR "No GoogleTest sources in ${HAPTOFLOW_GOOGLETEST_SOURCES}: install the package googletest, or "
                        "set HAPTOFLOW_GOOGLETEST_SOURCES")
  endif()
  set(INSTALL_GTEST OFF)
  add_subdirectory("${HAPTOFLOW_GOOGLETEST_SOURCES}" "${CMAKE_BINARY_DIR}/googletest" EXCLUDE_FROM_ALL)
endfunction()
