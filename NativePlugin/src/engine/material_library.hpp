#pragma once

#include "engine/contact_state.hpp"
#include "engine/known_material.hpp"
#include "engine/onset_levels.hpp"
#include "inference/load_limits.hpp"
#include "inference/segment_generator.hpp"
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

/// One material of a blend and its share.
struct Ingredient {
    const KnownMaterial* material = nullptr;
    /// Index as a contact state names it.
    std::uint32_t index = 0;
    double weight = 0.0;
};

/// What a surface feels like: at least one material, each once, with a weight above 0.
struct Ingredients {
    std::array<Ingredient, MaterialBlend::capacity> entries{};
    std::size_t count = 0;

    [[nodiscard]] std::span<const Ingredient> all() const noexcept { return std::span(entries).first(count); }
    /// The one with the largest weight, the first of several.
    [[nodiscard]] const Ingredient& heaviest() const noexcept;
    [[nodiscard]] double totalWeight() const noexcept;
    [[nodiscard]] bool isBlend() const noexcept { return count > 1; }
    /// RMS in m/s^2 before tone at a motion inside the trained range: the weighted mean of the materials' logarithms.
    [[nodiscard]] float levelMps2(const std::array<float, 3>& motion) const noexcept;
};

/// The labels of a model and the materials that were registered beside them. Any thread may register, replace and ask;
/// publishers read without waiting, and what they may still be reading is not freed.
class MaterialLibrary {
public:
    static constexpr std::size_t maximumRegistered = 64;
    /// Gives a level graph that nobody else uses meanwhile; called only where one is needed.
    using LevelSource = std::function<inference::LevelEstimator&()>;

    /// Asks the level graph for the levels of all labels (OnsetLevels). The model must outlive the library. Throws
    /// inference::InferenceError, inference::LoadCancelled.
    MaterialLibrary(const model::ModelFile& model, inference::LevelEstimator& levels,
                    const inference::LoadLimits& limits = {});
    MaterialLibrary(const MaterialLibrary&) = delete;
    MaterialLibrary& operator=(const MaterialLibrary&) = delete;
    ~MaterialLibrary() = default;

    /// Returns the index by which contact states name it: the number of labels and of those before it. Throws
    /// model::MaterialMismatch, inference::InferenceError, std::invalid_argument where the library is full.
    std::size_t add(model::MaterialFile material, const LevelSource& levels);
    /// Takes the place of a registered one; what is published from now on is the new one. Waits for publishers that
    /// are at work, which takes microseconds. Throws the same, std::invalid_argument for an index of none.
    void replace(std::size_t index, model::MaterialFile material, const LevelSource& levels);
    [[nodiscard]] std::size_t registeredCount() const noexcept { return count_.load(std::memory_order_acquire); }
    /// Shows the label of a registered material, which lives until that is replaced; nothing is replaced meanwhile.
    /// Throws std::invalid_argument.
    void showLabel(std::size_t index, const std::function<void(const model::Label&)>& look) const;

    [[nodiscard]] const model::ModelFile& model() const noexcept { return model_; }

    /// Held while ingredients are in use. Wait-free.
    class Reading {
    public:
        explicit Reading(const MaterialLibrary& library) noexcept;
        Reading(const Reading&) = delete;
        Reading& operator=(const Reading&) = delete;
        ~Reading();

        /// Indices that nothing was registered for are left out; a blend without any weight is the first label.
        [[nodiscard]] Ingredients ingredients(const MaterialBlend& blend) const noexcept;

    private:
        const MaterialLibrary& library_;
        std::atomic<std::uint32_t>& readers_;
    };

private:
    /// Owns what its KnownMaterial views.
    struct Registered {
        model::MaterialFile file;
        std::vector<float> graphLevels;
        KnownMaterial known;
    };

    [[nodiscard]] KnownMaterial knownLabel(std::size_t label) const;
    [[nodiscard]] std::unique_ptr<const Registered> prepare(model::MaterialFile material,
                                                            const LevelSource& levels) const;
    [[nodiscard]] const KnownMaterial& nearestLabel(std::span<const float, model::embeddingSize> embedding) const;
    [[nodiscard]] const KnownMaterial* find(std::uint32_t index) const noexcept;
    [[nodiscard]] std::size_t placeOf(std::size_t index) const;
    void waitForReaders() noexcept;

    const model::ModelFile& model_;
    OnsetLevels levels_;
    std::vector<KnownMaterial> labels_;

    // Held by whoever registers, replaces or asks for a label.
    mutable std::mutex mutex_;
    std::array<std::unique_ptr<const Registered>, maximumRegistered> owned_;
    // What publishers see of `owned_`.
    std::array<std::atomic<const Registered*>, maximumRegistered> visible_{};
    std::atomic<std::size_t> count_{0};

    // Readers enter the phase that is open; a replacement closes each phase once and waits until it is empty. Those who
    // came before have then left, and newcomers never hold it up.
    mutable std::array<std::atomic<std::uint32_t>, 2> readers_{};
    mutable std::atomic<std::uint32_t> openPhase_{0};
};

}  // namespace haptoflow::engine
