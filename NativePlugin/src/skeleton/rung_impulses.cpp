#include "skeleton/rung_impulses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptoflow::skeleton {
namespace {

constexpr std::array<double, 6> ringsHz{50.0, 90.0, 160.0, 280.0, 500.0, 800.0};
constexpr double ringDecay = 0.4;
constexpr float largestGain = 8.0F;
constexpr auto lowestRung = static_cast<float>(model::SkeletonHeader::rungs.front());
static_assert(atomCount == 1 + 2 * ringsHz.size());

/// Standard deviation of sign(n) max(|n| - rung, 0) of standard normal n: E = 2 [(1 + t^2) Q(t) - t p(t)].
double excessDeviation(double rung) noexcept {
    const double tail = 0.5 * std::erfc(rung / std::numbers::sqrt2);
    const double density = std::exp(-0.5 * rung * rung) / std::sqrt(2.0 * std::numbers::pi);
    return std::sqrt(2.0 * ((1.0 + rung * rung) * tail - rung * density));
}

/// Of unit energy: the damped cosine or sine of a ring.
template <typename Sinusoid>
std::array<float, RungImpulses::taps> ringing(double ringHz, Sinusoid sinusoid) noexcept {
    std::array<double, RungImpulses::taps> atom{};
    double energy = 0.0;
    for (std::size_t n = 0; n < atom.size(); ++n) {
        const double turn = 2.0 * std::numbers::pi * ringHz * static_cast<double>(n) / waveformRateHz;
        atom[n] = std::exp(-ringDecay * turn) * sinusoid(turn);
        energy += atom[n] * atom[n];
    }
    std::array<float, RungImpulses::taps> result{};
    std::ranges::transform(atom, result.begin(),
                           [energy](double value) { return static_cast<float>(value / std::sqrt(energy)); });
    return result;
}

}  // namespace

RungImpulses::RungImpulses() {
    atoms_[0][0] = 1.0F;
    for (std::size_t ring = 0; ring < ringsHz.size(); ++ring) {
        atoms_[1 + 2 * ring] = ringing(ringsHz[ring], [](double turn) { return std::cos(turn); });
        atoms_[2 + 2 * ring] = ringing(ringsHz[ring], [](double turn) { return std::sin(turn); });
    }
    std::ranges::transform(model::SkeletonHeader::rungs, scales_.begin(),
                           [](double rung) { return static_cast<float>(1.0 / excessDeviation(rung)); });
}

void RungImpulses::strike(Segment noise, std::span<const float, gainCount> gains,
                          std::span<float, segmentSamples> struck) const noexcept {
    std::ranges::fill(struck, 0.0F);
    // Rarely more than twenty of the 200 samples.
    std::array<std::size_t, segmentSamples> places{};
    std::size_t count = 0;
    for (std::size_t at = 0; at < noise.size(); ++at) {
        places[count] = at;
        count += std::fabs(noise[at]) > lowestRung ? 1 : 0;
    }
    for (const bool isNegative : {false, true}) {
        for (std::size_t rung = 0; rung < rungCount; ++rung) {
            const std::size_t first = ((isNegative ? rungCount : 0) + rung) * atomCount;
            const float sign = isNegative ? -1.0F : 1.0F;
            const auto height = static_cast<float>(model::SkeletonHeader::rungs[rung]);
            Kernel kernel;
            bool hasKernel = false;
            for (const std::size_t at : std::span(places).first(count)) {
                const float excess = sign * noise[at] - height;
                if (!(excess > 0.0F)) {
                    continue;
                }
                if (!hasKernel) {
                    kernel = kernelOf(std::span<const float, atomCount>(gains.subspan(first, atomCount)));
                    hasKernel = true;
                }
                const float event = sign * scales_[rung] * excess;
                const std::size_t heard = std::min(taps, segmentSamples - at);
                for (std::size_t tap = 0; tap < heard; ++tap) {
                    struck[at + tap] += event * kernel[tap];
                }
            }
        }
    }
}

RungImpulses::Kernel RungImpulses::kernelOf(std::span<const float, atomCount> gains) const noexcept {
    Kernel kernel{};
    for (std::size_t atom = 0; atom < atomCount; ++atom) {
        const float gain = largestGain * std::tanh(gains[atom] / largestGain);
        for (std::size_t tap = 0; tap < taps; ++tap) {
            kernel[tap] += gain * atoms_[atom][tap];
        }
    }
    return kernel;
}

}  // namespace haptoflow::skeleton
