#include "engine/surface_wander.hpp"

#include "inference/hashed_numbers.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace haptoflow::engine {
namespace {

constexpr std::uint64_t waves = 12;
constexpr std::uint64_t numbersPerWave = 4;
constexpr double octaves = 0.5;
// A surface cuts the waves at an angle, which makes them longer. This restores the mean square slope that waves within
// the surface have: 2/3 of a direction's square lies in a plane, half of it along a path.
const double shortening = std::sqrt(1.5);

}  // namespace

WanderPoint surfaceWander(std::uint64_t key, double wavelengthMetres, const inference::SurfacePath& path) noexcept {
    constexpr double wholeTurn = 2.0 * std::numbers::pi;
    const double size = std::sqrt(2.0 / static_cast<double>(waves));
    WanderPoint point;
    for (std::uint64_t wave = 0; wave < waves; ++wave) {
        std::array<double, numbersPerWave> drawn{};
        for (std::size_t number = 0; number < numbersPerWave; ++number) {
            drawn[number] = inference::fractionOf(key, wave * numbersPerWave + number);
        }
        // Uniform on the sphere: height and angle are independent.
        const double height = 2.0 * drawn[0] - 1.0;
        const double across = std::sqrt(1.0 - height * height);
        const double turn = wholeTurn * drawn[1];
        const double cycles = shortening * std::exp2(octaves * (2.0 * drawn[2] - 1.0)) / wavelengthMetres;
        const std::array<double, 3> direction{across * std::cos(turn), across * std::sin(turn), height};
        double phase = drawn[3];
        double step = 0.0;
        for (std::size_t axis = 0; axis < direction.size(); ++axis) {
            phase += cycles * direction[axis] * path.startMetres[axis];
            step += cycles * direction[axis] * path.stepMetres[axis];
        }
        const double angle = wholeTurn * (phase - std::floor(phase));
        point.value += size * std::cos(angle);
        point.changePerSample -= size * wholeTurn * step * std::sin(angle);
    }
    return point;
}

}  // namespace haptoflow::engine
