#include "engine/tap_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace haptoflow::engine {
namespace {

using effects::ImpactResponse;

constexpr double penKilograms = 0.015;
constexpr double contactRadiusMetres = 0.0005;
constexpr double tipYoungPa = 3e9;
constexpr double poisson = 0.3;
constexpr double supportPerSecond = 60.0;
constexpr double tipLossFactor = 0.1;
constexpr double feltAnchorHz = 100.0;
constexpr double feltExponent = 0.404;
constexpr double shareLeftByTheHand = 0.15;
constexpr double upperModeShare = 0.3;

// clang-format off
constexpr std::array pieces{
    //        label         category    N/m      E, Pa    kg/m^3  h, m     L, m   eta
    TapPiece{"wood",       "wood",      1200.0, 10.0e9,  600.0,  0.018,   0.50,  0.020},  // board of a table
    TapPiece{"plywood",    "wood",      1000.0,  7.0e9,  600.0,  0.009,   0.45,  0.025},  // panel
    TapPiece{"stone",      "stone",     4000.0, 50.0e9, 2650.0,  0.040,   0.40,  0.006},  // granite slab
    TapPiece{"concrete",   "stone",     4000.0, 28.0e9, 2300.0,  0.050,   0.40,  0.012},  // paving slab
    TapPiece{"brick",      "stone",     3500.0, 14.0e9, 1900.0,  0.065,   0.215, 0.015},  // one brick
    TapPiece{"ceramic",    "ceramic",   4000.0, 65.0e9, 2300.0,  0.006,   0.10,  0.005},  // wall tile
    TapPiece{"glass",      "glass",     5000.0, 70.0e9, 2500.0,  0.006,   0.30,  0.004},  // shelf
    TapPiece{"metal",      "metal",     5000.0, 200.0e9, 7850.0, 0.003,   0.15,  0.002},  // steel plate
    TapPiece{"metal mesh", "metal",     3000.0, 20.0e9, 2500.0,  0.0008,  0.15,  0.200},  // woven, wires rub
    TapPiece{"plastic",    "plastic",    900.0,  2.5e9, 1100.0,  0.0025,  0.20,  0.050},  // panel of a housing
    TapPiece{"rubber",     "plastic",    300.0,  5.0e6, 1100.0,  0.006,   0.0,   0.250},  // mat
    TapPiece{"leather",    "leather",    400.0, 20.0e6,  900.0,  0.002,   0.0,   0.150},
    TapPiece{"cotton",     "fabric",     250.0,  0.4e6,  300.0,  0.002,   0.0,   0.600},  // threads rub
    TapPiece{"corduroy",   "fabric",     300.0,  0.8e6,  350.0,  0.003,   0.0,   0.900},
    TapPiece{"jute",       "fabric",     350.0,  1.5e6,  450.0,  0.002,   0.0,   0.400},
    TapPiece{"fur",        "fur",        100.0,  0.02e6, 100.0,  0.020,   0.0,   1.000},
    TapPiece{"paper",      "paper",      800.0, 10.0e6,  800.0,  0.005,   0.0,   0.080},  // pad
    TapPiece{"cardboard",  "paper",      500.0,  0.5e9,  150.0,  0.004,   0.40,  0.060},  // corrugated, side of a box
    TapPiece{"sandpaper",  "sandpaper", 3000.0,  0.2e9, 1500.0,  0.001,   0.0,   0.100},  // glued to a block
    TapPiece{"carpet",     "carpet",     150.0,  0.1e6,  200.0,  0.008,   0.0,   0.800},
};
// clang-format on

struct CoupledMode {
    double frequencyHz = 0.0;
    /// The pen's share in the mode's energy, 0 to 1.
    double penShare = 1.0;
};

double contactStiffness(const TapPiece& piece) noexcept {
    const double compliance = (1.0 - poisson * poisson) * (1.0 / piece.youngPa + 1.0 / tipYoungPa);
    return 2.0 * contactRadiusMetres / compliance;
}

/// Lower and upper mode of the pen on its contact's spring on the plate.
std::array<CoupledMode, 2> coupledModes(const TapPiece& piece) noexcept {
    const double own = contactStiffness(piece) / penKilograms;
    if (!(piece.sideMetres > 0.0)) {
        return {CoupledMode{.frequencyHz = std::sqrt(own) / (2.0 * std::numbers::pi)}, CoupledMode{}};
    }
    const double area = piece.sideMetres * piece.sideMetres;
    const double mass = 0.25 * piece.densityKgPerM3 * piece.thicknessMetres * area;
    const double plateHz = std::numbers::pi * piece.thicknessMetres / area *
                           std::sqrt(piece.youngPa / (12.0 * piece.densityKgPerM3 * (1.0 - poisson * poisson)));
    const double plate = std::pow(2.0 * std::numbers::pi * plateHz, 2.0) + contactStiffness(piece) / mass;
    const double coupling = contactStiffness(piece) / std::sqrt(penKilograms * mass);
    const double middle = 0.5 * (own + plate);
    const double spread = std::hypot(0.5 * (own - plate), coupling);
    const double upperShare = 0.5 * (1.0 + 0.5 * (own - plate) / spread);
    return {CoupledMode{std::sqrt(middle - spread) / (2.0 * std::numbers::pi), 1.0 - upperShare},
            CoupledMode{std::sqrt(middle + spread) / (2.0 * std::numbers::pi), upperShare}};
}

ImpactResponse::Mode feltMode(double frequencyHz, double lossFactor, double share) noexcept {
    const double felt = feltAnchorHz * std::pow(frequencyHz / feltAnchorHz, feltExponent);
    return {.frequencyHz = static_cast<float>(felt),
            .decayPerSecond = static_cast<float>(supportPerSecond + std::numbers::pi * lossFactor * frequencyHz),
            .gainPerSecond = static_cast<float>(shareLeftByTheHand * share * 2.0 * std::numbers::pi * felt)};
}

struct Category {
    std::string_view name;
    std::string_view ofPieces;
};

/// Categories of the Cluster Haptic Texture Dataset that have other names here.
constexpr std::array categories{
    Category{"polymer", "plastic"},      Category{"cloth", "fabric"},      Category{"biodegradable", "leather"},
    Category{"biodegradable", "fabric"}, Category{"biodegradable", "fur"}, Category{"composite", "plastic"},
    Category{"composite", "sandpaper"},
};

bool isOfCategory(const TapPiece& piece, std::string_view category) noexcept {
    return piece.category == category || std::ranges::any_of(categories, [&](const Category& each) {
               return each.name == category && each.ofPieces == piece.category;
           });
}

double distance(double stiffness, double other) noexcept {
    return std::abs(std::log(stiffness / other));
}

using effects::ImpactResponse;
static_assert(ImpactResponse::modeCount == model::Impact::maximumModes);

/// Weighted sums of one mode over the labels of a blend.
struct MeanMode {
    double weight = 0.0;
    double logFrequency = 0.0;
    double logDecay = 0.0;
    double gain = 0.0;

    void add(double share, const ImpactResponse::Mode& mode) noexcept {
        if (!(mode.frequencyHz > 0.0F && mode.decayPerSecond > 0.0F)) {
            return;
        }
        weight += share;
        logFrequency += share * std::log(static_cast<double>(mode.frequencyHz));
        logDecay += share * std::log(static_cast<double>(mode.decayPerSecond));
        gain += share * static_cast<double>(mode.gainPerSecond);
    }

    /// `total` is the weight of all labels. Labels without this mode make it weaker.
    [[nodiscard]] ImpactResponse::Mode mode(double total) const noexcept {
        if (!(weight > 0.0)) {
            return {};
        }
        return {.frequencyHz = static_cast<float>(std::exp(logFrequency / weight)),
                .decayPerSecond = static_cast<float>(std::exp(logDecay / weight)),
                .gainPerSecond = static_cast<float>(gain / total)};
    }
};

double stiffnessHz(const model::Label& label) noexcept {
    return std::clamp(5.0 * std::sqrt(label.stiffnessNewtonsPerMetre), 25.0, 450.0);
}

/// Whether the header's main mode repeats what follows from the stiffness, rounded as training writes it.
bool statesOnlyStiffness(const model::Label& label) noexcept {
    return !label.impact || std::abs(label.impact->modes[0].frequencyHz - stiffnessHz(label)) < 0.01;
}

}  // namespace

std::span<const TapPiece> tapPieces() noexcept {
    return pieces;
}

const TapPiece* tapPieceOf(const model::Label& label) noexcept {
    const TapPiece* nearest = nullptr;
    for (const TapPiece& piece : pieces) {
        if (piece.label == label.name) {
            return &piece;
        }
        const double own = label.stiffnessNewtonsPerMetre;
        if (isOfCategory(piece, label.category) &&
            (nearest == nullptr ||
             distance(piece.stiffnessNewtonsPerMetre, own) < distance(nearest->stiffnessNewtonsPerMetre, own))) {
            nearest = &piece;
        }
    }
    return nearest;
}

ImpactResponse tapOn(const TapPiece& piece) noexcept {
    const std::array<CoupledMode, 2> modes = coupledModes(piece);
    ImpactResponse response;
    response.modes[0] = feltMode(modes[0].frequencyHz, piece.lossFactor, 1.0);
    if (modes[1].frequencyHz > 0.0) {
        // Relative to the first mode, whatever the frequency.
        response.modes[1] = feltMode(modes[1].frequencyHz, tipLossFactor, 0.0);
        response.modes[1].gainPerSecond =
            static_cast<float>(upperModeShare * modes[1].penShare) * response.modes[0].gainPerSecond;
    }
    return response;
}

ImpactResponse impactResponse(const model::Label& label) noexcept {
    ImpactResponse response;
    if (const TapPiece* piece = tapPieceOf(label); piece != nullptr && statesOnlyStiffness(label)) {
        response = tapOn(*piece);
        response.restitution = label.impact ? static_cast<float>(label.impact->restitution) : 0.0F;
        return response;
    }
    if (label.impact) {
        for (std::size_t i = 0; i < response.modes.size(); ++i) {
            const model::ImpactMode& mode = label.impact->modes[i];
            response.modes[i] = {.frequencyHz = static_cast<float>(mode.frequencyHz),
                                 .decayPerSecond = static_cast<float>(mode.decayPerSecond),
                                 .gainPerSecond = static_cast<float>(mode.gainPerSecond)};
        }
        response.restitution = static_cast<float>(label.impact->restitution);
        return response;
    }
    const double frequencyHz = stiffnessHz(label);
    response.modes[0] = {.frequencyHz = static_cast<float>(frequencyHz),
                         .decayPerSecond = static_cast<float>(60.0 + 0.15 * frequencyHz),
                         .gainPerSecond = static_cast<float>(0.15 * 2.0 * std::numbers::pi * frequencyHz)};
    return response;
}

ImpactResponse impactResponse(const Ingredients& ingredients) noexcept {
    std::array<MeanMode, ImpactResponse::modeCount> means{};
    const double total = ingredients.totalWeight();
    double restitution = 0.0;
    for (const Ingredient& each : ingredients.all()) {
        const ImpactResponse own = impactResponse(*each.material->label);
        for (std::size_t mode = 0; mode < means.size(); ++mode) {
            means[mode].add(each.weight, own.modes[mode]);
        }
        restitution += each.weight * static_cast<double>(own.restitution);
    }
    ImpactResponse response;
    for (std::size_t mode = 0; mode < means.size(); ++mode) {
        response.modes[mode] = means[mode].mode(total);
    }
    response.restitution = static_cast<float>(restitution / total);
    return response;
}

double stiffnessOf(const Ingredients& ingredients) noexcept {
    double logarithm = 0.0;
    for (const Ingredient& each : ingredients.all()) {
        logarithm += each.weight * std::log(each.material->label->stiffnessNewtonsPerMetre);
    }
    return std::exp(logarithm / ingredients.totalWeight());
}

}  // namespace haptoflow::engine
