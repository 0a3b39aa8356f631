#include "learning/embedding_search.hpp"

#include "learning/numerics.hpp"
#include "skeleton/condition.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

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

namespace {

constexpr std::size_t freeNumbers = inference::embeddingSize - 2 * inference::ribCount;

}  // namespace

EmbeddingSpace::EmbeddingSpace(const model::ModelFile& model,
                               std::span<const float, 2 * inference::ribCount> waveVectors)
    : model_(model), mean_(freeNumbers) {
    std::ranges::copy(waveVectors, waveVectors_.begin());
    const std::size_t labels = model.header().labels.size();
    const auto count = static_cast<double>(labels);
    for (std::size_t label = 0; label < labels; ++label) {
        for (std::size_t i = 0; i < freeNumbers; ++i) {
            mean_[i] += model.embedding(label)[i] / count;
        }
    }
    SymmetricMatrix covariance(freeNumbers);
    for (std::size_t label = 0; label < labels; ++label) {
        const auto row = model.embedding(label);
        for (std::size_t i = 0; i < freeNumbers; ++i) {
            for (std::size_t j = 0; j < freeNumbers; ++j) {
                covariance.at(i, j) += (row[i] - mean_[i]) * (row[j] - mean_[j]) / count;
            }
        }
    }
    EigenDecomposition axes = decompose(std::move(covariance));
    for (std::size_t axis = 0; axis < std::min({maximumAxes, labels - std::min<std::size_t>(labels, 1), freeNumbers});
         ++axis) {
        if (axes.values[axis] <= 1e-6 * axes.values[0]) {
            break;
        }
        spreads_.push_back(std::sqrt(axes.values[axis]));
        axes_.push_back(std::move(axes.vectors[axis]));
    }
}

std::vector<double> EmbeddingSpace::coordinatesOf(const Embedding& embedding) const {
    std::vector<double> coordinates(axes_.size());
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        for (std::size_t i = 0; i < freeNumbers; ++i) {
            coordinates[axis] += (embedding[i] - mean_[i]) * axes_[axis][i] / spreads_[axis];
        }
    }
    return coordinates;
}

Embedding EmbeddingSpace::at(const Embedding& base, std::span<const double> coordinates) const {
    const std::vector<double> own = coordinatesOf(base);
    Embedding result = base;
    for (std::size_t i = 0; i < freeNumbers; ++i) {
        double value = base[i];
        for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
            value += (coordinates[axis] - own[axis]) * spreads_[axis] * axes_[axis][i];
        }
        result[i] = static_cast<float>(value);
    }
    return result;
}

Embedding EmbeddingSpace::ofLabel(std::size_t label) const {
    Embedding result{};
    std::ranges::copy(model_.embedding(label), result.begin());
    std::ranges::copy(waveVectors_, result.begin() + freeNumbers);
    return result;
}

namespace {

constexpr std::size_t population = 12;
constexpr double firstStep = 0.45;
/// Weight that draws coordinates to the labels' mean, in dB^2 per squared standard deviation.
constexpr double shrinkage = 0.06;
/// Segments of one chain of the fit; see TextureFit::distances.
constexpr std::uint64_t segmentsPerChain = 8;
/// Samples that the mean likelihood counts as. So few, because the tone says what the recording's spectrum is: an
/// embedding far from all labels, which fits the recorded conditions a little better, is worse in all others.
constexpr double likelihoodWeight = 10.0;
/// A generation of likelihoods takes as long as these.
constexpr std::uint64_t segmentsPerGeneration = 280;

std::vector<double> manyDistances(TextureFit& fit, const Embedding& start, const Embedding& fitted) {
    const std::size_t chains = 6 * fit.bins().count();
    const std::array<Embedding, 2> both{start, fitted};
    return fit.distances(both, chains, 1'000'000 / chains);
}

}  // namespace

std::size_t startLabel(TextureFit& fit, const EmbeddingSpace& space, const std::vector<model::Label>& labels,
                       const SearchSettings& settings) {
    constexpr std::size_t labelsAtOnce = 32;
    const auto share = static_cast<std::uint64_t>(0.15 * static_cast<double>(settings.segmentBudget));
    const auto chains = static_cast<std::size_t>(
        std::clamp<std::uint64_t>(share / (labels.size() * segmentsPerChain), 4, 4 * fit.bins().count()));
    std::vector<double> distances;
    for (std::size_t first = 0; first < labels.size(); first += labelsAtOnce) {
        std::vector<Embedding> embeddings;
        for (std::size_t label = first; label < std::min(labels.size(), first + labelsAtOnce); ++label) {
            embeddings.push_back(space.ofLabel(label));
        }
        settings.progress(static_cast<double>(first) / static_cast<double>(labels.size()));
        if (first > 0 && settings.isOver()) {
            break;
        }
        const std::vector<double> part = fit.distances(embeddings, chains, 0);
        distances.insert(distances.end(), part.begin(), part.end());
    }
    std::vector<std::size_t> eligible;
    for (std::size_t label = 0; label < distances.size(); ++label) {
        if (!settings.needsRibs || labels[label].wavelengthMetres) {
            eligible.push_back(label);
        }
    }
    if (eligible.empty()) {
        eligible.resize(distances.size());
        std::iota(eligible.begin(), eligible.end(), std::size_t{0});
    }
    return *std::ranges::min_element(eligible, {}, [&](std::size_t label) { return distances[label]; });
}

FittedEmbedding fitEmbedding(TextureFit& fit, const EmbeddingSpace& space, const Embedding& start,
                             const SearchSettings& settings) {
    const std::size_t chains = std::max<std::size_t>(12, 3 * fit.bins().count());
    const std::uint64_t generations = settings.segmentBudget / (population * chains * segmentsPerChain);
    FittedEmbedding result;
    Embedding fitted = start;
    if (space.axisCount() > 0 && generations > 0) {
        EvolutionStrategy strategy(space.coordinatesOf(start), firstStep, population, settings.seed + 1);
        for (std::uint64_t generation = 0; generation < generations; ++generation) {
            settings.progress(static_cast<double>(generation) / static_cast<double>(generations));
            if (settings.isOver()) {
                break;
            }
            const std::vector<std::vector<double>>& points = strategy.ask();
            std::vector<Embedding> embeddings;
            embeddings.reserve(points.size());
            for (const std::vector<double>& point : points) {
                embeddings.push_back(space.at(start, point));
            }
            std::vector<double> scores = fit.distances(embeddings, chains, generation + 1);
            for (std::size_t k = 0; k < scores.size(); ++k) {
                for (const double coordinate : points[k]) {
                    scores[k] += shrinkage * coordinate * coordinate;
                }
            }
            strategy.tell(scores);
            ++result.generations;
        }
        fitted = space.at(start, strategy.mean());
    }
    const std::vector<double> distances = manyDistances(fit, start, fitted);
    result.embedding = distances[1] < distances[0] ? fitted : start;
    result.startDistanceDb = std::sqrt(distances[0]);
    result.distanceDb = std::sqrt(std::min(distances[0], distances[1]));
    return result;
}

std::size_t likeliestLabel(const FilterLikelihood& likelihood, const EmbeddingSpace& space, std::size_t labels) {
    std::vector<double> losses;
    for (std::size_t label = 0; label < labels; ++label) {
        losses.push_back(likelihood.loss(space.ofLabel(label)));
    }
    return static_cast<std::size_t>(std::ranges::min_element(losses) - losses.begin());
}

FittedEmbedding likeliestEmbedding(const FilterLikelihood& likelihood, TextureFit& fit, const EmbeddingSpace& space,
                                   const Embedding& start, const SearchSettings& settings) {
    const std::uint64_t generations = settings.segmentBudget / segmentsPerGeneration;
    FittedEmbedding result{.embedding = start};
    if (space.axisCount() > 0) {
        EvolutionStrategy strategy(space.coordinatesOf(start), firstStep, population, settings.seed + 1);
        while (result.generations < generations && !settings.isOver()) {
            settings.progress(static_cast<double>(result.generations) / static_cast<double>(generations));
            std::vector<double> losses;
            for (const std::vector<double>& point : strategy.ask()) {
                const double distance = std::inner_product(point.begin(), point.end(), point.begin(), 0.0);
                losses.push_back(likelihoodWeight * likelihood.loss(space.at(start, point)) + 0.5 * distance);
            }
            strategy.tell(losses);
            ++result.generations;
        }
        result.embedding = space.at(start, strategy.mean());
    }
    const std::vector<double> distances = manyDistances(fit, start, result.embedding);
    result.startDistanceDb = std::sqrt(distances[0]);
    result.distanceDb = std::sqrt(distances[1]);
    return result;
}

double frequencyExponent(const SpeedBins& bins, std::span<const TextureFigures> recorded, const model::Label& start) {
    constexpr double priorSpread = 0.1;
    constexpr double centroidSpread = 0.08;
    const double prior = start.wavelengthMetres ? 0.1 : start.frequencyExponent;
    std::vector<double> x;
    std::vector<double> y;
    for (std::size_t bin = 0; bin < bins.count(); ++bin) {
        double power = 0.0;
        double logs = 0.0;
        for (std::size_t i = 3; i < spectrumBins / 2; ++i) {
            power += recorded[bin].power[i];
            logs += recorded[bin].power[i] * std::log(static_cast<double>(i));
        }
        if (power > 0.0) {
            x.push_back(std::log(bins.centresMps[bin]));
            y.push_back(logs / power);
        }
    }
    const auto count = static_cast<double>(std::max<std::size_t>(x.size(), 1));
    const double meanX = std::accumulate(x.begin(), x.end(), 0.0) / count;
    const double meanY = std::accumulate(y.begin(), y.end(), 0.0) / count;
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        squares += (x[i] - meanX) * (x[i] - meanX);
        products += (x[i] - meanX) * (y[i] - meanY);
    }
    const double trust = squares / (centroidSpread * centroidSpread);
    const double priorTrust = 1.0 / (priorSpread * priorSpread);
    const double slope = squares > 0.0 ? products / squares : prior;
    return std::clamp((trust * slope + priorTrust * prior) / (trust + priorTrust), 0.0, 1.0);
}

namespace {

constexpr std::array<float, 7> factors{0.0F, 0.5F, 1.0F, 1.5F, 2.0F, 3.0F, 4.0F};

double kurtosisDistance(const TextureFigures& recorded, const TextureFigures& generated) {
    const double difference = generated.logKurtosis - recorded.logKurtosis;
    return difference * difference;
}

}  // namespace

float fitImpulseGain(TextureFit& fit, const Embedding& embedding, const std::function<void(double)>& progress) {
    std::vector<double> distances;
    for (const float factor : factors) {
        progress(static_cast<double>(distances.size()) / static_cast<double>(factors.size()));
        distances.push_back(meanOverSpeeds(fit.recorded(), fit.figuresOf(embedding, factor), kurtosisDistance));
    }
    return factors[static_cast<std::size_t>(std::ranges::min_element(distances) - distances.begin())];
}

}  // namespace haptoflow::learning
