#include "skeleton/stream.hpp"

#include "skeleton/condition.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace haptoflow::skeleton {
namespace {

constexpr std::size_t levelRampSamples = 4;
// A state of a display of 72 Hz.
constexpr std::size_t correctionSamples = 28;
constexpr double largestCorrectionCycles = 0.1;

SurfacePath movedOn(const SurfacePath& path, double samples) noexcept {
    SurfacePath moved = path;
    for (std::size_t axis = 0; axis < moved.startMetres.size(); ++axis) {
        moved.startMetres[axis] += path.stepMetres[axis] * samples;
    }
    return moved;
}

double withoutWholeTurns(double cycles) noexcept {
    return cycles - std::floor(cycles);
}

}  // namespace

void Stream::begin(const StreamParameters& parameters, double samplesAhead, const NoiseKey& key) noexcept {
    key_ = key;
    path_ = {};
    noise_ = {};
    setParameters(parameters, samplesAhead);
    takePhases(parameters, samplesAhead, true);
    rampedLevelMps2_ = levelMps2_;
    levelSamplesLeft_ = 0;
    draws_ = 0;
    synthesis_.begin(skeleton_.filter, drawn());
}

std::array<float, filterOrder> Stream::drawn() noexcept {
    std::array<float, filterOrder> numbers{};
    // Numbers that `next` does not use: a key has 2^33.
    fillStandardNormal(key_, numbers, (std::uint64_t{1} << 32U) + filterOrder * draws_++);
    return numbers;
}

void Stream::follow(const StreamParameters& parameters, double samplesAhead) noexcept {
    const ReflectionFilter& now = parameters.skeleton.filter;
    synthesis_.limitPast();
    if (!synthesis_.fits(skeleton_.filter, now)) {
        synthesis_.replace(skeleton_.filter, now, drawn());
    }
    setParameters(parameters, samplesAhead);
    takePhases(parameters, samplesAhead, false);
}

void Stream::setParameters(const StreamParameters& parameters, double samplesAhead) noexcept {
    skeleton_ = parameters.skeleton;
    surface_ = parameters.surface;
    noise_.follow();
    if (parameters.isPlaced) {
        path_ = movedOn(parameters.path, samplesAhead);
    } else {
        path_.stepMetres = parameters.path.stepMetres;
    }
    const bool isUsable = parameters.levelMps2 > lowestLevelMps2 && std::isfinite(parameters.levelMps2);
    rampLevelTo(isUsable ? parameters.levelMps2 : lowestLevelMps2);
}

void Stream::rampLevelTo(float levelMps2) noexcept {
    if (levelMps2 == levelMps2_) {
        return;
    }
    constexpr float part = 1.0F / static_cast<float>(levelRampSamples);
    const bool isRising = levelMps2 > rampedLevelMps2_;
    levelStepMps2_ = isRising ? part * (levelMps2 - rampedLevelMps2_) : 0.0F;
    levelFactor_ = isRising ? 1.0F : std::pow(levelMps2 / rampedLevelMps2_, part);
    levelSamplesLeft_ = levelRampSamples;
    levelMps2_ = levelMps2;
}

void Stream::takePhases(const StreamParameters& parameters, double samplesAhead, bool isBeginning) noexcept {
    const std::array<Family, familyCount> before = families_;
    for (std::size_t family = 0; family < familyCount; ++family) {
        const PlacedFamily& given = parameters.families[family];
        const double wanted = given.phase.cycles + given.phase.rateHz * samplesAhead / waveformRateHz;
        double own = before[family].phase.cycles;
        if (isBeginning) {
            own = std::isfinite(wanted) ? withoutWholeTurns(wanted) : 0.0;
        }
        if (family < ribCount && !isBeginning && ribs_[family] != parameters.ribs[family]) {
            const auto known = std::ranges::find(ribs_, parameters.ribs[family]);
            own = known != ribs_.end() ? before[static_cast<std::size_t>(known - ribs_.begin())].phase.cycles : own;
        }
        Family& now = families_[family];
        now = {.phase = {.cycles = own, .rateHz = given.phase.rateHz}};
        const double missing = wanted - own - std::round(wanted - own);
        if (given.isPlaced && !isBeginning && std::isfinite(missing)) {
            constexpr auto samples = static_cast<double>(correctionSamples);
            // Half of the way at most, so that a family that is heard is not met backwards meanwhile.
            const double halfWay = 0.5 * std::abs(now.phase.rateHz) * samples / waveformRateHz;
            const double largest =
                isHeardHz(now.phase.rateHz) ? std::min(largestCorrectionCycles, halfWay) : largestCorrectionCycles;
            now.correctionCycles = std::clamp(0.5 * missing, -largest, largest) / samples;
        }
    }
    ribs_ = parameters.ribs;
    correctedSamplesLeft_ = correctionSamples;
}

std::size_t Stream::pieceOf(std::size_t wanted) const noexcept {
    const std::size_t piece = std::min(wanted, pieceSamples);
    return correctedSamplesLeft_ > 0 ? std::min(piece, correctedSamplesLeft_) : piece;
}

void Stream::advance(std::size_t samples) noexcept {
    for (Family& family : families_) {
        const double cycles = family.phase.cycles + (family.phase.rateHz / waveformRateHz + family.correctionCycles) *
                                                        static_cast<double>(samples);
        family.phase.cycles = std::isfinite(cycles) ? withoutWholeTurns(cycles) : 0.0;
    }
    path_ = movedOn(path_, static_cast<double>(samples));
    if (correctedSamplesLeft_ > 0) {
        correctedSamplesLeft_ -= samples;
        if (correctedSamplesLeft_ == 0) {
            std::ranges::for_each(families_, [](Family& family) { family.correctionCycles = 0.0; });
        }
    }
}

float Stream::nextRampedLevelMps2() noexcept {
    if (levelSamplesLeft_ > 0) {
        levelSamplesLeft_ -= 1;
        rampedLevelMps2_ = levelSamplesLeft_ == 0 ? levelMps2_ : levelFactor_ * rampedLevelMps2_ + levelStepMps2_;
    }
    return rampedLevelMps2_;
}

void Stream::next(const Skeleton* skeleton, std::span<float> unit, NetworkInput* input) noexcept {
    std::size_t done = 0;
    while (done < unit.size()) {
        const std::size_t samples = pieceOf(unit.size() - done);
        const auto piece = unit.subspan(done, samples);
        Piece drawn{};
        const auto noise = std::span(drawn).first(samples);
        if (skeleton != nullptr || input != nullptr) {
            noise_.next(surface_, path_, key_, noise);
        } else {
            noise_.skip(samples);
        }
        if (input != nullptr) {
            std::ranges::copy(noise, input->noise.begin() + static_cast<std::ptrdiff_t>(done));
        }
        if (skeleton == nullptr) {
            std::ranges::fill(piece, 0.0F);
        } else {
            synthesis_.next(skeleton->impulses(), skeleton_, correctedPhases(), noise, piece,
                            {.input = input, .first = done});
        }
        advance(samples);
        done += samples;
    }
}

std::array<FamilyPhase, familyCount> Stream::correctedPhases() const noexcept {
    std::array<FamilyPhase, familyCount> phases{};
    for (std::size_t family = 0; family < familyCount; ++family) {
        phases[family] = families_[family].phase;
        if (isHeardHz(phases[family].rateHz)) {
            phases[family].rateHz += families_[family].correctionCycles * waveformRateHz;
        }
    }
    return phases;
}

Phases Stream::phases() const noexcept {
    Phases phases{};
    for (std::size_t family = 0; family < familyCount; ++family) {
        phases[family] = wrapped(families_[family].phase.cycles);
        phases[familyCount + family] = static_cast<float>(families_[family].phase.rateHz);
    }
    return phases;
}

}  // namespace haptoflow::skeleton
