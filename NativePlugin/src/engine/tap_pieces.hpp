#pragma once

#include "effects/impacts.hpp"
#include "engine/material_library.hpp"
#include "model/model_header.hpp"

#include <span>
#include <string_view>

namespace haptoflow::engine {

/// What a label may be made of and how large a piece of it may be. Modulus and density of solids and losses of plates
/// are rounded typical values: Ashby (Materials Selection in Mechanical Design, appendix A) for solids, the Wood
/// Handbook (Forest Products Laboratory) for wood and plywood, Cremer, Heckl and Petersson (Structure-Borne Sound) for
/// losses. Sizes, the mesh's losses, and modulus and losses of layers are assumptions, adjusted within what such pieces
/// may have until each pair of taps differs noticeably.
struct TapPiece {
    std::string_view label;
    std::string_view category;
    /// Of the virtual surface: selects among the pieces of a category.
    double stiffnessNewtonsPerMetre = 0.0;
    double youngPa = 0.0;
    double densityKgPerM3 = 0.0;
    /// Thickness, and side of a square plate that is supported along its edges; a side of 0 for a layer on a rigid
    /// base, which does not bend.
    double thicknessMetres = 0.0;
    double sideMetres = 0.0;
    double lossFactor = 0.0;
};

[[nodiscard]] std::span<const TapPiece> tapPieces() noexcept;

/// The piece of a label: that of its name, else the one of its category with the nearest stiffness; null if there is
/// none. Any thread.
[[nodiscard]] const TapPiece* tapPieceOf(const model::Label& label) noexcept;

/// The modes with which a pen that taps on the piece vibrates; restitution is 0. Any thread; allocates nothing.
///
/// A pen of mass m = 15 g meets the piece through the spring of its contact, k = 2 a E* (Johnson 1985, a flat punch of
/// radius a = 0.5 mm; 1 / E* = (1 - nu^2) / E + the same of a nylon tip of 3 GPa, nu = 0.3). The piece is the lowest
/// mode of a square plate supported along its edges (Leissa 1969): f = pi h / L^2 sqrt(E / (12 rho (1 - nu^2))) with
/// the modal mass M = rho h L^2 / 4. The two coupled modes of m and M follow; for a layer there is one, sqrt(k / m).
///
/// Most of these lie above what a hand feels or an actuator plays, as Okamura, Cutkosky and Dennerlein 2001 found of
/// measured taps, and are brought into the band as there, with their order kept: f_felt = 100 Hz (f / 100 Hz)^0.404
/// maps 10 Hz to 4 kHz to 40 to 450 Hz, so that an octave becomes a third, slightly more than a just noticeable
/// difference of frequency. The decay is 60 + pi eta f per second: the support and the hand, and the losses eta of the
/// material at the piece's own frequency f. The hand's share of the amplitude, 0.15 * 2 pi f_felt m/s^2 per m/s, is
/// that of a label without a piece; the upper mode has 0.3 of it, times the pen's share in that mode, and the losses of
/// a tip (0.1).
[[nodiscard]] effects::ImpactResponse tapOn(const TapPiece& piece) noexcept;

/// Impact response of a label, from the first of these that there is:
/// - the header's modes, unless the main one only repeats what follows from the stiffness k in N/m: f = 5 sqrt(k) Hz,
///   25 to 450 Hz (materials of one stiffness, such as metal and glass, would sound alike);
/// - the tap on the piece of the label's name or category (tap_pieces.hpp), with the header's restitution;
/// - one mode of that f, a decay of 60 + 0.15 f per second and an amplitude of 0.15 * 2 pi f m/s^2 per m/s. The form
///   follows from a mass m that meets a spring at speed v: v sqrt(k / m) sin(sqrt(k / m) t). The constants give about
///   90, 170 and 320 Hz for 300, 1200 and 4000 N/m and account for the damping by the hand.
[[nodiscard]] effects::ImpactResponse impactResponse(const model::Label& label) noexcept;

/// Impact response of a blend: the weighted mean of its materials; frequencies and decays are averaged as logarithms.
[[nodiscard]] effects::ImpactResponse impactResponse(const Ingredients& ingredients) noexcept;

/// The stiffness of a blend in N/m: the geometric mean by weight.
[[nodiscard]] double stiffnessOf(const Ingredients& ingredients) noexcept;

}  // namespace haptoflow::engine
