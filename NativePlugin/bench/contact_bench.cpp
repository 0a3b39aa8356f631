#include "bench/measurements.hpp"

#include "bench/distribution.hpp"
#include "headless/contact_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>
#include <utility>
#include <vector>

namespace haptoflow::bench {
namespace {

constexpr double spacingMetres = 0.05;
constexpr double topMetres = 0.02;
constexpr std::size_t turnsOfEach = 20;

headless::Shape shapeOf(std::size_t index) {
    switch (index % 3) {
        case 0:
            return headless::Box{.sizeMetres = {0.04, 2.0 * topMetres, 0.04}};
        case 1:
            return headless::Sphere{.radiusMetres = topMetres};
        default:
            return headless::Capsule{.radiusMetres = 0.01, .heightMetres = 2.0 * topMetres};
    }
}

/// Surfaces on a square grid with their tops at one height.
headless::Scene gridOfSurfaces(std::size_t surfaces) {
    const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(surfaces))));
    headless::Scene scene;
    for (std::size_t index = 0; index < surfaces; ++index) {
        headless::SceneSurface surface;
        surface.name = "surface " + std::to_string(index);
        surface.shape = shapeOf(index);
        const std::size_t row = index / columns;
        surface.pose.positionMetres = {static_cast<double>(index % columns) * spacingMetres, 0.0,
                                       static_cast<double>(row) * spacingMetres};
        surface.material = {{"wood", 1.0}};
        scene.surfaces.push_back(std::move(surface));
    }
    return scene;
}

/// A tip that moves over the grid at 0.2 m/s, half a millimetre deep in the tops.
class SlidingTip {
public:
    SlidingTip(std::size_t surfaces, std::uint64_t seed)
        : extentMetres_(spacingMetres * std::ceil(std::sqrt(static_cast<double>(surfaces)))),
          random_(seed),
          tracker_(gridOfSurfaces(surfaces)) {}

    void slide(std::size_t updates) {
        for (std::size_t update = 0; update < updates; ++update) {
            advance();
            headless::TipSample sample;
            sample.timeSeconds = seconds_;
            sample.positionMetres = tip_;
            microseconds_.push_back(microseconds * secondsOf([&] { touching_ += tracker_.update(sample).touching; }));
        }
    }

    [[nodiscard]] nlohmann::ordered_json figures(std::size_t surfaces) const {
        nlohmann::ordered_json row{{"surfaces", surfaces}};
        const nlohmann::ordered_json figures = toJson(distributionOf(microseconds_));
        row["us_per_update"] = figures["p50"];
        row.update(figures);
        const auto updates = static_cast<double>(tracker_.statistics().samples);
        row["touching_share"] = rounded(static_cast<double>(touching_) / updates);
        row["exact_queries_per_update"] = rounded(static_cast<double>(tracker_.statistics().surfaceQueries) / updates);
        return row;
    }

private:
    void advance() {
        constexpr double step = 0.2 / 90.0;
        seconds_ += 1.0 / 90.0;
        while (leftMetres_ < step) {
            std::uniform_real_distribution<double> place(0.0, extentMetres_);
            const glm::dvec3 goal{place(random_), topMetres + 0.0005, place(random_)};
            leftMetres_ = glm::length(goal - tip_);
            direction_ = (goal - tip_) / std::max(leftMetres_, 1e-9);
        }
        tip_ += direction_ * step;
        leftMetres_ -= step;
    }

    double extentMetres_;
    std::mt19937_64 random_;
    headless::ContactTracker tracker_;
    glm::dvec3 tip_{0.0, topMetres + 0.0005, 0.0};
    glm::dvec3 direction_{0.0};
    double leftMetres_ = 0.0;
    double seconds_ = 0.0;
    std::size_t touching_ = 0;
    std::vector<double> microseconds_;
};

}  // namespace

nlohmann::ordered_json measureContact(std::uint64_t seed, const BenchPlan& plan, const Advance& advance) {
    std::deque<SlidingTip> tips;
    std::vector<std::size_t> order;
    for (const std::size_t surfaces : plan.surfaces) {
        order.insert(order.end(), turnsOfEach, tips.size());
        tips.emplace_back(surfaces, seed);
    }
    std::mt19937_64 random(seed);
    std::ranges::shuffle(order, random);
    std::size_t done = 0;
    for (const std::size_t index : order) {
        tips[index].slide((plan.contactUpdates() + turnsOfEach - 1) / turnsOfEach);
        advance(static_cast<double>(++done) / static_cast<double>(order.size()));
    }
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (std::size_t index = 0; index < tips.size(); ++index) {
        rows.push_back(tips[index].figures(plan.surfaces[index]));
    }
    for (auto& row : rows) {
        row["ratio"] = ratioOf(row["us_per_update"].get<double>(), rows[0]["us_per_update"].get<double>());
    }
    return {{"contact", rows}};
}

}  // namespace haptoflow::bench
