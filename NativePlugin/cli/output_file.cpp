#include "output_file.hpp"

#include "dsp/sample_rates.hpp"
#include "headless/command_files.hpp"
#include "messages.hpp"
#include "recordings/recording_files.hpp"

#include <sndfile.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <system_error>
#include <utility>

namespace haptoflow::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* remedy = ": cannot be written: name a file in an existing folder with write permission";

/// True for something that a rename would replace although it is no file of its own.
bool isSpecial(const fs::path& path) {
    const std::string name = path.generic_string();
    return headless::isStandardOutput(path) || headless::isDevice(path) || name.starts_with("/dev/std") ||
           name.starts_with("/dev/fd/") || name.starts_with("/proc/");
}

/// Creates a new file with a unique name beside `target` (or with its name in `folder`).
fs::path makePartial(const fs::path& target, const fs::path& shown) {
    for (int attempt = 0; attempt < 1000; ++attempt) {
        fs::path partial = target;
        partial += (attempt == 0 ? "" : "." + std::to_string(attempt)) + ".part";
        if (std::FILE* file = std::fopen(partial.string().c_str(), "wxb")) {
            std::fclose(file);
            return partial;
        }
        if (errno != EEXIST) {
            break;
        }
    }
    throw InputError(shown.string() + remedy);
}

/// Partial files of this process, which the signal handler removes: a fixed array, because a handler must not allocate.
/// An entry is valid while its flag is set.
struct Unfinished {
    std::atomic<bool> isUsed = false;
    std::array<char, 4096> path{};
};
std::array<Unfinished, 8> unfinished;

void removeUnfinished(int signal) {
    for (Unfinished& entry : unfinished) {
        if (entry.isUsed) {
            std::remove(entry.path.data());
        }
    }
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

void rememberUnfinished(const fs::path& partial) {
    const std::string path = partial.string();
    for (Unfinished& entry : unfinished) {
        if (!entry.isUsed && path.size() < entry.path.size()) {
            std::copy(path.begin(), path.end(), entry.path.begin());
            entry.path.at(path.size()) = '\0';
            entry.isUsed = true;
            break;
        }
    }
    for (const int signal : {SIGINT, SIGTERM}) {
        // A signal that was ignored before (nohup, a shell's background jobs) stays ignored.
        if (std::signal(signal, removeUnfinished) == SIG_IGN) {
            std::signal(signal, SIG_IGN);
        }
    }
}

void forgetUnfinished(const fs::path& partial) {
    const std::string path = partial.string();
    for (Unfinished& entry : unfinished) {
        if (entry.isUsed && path == entry.path.data()) {
            entry.isUsed = false;
        }
    }
}

void copyToStandardOutput(const fs::path& partial) {
    std::ifstream from(partial, std::ios::binary);
    if (from.peek() != std::ifstream::traits_type::eof()) {
        std::cout << from.rdbuf();
    }
    if (from.bad() || !std::cout.flush()) {
        throw InputError("standard output could not be written to its end");
    }
}

}  // namespace

OutputFile::OutputFile(const std::string& role, const fs::path& path)
    : path_(path), isWrittenInPlace_(isSpecial(path)) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
        throw InputError(path.string() + ": is a folder; expected the name of a file");
    }
    target_ = isWrittenInPlace_ ? path : headless::followLinks(path);
    if (!isWrittenInPlace_ && fs::exists(target_, ignored) && !std::ofstream(target_, std::ios::app)) {
        throw InputError(path.string() + remedy);
    }
    partial_ = makePartial(isWrittenInPlace_ ? fs::temp_directory_path() / "haptoflow" : target_, path);
    rememberUnfinished(partial_);
    try {
        headless::claimOutput({role, path_, target_, isWrittenInPlace_ ? fs::path() : partial_});
    } catch (...) {
        removePartial();
        throw;
    }
}

OutputFile::~OutputFile() {
    headless::releaseOutput(path_);
    removePartial();
}

void OutputFile::removePartial() const noexcept {
    std::error_code ignored;
    fs::remove(partial_, ignored);
    forgetUnfinished(partial_);
}

void OutputFile::commit() {
    std::error_code error;
    if (headless::isStandardOutput(path_)) {
        copyToStandardOutput(partial_);
        return;
    }
    if (isWrittenInPlace_) {
        std::ifstream from(partial_, std::ios::binary);
        std::ofstream to(target_, std::ios::binary);
        if (fs::file_size(partial_, error) > 0) {
            to << from.rdbuf();
        }
        if (error || !to.flush()) {
            throw InputError(path_.string() + ": could not be written to its end");
        }
        return;
    }
    if (fs::exists(target_, error)) {
        fs::permissions(partial_, fs::status(target_, error).permissions(), error);
    }
    fs::rename(partial_, target_, error);
    if (error) {
        throw InputError(path_.string() + ": cannot be written (" + error.message() + ")");
    }
}

void writeText(const OutputFile& file, const std::string& text) {
    std::ofstream stream(file.partial(), std::ios::binary);
    stream << text;
    if (!stream.flush()) {
        throw InputError(file.path().string() + ": could not be written to its end; is the disk full?");
    }
}

OptionalOutput optionalOutput(const std::string& role, const fs::path& path) {
    return path.empty() ? nullptr : std::make_unique<OutputFile>(role, path);
}

void writeText(const OptionalOutput& file, const std::string& text) {
    if (file) {
        writeText(*file, text);
    }
}

void commit(const OptionalOutput& file) {
    if (file) {
        file->commit();
    }
}

void requireWavName(const std::string& role, const fs::path& path) {
    const std::string ending = path.extension().string();
    if (ending.empty() || recordings::endingOf(path) == ".wav" || isSpecial(path)) {
        return;
    }
    fs::path meant = path;
    meant.replace_extension(".wav");
    throw UsageError(role + " " + path.string() + ": only WAV is written, not '" + ending + "'; did you mean " +
                     meant.string() + "?");
}

struct WavWriter::SoundFile {
    SNDFILE* handle = nullptr;
};

WavWriter::WavWriter(const std::filesystem::path& file, int rateHz, std::string shownAs, const std::string& comment)
    : file_(std::make_unique<SoundFile>()), shownAs_(std::move(shownAs)) {
    SF_INFO info{};
    info.channels = 1;
    info.samplerate = rateHz;
    info.format = SF_FORMAT_WAV | SF_FORMAT_FLOAT;
    file_->handle = sf_open(file.string().c_str(), SFM_WRITE, &info);
    if (file_->handle == nullptr) {
        throw InputError(shownAs_ + ": cannot be written (" + sf_strerror(nullptr) + ")");
    }
    // A peak chunk contains the time of writing, so that equal renders would have different bytes.
    sf_command(file_->handle, SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);
    if (!comment.empty()) {
        sf_set_string(file_->handle, SF_STR_COMMENT, comment.c_str());
    }
}

WavWriter::~WavWriter() {
    if (file_->handle != nullptr) {
        sf_close(file_->handle);
    }
}

void WavWriter::write(std::span<const float> samples) {
    const auto count = static_cast<sf_count_t>(samples.size());
    if (sf_write_float(file_->handle, samples.data(), count) != count) {
        throw InputError(shownAs_ + ": could not be written to its end; is the disk full?");
    }
}

void WavWriter::close() {
    if (sf_close(std::exchange(file_->handle, nullptr)) != 0) {
        throw InputError(shownAs_ + ": could not be written to its end; is the disk full?");
    }
}

Recording readRecording(const std::string& role, const std::string& path, int channel) {
    headless::claimInput(role, path);
    constexpr sf_count_t maximumSeconds = 600;
    SF_INFO info{};
    const std::unique_ptr<SNDFILE, int (*)(SNDFILE*)> file(sf_open(path.c_str(), SFM_READ, &info), sf_close);
    if (file == nullptr) {
        throw InputError(path + ": cannot be read (" + sf_strerror(nullptr) + "); expected a sound file such as WAV");
    }
    if (info.samplerate < dsp::minimumOutputRateHz || info.samplerate > dsp::maximumOutputRateHz) {
        throw InputError(path + ": has a rate of " + std::to_string(info.samplerate) +
                         " Hz; expected 8000 to 192000 Hz");
    }
    if (info.frames > maximumSeconds * info.samplerate) {
        throw InputError(path + ": is longer than ten minutes; cut it to the sweep and the silence after it");
    }
    if (channel == 0 && info.channels != 1) {
        throw InputError(path + ": has " + std::to_string(info.channels) +
                         " channels; name the sensor's with --channel, which counts from 1");
    }
    if (channel > info.channels) {
        throw InputError(path + ": has no channel " + std::to_string(channel) + "; it has " +
                         std::to_string(info.channels));
    }
    const auto channels = static_cast<std::size_t>(info.channels);
    std::vector<float> all(static_cast<std::size_t>(info.frames) * channels);
    if (sf_readf_float(file.get(), all.data(), info.frames) != info.frames) {
        throw InputError(path + ": cannot be read to its end; is it cut off?");
    }
    Recording recording;
    recording.rateHz = info.samplerate;
    const auto first = static_cast<std::size_t>(std::max(channel, 1) - 1);
    for (std::size_t i = first; i < all.size(); i += channels) {
        recording.samples.push_back(all[i]);
    }
    if (!std::ranges::all_of(recording.samples, [](float sample) { return std::isfinite(sample); })) {
        throw InputError(path + ": holds samples that are not finite; expected a recording");
    }
    if (const char* comment = sf_get_string(file.get(), SF_STR_COMMENT)) {
        recording.comment = comment;
    }
    return recording;
}

}  // namespace haptoflow::cli
