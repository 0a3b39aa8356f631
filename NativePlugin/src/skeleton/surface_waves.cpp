#include "skeleton/surface_waves.hpp"

#include <cmath>
#include <numbers>

namespace haptoflow::skeleton {
namespace {

constexpr double slowestHz = 0.5;
constexpr double highestSwingHz = 700.0;
constexpr double highestLineHz = 960.0;
constexpr float largestLine = 30.0F;

using Wave = std::array<float, segmentSamples>;

/// Cosine and sine of an angle that grows evenly from sample to sample.
struct Rotation {
    Wave cosine;
    Wave sine;
};

/// The rotation of a family's first harmonic. Eight samples are computed as such and turned on from there, in double
/// precision, so that the error does not grow over the segment.
Rotation firstHarmonic(double turns, double turnsPerSample) noexcept {
    constexpr std::size_t lanes = 8;
    static_assert(segmentSamples % lanes == 0);
    std::array<double, lanes> cosine{};
    std::array<double, lanes> sine{};
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        const double angle = turns + turnsPerSample * (static_cast<double>(lane) + 0.5);
        const double radians = 2.0 * std::numbers::pi * (angle - std::round(angle));
        cosine[lane] = std::cos(radians);
        sine[lane] = std::sin(radians);
    }
    const double step = 2.0 * std::numbers::pi * turnsPerSample * static_cast<double>(lanes);
    const double stepCosine = std::cos(step);
    const double stepSine = std::sin(step);
    Rotation rotation;
    for (std::size_t first = 0; first < rotation.cosine.size(); first += lanes) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            rotation.cosine[first + lane] = static_cast<float>(cosine[lane]);
            rotation.sine[first + lane] = static_cast<float>(sine[lane]);
            const double turned = cosine[lane] * stepCosine - sine[lane] * stepSine;
            sine[lane] = cosine[lane] * stepSine + sine[lane] * stepCosine;
            cosine[lane] = turned;
        }
    }
    return rotation;
}

/// Turns `rotation` on by `step`.
void turn(Rotation& rotation, const Rotation& step) noexcept {
    for (std::size_t n = 0; n < rotation.cosine.size(); ++n) {
        const float cosine = rotation.cosine[n];
        const float sine = rotation.sine[n];
        rotation.cosine[n] = cosine * step.cosine[n] - sine * step.sine[n];
        rotation.sine[n] = cosine * step.sine[n] + sine * step.cosine[n];
    }
}

float lineGain(float output) noexcept {
    return largestLine * std::tanh(output / largestLine);
}

}  // namespace

bool FamilyPhase::isHeard() const noexcept {
    return std::isfinite(turns) && std::fabs(rateHz) > slowestHz && std::fabs(rateHz) < highestLineHz;
}

void SurfaceWaves::add(const FamilyPhase& phase, const FamilyGains& gains, Pulses* cosines, Pulses* sines) noexcept {
    isHeard_ = true;
    const double rateHz = std::fabs(phase.rateHz);
    const double turns = phase.rateHz >= 0.0 ? phase.turns : -phase.turns;
    const Rotation first = firstHarmonic(turns, rateHz / waveformRateHz);
    Rotation rotation = first;
    for (std::size_t index = 0; index < lineHarmonics; ++index) {
        const double harmonicHz = rateHz * static_cast<double>(index + 1);
        if (harmonicHz >= highestLineHz) {
            return;
        }
        if (index > 0) {
            turn(rotation, first);
        }
        const float lineCosine = lineGain(gains.lineCosine[index]);
        const float lineSine = lineGain(gains.lineSine[index]);
        for (std::size_t n = 0; n < lines_.size(); ++n) {
            lines_[n] += lineCosine * rotation.cosine[n] + lineSine * rotation.sine[n];
        }
        if (index >= swingHarmonics || harmonicHz >= highestSwingHz) {
            continue;
        }
        const float swingCosine = gains.swingCosine[index];
        const float swingSine = gains.swingSine[index];
        for (std::size_t n = 0; n < segmentSamples; ++n) {
            swing_[n] += swingCosine * rotation.cosine[n] + swingSine * rotation.sine[n];
        }
        if (cosines != nullptr && sines != nullptr) {
            for (std::size_t n = 0; n < segmentSamples; ++n) {
                (*cosines)[index][n] += rotation.cosine[n];
                (*sines)[index][n] += rotation.sine[n];
            }
        }
    }
}

}  // namespace haptoflow::skeleton
