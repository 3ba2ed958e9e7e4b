// SPDX-License-Identifier: Apache-2.0
#include "stored_axis.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <sstream>
#include <utility>
#include <vector>

#include "interrupts.hpp"
#include "outputs.hpp"
#include "readable.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/report.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

// Of the edges of computed axes, up to 4 in 100 are longer than the radius of the larger ball, of simplified ones most.
constexpr double kCoarsePart = 0.1;

std::ptrdiff_t count_long_edges(const MedialComplex& complex) {
    return std::ranges::count_if(complex.edges, [&](const std::array<Index, 2>& edge) {
        const auto& [a, b] = edge;
        return distance(complex.vertices[a], complex.vertices[b]) > std::max(complex.radii[a], complex.radii[b]);
    });
}

bool is_coarse(const MedialComplex& complex) {
    return static_cast<double>(count_long_edges(complex)) > kCoarsePart * static_cast<double>(complex.edges.size());
}

}  // namespace

std::vector<Diagnostic> coarse_axis_warning(const MedialComplex& complex) {
    if (!is_coarse(complex)) {
        return {};
    }
    return {Diagnostic{"complex.coarse", std::to_string(count_long_edges(complex)) + " of " +
                                             std::to_string(complex.edges.size()) +
                                             " edges are longer than the radii of the balls at their ends, so that "
                                             "much of the axis has no vertices: call scaleaxis refine first"}};
}

Option add_stored_scale_option(CommandLine command, std::optional<double>& scale, const Range& scales) {
    return command
        .add_option("--scale", scale,
                    "Factor by which the balls had been grown, and the radii of the axis divided" +
                        range_and_default(kScaleRange, "as the file says, or else 1"))
        .check(in_range(scales))
        .value_text("S");
}

void add_stored_axis_options(CommandLine command, const std::string& name, StoredAxisOptions& options,
                             const Range& scales) {
    command.add_option("AXIS", options.input, "Axis: .ply or .ma, of this program or of others")
        .required()
        .value_text(" ");
    add_format_option(command, options.format);
    add_output_option(command, options.output, options.output_format,
                      "Axis: .ply, .ma, .vtp, .obj or .glb; a folder gets {name}-" + name +
                          ".ply;\n{name} and {scale} are filled in");
    add_polygons_option(command, options.has_polygons);
    add_stored_scale_option(command, options.scale, scales);
    add_common_options(command, options.common);
}

Status run_stored_axis(const std::string& name, StoredAxisOptions options, const std::stop_token& cancel,
                       const Derivation& derive) {
    const auto output_at = [&](double scale) {
        return checked_output(output_pattern(options.output, name, false, options.output_format), options.input, scale,
                              options.common.statistics,
                              axis_output_check(options.output_format, options.has_polygons));
    };
    output_at(options.scale.value_or(1.0));  // what is wrong with it is told before anything is read
    Stopwatch watch;
    std::vector<Diagnostic> warnings;
    const MedialComplex complex = reading(options.input, options.format, [&](const fs::path& path) {
        if (name != "filter" && is_filtration(path)) {
            warnings.push_back({"axis.filtration",
                                "it holds the axes of many scales, of which the first is taken: cut it with scaleaxis "
                                "filter --scale S first to have another one"});
        }
        return read_axis(path, options.scale);
    });
    if (!complex.vertex_labels.empty()) {
        warnings.push_back({"axis.labels", "the labels of its vertices are left out"});
    }
    const fs::path output = output_at(complex.scale);
    options.common.has_data_on_stdout = is_stdout(output);
    ProgressBar bar(options.input.filename().string(), options.common.verbosity());
    const ComplexReport before = report_of(complex);
    std::vector<StageCost> costs{watch.lap("reading")};
    const DerivedAxis derived =
        derive(complex, before.bounds.diagonal(), bar.execution(options.common.threads, cancel));
    costs.push_back(watch.lap(name));
    bar.erase();
    stop_if_requested(cancel);
    warnings.insert(warnings.end(), derived.warnings.begin(), derived.warnings.end());
    for (const Diagnostic& warning : warnings) {
        print_warning(options.input.string() + ": " + with_hints(warning));
    }
    write_axis_file(output, derived.complex, written_format(output, options.output_format), options.has_polygons,
                    {options.common.threads, {}, cancel});
    costs.push_back(watch.lap("writing"));

    const ComplexReport after = report_of(derived.complex);
    if (options.common.has_summary()) {
        std::ostringstream text;
        text << options.input.string() << '\n';
        print(text, before);
        text << derived.summary << "\n-> " << output.string() << '\n';
        print(text, after);
        print(text, costs);
        print_text(text.str());
    }
    Json document = new_document("scaleaxis." + name + "/1");
    document.update({{"input", options.input.string()}, {"scale", complex.scale}, {"before", json_of(before)}});
    document.update(derived.statistics);
    document["warnings"] = json_of(warnings);
    document.update({{"file", output.string()}, {"after", json_of(after)}, {"costs", json_of(costs)}});
    write_statistics(options.common.statistics, document);
    return kDone;
}

}  // namespace scaleaxis::app
