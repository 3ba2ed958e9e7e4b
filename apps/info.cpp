// SPDX-License-Identifier: Apache-2.0
// scaleaxis info: what is in a file.
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "documents.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "readable.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/crust.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/solid.hpp"
#include "source.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

struct InfoOptions {
    fs::path file;
    std::optional<FileKind> kind;
    std::string format;
    SolidOptions solid;
    std::string repaired;
    bool is_json = false;
};

/// What there is to tell about a file, in both forms.
struct Description {
    std::string kind;  ///< the key in JSON
    Json json;
    std::string text;
};

template <class Report>
Description described(std::string kind, const Report& report) {
    std::ostringstream text;
    print(text, report);
    return {std::move(kind), json_of(report), text.str()};
}

Description described_points(const fs::path& file, const Execution& execution) {
    const PreparedCloud cloud = prepare(read_points(file), {}, execution);
    PointsReport report{cloud.report, std::nullopt, {}};
    if (report.cloud.fault.empty()) {
        try {
            const CloudChoice choice = choose_method(cloud, execution);
            report.method = choice.method;
            report.reason = choice.reason;
        } catch (const UnusableInput& error) {
            report.cloud.fault = error.diagnostic();
        }
    }
    Description description = described("points", report);
    description.json.erase("method");  // that is for those who make a solid of them
    if (!report.cloud.fault.empty()) {
        std::ostringstream text;
        print_solid(text, report.cloud.fault, std::nullopt);
        description.text += text.str();
    }
    return description;
}

/// The boundary of a solid that has no triangles of its own.
TriangleMesh surface_of(const Solid& solid, const Execution& execution) {
    const double tolerance = tolerance_of(kDefaultDelta, solid.bounds().diagonal());
    return boundary_mesh(sample(solid, boundary_sampling(tolerance), execution), execution).mesh;
}

/// Of a file with several objects, which they are, and what was left out.
Description described_objects(const MeshObjects& read) {
    Description result{"objects", Json::array(), {}};
    std::ostringstream text;
    for (const Diagnostic& warning : read.warnings) {
        text << "  " << with_hints(warning) << '\n';
    }
    const auto print_one = [&](std::size_t i) {
        const auto& [name, mesh] = read.objects[i];
        result.json.push_back(
            {{"name", name}, {"vertices", mesh.vertices.size()}, {"triangles", mesh.triangles.size()}});
        if (read.objects.size() > 1) {
            text << "  object " << i + 1 << ' ' << name << ": " << mesh.vertices.size() << " vertices, "
                 << mesh.triangles.size() << " triangles\n";
        }
    };
    for (std::size_t i = 0; i < read.objects.size(); ++i) {
        print_one(i);
    }
    result.text = text.str();
    return result;
}

Description described_mesh(const fs::path& file, const InfoOptions& options, const Execution& execution) {
    MeshObjects read = read_objects(file);
    const Description objects = described_objects(read);
    auto [solid, report, surface, left_out] =
        solid_of_triangles(joined(std::move(read.objects)), options.solid, execution);
    report.unit = read.unit;
    const std::optional<Topology> topology = solid ? solid->topology() : std::nullopt;
    if (!options.repaired.empty()) {
        if (!solid) {
            throw UnusableInput(report.fault);
        }
        write_mesh(options.repaired, surface.triangles.empty() ? surface_of(*solid, execution) : surface);
    }
    Description description = described("mesh", report);
    std::ostringstream text;
    print_solid(text, report.fault, topology);
    description.text = objects.text + description.text + text.str();
    std::vector<Diagnostic> warnings = report.warnings();
    warnings.insert(warnings.begin(), read.warnings.begin(), read.warnings.end());
    description.json["warnings"] = json_of(std::span<const Diagnostic>(warnings));
    description.json["objects"] = objects.json;
    description.json["solid"] = json_of(topology);
    return description;
}

Description described_file(const fs::path& file, const InfoOptions& options, const Execution& execution) {
    const FileKind kind = options.kind ? *options.kind : file_kind(file);
    if (kind != FileKind::kMesh && (options.solid.kind != SolidKind::kAuto || !options.repaired.empty())) {
        throw InvalidOption("--solid and --repaired are for inputs of kind mesh, this one is of kind " +
                            std::string(name_of(kind)));
    }
    switch (kind) {
        case FileKind::kBalls:
            return described("balls", report_of(read_balls(file)));
        case FileKind::kAxis:
            return described("axis", report_of(read_axis(file)));
        case FileKind::kImage:
            return described("image", report_of(read_image(file)));
        case FileKind::kPoints:
            return described_points(file, execution);
        default:
            return described_mesh(file, options, execution);
    }
}

Status run_info(const InfoOptions& options, const std::stop_token& cancel) {
    validate(options.solid);
    if (options.repaired == "-" || is_stdout(options.repaired)) {
        throw InvalidOption("--repaired: stdout has the description; name a file");
    }
    if (!options.repaired.empty()) {
        check_output(options.repaired, with_format(check_mesh_output, {}));
    }
    const Execution execution{0, {}, cancel};
    const Description description = reading(
        options.file, options.format, [&](const fs::path& path) { return described_file(path, options, execution); });
    if (options.is_json) {
        Json document = new_document("scaleaxis.info/2");
        document["file"] = options.file.string();
        document["kind"] = description.kind;
        document[description.kind] = description.json;
        print_text(to_text(document));
    } else {
        print_text(options.file.string() + '\n' + description.text);
    }
    return kDone;
}

}  // namespace

Command info_command(CommandLine program) {
    const CommandLine command =
        program.add_subcommand("info", "What is in a file: counts, bounds, topology, values, faults");
    auto options = std::make_shared<InfoOptions>();
    command.add_option("FILE", options->file, "Mesh, 3D image, points, balls, or axis (.ply, .ma)")
        .required()
        .value_text(" ");
    add_kind_option(command, options->kind);
    add_format_option(command, options->format);
    add_solid_options(command, options->solid);
    command
        .add_option("--repaired", options->repaired,
                    "Write the closed surface that a mesh is taken for: .ply, .obj, .off or .stl")
        .value_text("FILE");
    command.add_flag("--json", options->is_json, "As JSON").value_text(" ");
    command.footer(
        "A mesh or points that bound no solid are described, too; their fault is named, and the exit status is 0.");
    return {command, [options](const std::stop_token& cancel) { return run_info(*options, cancel); }};
}

}  // namespace scaleaxis::app
