#include "inference/shared_library.hpp"

#include "inference/inference_error.hpp"

#include <string>

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

namespace haptoflow::inference {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& reason) {
    const std::u8string name = path.u8string();
    throw RuntimeUnavailable(std::string(name.begin(), name.end()) + ": " + reason);
}

}  // namespace

#ifdef _WIN32

void* loadSymbol(const std::filesystem::path& path, const char* symbol) {
    // The altered search path makes the library's own neighbours, not the program's, answer for what it needs.
    const DWORD flags = path.is_absolute() ? LOAD_WITH_ALTERED_SEARCH_PATH : 0;
    HMODULE library = LoadLibraryExW(path.c_str(), nullptr, flags);
    if (library == nullptr) {
        refuse(path, "cannot be loaded (Windows error " + std::to_string(GetLastError()) + ")");
    }
    void* address = reinterpret_cast<void*>(GetProcAddress(library, symbol));
    if (address == nullptr) {
        FreeLibrary(library);
        refuse(path, std::string("has no function ") + symbol);
    }
    return address;
}

#else

void* loadSymbol(const std::filesystem::path& path, const char* symbol) {
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (library == nullptr) {
        const char* reason = dlerror();
        refuse(path, std::string("cannot be loaded: ") + (reason != nullptr ? reason : "unknown reason"));
    }
    void* address = dlsym(library, symbol);
    if (address == nullptr) {
        dlclose(library);
        refuse(path, std::string("has no function ") + symbol);
    }
    return address;
}

#endif

}  // namespace haptoflow::inference
