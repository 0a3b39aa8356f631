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
