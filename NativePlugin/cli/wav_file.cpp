#include "wav_file.hpp"

#include "dsp/sample_rates.hpp"
#include "headless/scenes/command_files.hpp"
#include "messages.hpp"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptoflow::cli {

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
