#pragma once

#include "engine/contact_state.hpp"
#include "engine/prepared_material.hpp"
#include "inference/load_limits.hpp"
#include "model/material_file.hpp"
#include "model/model_file.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace haptoflow::engine {

/// One material of a blend and its weight.
struct Ingredient {
    const PreparedMaterial* material = nullptr;
    /// Index in contact states.
    std::uint32_t index = 0;
    double weight = 0.0;
};

/// The materials of a surface: at least one, each once, with a weight above 0.
struct Ingredients {
    std::array<Ingredient, MaterialBlend::capacity> entries{};
    std::size_t count = 0;

    [[nodiscard]] std::span<const Ingredient> all() const noexcept { return std::span(entries).first(count); }
    /// The one with the largest weight; of several, the first.
    [[nodiscard]] const Ingredient& heaviest() const noexcept;
    [[nodiscard]] double totalWeight() const noexcept;
    [[nodiscard]] bool isBlend() const noexcept { return count > 1; }
    /// RMS in m/s^2 before tone, at a motion inside the trained range: the weighted geometric mean of the materials.
    [[nodiscard]] float levelMps2(const std::array<float, 3>& motion) const noexcept;
};

/// The labels of a model and the registered materials. Any thread may register, replace and look up materials.
/// Publishers read without waiting, and a material is freed only after all its readers have finished.
class MaterialLibrary {
public:
    static constexpr std::size_t maximumRegistered = 64;
    /// Returns a level graph that no other thread uses meanwhile; called only if one is needed.
    using LevelSource = std::function<inference::LevelEstimator&()>;

    /// Tabulates the level graph for each embedding that labels use, so that touch-downs run no graph; labels with the
    /// same embedding share a table. The model must outlive the library. Throws inference::InferenceError,
    /// inference::LoadCancelled.
    MaterialLibrary(const model::ModelFile& model, inference::LevelEstimator& levels,
                    const inference::LoadLimits& limits = {});

    /// Registers a material and returns its index for contact states: the number of labels plus the number of materials
    /// registered before. Throws model::MaterialMismatch, inference::InferenceError, and std::invalid_argument if the
    /// library is full.
    std::size_t add(model::MaterialFile material, const LevelSource& levels);
    /// Replaces a registered material for all states published afterwards. Waits some microseconds for running
    /// publishers. Throws the same as `add`, and std::invalid_argument for an index without a registered material.
    void replace(std::size_t index, model::MaterialFile material, const LevelSource& levels);
    [[nodiscard]] std::size_t registeredCount() const noexcept { return count_.load(std::memory_order_acquire); }
    /// Calls `look` with the label of a registered material, which cannot be replaced meanwhile. The label lives until
    /// its material is replaced. Throws std::invalid_argument for an index without a registered material.
    void showLabel(std::size_t index, const std::function<void(const model::Label&)>& look) const;

    [[nodiscard]] const model::ModelFile& model() const noexcept { return model_; }

    /// Must exist while ingredients are in use. Wait-free.
    class ReadScope {
    public:
        explicit ReadScope(const MaterialLibrary& library) noexcept;
        ReadScope(const ReadScope&) = delete;
        ReadScope& operator=(const ReadScope&) = delete;
        ~ReadScope();

        /// Skips indices without a material; a blend without any weight becomes the first label.
        [[nodiscard]] Ingredients ingredients(const MaterialBlend& blend) const noexcept;

    private:
        const MaterialLibrary& library_;
        std::atomic<std::uint32_t>& readers_;
    };

private:
    /// Owns the data that its PreparedMaterial views.
    struct Registered {
        model::MaterialFile file;
        std::vector<float> graphLevels;
        PreparedMaterial known;
    };

    [[nodiscard]] std::unique_ptr<const Registered> prepare(model::MaterialFile material,
                                                            const LevelSource& levels) const;
    [[nodiscard]] const PreparedMaterial* find(std::uint32_t index) const noexcept;
    [[nodiscard]] std::size_t placeOf(std::size_t index) const;
    void waitForReaders() noexcept;

    const model::ModelFile& model_;
    LevelGrid grid_;
    /// Tables of the level graph, one after the other; the labels view them.
    std::vector<float> graphLevels_;
    std::vector<PreparedMaterial> labels_;

    // Held while a material is registered or replaced or a label is shown.
    mutable std::mutex mutex_;
    std::array<std::unique_ptr<const Registered>, maximumRegistered> owned_;
    // The materials of `owned_`, for publishers.
    std::array<std::atomic<const Registered*>, maximumRegistered> visible_{};
    std::atomic<std::size_t> count_{0};

    // Number of readers in each of two phases. Readers enter the open phase; `replace` closes each phase once and waits
    // until it is empty. Then all earlier readers have left, and later ones cannot delay it.
    mutable std::array<std::atomic<std::uint32_t>, 2> readers_{};
    mutable std::atomic<std::uint32_t> openPhase_{0};
};

}  // namespace haptoflow::engine
