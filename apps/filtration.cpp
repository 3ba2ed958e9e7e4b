// SPDX-License-Identifier: Apache-2.0
// scaleaxis filtration: a solid, or its axis at s = 1 → the axis with the scale at which each element vanishes.
#include "scaleaxis/filtration.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "batch.hpp"
#include "commands.hpp"
#include "documents.hpp"
#include "interrupts.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "page.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/view.hpp"
#include "source.hpp"
#include "stopwatch.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

constexpr double kShareOfAxis = 0.6;  // of the time

struct FiltrationRunOptions {
    std::optional<fs::path> input;
    SourceOptions source;
    std::string output;
    std::string output_format;
    bool has_polygons = false;
    std::vector<std::string> plots;
    std::string view;  ///< where to write the interactive page; empty: nowhere
    std::optional<Length> delta;
    std::optional<DeltaRange> delta_range;
    Sizing sizing = Sizing::kAdaptive;
    FiltrationOptions filtration;
    CommonOptions common;
};

Source single_source(const FiltrationRunOptions& options) {
    std::vector<Source> sources =
        sources_of(options.input ? expanded({*options.input}) : std::vector<Input>(), options.source);
    if (sources.size() > 1) {
        throw InvalidOption("one solid is needed, and these are " + std::to_string(sources.size()) +
                            ": name one file, and one label or object in it");
    }
    find_kind(sources.front());
    return sources.front();
}

/// The axis at s = 1, the surface for the page, if there is to be one, and what both cost.
struct FilteredSolid {
    MedialComplex axis;
    TriangleMesh surface;
    std::vector<StageCost> costs;
};

ScaleAxisOptions pipeline_of(const FiltrationRunOptions& options) {
    ScaleAxisOptions pipeline;
    pipeline.delta = options.delta;
    pipeline.delta_range = options.delta_range;
    pipeline.sizing = options.sizing;
    pipeline.scales = {1.0};
    pipeline.seed = options.common.seed;
    return pipeline;
}

FilteredSolid subject_of(const FiltrationRunOptions& options, Source source, ProgressBar& bar,
                         const std::stop_token& cancel) {
    ScaleAxisOptions pipeline = pipeline_of(options);
    validate(pipeline);
    source.options.load.delta = finest_delta(pipeline);
    const auto warn = warn_above(bar, source.name);
    LoadedSolid input =
        load_source(source, bar.execution(options.common.threads, cancel, {0.0, 0.1}), warn, !options.view.empty());
    pipeline.keeps_samples = !options.view.empty() && input.mesh.triangles.empty();
    const Execution execution = bar.execution(options.common.threads, cancel, {0.1, kShareOfAxis});
    ScaleAxis axis = input.samples ? scale_axis(std::move(*input.samples), pipeline, execution)
                                   : scale_axis(*input.solid, pipeline, execution);
    std::ranges::for_each(axis.warnings, warn);
    FilteredSolid subject{std::move(axis.axes[0].complex), std::move(input.mesh), std::move(input.costs)};
    if (axis.kept_samples) {
        subject.surface = boundary_mesh(*axis.kept_samples).mesh;
    }
    subject.costs.insert(subject.costs.end(), axis.costs.begin(), axis.costs.end());
    subject.costs.insert(subject.costs.end(), axis.axes[0].costs.begin(), axis.axes[0].costs.end());
    return subject;
}

void print_levels(std::ostream& out, const std::vector<FiltrationLevel>& levels) {
    out << "  at s        sheets  balls    area of the sheets, length of the curves, volume of the balls\n";
    for (const double scale : {1.0, 1.05, 1.1, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0}) {
        const auto next = std::ranges::upper_bound(levels, scale * (1.0 + 1e-9), {}, &FiltrationLevel::scale);
        if (next == levels.begin() || scale > levels.back().scale * (1.0 + 1e-9)) {
            continue;
        }
        const FiltrationLevel& level = *std::prev(next);
        std::ostringstream row;
        row << "  " << scale;
        std::string text = row.str();
        const auto column = [&](std::size_t width, const auto& value) {
            text.resize(std::max(width, text.size() + 1), ' ');
            std::ostringstream word;
            word << value;
            text += word.str();
        };
        column(14, level.sheets);
        column(22, level.balls);
        column(31, level.area);
        text += ",";
        column(51, level.curve_length);
        text += ",";
        column(72, level.volume);
        out << text << '\n';
    }
}

Status run_filtration_of(FiltrationRunOptions options, const Source& source, const std::stop_token& cancel) {
    const fs::path output =
        checked_output(output_pattern(options.output, "filtration", false, options.output_format), source.name, 1.0,
                       options.common.statistics, with_format(check_filtration_output, options.output_format));
    std::vector<Output> outputs{{output, source.name}};
    for (const std::string& plot : options.plots) {
        const fs::path extension = fs::path(plot).extension();
        if (extension == ".png") {
            throw InvalidOption("--plot " + plot +
                                ": plots are written to .svg; a browser or Inkscape makes a PNG of " +
                                "it, or `rsvg-convert -z 2 plot.svg -o plot.png`");
        }
        if (plot != "-" && extension != ".svg" && extension != ".csv") {
            throw InvalidOption("--plot " + plot + ": plots are written to .svg, and their numbers to .csv");
        }
        add_statistics_file(plot, outputs);
    }
    const fs::path page = page_output(options.view, source.name, 1.0);
    if (!page.empty()) {
        outputs.push_back({page, source.name});
    }
    add_statistics_file(options.common.statistics, outputs);
    check_distinct(outputs);
    options.common.has_data_on_stdout = is_stdout(output);
    ProgressBar bar(source.name.filename().string(), options.common.verbosity());
    Stopwatch watch;
    FilteredSolid subject =
        source.is_axis ? FilteredSolid{reading(source, [](const fs::path& path) { return read_axis(path); }), {}, {}}
                       : subject_of(options, source, bar, cancel);
    if (const std::optional<Diagnostic> grown = grown_axis(subject.axis)) {
        warn_above(bar, source.name)(*grown);
    }
    std::vector<StageCost>& costs = subject.costs;
    watch.lap("axis");
    Filtration nested = filtration(std::move(subject.axis), options.filtration,
                                   bar.execution(options.common.threads, cancel, {kShareOfAxis, 1.0}));
    costs.push_back(watch.lap("filtration"));
    const std::vector<FiltrationLevel> levels = profile(nested, options.filtration.largest_scale);
    const ScalePlateau plateau = longest_plateau(levels);
    costs.push_back(watch.lap("profile"));
    bar.erase();
    stop_if_requested(cancel);
    write_filtration(output, nested, written_format(output, options.output_format), options.has_polygons);
    for (const std::string& plot : options.plots) {
        const bool is_table = fs::path(plot).extension() == ".csv";
        write_text(plot, is_table ? to_csv(levels) : to_svg(levels, plateau, stem_of(source.name)));
    }
    costs.push_back(watch.lap("writing"));

    if (options.common.has_summary()) {
        std::ostringstream text;
        text << source.name.string() << " -> " << output.string() << '\n';
        print_levels(text, levels);
        text << "  the area of the sheets changes least from s = " << plateau.begin << " to " << plateau.end
             << ": s = " << plateau.middle << " is the middle\n";
        print(text, costs);
        print_text(text.str());
    }
    Json document = new_document("scaleaxis.filtration/1");
    document.update({{"input", source.name.string()},
                     {"file", output.string()},
                     {"plots", options.plots},
                     {"view", page.empty() ? Json(nullptr) : Json(page.string())},
                     {"largest_scale", options.filtration.largest_scale},
                     {"tolerance", options.filtration.tolerance},
                     {"levels", json_of(std::span<const FiltrationLevel>(levels))},
                     {"plateau", json_of(plateau)},
                     {"costs", json_of(costs)}});
    write_statistics(options.common.statistics, document);
    if (!page.empty()) {
        Json about = document;
        about.erase("levels");
        ViewedModel model{source.name.stem().string(), std::move(subject.surface), {}, to_text(about)};
        const Json statistics{{"file", output.string()}, {"topology", json_of(topology(nested.complex))}};
        model.axes.push_back(viewed(std::move(nested), levels));
        model.axes.back().statistics = to_text(statistics);
        write_page(page, model, options.common.has_summary(), {options.common.threads, {}, cancel});
    }
    return kDone;
}

Status run_filtration(const FiltrationRunOptions& options, const std::stop_token& cancel) {
    const Source source = single_source(options);
    if (source.is_axis) {
        check_unused_beside_axis(options.source);
    }
    return telling_source(source, [&] { return run_filtration_of(options, source, cancel); });
}

}  // namespace

Command filtration_command(CommandLine program) {
    const CommandLine command = program.add_subcommand(
        "filtration", "The axis at all scales in one file: when each ball, edge and face vanishes");
    auto options = std::make_shared<FiltrationRunOptions>();
    command
        .add_option("INPUT", options->input,
                    "Mesh, 3D image, points or balls; or an axis (.ply, .ma) at s = 1; none with --implicit")
        .value_text(" ");
    add_output_option(command, options->output, options->output_format,
                      "Filtration: .ply, which scaleaxis filter --scale S cuts, or .vtp;\n"
                      "a folder gets {name}-filtration.ply; {name} is filled in");
    add_polygons_option(command, options->has_polygons);
    command
        .add_option("--plot", options->plots,
                    "Also draw what is left over the scale: .svg, or write its numbers: .csv; may be repeated")
        .one_text_each()
        .value_text("FILE");
    command
        .add_option("--view", options->view,
                    "Also write a page that any browser shows, with a slider over all scales: .html;\n"
                    "a folder gets {name}-view.html")
        .value_text("FILE");
    add_number(command, "--largest-scale", options->filtration.largest_scale,
               "Scale up to which to look; what is left there never vanishes", kLargestScaleRange, "S");
    add_delta_options(command, options->delta, &options->delta_range);
    add_sampling_option(command, options->sizing);
    add_source_options(command, options->source, {"--delta", "--delta-abs", "--sampling"});
    add_common_options(command, options->common);
    command.footer(
        "Examples:\n"
        "  scaleaxis filtration cat.obj --plot cat.svg -o cat-filtration.ply --view cat.html\n"
        "  scaleaxis filter cat-filtration.ply --scale 1.3 -o cat-1.3.ply");
    return {command, [options](const std::stop_token& cancel) { return run_filtration(*options, cancel); }};
}

}  // namespace scaleaxis::app
