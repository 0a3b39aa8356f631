#pragma once

#include <string>

namespace haptoflow::testing {

/// A library opened at run time and closed in the destructor.
class DynamicLibrary {
public:
    /// Throws std::runtime_error naming the path if the library cannot be opened.
    explicit DynamicLibrary(const std::string& path);
    ~DynamicLibrary();
    DynamicLibrary(const DynamicLibrary&) = delete;
    DynamicLibrary& operator=(const DynamicLibrary&) = delete;

    /// Throws std::runtime_error if the library has no such symbol.
    template <typename Function>
    [[nodiscard]] Function function(const char* name) const {
        return reinterpret_cast<Function>(address(name));
    }

private:
    using Address = void (*)();
    [[nodiscard]] Address address(const char* name) const;

    std::string path_;
    void* handle_;
};

}  // namespace haptoflow::testing
