#include "capi/handles.hpp"
#include "effects/relief_map.hpp"
#include "effects/relief_normals.hpp"
#include "engine/relief_table.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>

using namespace haptoflow;
using namespace haptoflow::capi;

namespace {

std::array<double, 2> sizeOf(const float* metres) {
    return {static_cast<double>(metres[0]), static_cast<double>(metres[1])};
}

}  // namespace

haptoflow_status haptoflow_relief_create(const haptoflow_relief_options* options, haptoflow_relief* relief) {
    return guarded([&] {
        const auto given = readDescriptor(options, "options");
        (void)require(relief, "relief");
        (void)require(given.heights_metres, "heights_metres");
        // Before any of the heights is read.
        effects::ReliefMap::requireTexels(given.columns, given.rows);
        *relief = engine::reliefs().add(std::make_shared<const effects::ReliefMap>(
            std::span(given.heights_metres, std::size_t{given.columns} * given.rows),
            effects::ReliefDescription{.columns = given.columns,
                                       .rows = given.rows,
                                       .sizeMetres = sizeOf(given.size_metres),
                                       .depthMetres = static_cast<double>(given.depth_metres),
                                       .tipRadiusMetres = static_cast<double>(given.tip_radius_metres),
                                       .isTiled = given.is_tiled != 0}));
    });
}

haptoflow_status haptoflow_relief_destroy(haptoflow_relief* relief) {
    return guarded([&] {
        if (*require(relief, "relief") != 0 && !engine::reliefs().remove(*relief)) {
            throw std::invalid_argument("not a relief");
        }
        *relief = 0;
    });
}

haptoflow_status haptoflow_relief_heights_of_normals(const float* normals, uint32_t columns, uint32_t rows,
                                                     const float* size_metres, uint32_t is_tiled,
                                                     float* heights_metres) {
    return guarded([&] {
        (void)require(normals, "normals");
        (void)require(size_metres, "size_metres");
        (void)require(heights_metres, "heights_metres");
        effects::ReliefMap::requireTexels(columns, rows);
        const auto heights = effects::heightsOfNormals(std::span(normals, std::size_t{3} * columns * rows), columns,
                                                       rows, sizeOf(size_metres), is_tiled != 0);
        std::ranges::copy(heights, heights_metres);
    });
}
