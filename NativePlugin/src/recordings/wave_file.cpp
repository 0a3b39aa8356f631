#include "recordings/wave_file.hpp"

#include "recordings/recording.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>

namespace haptoflow::recordings {
namespace {

constexpr const char* expectedForm = "a WAV file of 1 or 3 channels, PCM or float";
constexpr unsigned pcmTag = 1;
constexpr unsigned floatTag = 3;
constexpr unsigned extensibleTag = 0xfffe;
constexpr std::size_t minimumSamples = 4;

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
    /// Whether the file says how long it is.
    bool isSizeKnown = true;
};

/// Sizes of writers that cannot go back to the head when they know it, such as a pipe's: 0, the largest number, and it
/// less a head; the same of numbers with a sign, as sox and arecord write them.
bool isSizeKnown(std::uint64_t size) {
    constexpr std::uint64_t head = 4096;
    constexpr std::uint64_t ofSigned = 0x8000'0000;
    constexpr std::uint64_t ofUnsigned = 0xFFFF'FFFF;
    const auto isJustBelow = [&](std::uint64_t limit) { return size <= limit && size >= limit - head; };
    return size > 0 && !isJustBelow(ofSigned) && !isJustBelow(ofUnsigned) && size != ~std::uint64_t{0};
}

Chunk chunkOf(std::string_view rest, std::uint64_t size) {
    if (!isSizeKnown(size) && size <= rest.size() && size > 0) {
        return {rest.substr(0, static_cast<std::size_t>(size))};
    }
    if (!isSizeKnown(size)) {
        return {.content = rest, .isSizeKnown = false};
    }
    return {.content = rest.substr(0, static_cast<std::size_t>(std::min<std::uint64_t>(size, rest.size()))),
            .isWhole = size <= rest.size()};
}

/// The chunks of a file, by their tags; of several of a kind the first.
using Chunks = std::map<std::string, Chunk, std::less<>>;

bool isChunkAt(std::string_view file, std::size_t place) {
    const std::string_view head = file.substr(std::min(place, file.size()), 8);
    const auto isLetter = [](char letter) {
        return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
               (letter >= '0' && letter <= '9') || letter == ' ' || letter == '_';
    };
    if (head.size() < 8 || head.front() == ' ' || !std::ranges::all_of(head.substr(0, 4), isLetter)) {
        return false;
    }
    const std::uint64_t size = numberIn(head.substr(4));
    return size <= file.size() - place - 8 || head.starts_with("data");
}

/// RIFF, and RF64, whose chunk "ds64" says the sizes that 32 bits cannot hold.
Chunks riffChunks(std::string_view file) {
    constexpr std::size_t headBytes = 8;
    Chunks chunks;
    std::optional<std::uint64_t> dataSize;
    for (std::size_t place = 12; place + headBytes <= file.size();) {
        const std::string tag(file.substr(place, 4));
        const std::string_view rest = file.substr(place + headBytes);
        std::uint64_t size = numberIn(file.substr(place + 4, 4));
        if (tag == "ds64" && rest.size() >= 16) {
            dataSize = numberIn(rest.substr(8, 8));
        }
        if (tag == "data") {
            size = dataSize && size == 0xFFFF'FFFF ? *dataSize : size;
            // A file without a sample has other chunks after its empty one, or nothing.
            chunks.emplace(tag, size == 0 && isChunkAt(rest, 0) ? Chunk{rest.substr(0, 0)} : chunkOf(rest, size));
        } else {
            chunks.emplace(tag, Chunk{rest.substr(0, static_cast<std::size_t>(size)), size <= rest.size()});
        }
        if (size >= rest.size() || (tag == "data" && !isSizeKnown(size))) {
            break;
        }
        // Some writers leave out the byte that fills an odd chunk up.
        const std::size_t end = place + headBytes + static_cast<std::size_t>(size);
        place = (size & 1U) == 0 || isChunkAt(file, end) ? end : end + 1;
    }
    return chunks;
}

constexpr std::string_view wave64Head = "riff\x2E\x91\xCF\x11\xA5\xD6\x28\xDB\x04\xC1";

/// Sony Wave64: tags of 16 bytes that begin with those of RIFF, sizes of 64 bits that contain tag and size, chunks at
/// multiples of 8 bytes.
Chunks wave64Chunks(std::string_view file) {
    constexpr std::size_t headBytes = 24;
    Chunks chunks;
    for (std::size_t place = 40; place + headBytes <= file.size();) {
        const std::string_view rest = file.substr(place + headBytes);
        const std::uint64_t whole = numberIn(file.substr(place + 16, 8));
        const std::uint64_t size = whole > headBytes && whole != ~std::uint64_t{0} ? whole - headBytes : 0;
        const std::string tag(file.substr(place, 4));
        const bool isData = tag == "data";
        chunks.emplace(tag, isData ? chunkOf(rest, size) : Chunk{rest.substr(0, static_cast<std::size_t>(size))});
        if ((isData && size == 0) || size >= rest.size()) {
            break;
        }
        place += headBytes + static_cast<std::size_t>((size + 7) / 8 * 8);
    }
    return chunks;
}

/// What a file is that is no WAV.
std::string kindOf(std::string_view bytes) {
    constexpr std::array<std::pair<std::string_view, const char*>, 6> kinds{{{"RIFX", "RIFX, with the high byte first"},
                                                                             {"FORM", "AIFF"},
                                                                             {"fLaC", "FLAC"},
                                                                             {"OggS", "Ogg"},
                                                                             {"ID3", "MP3"},
                                                                             {"caff", "Core Audio Format"}}};
    for (const auto& [head, name] : kinds) {
        if (bytes.starts_with(head)) {
            return std::string("is ") + name;
        }
    }
    return bytes.empty() ? "empty file" : "not a RIFF WAVE file";
}

Chunks chunksOf(const std::string& name, std::string_view bytes) {
    const std::string_view head = bytes.substr(0, 4);
    if ((head == "RIFF" || head == "RF64" || head == "BW64") && bytes.size() >= 12 && bytes.substr(8, 4) == "WAVE") {
        return riffChunks(bytes);
    }
    if (bytes.starts_with(wave64Head) && bytes.size() >= 40 && bytes.substr(24, 4) == "wave") {
        return wave64Chunks(bytes);
    }
    fail(name, kindOf(bytes), expectedForm);
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
    const Chunks chunks = chunksOf(name, bytes);
    const auto format = chunks.find("fmt ");
    const auto found = chunks.find("data");
    if (format == chunks.end() || format->second.content.size() < 16 || found == chunks.end()) {
        fail(name, "a WAV file without format or samples", expectedForm);
    }
    WaveFile wave;
    const Form form = formOf(name, format->second.content, wave);
    const Chunk& data = found->second;
    if (!data.isWhole) {
        fail(name, "cannot be read to its end", "a whole file; is it cut off?");
    }
    wave.isSizeKnown = data.isSizeKnown;
    const std::size_t width = form.bits / 8;
    const std::size_t frames = data.content.size() / (width * wave.channels);
    if (frames < minimumSamples) {
        fail(name, std::to_string(frames) + " samples", "4 at least");
    }
    wave.samples.resize(frames * wave.channels);
    for (std::size_t i = 0; i < wave.samples.size(); ++i) {
        wave.samples[i] = sampleOf(data.content.substr(i * width, width), form);
        if (!std::isfinite(wave.samples[i])) {
            fail(name, "sample " + std::to_string(i / wave.channels) + " is not finite", "numbers only");
        }
    }
    return wave;
}

}  // namespace haptoflow::recordings
