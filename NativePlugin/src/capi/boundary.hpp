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

/// No descriptor will be larger; a larger struct_size is uninitialised memory.
inline constexpr std::size_t maximumDescriptor = 4096;

inline void checkStructSize(std::size_t found, std::size_t minimum, const char* name) {
    if (found < minimum || found > maximumDescriptor) {
        throw std::invalid_argument(std::string(name) + ": struct_size is " + std::to_string(found) +
                                    "; set it to sizeof the struct");
    }
}

/// Copies a caller's descriptor of any version; fields that the caller's version does not have are zero. `minimum` is
/// the size of the first version's mandatory fields. A size that ends within a field belongs to no version; it is
/// rounded down, because copying part of a pointer would make an invalid address. Throws std::invalid_argument.
template <typename Descriptor>
[[nodiscard]] Descriptor readDescriptor(const Descriptor* descriptor, std::size_t minimum, const char* name) {
    const std::size_t size = require(descriptor, name)->struct_size;
    checkStructSize(size, minimum, name);
    const std::size_t whole = std::max(minimum, size - size % alignof(Descriptor));
    Descriptor copy{};
    std::memcpy(&copy, descriptor, std::min(whole, sizeof(Descriptor)));
    return copy;
}

/// Fills a caller's descriptor of any version up to its size and sets its struct_size to the number of bytes filled.
/// Throws std::invalid_argument.
template <typename Descriptor>
void writeDescriptor(Descriptor* target, Descriptor content, const char* name) {
    const std::size_t size = require(target, name)->struct_size;
    checkStructSize(size, sizeof(content.struct_size), name);
    const std::size_t filled = std::min(size, sizeof(Descriptor));
    content.struct_size = static_cast<decltype(content.struct_size)>(filled);
    std::memcpy(target, &content, filled);
}

/// A caller's path, which is UTF-8 on every platform.
[[nodiscard]] inline std::filesystem::path utf8Path(const char* text) {
    const std::u8string utf8(text, text + std::strlen(text));
    return std::filesystem::path(utf8);
}

}  // namespace haptoflow::capi
