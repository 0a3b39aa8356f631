# Debian's Emscripten 3.1.6 brings libc++ 13, which lacks the range algorithms and std::bit_cast. There a header supplies
# what the engine uses of them; a newer Emscripten needs none.
include(CheckCXXSourceCompiles)
check_cxx_source_compiles(
  "#include <algorithm>
   #include <bit>
   int main() { int numbers[] = {2, 1}; std::ranges::sort(numbers); return std::bit_cast<int>(1.0F); }"
  HAPTOFLOW_HAS_RANGE_ALGORITHMS)
if(NOT HAPTOFLOW_HAS_RANGE_ALGORITHMS)
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-include${PROJECT_SOURCE_DIR}/Web/engine/native/older_libcxx.hpp>")
endif()
# Clang 14's vectoriser of straight code let Synthesis::fits find 5.44 below 4.84 (Tests/Web/scene-reliefs.test.mjs). Without
# it renders take as long as before and hot segments 0 to 2 % more, so that no source is left to its mistakes.
if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 15)
  add_compile_options(-fno-slp-vectorize)
endif()
