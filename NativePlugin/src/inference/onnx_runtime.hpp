#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <string_view>

struct OrtApi;
struct OrtApiBase;
struct OrtEnv;
struct OrtStatus;

namespace haptoflow::inference {

/// Passes warnings and errors to a callback until it is closed. Any thread except an audio callback's; several threads
/// may write at the same time.
class LogSink {
public:
    using Callback = void (*)(void* context, int severity, const char* message);

    LogSink(Callback callback, void* context) noexcept : callback_(callback), context_(context) {}

    /// `severity` is a value of OrtLoggingLevel. Does not throw: a message that cannot be passed on is lost.
    void write(int severity, const char* category, const char* message) noexcept {
        constexpr int warning = 2;
        try {
            const std::shared_lock lock(mutex_);
            if (callback_ != nullptr && severity >= warning) {
                callback_(context_, severity, (std::string(category) + ": " + message).c_str());
            }
        } catch (const std::exception&) {
            // Out of memory: the message is lost.
        }
    }
    /// Waits for running calls. Afterwards the callback is never called again.
    void close() noexcept {
        const std::unique_lock lock(mutex_);
        callback_ = nullptr;
    }

private:
    std::shared_mutex mutex_;
    Callback callback_;
    void* context_;
};

/// An ONNX Runtime library opened at run time, version 1.16 or newer. It is never linked, and several versions can be
/// used in one process, each through its own function table. Construction may wait for the disk; afterwards any thread
/// may use it.
class Runtime {
public:
    /// `base` is the result of OrtGetApiBase of a loaded library, which must outlive the Runtime. `log` receives
    /// warnings and errors; without it they go to the standard error stream. Throws RuntimeUnavailable.
    [[nodiscard]] static std::shared_ptr<const Runtime> fromApiBase(const OrtApiBase* base,
                                                                    std::shared_ptr<LogSink> log = nullptr);
    /// Opens the library file. Throws RuntimeUnavailable; the message begins with the path.
    [[nodiscard]] static std::shared_ptr<const Runtime> open(const std::filesystem::path& library,
                                                             std::shared_ptr<LogSink> log = nullptr);

    Runtime(const Runtime&) = delete;
    Runtime& operator=(const Runtime&) = delete;
    ~Runtime();

    /// For example "1.29.0".
    [[nodiscard]] const std::string& version() const noexcept { return version_; }
    [[nodiscard]] const OrtApi& api() const noexcept { return *api_; }
    /// Version of the function table in use, 16 to 22.
    [[nodiscard]] std::uint32_t apiVersion() const noexcept { return apiVersion_; }
    /// Shared by all Runtimes of one library.
    [[nodiscard]] OrtEnv& environment() const noexcept { return *environment_; }
    /// Null if there is no log.
    [[nodiscard]] LogSink* log() const noexcept { return log_.get(); }

    /// Takes ownership of `status`. If it reports a failure, throws InferenceError with `what` before its message.
    void check(OrtStatus* status, std::string_view what) const;

private:
    Runtime(const OrtApiBase* base, std::shared_ptr<LogSink> log);
    [[nodiscard]] OrtStatus* createEnvironment();

    const OrtApi* api_ = nullptr;
    std::uint32_t apiVersion_ = 0;
    std::string version_;
    std::shared_ptr<LogSink> log_;
    OrtEnv* environment_ = nullptr;
};

}  // namespace haptoflow::inference
