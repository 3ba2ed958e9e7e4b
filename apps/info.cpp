// SPDX-License-Identifier: GPL-3.0-or-later
// scaleaxis info: what is in a file.
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "commands.hpp"
#include "outputs.hpp"
#include "report.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/shape.hpp"
#include "solid.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

struct InfoOptions {
    fs::path file;
    std::optional<FileKind> kind;
    bool is_json = false;
};

Description described_points(const fs::path& file) {
    const PreparedCloud cloud = prepare(read_points(file));
    Description description = described(cloud.report);
    std::ostringstream text;
    std::string fault = cloud.report.fault;
    try {
        if (fault.empty()) {
            const CloudChoice choice = choose_method(cloud);
            label(text, "method") << (choice.method == CloudMethod::kCrust ? "crust" : "moving least squares") << ": "
                                  << choice.reason << '\n';
        }
    } catch (const UnusableShape& error) {
        fault = error.what();
        description.json["fault"] = fault;
    }
    if (!fault.empty()) {
        print_solid(text, fault, std::nullopt);
    }
    description.text += text.str();
    return description;
}

Description described_file(const fs::path& file, const std::optional<FileKind>& kind) {
    switch (kind ? *kind : file_kind(file)) {
        case FileKind::kBalls:
            return described(read_balls(file));
        case FileKind::kAxis:
            return described(read_axis(file));
        case FileKind::kImage:
            return described(read_image(file));
        case FileKind::kPoints:
            return described_points(file);
        case FileKind::kMesh:
            break;
    }
    RepairedMesh repaired = repair(read_mesh(file));
    const MeshReport report = repaired.report;
    std::optional<Topology> solid;
    if (report.fault.empty()) {
        solid = mesh_shape(std::move(repaired))->topology();
    }
    Description description = described(report);
    std::ostringstream text;
    print_solid(text, report.fault, solid);
    description.text += text.str();
    description.json["solid"] = solid ? to_json(*solid) : Json(nullptr);
    return description;
}

Status run_info(const InfoOptions& options) {
    const Description description = described_file(options.file, options.kind);
    if (options.is_json) {
        Json document = new_document("scaleaxis.info/1");
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

Command info_command(CLI::App& program) {
    CLI::App* command = program.add_subcommand("info", "What is in a file: counts, bounds, topology, values, faults");
    auto options = std::make_shared<InfoOptions>();
    command->add_option("FILE", options->file, "Mesh, 3D image, points, balls, or axis (.ply, .ma)")
        ->required()
        ->option_text(" ");
    add_kind_option(*command, options->kind);
    command->add_flag("--json", options->is_json, "As JSON")->option_text(" ");
    command->footer(
        "A mesh or points that bound no solid are described, too; their fault is named, and the exit status is 0.");
    return {command, [options] { return run_info(*options); }};
}

}  // namespace scaleaxis::app
