#include "learning/numerics.hpp"
#include "learning/embedding_search.hpp"
#include "model/model_file.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/gaussian_noise.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace haptoflow::learning {
namespace {

TEST(LinearAlgebraTest, ASingularMatrixGivesFiniteNumbers) {
    SymmetricMatrix matrix(2);
    matrix.at(0, 0) = 1.0;
    for (const double value : solvePositive(matrix, {1.0, 0.0})) {
        EXPECT_TRUE(std::isfinite(value));
    }
}

/// A rotated ellipsoid, a hundred times longer than wide, with its minimum at (1, -2, 0.5, 0).
double valley(const std::vector<double>& point) {
    const double a = point[0] - 1.0 + point[1] + 2.0;
    const double b = point[0] - 1.0 - (point[1] + 2.0);
    const double c = point[2] - 0.5;
    return 100.0 * a * a + 0.01 * b * b + c * c + point[3] * point[3];
}

TEST(EvolutionStrategyTest, TheMinimumOfARotatedEllipsoidIsFound) {
    EvolutionStrategy strategy({0.0, 0.0, 0.0, 1.0}, 0.5, 10, 3);
    for (int generation = 0; generation < 200; ++generation) {
        std::vector<double> scores;
        for (const std::vector<double>& point : strategy.ask()) {
            scores.push_back(valley(point));
        }
        strategy.tell(scores);
    }
    const std::vector<double>& found = strategy.mean();
    EXPECT_LT(valley(found), 1e-6);
    EXPECT_NEAR(found[0], 1.0, 1e-2);
    EXPECT_NEAR(found[1], -2.0, 1e-2);
}

TEST(ConditionBasisTest, BeyondTheRecordingEveryFunctionIsConstant) {
    std::vector<SpectrumFrame> frames(101);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        frames[i].speedMps = 0.02 * std::pow(10.0, static_cast<double>(i) / 100.0);
        frames[i].forceNewtons = 1.0;
    }
    const ConditionBasis basis(frames);
    EXPECT_EQ(basis.at(0.001, 1.0), basis.at(0.02, 1.0));
    EXPECT_EQ(basis.at(5.0, 1.0), basis.at(0.2, 1.0));
    EXPECT_NE(basis.at(0.05, 1.0), basis.at(0.1, 1.0));
    EXPECT_EQ(basis.at(0.05, 0.1), basis.at(0.05, 9.0)) << "a force that does not change";
    EXPECT_EQ(basis.at(0.05, 0.0).size(), basis.count());
}

TEST(GammaRegressionTest, TheMeanIsKeptWhereLeastSquaresOfLogarithmsWouldFallShort) {
    std::mt19937 random(3);
    std::exponential_distribution<double> chance(1.0);
    std::vector<double> values;
    std::vector<double> rows;
    for (int i = 0; i < 4000; ++i) {
        const double x = static_cast<double>(i % 41) / 20.0 - 1.0;
        values.push_back(std::exp(1.5 + 0.8 * x) * chance(random));
        rows.insert(rows.end(), {1.0, x});
    }
    const std::vector<double> found = gammaRegression(values, rows, std::vector<double>{10.0, 10.0}, 1.0);
    EXPECT_NEAR(found[0], 1.5, 0.06);
    EXPECT_NEAR(found[1], 0.8, 0.1);
}

TEST(GammaRegressionTest, FarOutliersAndANarrowPriorStayFinite) {
    const std::vector<double> values{1e-9, 1e9, 1.0};
    const std::vector<double> rows{1.0, 1.0, 1.0};
    EXPECT_TRUE(std::isfinite(gammaRegression(values, rows, std::vector<double>{10.0}, 1.0)[0]));
    EXPECT_NEAR(gammaRegression(values, rows, std::vector<double>{1e-6}, 1.0)[0], 0.0, 1e-3);
}

constexpr std::size_t order = skeleton::filterOrder;

/// A motion whose speed, force and direction change, and the shipped model's skeleton.
class FilterLikelihoodTest : public ::testing::Test {
protected:
    FilterLikelihoodTest() {
        constexpr std::size_t samples = 20'000;
        recording_.bandwidthHz = 1000.0;
        recording_.isUsable.assign(samples, 1);
        recording_.wave.assign(samples, 0.0F);
        for (std::size_t i = 0; i < samples; ++i) {
            const double seconds = static_cast<double>(i) / inference::waveformRateHz;
            const double speed = 0.09 + 0.06 * std::sin(1.3 * seconds);
            recording_.motion.push_back({static_cast<float>(speed * std::cos(0.4 * seconds)),
                                         static_cast<float>(speed * std::sin(0.4 * seconds)),
                                         static_cast<float>(1.2 + 0.6 * std::sin(0.7 * seconds))});
        }
        sliding_ = findSliding(recording_, model_.header());
    }

    [[nodiscard]] Embedding embedding(std::size_t label) const {
        Embedding result{};
        std::ranges::copy(model_.embedding(label), result.begin());
        std::fill(result.end() - 2 * inference::ribCount, result.end(), 0.0F);
        return result;
    }

    [[nodiscard]] skeleton::ReflectionFilter filterAt(const Embedding& embedding,
                                                      const skeleton::Motion& motion) const {
        return skeleton_->filterFor(
            skeleton::conditionOf(embedding, motion, skeleton::phasesOf(embedding, motion, {})));
    }

    /// White noise through the embedding's own filter, which changes with the motion.
    [[nodiscard]] std::vector<float> waveOf(const Embedding& embedding) const {
        std::vector<float> wave(recording_.wave.size());
        skeleton::fillStandardNormal({.seed = 3, .voice = 0, .segment = 0}, wave);
        skeleton::ReflectionFilter filter;
        for (std::size_t n = 0; n < wave.size(); ++n) {
            if (n % 50 == 0) {
                filter = filterAt(embedding, recording_.motion[n]);
            }
            double sample = std::exp(filter.logGain) * static_cast<double>(wave[n]);
            for (std::size_t i = 1; i <= std::min(n, order); ++i) {
                sample -= filter.coefficients[i - 1] * static_cast<double>(wave[n - i]);
            }
            wave[n] = static_cast<float>(sample);
        }
        return wave;
    }

    model::ModelFile model_ = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    std::shared_ptr<const skeleton::Skeleton> skeleton_ = skeleton::readSkeleton(model_);
    recordings::PreparedRecording recording_;
    Sliding sliding_;
};

TEST_F(FilterLikelihoodTest, AWaveIsTheMostProbableForTheLabelWhoseFilterMadeIt) {
    for (const std::size_t made : {0U, 3U, 7U, 15U}) {
        const std::vector<float> wave = waveOf(embedding(made));
        const FilterLikelihood likelihood(*skeleton_, recording_, sliding_, wave);
        const double own = likelihood.loss(embedding(made));
        for (std::size_t label = 0; label < model_.header().labels.size(); ++label) {
            if (label != made) {
                EXPECT_LT(own, likelihood.loss(embedding(label))) << made << " and " << label;
            }
        }
    }
}

TEST_F(FilterLikelihoodTest, AtASteadyMotionTheLossIsThatOfThePredictionErrors) {
    std::ranges::fill(recording_.motion, std::array<float, 3>{0.08F, 0.02F, 1.1F});
    sliding_ = findSliding(recording_, model_.header());
    const std::vector<float> wave = waveOf(embedding(2));
    const FilterLikelihood likelihood(*skeleton_, recording_, sliding_, wave);
    const auto filter = filterAt(embedding(5), recording_.motion[0]);
    double squares = 0.0;
    const auto end = order + static_cast<std::size_t>(likelihood.samples());
    ASSERT_GT(end, 19'000U);
    for (std::size_t n = order; n < end; ++n) {
        double error = wave[n];
        for (std::size_t i = 1; i <= order; ++i) {
            error += filter.coefficients[i - 1] * static_cast<double>(wave[n - i]);
        }
        squares += error * error;
    }
    const double expected = filter.logGain + 0.5 * squares / likelihood.samples() * std::exp(-2.0 * filter.logGain);
    EXPECT_NEAR(likelihood.loss(embedding(5)), expected, 1e-5);
}

TEST_F(FilterLikelihoodTest, SamplesThatDoNotSlideDoNotCount) {
    std::vector<float> wave = waveOf(embedding(4));
    const double loss = FilterLikelihood(*skeleton_, recording_, sliding_, wave).loss(embedding(4));
    for (std::size_t n = 8000; n < 9000; ++n) {
        recording_.isUsable[n] = 0;
        wave[n] = 100.0F;
    }
    sliding_ = findSliding(recording_, model_.header());
    EXPECT_NEAR(FilterLikelihood(*skeleton_, recording_, sliding_, wave).loss(embedding(4)), loss, 0.01);
}

TEST_F(FilterLikelihoodTest, ARecordingWithoutAStretchThatSlidesSaysNothing) {
    std::ranges::fill(sliding_.before, 0U);
    const FilterLikelihood likelihood(*skeleton_, recording_, sliding_, waveOf(embedding(0)));
    EXPECT_EQ(likelihood.samples(), 0.0);
    EXPECT_EQ(likelihood.loss(embedding(0)), 0.0);
}

}  // namespace
}  // namespace haptoflow::learning
