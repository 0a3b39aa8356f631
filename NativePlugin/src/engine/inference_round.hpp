#pragma once

#include "engine/live_voice.hpp"
#include "inference/segment_generator.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::engine {

/// Result of one round of inference.
struct RoundResult {
    /// Number of voices that needed a segment; 0 if nothing was run.
    std::size_t voices = 0;
    /// Number of segments that voices got.
    std::size_t segments = 0;
    /// Whether the run of a voice failed, and the message of the newest failure.
    bool failed = false;
    std::string failure;
    /// A voice waits for the callback, so the worker must check again soon.
    bool mustPoll = false;
    double milliseconds = 0.0;
};

/// Generates segments for all voices that need one, in one batch, and then further segments for those that need more
/// than one. Worker thread; keeps its buffers between rounds.
class InferenceRound {
public:
    /// If a batch fails, its voices are run one by one, so that only the voice for which the graph fails gets no
    /// segment.
    RoundResult run(std::span<LiveVoice* const> voices, inference::SegmentGenerator& generator);

private:
    void generate(inference::SegmentGenerator& generator, RoundResult& result);

    std::vector<LiveVoice*> pending_;
    std::vector<inference::SegmentRequest> requests_;
    std::vector<float> segments_;
};

}  // namespace haptoflow::engine
