#include "engine/live_voice.hpp"

#include <chrono>
#include <cstdint>
#include <exception>
#include <optional>

namespace haptoflow::engine {
namespace {

/// Runs the generator and returns the time it took. If it fails, returns nothing and sets `failure` to the reason.
std::optional<std::uint64_t> nanosecondsOf(inference::SegmentGenerator& generator,
                                           std::span<const inference::SegmentRequest> requests,
                                           std::span<float> segments, std::string& failure) {
    const auto began = std::chrono::steady_clock::now();
    try {
        generator.generate(requests, segments);
    } catch (const std::exception& error) {
        failure = error.what();
        return std::nullopt;
    }
    const auto spent = std::chrono::steady_clock::now() - began;
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count());
}

}  // namespace

RoundResult InferenceRound::run(std::span<LiveVoice* const> voices, inference::SegmentGenerator& generator) {
    pending_.clear();
    RoundResult result;
    const auto began = std::chrono::steady_clock::now();
    for (LiveVoice* voice : voices) {
        voice->planner.serveOutputRate();
        if (voice->planner.wake()) {
            pending_.push_back(voice);
        } else {
            result.mustPoll = voice->planner.mustPoll() || result.mustPoll;
        }
    }
    result.voices = pending_.size();
    while (!pending_.empty()) {
        generate(generator, result);
    }
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - began;
    result.milliseconds = result.voices > 0 ? spent.count() : 0.0;
    return result;
}

void InferenceRound::generate(inference::SegmentGenerator& generator, RoundResult& result) {
    requests_.clear();
    for (const LiveVoice* voice : pending_) {
        requests_.push_back(voice->planner.request());
    }
    segments_.resize(requests_.size() * inference::segmentSamples);
    const std::optional<std::uint64_t> together = nanosecondsOf(generator, requests_, segments_, result.failure);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < pending_.size(); ++i) {
        const std::span<float, inference::segmentSamples> segment(segments_.data() + i * inference::segmentSamples,
                                                                  inference::segmentSamples);
        std::optional<std::uint64_t> spent = together;
        if (spent) {
            *spent /= pending_.size();
        } else if (pending_.size() > 1) {
            spent = nanosecondsOf(generator, std::span(requests_).subspan(i, 1), segment, result.failure);
        }
        if (!spent) {
            // No segment is sent; the skeleton goes on alone, or the running segment plays to its end and fades there.
            pending_[i]->planner.fail();
            result.failed = true;
            continue;
        }
        pending_[i]->channels.counters.inferenceNanoseconds.fetch_add(*spent, std::memory_order_relaxed);
        ++result.segments;
        if (pending_[i]->planner.deliver(segment)) {
            pending_[kept] = pending_[i];
            ++kept;
        }
    }
    pending_.resize(kept);
}

}  // namespace haptoflow::engine
