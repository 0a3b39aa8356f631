#pragma once

#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::bench {

/// Requests like those of live voices: labels and motions of the recorded range, noise as previous waveform and noise.
class RandomRequests {
public:
    RandomRequests(const model::ModelFile& model, std::size_t count, std::uint64_t seed);

    /// The next `count` requests, starting again after the last one; `count` is at most their number.
    [[nodiscard]] std::span<const inference::SegmentRequest> next(std::size_t count);

private:
    std::vector<float> waves_;
    std::vector<inference::SegmentRequest> requests_;
    std::size_t at_ = 0;
};

}  // namespace haptoflow::bench
