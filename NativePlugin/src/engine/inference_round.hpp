#pragma once

#include "engine/live_voice.hpp"
#include "inference/segment_generator.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::engine {

/// What one round of inference did.
struct RoundResult {
    /// Voices that wanted a segment; 0 where nothing was run.
    std::size_t voices = 0;
    std::size_t segments = 0;
    /// At least one voice's run failed; the newest failure's text.
    bool failed = false;
    std::string failure;
    /// A voice waits for the callback: look again soon.
    bool looksAgain = false;
    double milliseconds = 0.0;
};

/// One look at all voices: those that want a segment get one, all in the same batch, and then those that need another
/// behind it. Worker thread; keeps its buffers from round to round.
class InferenceRound {
public:
    /// Where a batch fails, each of its voices is run alone: what the graph cannot do for one leaves that one without a
    /// new segment, counted, and not the others.
    RoundResult run(std::span<LiveVoice* const> voices, inference::SegmentGenerator& generator);

private:
    void generate(inference::SegmentGenerator& generator, RoundResult& result);
    void balanceBlends(inference::SegmentGenerator& generator);

    std::vector<LiveVoice*> wanting_;
    std::vector<LiveVoice*> balancing_;
    std::vector<inference::SegmentRequest> requests_;
    std::vector<float> segments_;
};

}  // namespace haptoflow::engine
