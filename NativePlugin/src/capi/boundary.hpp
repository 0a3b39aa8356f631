#pragma once

#include "haptoflow/haptoflow.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>

namespace haptoflow::capi {

/// Converts the exception that is being handled into a status and stores its message for this thread.
[[nodiscard]] haptoflow_status reportCurrentException() noexcept;

/// The message of the last failed call on this thread.
[[nodiscard]] const char* lastMessage() noexcept;

/// Runs the body of a C function; no exception leaves it.
template <typename Action>
[[nodiscard]] haptoflow_status guarded(Action&& action) noexcept {
    try {
        action();
        return HAPTOFLOW_OK;
    } catch (...) {
        return reportCurrentException();
    }
}

/// Returns `pointer`. Throws std::invalid_argument that names it if it is null.
template <typename Type>
[[nodiscard]] Type* require(Type* pointer, const char* name) {
    if (pointer == nullptr) {
        throw std::invalid_argument(std::string(name) + " is null");
    }
    return pointer;
}

/// A number of samples of up to three axes. Throws std::invalid_argument that names it if no memory could hold them.
[[nodiscard]] inline std::size_t countOf(uint64_t given, const char* name) {
    constexpr uint64_t maximumSamples = std::numeric_limits<std::size_t>::max() / (3 * sizeof(float));
    if (given > maximumSamples) {
        throw std::invalid_argument(std::string(name) + " is " + std::to_string(given));
    }
    return static_cast<std::size_t>(given);
}

/// Throws std::invalid_argument unless the caller's struct has the library's size.
template <typename Descriptor>
void checkStructSize(const Descriptor* descriptor, const char* name) {
    const std::size_t size = require(descriptor, name)->struct_size;
    if (size != sizeof(Descriptor)) {
        throw std::invalid_argument(std::string(name) + ": struct_size is " + std::to_string(size) + "; expected " +
                                    std::to_string(sizeof(Descriptor)) + ", the size of the struct in this version");
    }
}

template <typename Descriptor>
[[nodiscard]] Descriptor readDescriptor(const Descriptor* descriptor, const char* name) {
    checkStructSize(descriptor, name);
    return *descriptor;
}

template <typename Descriptor>
void writeDescriptor(Descriptor* target, Descriptor content, const char* name) {
    checkStructSize(target, name);
    content.struct_size = sizeof(Descriptor);
    *target = content;
}

/// A caller's path, which is UTF-8 on every platform.
[[nodiscard]] inline std::filesystem::path utf8Path(const char* text) {
    const std::u8string utf8(text, text + std::strlen(text));
    return std::filesystem::path(utf8);
}

}  // namespace haptoflow::capi
