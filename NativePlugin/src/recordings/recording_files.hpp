#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>

namespace haptoflow::recordings {

/// The folder of a recording: on disk, or the bytes of files that are part of an application.
class RecordingFiles {
public:
    virtual ~RecordingFiles() = default;

    /// The file's bytes; empty if it is not there. `role` is its name in messages: "the recording". Throws
    /// RecordingUnusable if it is there and cannot be read.
    [[nodiscard]] virtual std::optional<std::string> read(const std::string& role,
                                                          const std::filesystem::path& path) = 0;
    [[nodiscard]] virtual bool contains(const std::filesystem::path& path) const = 0;
    /// The path of the file `name` in the folder of another file. Capitals do not matter, because some recorders write
    /// NAME.JSON. If there is no such file, the path ends with `name` as given.
    [[nodiscard]] virtual std::filesystem::path beside(const std::filesystem::path& file,
                                                       const std::string& name) const = 0;
    /// False if a name in `origin` leads out of its folder, also by a link.
    [[nodiscard]] virtual bool isBeside(const std::filesystem::path& origin,
                                        const std::filesystem::path& path) const = 0;
};

/// Files on disk.
class DiskFiles final : public RecordingFiles {
public:
    /// `onInput` is called with the role and the path of each file before it is looked for.
    explicit DiskFiles(std::function<void(const std::string&, const std::filesystem::path&)> onInput = {})
        : onInput_(std::move(onInput)) {}

    std::optional<std::string> read(const std::string& role, const std::filesystem::path& path) override;
    bool contains(const std::filesystem::path& path) const override;
    std::filesystem::path beside(const std::filesystem::path& file, const std::string& name) const override;
    bool isBeside(const std::filesystem::path& origin, const std::filesystem::path& path) const override;

private:
    std::function<void(const std::string&, const std::filesystem::path&)> onInput_;
};

/// Files given by name. Their bytes must outlive the object.
class GivenFiles final : public RecordingFiles {
public:
    explicit GivenFiles(std::map<std::string, std::span<const char>> files) : files_(std::move(files)) {}

    std::optional<std::string> read(const std::string& role, const std::filesystem::path& path) override;
    bool contains(const std::filesystem::path& path) const override;
    std::filesystem::path beside(const std::filesystem::path& file, const std::string& name) const override;
    bool isBeside(const std::filesystem::path& origin, const std::filesystem::path& path) const override;

private:
    std::map<std::string, std::span<const char>> files_;
};

/// The bytes of a file or pipe of up to 1 GiB. `expected` is its kind, for messages. Throws RecordingUnusable that
/// names the path if it is missing, a folder, unreadable or too large.
[[nodiscard]] std::string readWholeFile(const std::filesystem::path& path, const std::string& expected);

/// A path in messages and in the C interface: UTF-8 on every platform.
[[nodiscard]] std::string utf8Of(const std::filesystem::path& path);

/// The ending in lower case, with its dot: some recorders write .CSV and .WAV.
[[nodiscard]] std::string endingOf(const std::filesystem::path& path);

/// Properties of a recording from the files beside it; empty if the recording's own columns give them.
struct RecordingSidecar {
    /// The path NAME.json, whether it exists or not.
    std::filesystem::path path;
    std::string label;
    std::optional<double> fullScaleMps2;
    /// A given speed is a velocity along the first axis.
    std::optional<std::array<double, 2>> velocityMps;
    std::optional<double> forceNewtons;
    /// 1 or -1: the sign with which a measured force counts pressing.
    std::optional<double> forceSign;
    /// What a measured force is where the tip touches nothing.
    std::optional<double> forceRestNewtons;
    /// A table of motion and force with its own time stamps.
    std::optional<std::filesystem::path> motion;
    std::optional<double> rateHz;
    std::string licence;
    std::string source;
};

/// Reads NAME.json beside NAME.csv or NAME.wav, and recordings.json in the same folder for keys that NAME.json does not
/// have. Throws RecordingUnusable that names file and key, the value found and the expected one.
[[nodiscard]] RecordingSidecar readRecordingSidecar(RecordingFiles& files, const std::filesystem::path& recording);

}  // namespace haptoflow::recordings
