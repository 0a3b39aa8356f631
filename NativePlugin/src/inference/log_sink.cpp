#include "inference/log_sink.hpp"

#include <exception>
#include <mutex>
#include <string>

namespace haptoflow::inference {

void LogSink::write(LogSeverity severity, const char* category, const char* message) noexcept {
    try {
        const std::shared_lock lock(mutex_);
        if (callback_ != nullptr && severity >= LogSeverity::warning) {
            callback_(context_, static_cast<int>(severity), (std::string(category) + ": " + message).c_str());
        }
    } catch (const std::exception&) {
        // Out of memory: the message is lost.
    }
}

void LogSink::close() noexcept {
    const std::unique_lock lock(mutex_);
    callback_ = nullptr;
}

bool LogSink::isOpen() const noexcept {
    const std::shared_lock lock(mutex_);
    return callback_ != nullptr;
}

}  // namespace haptoflow::inference
