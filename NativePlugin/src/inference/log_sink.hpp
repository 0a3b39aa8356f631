#pragma once

#include <shared_mutex>

namespace haptoflow::inference {

/// Values of OrtLoggingLevel.
enum class LogSeverity : int { verbose = 0, information = 1, warning = 2, error = 3, fatal = 4 };

using LogCallback = void (*)(void* context, int severity, const char* message);

/// Passes warnings and errors to a callback until it is closed. Any thread except an audio callback's; several threads
/// may write at the same time.
class LogSink {
public:
    LogSink() = default;
    LogSink(LogCallback callback, void* context) noexcept : callback_(callback), context_(context) {}

    /// Does not throw: a message that cannot be passed on is lost.
    void write(LogSeverity severity, const char* category, const char* message) noexcept;
    /// Waits for running calls. Afterwards the callback is never called again.
    void close() noexcept;
    [[nodiscard]] bool isOpen() const noexcept;

private:
    mutable std::shared_mutex mutex_;
    LogCallback callback_ = nullptr;
    void* context_ = nullptr;
};

}  // namespace haptoflow::inference
