#pragma once

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

/// An ONNX Runtime library opened at run time, version 1.16 or newer. It is never linked, and several versions can be
/// used in one process, each through its own function table. Construction may wait for the disk; afterwards any thread
/// may use it.
class Runtime {
public:
    /// `base` is the result of OrtGetApiBase of a loaded library, which must outlive the Runtime. Its errors
    /// go to the standard error stream. Throws RuntimeUnavailable.
    [[nodiscard]] static std::shared_ptr<const Runtime> fromApiBase(const OrtApiBase* base);
    /// Opens the library file. Throws RuntimeUnavailable; the message begins with the path.
    [[nodiscard]] static std::shared_ptr<const Runtime> open(const std::filesystem::path& library);

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

    /// Takes ownership of `status`. If it reports a failure, throws InferenceError with `what` before its message.
    void check(OrtStatus* status, std::string_view what) const;

private:
    explicit Runtime(const OrtApiBase* base);

    const OrtApi* api_ = nullptr;
    std::uint32_t apiVersion_ = 0;
    std::string version_;
    OrtEnv* environment_ = nullptr;
};

}  // namespace haptoflow::inference
