# Settings that all native targets share: language level, warnings, sanitizers and the paths of third-party headers.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if(NOT HAPTOFLOW_BUILD_WEB)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
endif()
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)

if(CMAKE_CROSSCOMPILING)
  include(HaptoFlowCrossLibraries)
else()
  if(HAPTOFLOW_BUILD_CLI OR HAPTOFLOW_BUILD_TESTS)
    find_package(glm REQUIRED)
  endif()
  find_package(nlohmann_json REQUIRED)
endif()
find_package(Threads REQUIRED)

add_library(haptoflow_options INTERFACE)
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  target_compile_options(haptoflow_options INTERFACE -Wall -Wextra -Wconversion -Wshadow -Werror)
  # Compilers contract to fused multiply-adds on some processors only; without contraction the samples of a seeded
  # render do not depend on the processor.
  target_compile_options(haptoflow_options INTERFACE -ffp-contract=off)
elseif(MSVC)
  target_compile_options(haptoflow_options INTERFACE /W4 /WX /utf-8)
endif()
if(HAPTOFLOW_SANITIZERS)
  add_compile_options(-fsanitize=${HAPTOFLOW_SANITIZERS} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${HAPTOFLOW_SANITIZERS})
  set(haptoflow_sanitizer_flags "-fsanitize=${HAPTOFLOW_SANITIZERS}")
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC 12 reports false positives of this warning in instrumented standard headers (std::regex). The release build
    # keeps the warning.
    target_compile_options(haptoflow_options INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()

# ONNX Runtime: headers only. The plugin opens the library at run time instead of linking it: on Linux its SONAME
# differs from its file name, so Unity could not load a plugin that is linked to it.
set(haptoflow_onnxruntime_headers
    "${HAPTOFLOW_ONNXRUNTIME_DIR}/Plugins/iOS~/onnxruntime.xcframework/ios-arm64/onnxruntime.framework/Headers")
if(NOT EXISTS "${haptoflow_onnxruntime_headers}/onnxruntime_c_api.h")
  message(FATAL_ERROR
          "ONNX Runtime's headers are not in ${haptoflow_onnxruntime_headers}: run `npm ci` in the repository "
          "root, or set HAPTOFLOW_ONNXRUNTIME_DIR to an unpacked com.github.asus4.onnxruntime package.")
endif()
add_library(haptoflow_onnxruntime_headers INTERFACE)
target_include_directories(haptoflow_onnxruntime_headers SYSTEM INTERFACE "${haptoflow_onnxruntime_headers}")

if(CMAKE_SYSTEM_NAME STREQUAL "Windows")
  set(haptoflow_onnxruntime_library "${HAPTOFLOW_ONNXRUNTIME_DIR}/Plugins/Windows/x64/onnxruntime.dll")
elseif(APPLE)
  set(haptoflow_onnxruntime_library "${HAPTOFLOW_ONNXRUNTIME_DIR}/Plugins/macOS/arm64/libonnxruntime.dylib")
elseif(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  # That package has no library for Linux arm64; the npm package onnxruntime-node, which the platform tests install,
  # has one.
  set(haptoflow_onnxruntime_library
      "${PROJECT_SOURCE_DIR}/Tests/Platforms/node_modules/onnxruntime-node/bin/napi-v6/linux/arm64/libonnxruntime.so.1")
else()
  set(haptoflow_onnxruntime_library "${HAPTOFLOW_ONNXRUNTIME_DIR}/Plugins/Linux/x64/libonnxruntime.so")
endif()
set(HAPTOFLOW_ONNXRUNTIME_LIBRARY "${haptoflow_onnxruntime_library}" CACHE FILEPATH
    "ONNX Runtime library that the tests open at run time")

# haptoflow_add_library(NAME SOURCES ... [DEPENDS ...] [PRIVATE_DEPENDS ...]): the static library of one folder. Includes
# name the folder: "dsp/gate.hpp" for NativePlugin/src/dsp/gate.hpp, "headless/scene.hpp" for NativePlugin/headless/.
function(haptoflow_add_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS")
  add_library(${name} STATIC ${arg_SOURCES})
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR PARENT_PATH include_root)
  target_include_directories(${name} PUBLIC "${include_root}")
  target_link_libraries(${name} PUBLIC ${arg_DEPENDS} PRIVATE haptoflow_options ${arg_PRIVATE_DEPENDS})
endfunction()

# haptoflow_join_sources(NAME): compiles the files of a test program or of the command line eight at a time. Most of
# their compile time goes into reading GoogleTest, CLI11 or the JSON library; joined, they compile in a third of the
# time. The plugin is always compiled file by file.
function(haptoflow_join_sources name)
  if(HAPTOFLOW_JOINED_SOURCES)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  endif()
endfunction()

# haptoflow_add_test(NAME [CLI] [APART] SOURCES ... DEPENDS ...): one GoogleTest program; ctest lists each of its tests.
# CLI: its tests start the command line, whose path is in HAPTOFLOW_TEST_CLI. APART: its files cannot be compiled joined.
function(haptoflow_add_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "CLI;APART" "" "SOURCES;DEPENDS")
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_DEPENDS} haptoflow_options GTest::gmock GTest::gtest GTest::gtest_main)
  target_compile_definitions(
    ${name}
    PRIVATE HAPTOFLOW_TEST_GOLDEN_DIR="${PROJECT_SOURCE_DIR}/Tests/Golden"
            HAPTOFLOW_TEST_DEFAULT_MODEL="${PROJECT_SOURCE_DIR}/Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow"
            HAPTOFLOW_TEST_ONNXRUNTIME="${HAPTOFLOW_ONNXRUNTIME_LIBRARY}")
  if(arg_CLI)
    target_compile_definitions(${name} PRIVATE HAPTOFLOW_TEST_CLI="$<TARGET_FILE:haptoflow_cli>")
    add_dependencies(${name} haptoflow_cli)
  endif()
  if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    # The libraries under test keep the optimisation of the shipped build. The tests' own code runs once, so that
    # compiling it faster saves more than optimising it.
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
    if(HAPTOFLOW_SANITIZERS MATCHES "undefined")
      # The libraries are checked for undefined behaviour; to check the tests' own code as well doubles its compile time.
      target_compile_options(${name} PRIVATE -fno-sanitize=undefined)
    endif()
    if(HAPTOFLOW_SANITIZERS)
      # Compiling the tests takes longer than running them.
      target_compile_options(${name} PRIVATE -O0)
    endif()
  elseif(MSVC)
    # Joined sources have more sections than an object file holds by default. Warnings of a compiler that the tests have
    # not met yet do not keep them from running.
    target_compile_options(${name} PRIVATE /bigobj /WX-)
  endif()
  if(NOT arg_APART)
    haptoflow_join_sources(${name})
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST)
endfunction()
