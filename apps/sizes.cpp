// SPDX-License-Identifier: Apache-2.0
// scaleaxis sizes: a solid → how large the elements of a mesh of it should be, as meshers read it.
#include "scaleaxis/sizes.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "batch.hpp"
#include "commands.hpp"
#include "documents.hpp"
#include "inputs.hpp"
#include "interrupts.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/report.hpp"
#include "source.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

const Choices<SizeMeasure> kMeasures{{"thickness", SizeMeasure::kThickness},
                                     {"feature-size", SizeMeasure::kFeatureSize}};

struct SizesCommandOptions {
    fs::path input;
    SourceOptions source;
    std::string output;
    std::string output_format;
    fs::path mesh;  ///< whose vertices the sizes are for; empty: none
    std::optional<Length> delta;
    SizeOptions sizes;
    CommonOptions common;
};

SourceResult run_sizes_of(const SizesCommandOptions& options, const Source& source, const fs::path& file,
                          const Listener& listener, const std::stop_token& cancel) {
    LoadedSolid input = load_source(source, listener.execution({0.0, 0.3}), listener.warn_about(source.name), true);
    if (!input.solid) {
        throw InvalidOption("sizes need a solid: take --points mls");
    }
    Stopwatch watch;
    TriangleMesh surface = take_surface(input, options.delta, options.common.seed, listener.execution({0.3, 0.4}));
    const SizeField field(*input.solid, std::move(surface), options.sizes, listener.execution({0.4, 0.9}));
    input.costs.push_back(watch.lap("sizes"));
    stop_if_requested(cancel);
    const Execution execution = listener.execution({0.9, 1.0});
    if (options.mesh.empty()) {
        write_sizes(file, field, written_format(file, options.output_format, "pos"), execution);
    } else {
        write_sizes_at(file, field, options.mesh, execution);
    }
    input.costs.push_back(watch.lap("writing"));

    const std::vector<double>& sizes = field.surface_sizes();
    const auto least = std::ranges::min_element(sizes);
    const double largest = std::ranges::max(sizes);
    const Point& place = field.surface().vertices[static_cast<std::size_t>(least - sizes.begin())];
    const std::string unit = unit_of(input.input);
    std::ostringstream text;
    text << source.name.string() << " -> " << file.string() << '\n';
    label(text, "sizes") << *least << " ... " << largest << (unit.empty() ? "" : " " + unit)
                         << " on the surface; the least at " << text_of_place(place) << '\n';
    print(text, input.costs);
    const auto& [measure, elements_across, min_size, max_size, gradation, angle] = options.sizes;
    return {{{"input", source.name.string()},
             {"file", file.string()},
             {"mesh", options.mesh.empty() ? Json(nullptr) : Json(options.mesh.string())},
             {"unit", unit.empty() ? Json(nullptr) : Json(unit)},
             {"of", kMeasures.at(static_cast<std::size_t>(measure)).first},
             {"elements_across", elements_across},
             {"min_size", min_size ? Json(*min_size) : Json(nullptr)},
             {"max_size", max_size ? Json(*max_size) : Json(nullptr)},
             {"gradation", gradation},
             {"angle", angle},
             {"least", *least},
             {"least_place", {place.x, place.y, place.z}},
             {"largest", largest},
             {"vertices", sizes.size()},
             {"warnings", json_of(input.warnings)},
             {"costs", json_of(input.costs)}},
            text.str()};
}

Status run_sizes(SizesCommandOptions options, const std::stop_token& cancel) {
    const std::vector<Source> sources = sources_of_one(options.input, options.source);
    std::vector<fs::path> files;
    std::vector<Output> outputs;
    const bool has_mesh = !options.mesh.empty();
    if (has_mesh && !options.output_format.empty()) {
        throw InvalidOption("--at writes a .sol: it goes without --output-format");
    }
    for (const Source& source : sources) {
        const std::string format = has_mesh ? "sol" : options.output_format;
        const fs::path file = expand(output_pattern(options.output, "sizes", false, format, "pos"), source.name, 1.0);
        check_output(file, with_format(check_sizes_output, options.output_format, "pos"));
        if (has_mesh && file.extension() != ".sol") {
            throw InvalidOption("--at writes a .sol, and not " + file.string());
        }
        files.push_back(file);
        outputs.push_back({file, source.name});
        if (const auto mesh = mesh_beside_sizes(file, written_format(file, options.output_format, "pos"));
            mesh && !has_mesh) {
            if (is_stdout(file)) {
                throw InvalidOption("a .sol has its mesh beside it: write it to a file");
            }
            check_is_no_input(*mesh);
            outputs.push_back({*mesh, source.name});
        }
    }
    check_all_outputs(outputs, options.common);
    return run_sources(sources, options.source, options.common, new_document("scaleaxis.sizes/1"), cancel,
                       [&](std::size_t i, const Listener& listener) {
                           return run_sizes_of(options, sources[i], files[i], listener, cancel);
                       });
}

}  // namespace

Command sizes_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("sizes", "Sizes of elements for Gmsh and mmg, from how thick a solid is");
    auto options = std::make_shared<SizesCommandOptions>();
    command.add_option("INPUT", options->input, "A solid as for scaleaxis axis;\nnone with --implicit").value_text(" ");
    add_output_option(command, options->output, options->output_format,
                      "Sizes: .pos or .msh for Gmsh, .sol for mmg, with the surface beside it as .mesh;\n"
                      "a folder gets {name}-sizes.pos; {name} is filled in");
    add_number(command, "--elements-across", options->sizes.elements_across, "How many elements lie across a wall",
               kElementsAcrossRange, "N");
    add_positive_length(command, "--min-size", options->sizes.min_size,
                        "Least size, a length in units of the input; 1/1000 of the diagonal if not given");
    add_positive_length(command, "--max-size", options->sizes.max_size, "Largest size");
    add_number(command, "--gradation", options->sizes.gradation,
               "Largest difference of sizes for each unit of distance: at 0.3 they grow by about a third from\n"
               "one element to the next",
               kGradationRange, "G");
    add_choice(command, "--of", options->sizes.measure, kMeasures,
               "What is divided by the number of elements: the thickness of the wall [default], or twice the\n"
               "distance to the medial axis, inside or outside, which is small at narrow holes and slots, too");
    command
        .add_option("--at", options->mesh,
                    "Write a .sol with the sizes at the vertices of this mesh, in Medit's text format: of tetrahedra\n"
                    "for mmg3d")
        .value_text("MESH");
    add_number(command, "--angle", options->sizes.angle,
               "Least angle between two contacts of a ball for which they lie on opposite sides, as for\n"
               "scaleaxis walls; degrees",
               kWallAngleRange, "A");
    add_delta_options(command, options->delta, nullptr);
    add_source_options(command, options->source);
    add_common_options(command, options->common);
    command.footer(
        "Examples:\n"
        "  scaleaxis sizes part.stl --elements-across 4 --max-size 5 -o sizes.pos\n"
        "  gmsh part.step -bgm sizes.pos -3 -setnumber Mesh.MeshSizeExtendFromBoundary 0 -setnumber \\\n"
        "    Mesh.MeshSizeFromPoints 0\n"
        "  scaleaxis sizes part.stl --min-size 0.2 -o part.sol && mmgs part.mesh fine.mesh");
    return {command, [options](const std::stop_token& cancel) { return run_sizes(*options, cancel); }};
}

}  // namespace scaleaxis::app
