#include "wav_file.hpp"

#include "exit_codes.hpp"

#include <sndfile.h>

#include <utility>

namespace haptoflow::cli {

struct WavWriter::SoundFile {
    SNDFILE* handle = nullptr;
};

WavWriter::WavWriter(const std::filesystem::path& file, int rateHz, std::string shownAs)
    : file_(std::make_unique<SoundFile>()), shownAs_(std::move(shownAs)) {
    SF_INFO info{};
    info.channels = 1;
    info.samplerate = rateHz;
    info.format = SF_FORMAT_WAV | SF_FORMAT_FLOAT;
    file_->handle = sf_open(file.string().c_str(), SFM_WRITE, &info);
    if (file_->handle == nullptr) {
        throw InputError(shownAs_ + ": cannot be written (" + sf_strerror(nullptr) + ")");
    }
    // A peak chunk carries the time of writing, and the same render would not give the same bytes twice.
    sf_command(file_->handle, SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);
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

}  // namespace haptoflow::cli
