#include "recordings/wave_file.hpp"

#include "recordings/recording.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

namespace haptoflow::recordings {
namespace {

constexpr const char* expectedForm = "a WAV file of 1 or 3 channels, PCM or float";
constexpr unsigned pcmTag = 1;
constexpr unsigned floatTag = 3;
constexpr unsigned extensibleTag = 0xfffe;
constexpr std::size_t minimumSamples = 4;

[[noreturn]] void fail(const std::string& name, const std::string& found, const std::string& expected) {
    throw RecordingUnusable(name + ": " + found + "; expected " + expected);
}

/// Little-endian, of up to 8 bytes.
std::uint64_t numberIn(std::string_view bytes) {
    std::uint64_t number = 0;
    for (std::size_t i = bytes.size(); i > 0; --i) {
        number = number << 8U | static_cast<unsigned char>(bytes[i - 1]);
    }
    return number;
}

unsigned shortAt(std::string_view bytes, std::size_t place) {
    return static_cast<unsigned>(numberIn(bytes.substr(place, 2)));
}

struct Chunk {
    std::string_view content;
    bool isWhole = true;
};

std::optional<Chunk> chunkOf(std::string_view file, std::string_view tag) {
    constexpr std::size_t headBytes = 8;
    for (std::size_t place = 12; place + headBytes <= file.size();) {
        const std::uint64_t size = numberIn(file.substr(place + 4, 4));
        const std::string_view rest = file.substr(place + headBytes);
        if (file.substr(place, 4) == tag) {
            const auto whole = static_cast<std::size_t>(size);
            return Chunk{rest.substr(0, whole), size <= rest.size()};
        }
        if (size >= rest.size()) {
            break;
        }
        place += headBytes + static_cast<std::size_t>(size + (size & 1U));
    }
    return std::nullopt;
}

struct Form {
    bool isFloat = false;
    unsigned bits = 16;
};

float sampleOf(std::string_view bytes, const Form& form) {
    const std::uint64_t number = numberIn(bytes);
    if (form.isFloat) {
        return form.bits == 32 ? std::bit_cast<float>(static_cast<std::uint32_t>(number))
                               : static_cast<float>(std::bit_cast<double>(number));
    }
    if (form.bits == 8) {
        return (static_cast<float>(number) - 128.0F) / 128.0F;
    }
    const auto wide = static_cast<std::int32_t>(static_cast<std::uint32_t>(number << (32U - form.bits)));
    return static_cast<float>(wide) / 2147483648.0F;
}

Form formOf(const std::string& name, std::string_view content, WaveFile& wave) {
    unsigned tag = shortAt(content, 0);
    if (tag == extensibleTag && content.size() >= 26) {
        tag = shortAt(content, 24);
    }
    const Form form{.isFloat = tag == floatTag, .bits = shortAt(content, 14)};
    const bool isPcm = tag == pcmTag && (form.bits == 8 || form.bits == 16 || form.bits == 24 || form.bits == 32);
    if (!isPcm && !(form.isFloat && (form.bits == 32 || form.bits == 64))) {
        fail(name, "samples of format " + std::to_string(tag) + " with " + std::to_string(form.bits) + " bits",
             expectedForm);
    }
    const std::uint64_t rate = numberIn(content.substr(4, 4));
    wave.rateHz = static_cast<double>(rate);
    if (wave.rateHz < lowestRateHz || wave.rateHz > highestRateHz) {
        fail(name, std::to_string(rate) + " samples a second", "1000 to 192000");
    }
    wave.channels = shortAt(content, 2);
    if (wave.channels != 1 && wave.channels != 3) {
        fail(name, std::to_string(wave.channels) + " channels", "1 or 3: one axis, or X, Y and Z");
    }
    return form;
}

}  // namespace

WaveFile readWaveFile(const std::string& name, std::string_view bytes) {
    if (bytes.size() < 12 || !bytes.starts_with("RIFF") || bytes.substr(8, 4) != "WAVE") {
        fail(name, bytes.empty() ? "empty file" : "not a RIFF WAVE file", expectedForm);
    }
    const std::optional<Chunk> format = chunkOf(bytes, "fmt ");
    const std::optional<Chunk> data = chunkOf(bytes, "data");
    if (!format || format->content.size() < 16 || !data) {
        fail(name, "a WAV file without format or samples", expectedForm);
    }
    WaveFile wave;
    const Form form = formOf(name, format->content, wave);
    if (!data->isWhole) {
        fail(name, "cannot be read to its end", "a whole file; is it cut off?");
    }
    const std::size_t width = form.bits / 8;
    const std::size_t frames = data->content.size() / (width * wave.channels);
    if (frames < minimumSamples) {
        fail(name, std::to_string(frames) + " samples", "4 at least");
    }
    wave.samples.resize(frames * wave.channels);
    for (std::size_t i = 0; i < wave.samples.size(); ++i) {
        wave.samples[i] = sampleOf(data->content.substr(i * width, width), form);
        if (!std::isfinite(wave.samples[i])) {
            fail(name, "sample " + std::to_string(i / wave.channels) + " is not finite", "numbers only");
        }
    }
    return wave;
}

}  // namespace haptoflow::recordings
