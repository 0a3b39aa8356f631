#pragma once

#include <shared_mutex>

namespace haptoflow::inference {

/// ONNX Runtime's own numbers.
enum class LogSeverity : int { verbose = 0, information = 1, warning = 2, error = 3, fatal = 4 };

using LogCallback = void (*)(void* context, int severity, const char* message);

/// Where warnings and errors go: to one callback, until it is closed. Any thread but an audio callback's; several may
/// write at the same time.
class LogSink {
public:
    LogSink() = default;
    LogSink(LogCallback callback, void* context) noexcept : callback_(callback), context_(context) {}

    /// Never throws: what the callback cannot be told is lost.
    void write(LogSeverity severity, const char* category, const char* message) noexcept;
    /// Waits for calls that are under way; afterwards the callback is never called again.
    void close() noexcept;
    [[nodiscard]] bool isOpen() const noexcept;

private:
    mutable std::shared_mutex mutex_;
    LogCallback callback_ = nullptr;
    void* context_ = nullptr;
};

}  // namespace haptoflow::inference
