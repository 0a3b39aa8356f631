#include "skeleton/gaussian_noise.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace haptoflow::skeleton {
namespace {

// The last bit of the C library's log, sin and cos differs between platforms, and so would a render. The series below
// use only +, -, *, / and std::sqrt, which are correctly rounded everywhere.

/// Natural logarithm of a positive normal number, from 2 artanh((m - 1) / (m + 1)) with m in [sqrt(1/2), sqrt(2)).
double portableLog(double value) noexcept {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    auto exponent = static_cast<int>(bits >> 52U) - 1023;
    double mantissa = std::bit_cast<double>((bits & 0xFFFFFFFFFFFFFU) | 0x3FF0000000000000U);
    if (mantissa > std::numbers::sqrt2) {
        mantissa *= 0.5;
        ++exponent;
    }
    const double ratio = (mantissa - 1.0) / (mantissa + 1.0);
    const double square = ratio * ratio;
    double series = 0.0;
    for (int power = 21; power >= 1; power -= 2) {
        series = series * square + 1.0 / power;
    }
    return 2.0 * ratio * series + exponent * std::numbers::ln2;
}

struct Direction {
    double cosine = 1.0;
    double sine = 0.0;
};

/// Unit vector at the angle 2 pi (turns - 1/8). The offset does not matter for a random direction and keeps the
/// argument of the series within +-pi/4.
Direction portableDirection(double cycles) noexcept {
    const auto quadrant = static_cast<int>(cycles * 4.0);
    const double angle = (cycles * 4.0 - quadrant - 0.5) * (std::numbers::pi / 2.0);
    const double square = angle * angle;
    double cosine = 1.0;
    double sine = 1.0;
    for (int order = 16; order >= 2; order -= 2) {
        cosine = 1.0 - cosine * square / (order * (order - 1));
        sine = 1.0 - sine * square / (order * (order + 1));
    }
    sine *= angle;
    switch (quadrant) {
        case 0:
            return {cosine, sine};
        case 1:
            return {-sine, cosine};
        case 2:
            return {-cosine, -sine};
        default:
            return {sine, -cosine};
    }
}

/// Philox-4x32 with ten rounds: 128 random bits for a 128-bit counter and a 64-bit key.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) noexcept {
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t even = std::uint64_t{0xD2511F53} * counter[0];
        const std::uint64_t odd = std::uint64_t{0xCD9E8D57} * counter[2];
        counter = {static_cast<std::uint32_t>(odd >> 32U) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(odd),
                   static_cast<std::uint32_t>(even >> 32U) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(even)};
        key[0] += 0x9E3779B9U;
        key[1] += 0xBB67AE85U;
    }
    return counter;
}

/// A number in (0, 1): the middle of one of 2^52 equal intervals.
double openUnit(std::uint32_t high, std::uint32_t low) noexcept {
    const std::uint64_t bits = (std::uint64_t{high} << 32U | low) >> 12U;
    return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}

std::array<float, 2> normalPair(const NoiseKey& key, std::uint32_t block) noexcept {
    const auto random = philox(
        {block, key.voice, static_cast<std::uint32_t>(key.segment), static_cast<std::uint32_t>(key.segment >> 32U)},
        {static_cast<std::uint32_t>(key.seed), static_cast<std::uint32_t>(key.seed >> 32U)});
    const double radius = std::sqrt(-2.0 * portableLog(openUnit(random[0], random[1])));
    const Direction direction = portableDirection(openUnit(random[2], random[3]));
    return {static_cast<float>(radius * direction.cosine), static_cast<float>(radius * direction.sine)};
}

}  // namespace

void fillStandardNormal(const NoiseKey& key, std::span<float> noise, std::uint64_t first) noexcept {
    std::size_t index = 0;
    while (index < noise.size()) {
        const std::uint64_t position = first + index;
        const auto pair = normalPair(key, static_cast<std::uint32_t>(position / 2));
        for (std::size_t place = position % 2; place < pair.size() && index < noise.size(); ++place, ++index) {
            noise[index] = pair[place];
        }
    }
}

}  // namespace haptoflow::skeleton
