#include "wav_file.hpp"

#include "exit_codes.hpp"

#include <sndfile.h>

#include <memory>
#include <string>
#include <system_error>

namespace haptoflow::cli {
namespace {

struct CloseSoundFile {
    void operator()(SNDFILE* file) const noexcept { sf_close(file); }
};

}  // namespace

void writeWav(const std::filesystem::path& path, std::span<const float> samples, int rateHz) {
    std::filesystem::path partial = path;
    partial += ".part";
    SF_INFO info{};
    info.channels = 1;
    info.samplerate = rateHz;
    info.format = SF_FORMAT_WAV | SF_FORMAT_FLOAT;
    {
        const std::unique_ptr<SNDFILE, CloseSoundFile> file(sf_open(partial.string().c_str(), SFM_WRITE, &info));
        if (!file) {
            throw InputError(path.string() + ": cannot be written (" + sf_strerror(nullptr) +
                             "): name a file in a folder that exists");
        }
        // A peak chunk carries the time of writing, and the same render would not give the same bytes twice.
        sf_command(file.get(), SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);
        const auto count = static_cast<sf_count_t>(samples.size());
        if (sf_write_float(file.get(), samples.data(), count) != count) {
            std::error_code ignored;
            std::filesystem::remove(partial, ignored);
            throw InputError(path.string() + ": could not be written to its end; is the disk full?");
        }
    }
    std::error_code error;
    std::filesystem::rename(partial, path, error);
    if (error) {
        std::error_code ignored;
        std::filesystem::remove(partial, ignored);
        throw InputError(path.string() + ": cannot be written (" + error.message() + ")");
    }
}

}  // namespace haptoflow::cli
