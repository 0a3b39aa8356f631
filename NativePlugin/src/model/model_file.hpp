#pragma once

#include "model/model_error.hpp"
#include "model/model_header.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace haptoflow::model {

/// A `.haptoflow` file in memory, with all of its bytes verified. Immutable, so that any number of threads
/// may read it at once. Spans and views are valid as long as the object.
class ModelFile {
public:
    /// Parses the bytes of a whole file. Throws ModelError.
    [[nodiscard]] static ModelFile parse(std::vector<std::byte> bytes);
    /// Reads a file. Throws ModelError with a message that begins with the path.
    [[nodiscard]] static ModelFile read(const std::filesystem::path& path);

    ModelFile(ModelFile&&) noexcept = default;
    ModelFile& operator=(ModelFile&&) noexcept = default;
    ModelFile(const ModelFile&) = delete;
    ModelFile& operator=(const ModelFile&) = delete;
    ~ModelFile() = default;

    [[nodiscard]] const ModelHeader& header() const noexcept { return header_; }
    /// The file's JSON header without padding.
    [[nodiscard]] std::string_view headerText() const noexcept;
    [[nodiscard]] std::size_t byteCount() const noexcept { return bytes_.size(); }
    /// CRC-32 of the whole file, which identifies the model in stored measurements.
    [[nodiscard]] std::uint32_t checksum() const noexcept;

    /// The tier of this name, or null.
    [[nodiscard]] const Tier* findTier(std::string_view name) const noexcept;

    /// The header's entry of the blob of this name, or null.
    [[nodiscard]] const Blob* findBlob(std::string_view name) const noexcept;
    /// The numbers of a float32 blob. Throws std::out_of_range for an unknown name.
    [[nodiscard]] std::vector<float> tensor(std::string_view name) const;
    /// A blob's bytes, aligned to at least 16. Throws std::out_of_range for an unknown name.
    [[nodiscard]] std::span<const std::byte> blob(std::string_view name) const;
    /// The material embedding of header().labels[label].
    [[nodiscard]] std::span<const float, embeddingSize> embedding(std::size_t label) const;
    /// Of every recorded piece of header().labels[label], one after the other: how far its embedding is from the
    /// label's, without the wave vectors (60 numbers). Empty for a model that does not tell pieces apart.
    [[nodiscard]] std::span<const float> pieceOffsets(std::size_t label) const;
    /// Index of the label whose embedding is nearest, wave vectors ignored: they are not part of the similarity of
    /// materials. The model needs a label.
    [[nodiscard]] std::size_t nearestLabel(std::span<const float, embeddingSize> embedding) const;
    /// The waveform of header().seeds[seed]: 400 samples at 2 kHz with an RMS of 1.
    [[nodiscard]] std::span<const float, seedSamples> seed(std::size_t seed) const;

private:
    ModelFile() = default;
    [[nodiscard]] const Blob& requireBlob(std::string_view name) const;

    std::vector<std::byte> bytes_;
    std::size_t headerTextBytes_ = 0;
    ModelHeader header_;
    std::vector<float> embeddings_;
    std::vector<float> pieces_;
    std::size_t piecesPerLabel_ = 0;
    std::vector<float> seeds_;
};

}  // namespace haptoflow::model
