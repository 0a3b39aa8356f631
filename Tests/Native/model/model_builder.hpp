#pragma once

#include "model/file_layout.hpp"
#include "model/model_header.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptoflow::model::testing {

using Bytes = std::vector<std::byte>;

inline void writeUnsigned(Bytes& file, std::size_t offset, std::size_t byteCount, std::uint64_t value) {
    for (std::size_t index = 0; index < byteCount; ++index) {
        file.at(offset + index) = static_cast<std::byte>(value >> (8 * index));
    }
}

inline std::uint64_t readUnsigned(const Bytes& file, std::size_t offset, std::size_t byteCount) {
    std::uint64_t value = 0;
    for (std::size_t index = byteCount; index > 0; --index) {
        value = value << 8U | std::to_integer<std::uint64_t>(file.at(offset + index - 1));
    }
    return value;
}

/// Corrects the checksum of bytes 0 to 27.
inline void resealPrefix(Bytes& file) {
    writeUnsigned(file, 28, 4, crc32(std::span(file).first(28)));
}

/// Corrects the checksums of the header and of bytes 0 to 27.
inline void resealHeader(Bytes& file) {
    const auto length = std::min<std::uint64_t>(readUnsigned(file, 12, 4), file.size() - 32);
    writeUnsigned(file, 24, 4, crc32(std::span(file).subspan(32, static_cast<std::size_t>(length))));
    resealPrefix(file);
}

inline Bytes bytesOf(const std::vector<float>& values) {
    Bytes bytes(values.size() * sizeof(float));
    for (std::size_t index = 0; index < values.size(); ++index) {
        writeUnsigned(bytes, index * sizeof(float), sizeof(float), std::bit_cast<std::uint32_t>(values[index]));
    }
    return bytes;
}

struct BlobContent {
    std::string name;
    std::string type;
    std::vector<std::int64_t> shape;
    Bytes bytes;
};

/// Builds `.haptoflow` files in memory. A new builder holds a small valid model (two labels, two tiers, three seeds,
/// graphs that no runtime could load); tests change `header` or `blobs` before building.
class ModelBuilder {
public:
    /// The header without "blobs".
    nlohmann::json header = validHeader();
    std::vector<BlobContent> blobs = validBlobs();
    /// Changes the header after "blobs" has been added with final offsets and checksums.
    std::function<void(nlohmann::json&)> editLaidOut;
    /// Changes the header's text without changing its length.
    std::function<void(std::string&)> editText;

    [[nodiscard]] Bytes build() const {
        const std::size_t headerEnd = roundUp(32 + header.dump().size() + 256 * (blobs.size() + 1) + spareBytes);
        nlohmann::json laidOut = header;
        laidOut["blobs"] = nlohmann::json::array();
        std::size_t end = headerEnd;
        for (const BlobContent& blob : blobs) {
            const std::size_t offset = roundUp(end);
            laidOut["blobs"].push_back({{"name", blob.name},
                                        {"type", blob.type},
                                        {"shape", blob.shape},
                                        {"offset", offset},
                                        {"bytes", blob.bytes.size()},
                                        {"crc32", crc32(blob.bytes)}});
            end = offset + blob.bytes.size();
        }
        if (editLaidOut) {
            editLaidOut(laidOut);
        }
        std::string text = laidOut.dump();
        if (text.size() > headerEnd - 32) {
            throw std::length_error("the changed header does not fit into its space");
        }
        text.resize(headerEnd - 32, ' ');
        if (editText) {
            editText(text);
        }
        return assemble(text, end);
    }

private:
    static constexpr std::size_t spareBytes = 4096;

    static std::size_t roundUp(std::size_t offset) { return (offset + 63) / 64 * 64; }

    [[nodiscard]] Bytes assemble(const std::string& text, std::size_t end) const {
        Bytes file(end);
        const std::string magic = "HAPTFLOW";
        std::transform(magic.begin(), magic.end(), file.begin(), [](char letter) { return std::byte(letter); });
        writeUnsigned(file, 8, 4, formatVersion);
        writeUnsigned(file, 12, 4, text.size());
        writeUnsigned(file, 16, 8, end);
        std::transform(text.begin(), text.end(), file.begin() + 32, [](char letter) { return std::byte(letter); });
        std::size_t next = 32 + text.size();
        for (const BlobContent& blob : blobs) {
            next = roundUp(next);
            std::copy(blob.bytes.begin(), blob.bytes.end(), file.begin() + static_cast<std::ptrdiff_t>(next));
            next += blob.bytes.size();
        }
        resealHeader(file);
        return file;
    }

    static nlohmann::json validLabel(const std::string& name, int row) {
        return {{"name", name},
                {"embedding_row", row},
                {"level_exponents", {{"speed", 0.5}, {"force", 0.25}}},
                {"frequency_exponent", 0.5},
                {"periodic", false},
                {"wavelength_metres", nullptr},
                {"stiffness_newtons_per_metre", 800.0},
                {"friction_coefficient", 0.4},
                {"category", "wood"}};
    }

    static nlohmann::json validTier(const std::string& name, const std::string& solver, int steps) {
        return {{"name", name},
                {"kind", "flow"},
                {"field", "field"},
                {"level", "level"},
                {"solver", solver},
                {"steps", steps},
                {"parameters", 12345},
                {"representation", "raw"},
                {"accuracy", {{"spectral_error_db", 1.5}}},
                {"cost", nlohmann::json::object()}};
    }

    static nlohmann::json validHeader() {
        nlohmann::json json = {
            {"name", "test model"},
            {"description", "Made by the tests."},
            {"provenance",
             {{"statement", "trained on nothing"},
              {"recordings", "none"},
              {"licence", "MIT"},
              {"seed", 7},
              {"commit", "0123abc"},
              {"configuration", {{"width", 8}}},
              {"created", "2025-01-31"}}},
            {"sample_rate_hz", 2000},
            {"segment_samples", 200},
            {"embedding_size", 64},
            {"normalisation", {{"unit", "m/s^2"}, {"peak_mps2", 25.0}}},
            {"range",
             {{"speed_mps", {0.01, 0.4}},
              {"force_newtons", {0.1, 4.0}},
              {"speed_percentiles_mps", {0.02, 0.06, 0.1, 0.2, 0.3}},
              {"force_percentiles_newtons", {0.2, 0.5, 1.0, 2.0, 3.0}}}},
            {"labels", {validLabel("oak", 0), validLabel("metal mesh", 1)}},
            {"tiers", {validTier("draft", "euler", 1), validTier("standard", "midpoint", 2)}},
            {"default_tier", "standard"},
            {"seed_bank", {{"samples", 400}, {"tensor", "seeds"}, {"entries", nlohmann::json::array()}}}};
        json["labels"][1]["periodic"] = true;
        json["labels"][1]["wavelength_metres"] = 0.002;
        for (int seed = 0; seed < 3; ++seed) {
            json["seed_bank"]["entries"].push_back({{"label", seed == 2 ? "metal mesh" : "oak"},
                                                    {"velocity_mps", {0.1 * (seed + 1), -0.05}},
                                                    {"force_newtons", 1.0 + seed}});
        }
        return json;
    }

    static std::vector<BlobContent> validBlobs() {
        std::vector<float> embedding(2 * embeddingSize);
        for (std::size_t index = 0; index < embedding.size(); ++index) {
            embedding[index] = 0.01F * static_cast<float>(index);
        }
        std::vector<float> seeds(3 * seedSamples);
        for (std::size_t index = 0; index < seeds.size(); ++index) {
            seeds[index] = (index / (index / seedSamples + 1)) % 2 == 0 ? 1.0F : -1.0F;
        }
        Bytes graph(100, std::byte{0x5A});
        return {{"embedding", "float32", {2, 64}, bytesOf(embedding)},
                {"seeds", "float32", {3, 400}, bytesOf(seeds)},
                {"field", "onnx", {}, graph},
                {"level", "onnx", {}, Bytes(37, std::byte{0x33})}};
    }
};

/// The blob of this name, to change.
inline BlobContent& blobOf(ModelBuilder& builder, const std::string& name) {
    const auto found = std::ranges::find(builder.blobs, name, &BlobContent::name);
    if (found == builder.blobs.end()) {
        throw std::runtime_error("the builder has no blob " + name);
    }
    return *found;
}

}  // namespace haptoflow::model::testing
