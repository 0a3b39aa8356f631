# Android's linker options without an NDK: what CMake knows of Android is that ANDROID is true. Nothing is compiled with
# this; see scripts/lib/android_pages.mjs.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(ANDROID TRUE)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
