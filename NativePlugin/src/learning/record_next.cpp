#include "learning/record_next.hpp"

#include "learning/texture_figures.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace haptoflow::learning {
namespace {

constexpr double slowestMps = 0.02;
constexpr double fastestMps = 0.3;
constexpr double lightestNewtons = 0.3;
constexpr double firmestNewtons = 2.0;
/// Uncertainty that is worth another recording.
constexpr double noticeableDb = 1.0;
/// Below this, chance in the frames limits the tone.
constexpr double enoughSeconds = 20.0;

struct Gap {
    double uncertaintyDb = 0.0;
    std::string sentence;
};

std::string millimetres(double metres) {
    return recordings::plainNumber(std::round(1000.0 * metres));
}

std::string newtons(double force) {
    return recordings::plainNumber(std::round(100.0 * force) / 100.0);
}

}  // namespace

std::string recordNext(const Sliding& sliding, const ExponentPrior& prior) {
    const auto [slow, usual, fast] = sliding.speedMps;
    const auto [light, medium, firm] = sliding.forceNewtons;
    const auto uncertainty = [](double spread, double ratio) { return decibelsPerNat * spread * std::log(ratio); };
    const std::array<Gap, 4> gaps{{
        {uncertainty(prior.speedSpread, fastestMps / fast), "record faster strokes, up to " + millimetres(fastestMps) +
                                                                " mm/s: above " + millimetres(fast) +
                                                                " mm/s the material is a guess"},
        {uncertainty(prior.speedSpread, slow / slowestMps), "record slower strokes, down to " +
                                                                millimetres(slowestMps) + " mm/s: below " +
                                                                millimetres(slow) + " mm/s the material is a guess"},
        {uncertainty(prior.forceSpread, firmestNewtons / firm), "press harder, up to " + newtons(firmestNewtons) +
                                                                    " N: above " + newtons(firm) +
                                                                    " N the material is a guess"},
        {uncertainty(prior.forceSpread, light / lightestNewtons), "press less, down to " + newtons(lightestNewtons) +
                                                                      " N: below " + newtons(light) +
                                                                      " N the material is a guess"},
    }};
    const Gap& widest = *std::ranges::max_element(gaps, {}, &Gap::uncertaintyDb);
    if (widest.uncertaintyDb >= noticeableDb) {
        return widest.sentence;
    }
    if (sliding.seconds < enoughSeconds) {
        return "record more of the same: " + recordings::plainNumber(enoughSeconds) +
               " s of sliding or more give a finer tone";
    }
    return {};
}

}  // namespace haptoflow::learning
