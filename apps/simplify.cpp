// SPDX-License-Identifier: Apache-2.0
// scaleaxis simplify: a stored axis → a compact medial mesh.
#include <array>
#include <limits>
#include <memory>
#include <sstream>
#include <vector>

#include "commands.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/length.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/simplification.hpp"
#include "stored_axis.hpp"

namespace scaleaxis::app {

namespace {

constexpr Length kDefaultError = Length::relative(0.0025);

struct SimplificationOptions {
    StoredAxisOptions stored;
    CompactOptions compact;
    std::vector<std::array<double, 3>> anchors;
};

/// The vertex nearest to a place.
Index nearest_vertex(const MedialComplex& complex, const Point& place) {
    Index nearest = kNone;
    double least = std::numeric_limits<double>::infinity();
    for (Index v = 0; v < static_cast<Index>(complex.vertices.size()); ++v) {
        const double square = squared_distance(complex.vertices[v], place);
        if (square < least) {
            least = square;
            nearest = v;
        }
    }
    return nearest;
}

Status run_simplify(const SimplificationOptions& options, const std::stop_token& cancel) {
    const auto derive = [&](const MedialComplex& complex, double diagonal, const Execution& execution) {
        const auto& [error, vertices] = options.compact;
        SimplifyOptions simplify_options{.vertices = vertices};
        if (error || !vertices) {
            simplify_options.error = error.value_or(kDefaultError).of(diagonal);
        }
        for (const auto& [x, y, z] : options.anchors) {
            if (!is_finite(Point{x, y, z})) {
                throw InvalidOption("the coordinates of an anchor must be numbers");
            }
            simplify_options.anchors.push_back(nearest_vertex(complex, {x, y, z}));
        }
        SimplifiedComplex simplified = simplify(complex, simplify_options, execution);
        std::ostringstream summary;
        print(summary, simplified.statistics);
        std::vector<Diagnostic> warnings;
        if (const auto warning = too_many_vertices(simplified.statistics, simplify_options)) {
            warnings.push_back(*warning);
        }
        return DerivedAxis{std::move(simplified.complex),
                           {{"simplification", json_of(simplified.statistics)}},
                           summary.str(),
                           std::move(warnings)};
    };
    return run_stored_axis("simplify", options.stored, cancel, derive);
}

}  // namespace

Command simplify_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("simplify", "Make a stored axis a compact medial mesh of few vertices");
    auto options = std::make_shared<SimplificationOptions>();
    std::ostringstream default_value;
    default_value << kDefaultError.value();
    add_compact_options(command, options->compact, default_value.str());
    command.add_option("--anchor", options->anchors, "The vertex nearest to this place stays as it is; may be repeated")
        .delimiter(',')
        .value_text("X,Y,Z");
    add_stored_axis_options(command, "simplify", options->stored);
    command.footer(
        "Between vertices balls are interpolated linearly; mesh, compare and sample-field take the result as that.\n"
        "Examples:\n"
        "  scaleaxis simplify cat-axis.ply --error 0.005 -o cat-compact.ply\n"
        "  scaleaxis simplify others.ma --vertices 300 -o few.ply");
    return {command, [options](const std::stop_token& cancel) { return run_simplify(*options, cancel); }};
}

}  // namespace scaleaxis::app
