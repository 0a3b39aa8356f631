#include "support/dynamic_library.hpp"

#include <stdexcept>

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

namespace haptoflow::testing {

#ifdef _WIN32

DynamicLibrary::DynamicLibrary(const std::string& path) : path_(path), handle_(LoadLibraryA(path.c_str())) {
    if (handle_ == nullptr) {
        throw std::runtime_error(path + ": Windows error " + std::to_string(GetLastError()));
    }
}

DynamicLibrary::~DynamicLibrary() {
    FreeLibrary(static_cast<HMODULE>(handle_));
}

DynamicLibrary::Address DynamicLibrary::address(const char* name) const {
    const auto found = reinterpret_cast<Address>(GetProcAddress(static_cast<HMODULE>(handle_), name));
    if (found == nullptr) {
        throw std::runtime_error(path_ + " has no " + name);
    }
    return found;
}

#else

DynamicLibrary::DynamicLibrary(const std::string& path) : path_(path), handle_(dlopen(path.c_str(), RTLD_NOW)) {
    if (handle_ == nullptr) {
        const char* reason = dlerror();
        throw std::runtime_error(reason != nullptr ? reason : path);
    }
}

DynamicLibrary::~DynamicLibrary() {
    dlclose(handle_);
}

DynamicLibrary::Address DynamicLibrary::address(const char* name) const {
    void* found = dlsym(handle_, name);
    if (found == nullptr) {
        throw std::runtime_error(path_ + " has no " + name);
    }
    return reinterpret_cast<Address>(found);
}

#endif

}  // namespace haptoflow::testing
