#pragma once

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
    /// Throws RuntimeUnavailable.
    [[nodiscard]] static std::shared_ptr<const Runtime> fromApiBase(const OrtApiBase* base);
    /// Opens the library file. Throws RuntimeUnavailable, whose message then begins with the path.
    [[nodiscard]] static std::shared_ptr<const Runtime> open(const std::filesystem::path& library);

    Runtime(const Runtime&) = delete;
    Runtime& operator=(const Runtime&) = delete;
    ~Runtime();

    /// For example "1.29.0".
    [[nodiscard]] const std::string& version() const noexcept { return version_; }
    [[nodiscard]] const OrtApi& api() const noexcept { return *api_; }
    [[nodiscard]] const OrtEnv& environment() const noexcept { return *environment_; }

    /// Takes ownership of `status`; where it reports a failure, throws InferenceError with `what` before its message.
    void check(OrtStatus* status, std::string_view what) const;

private:
    explicit Runtime(const OrtApiBase* base);

    const OrtApi* api_ = nullptr;
    std::string version_;
    OrtEnv* environment_ = nullptr;
};

}  // namespace haptoflow::inference
