#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::effects {

/// Integrates a normal map to heights in metres, row by row, of which the lowest is 0. `normals`: three numbers for
/// each texel, of any length: x along columns, y along rows, z out of the surface. `sizeMetres` is the map's length
/// along columns and rows.
///
/// The heights are those whose slopes differ least from the normals' (Frankot and Chellappa, "A method for enforcing
/// integrability in shape from shading algorithms", 1988), so noise and seams do not add up along a row. A map that is
/// not tiled is mirrored at its rims meanwhile. Allocates. Throws std::invalid_argument for numbers that are not finite
/// and a count or size that is not above 0.
[[nodiscard]] std::vector<float> heightsOfNormals(std::span<const float> normals, std::uint32_t columns,
                                                  std::uint32_t rows, std::array<double, 2> sizeMetres, bool isTiled);

}  // namespace haptoflow::effects
