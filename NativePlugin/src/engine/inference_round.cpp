#include "engine/inference_round.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <optional>

namespace haptoflow::engine {
namespace {

/// Runs the generator and returns the time it took. If it fails, returns nothing and sets `failure` to the reason.
std::optional<std::uint64_t> nanosecondsOf(inference::SegmentGenerator& generator,
                                           std::span<const inference::SegmentRequest> requests,
                                           std::span<float> segments,
                                           const inference::SegmentGenerator::Sketched& sketched,
                                           std::string& failure) {
    const auto began = std::chrono::steady_clock::now();
    try {
        generator.generateFromSketches(requests, segments, sketched);
    } catch (const std::exception& error) {
        failure = error.what();
        return std::nullopt;
    }
    const auto spent = std::chrono::steady_clock::now() - began;
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count());
}

void noSketches(std::size_t, std::span<const float>) {}

}  // namespace

RoundResult InferenceRound::run(std::span<LiveVoice* const> voices, inference::SegmentGenerator& generator) {
    pending_.clear();
    RoundResult result;
    for (LiveVoice* voice : voices) {
        voice->planner.serveOutputRate();
        if (voice->planner.wake()) {
            pending_.push_back(voice);
        } else {
            result.mustPoll = voice->planner.mustPoll() || result.mustPoll;
        }
    }
    result.voices = pending_.size();
    const auto began = std::chrono::steady_clock::now();
    balancing_.assign(pending_.begin(), pending_.end());
    while (!pending_.empty()) {
        generate(generator, result);
    }
    balanceBlends(generator, result);
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - began;
    result.milliseconds = result.voices > 0 ? spent.count() : 0.0;
    return result;
}

void InferenceRound::balanceBlends(inference::SegmentGenerator& generator, RoundResult& result) {
    requests_.clear();
    std::erase_if(balancing_, [this](LiveVoice* voice) {
        voice->planner.balance().request(requests_);
        return voice->planner.balance().requested() == 0;
    });
    if (requests_.empty()) {
        return;
    }
    result.generated += requests_.size();
    segments_.resize(requests_.size() * inference::segmentSamples);
    std::string failure;
    if (!nanosecondsOf(generator, requests_, segments_, noSketches, failure)) {
        // The segments of the parts are not played, so a failure only leaves the gains unchanged.
        return;
    }
    std::span<const float> segments = segments_;
    for (LiveVoice* voice : balancing_) {
        BlendBalance& balance = voice->planner.balance();
        const std::size_t taken = balance.requested() * inference::segmentSamples;
        balance.take(segments.first(taken));
        segments = segments.subspan(taken);
    }
}

void InferenceRound::generate(inference::SegmentGenerator& generator, RoundResult& result) {
    requests_.clear();
    for (const LiveVoice* voice : pending_) {
        requests_.push_back(voice->planner.request());
    }
    result.generated += requests_.size();
    segments_.resize(requests_.size() * inference::segmentSamples);
    sketches_.resize(segments_.size());
    isSketched_.assign(requests_.size(), false);
    std::size_t firstRow = 0;
    const inference::SegmentGenerator::Sketched keep = [this, &firstRow](std::size_t first,
                                                                         std::span<const float> sketches) {
        for (std::size_t row = 0; row * inference::segmentSamples < sketches.size(); ++row) {
            isSketched_[firstRow + first + row] = true;
        }
        std::ranges::copy(sketches,
                          std::span(sketches_).subspan((firstRow + first) * inference::segmentSamples).begin());
    };
    const std::optional<std::uint64_t> together = nanosecondsOf(generator, requests_, segments_, keep, result.failure);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < pending_.size(); ++i) {
        const std::span<float, inference::segmentSamples> segment(segments_.data() + i * inference::segmentSamples,
                                                                  inference::segmentSamples);
        std::optional<std::uint64_t> spent = together;
        if (spent) {
            *spent /= pending_.size();
        } else if (pending_.size() > 1) {
            firstRow = i;
            spent = nanosecondsOf(generator, std::span(requests_).subspan(i, 1), segment, keep, result.failure);
        }
        if (!spent) {
            // No segment is sent; the skeleton goes on alone, or the running segment plays to its end and fades there.
            pending_[i]->planner.fail();
            result.failed = true;
            continue;
        }
        pending_[i]->channels.counters.inferenceNanoseconds.fetch_add(*spent, std::memory_order_relaxed);
        ++result.segments;
        const auto sketch = std::span<const float>(sketches_).subspan(i * inference::segmentSamples,
                                                                      isSketched_[i] ? inference::segmentSamples : 0);
        if (pending_[i]->planner.deliver(segment, sketch)) {
            pending_[kept] = pending_[i];
            ++kept;
        }
    }
    pending_.resize(kept);
}

}  // namespace haptoflow::engine
