#include "engine/inference_round.hpp"

#include <chrono>
#include <exception>

namespace haptoflow::engine {

RoundResult InferenceRound::run(std::span<LiveVoice* const> voices, inference::SegmentGenerator& generator) {
    wanting_.clear();
    RoundResult result;
    for (LiveVoice* voice : voices) {
        voice->planner.serveOutputRate();
        if (voice->planner.wake()) {
            wanting_.push_back(voice);
        } else {
            result.awaitsCallback = result.awaitsCallback || voice->planner.awaitsCallback();
        }
    }
    result.voices = wanting_.size();
    const auto began = std::chrono::steady_clock::now();
    while (!wanting_.empty() && !result.failed) {
        generate(generator, result);
    }
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - began;
    result.milliseconds = result.voices > 0 ? spent.count() : 0.0;
    return result;
}

void InferenceRound::generate(inference::SegmentGenerator& generator, RoundResult& result) {
    requests_.clear();
    for (const LiveVoice* voice : wanting_) {
        requests_.push_back(voice->planner.request());
    }
    segments_.resize(requests_.size() * inference::segmentSamples);
    try {
        generator.generate(requests_, segments_);
    } catch (const std::exception&) {
        // Nothing goes out; the running segments go on to their ends and fade there.
        for (LiveVoice* voice : wanting_) {
            voice->planner.fail();
        }
        result.failed = true;
        return;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < wanting_.size(); ++i) {
        const std::span<const float, inference::segmentSamples> segment(
            segments_.data() + i * inference::segmentSamples, inference::segmentSamples);
        ++result.segments;
        if (wanting_[i]->planner.deliver(segment)) {
            wanting_[kept] = wanting_[i];
            ++kept;
        }
    }
    wanting_.resize(kept);
}

}  // namespace haptoflow::engine
