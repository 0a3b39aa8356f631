#pragma once

#include <string>

namespace haptoflow::testing {

/// A library opened as a program opens it at run time, closed at the end.
class DynamicLibrary {
public:
    /// @throws std::runtime_error naming the path where it cannot be opened.
    explicit DynamicLibrary(const std::string& path);
    ~DynamicLibrary();
    DynamicLibrary(const DynamicLibrary&) = delete;
    DynamicLibrary& operator=(const DynamicLibrary&) = delete;

    /// @throws std::runtime_error where the library has no such name.
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
