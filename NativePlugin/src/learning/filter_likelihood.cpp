#include "learning/filter_likelihood.hpp"

#include "skeleton/condition.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::learning {
namespace {

/// A filter belongs to one condition, so that a window ends before a hand's speed has changed much.
constexpr std::size_t windowSamples = 64;
constexpr std::size_t pastSamples = skeleton::filterOrder;
constexpr std::size_t speeds = 10;
constexpr std::size_t forces = 3;
constexpr std::size_t directions = 4;

/// The boundaries that divide the values into equal parts.
std::vector<double> quantiles(std::vector<double> values, std::size_t parts) {
    std::ranges::sort(values);
    std::vector<double> edges;
    for (std::size_t part = 1; part < parts; ++part) {
        edges.push_back(values[part * values.size() / parts]);
    }
    return edges;
}

std::size_t partOf(std::span<const double> edges, double value) {
    return static_cast<std::size_t>(std::ranges::upper_bound(edges, value) - edges.begin());
}

struct Window {
    std::size_t first = 0;
    std::array<double, 3> motion{};
    double speed = 0.0;
};

std::vector<Window> windowsOf(const recordings::PreparedRecording& recording, const Sliding& sliding) {
    std::vector<Window> windows;
    for (std::size_t first = pastSamples; first + windowSamples <= recording.wave.size(); first += windowSamples) {
        if (!sliding.holds(first - pastSamples, pastSamples + windowSamples)) {
            continue;
        }
        Window& window = windows.emplace_back();
        window.first = first;
        window.motion = recording.meanMotion(first, windowSamples);
        window.speed = std::hypot(window.motion[0], window.motion[1]);
    }
    return windows;
}

}  // namespace

FilterLikelihood::FilterLikelihood(const skeleton::Skeleton& skeleton, const recordings::PreparedRecording& recording,
                                   const Sliding& sliding, std::span<const float> unitWave)
    : skeleton_(skeleton), cells_(speeds * forces * directions) {
    const std::vector<Window> windows = windowsOf(recording, sliding);
    if (windows.empty()) {
        cells_.clear();
        return;
    }
    const auto valuesOf = [&](auto value) {
        std::vector<double> values(windows.size());
        std::ranges::transform(windows, values.begin(), value);
        return values;
    };
    const auto speedEdges = quantiles(valuesOf([](const Window& window) { return window.speed; }), speeds);
    const auto forceEdges = quantiles(valuesOf([](const Window& window) { return window.motion[2]; }), forces);
    for (const Window& window : windows) {
        const std::size_t direction = (window.motion[0] < 0.0 ? 1U : 0U) + (window.motion[1] < 0.0 ? 2U : 0U);
        const std::size_t cell =
            (partOf(speedEdges, window.speed) * forces + partOf(forceEdges, window.motion[2])) * directions + direction;
        add(cells_[cell], unitWave.subspan(window.first - pastSamples, pastSamples + windowSamples), window.motion);
    }
    std::erase_if(cells_, [](const Cell& cell) { return cell.samples <= 0.0; });
    for (Cell& cell : cells_) {
        samples_ += cell.samples;
        for (double& component : cell.motion) {
            component /= cell.samples;
        }
    }
}

void FilterLikelihood::add(Cell& cell, std::span<const float> wave, const std::array<double, 3>& motion) const {
    cell.samples += static_cast<double>(windowSamples);
    for (std::size_t component = 0; component < motion.size(); ++component) {
        cell.motion[component] += static_cast<double>(windowSamples) * motion[component];
    }
    for (std::size_t n = pastSamples; n < wave.size(); ++n) {
        for (std::size_t i = 0; i < size; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                cell.products[i][j] += static_cast<double>(wave[n - i]) * static_cast<double>(wave[n - j]);
            }
        }
    }
}

double FilterLikelihood::loss(const Embedding& embedding) const {
    double sum = 0.0;
    for (const Cell& cell : cells_) {
        skeleton::Motion motion{};
        std::ranges::transform(cell.motion, motion.begin(), [](double each) { return static_cast<float>(each); });
        const auto filter =
            skeleton_.filterFor(skeleton::conditionOf(embedding, motion, skeleton::phasesOf(embedding, motion, {})));
        std::array<double, size> predictor{1.0};
        std::ranges::copy(filter.coefficients, predictor.begin() + 1);
        double squares = 0.0;
        for (std::size_t i = 0; i < size; ++i) {
            double row = 0.5 * cell.products[i][i] * predictor[i];
            for (std::size_t j = 0; j < i; ++j) {
                row += cell.products[i][j] * predictor[j];
            }
            squares += 2.0 * row * predictor[i];
        }
        sum += cell.samples * filter.logGain + 0.5 * squares * std::exp(-2.0 * filter.logGain);
    }
    return samples_ > 0.0 ? sum / samples_ : 0.0;
}

}  // namespace haptoflow::learning
