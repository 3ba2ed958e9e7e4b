// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "base/text.hpp"
#include "scaleaxis/simplification.hpp"

namespace scaleaxis::inline v1 {

std::optional<Diagnostic> too_many_vertices(const SimplifyStatistics& statistics, const SimplifyOptions& options) {
    if (!options.vertices || statistics.vertices_after <= *options.vertices) {
        return std::nullopt;
    }
    const std::string reached = std::to_string(statistics.vertices_after) + " vertices are left of " +
                                std::to_string(statistics.vertices_before) + ", and not " +
                                std::to_string(*options.vertices) + " as asked for: ";
    const std::string reason =
        options.error
            ? "fewer would exceed the error of " + to_text(*options.error) +
                  ", or change the topology; allow a larger one, or none"
            : "fewer would change the topology, or move ends and junctions of curves, seams or borders, which stay; "
              "clean the axis more before";
    Diagnostic result{"complex.many_vertices", reached + reason};
    if (options.error) {
        result.hints = {{"error"}};
    }
    return result;
}

}  // namespace scaleaxis::inline v1
