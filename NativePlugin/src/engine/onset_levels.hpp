#pragma once

#include "engine/contact_state.hpp"
#include "inference/load_limits.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace haptoflow::engine {

/// The model's level for every label, tabulated over speed, direction and force, so that a touch-down can level its
/// seed without running a graph. Immutable after construction: any thread.
class OnsetLevels {
public:
    /// Asks the generator's level graph 640 times for each material embedding that a label names; labels that name the
    /// same one share its table. Throws inference::InferenceError, inference::LoadCancelled.
    OnsetLevels(const model::ModelFile& model, inference::SegmentGenerator& generator,
                const inference::LoadLimits& limits = {});

    /// RMS in m/s^2 at `motion` (vx, vy in m/s, force in N, inside the trained range): interpolated in the logarithms
    /// of speed and force, linearly in direction; labels of a blend by the weighted mean of their logarithms. Labels
    /// that the model does not have are left out; a blend without any weight is the first label.
    [[nodiscard]] float at(const MaterialBlend& blend, const std::array<float, 3>& motion) const noexcept;

private:
    static constexpr std::size_t speeds = 10;
    static constexpr std::size_t directions = 8;
    static constexpr std::size_t forces = 8;
    static constexpr std::size_t pointsOfLabel = speeds * directions * forces;

    /// Points spread evenly over a logarithm.
    struct Axis {
        double lowest = 0.0;
        double highest = 0.0;
        [[nodiscard]] double value(double place) const noexcept;
        [[nodiscard]] double place(double value, std::size_t points) const noexcept;
    };

    [[nodiscard]] std::array<float, 3> motionOf(std::size_t point) const noexcept;
    [[nodiscard]] double logLevel(std::size_t label, const std::array<float, 3>& motion) const noexcept;

    Axis speed_;
    Axis force_;
    /// Of each label, where its levels begin.
    std::vector<std::size_t> tables_;
    std::vector<float> logLevels_;
};

}  // namespace haptoflow::engine
