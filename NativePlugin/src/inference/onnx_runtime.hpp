#pragma once

#include "inference/log_sink.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct OrtApi;
struct OrtApiBase;
struct OrtEnv;
struct OrtStatus;

namespace haptoflow::inference {

/// ONNX Runtime as found at run time: never linked, any version from 1.16 on. Several may live in one process, each
/// with its own function table. Construction may block on disk; afterwards any thread may use it.
class Runtime {
public:
    /// `base` is what OrtGetApiBase of a loaded library returns; the library must outlive the Runtime.
    /// `log` gets its warnings and errors; without it they go to the standard error stream. Throws RuntimeUnavailable.
    [[nodiscard]] static std::shared_ptr<const Runtime> fromApiBase(const OrtApiBase* base,
                                                                    std::shared_ptr<LogSink> log = nullptr);
    /// Opens the library file. Throws RuntimeUnavailable, whose message then begins with the path.
    [[nodiscard]] static std::shared_ptr<const Runtime> open(const std::filesystem::path& library,
                                                             std::shared_ptr<LogSink> log = nullptr);

    Runtime(const Runtime&) = delete;
    Runtime& operator=(const Runtime&) = delete;
    ~Runtime();

    /// For example "1.29.0".
    [[nodiscard]] const std::string& version() const noexcept { return version_; }
    [[nodiscard]] const OrtApi& api() const noexcept { return *api_; }
    /// The newest version of the function table that this project asks for and the library has, 16 to 22.
    [[nodiscard]] std::uint32_t apiVersion() const noexcept { return apiVersion_; }
    /// One for all runtimes of one library.
    [[nodiscard]] OrtEnv& environment() const noexcept { return *environment_; }
    /// Null where nobody wants to hear.
    [[nodiscard]] LogSink* log() const noexcept { return log_.get(); }

    /// Takes ownership of `status`; where it reports a failure, throws InferenceError with `what` before its message.
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
