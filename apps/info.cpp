// SPDX-License-Identifier: GPL-3.0-or-later
// scaleaxis info: what is in a file.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <ostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "outputs.hpp"
#include "report.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/points.hpp"
#include "scaleaxis/shape.hpp"
#include "solid.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

struct InfoOptions {
    fs::path file;
    bool is_json = false;
};

/// What is in a file, the same in both forms.
struct Description {
    std::string kind;
    Json json;
    std::string text;
};

Description described_mesh(const fs::path& file) {
    RepairedMesh repaired = repair(read_mesh(file));
    const MeshReport report = repaired.report;
    std::optional<Topology> solid;
    if (report.fault.empty()) {
        solid = mesh_shape(std::move(repaired))->topology();
    }
    std::ostringstream text;
    print(text, report);
    print_solid(text, report.fault, solid);
    Json json = to_json(report);
    json["solid"] = solid ? to_json(*solid) : Json(nullptr);
    return {"mesh", std::move(json), text.str()};
}

Description described_points(const fs::path& file) {
    const CloudReport report = prepare(read_points(file)).report;
    std::ostringstream text;
    print(text, report);
    print_solid(text, report.fault, std::nullopt);
    return {"points", to_json(report), text.str()};
}

/// The radii and the bounds of balls, in both forms.
void describe_extent(const std::vector<Ball>& balls, Description& description) {
    const Box box = bounds(balls);
    description.json["bounds"] = to_json(box);
    description.json["radius"] = nullptr;
    if (!balls.empty()) {
        const auto [smallest, largest] = std::ranges::minmax_element(balls, {}, &Ball::radius);
        description.json["radius"] = {{"min", smallest->radius}, {"max", largest->radius}};
        std::ostringstream text;
        label(text, "radius") << smallest->radius << " ... " << largest->radius << '\n';
        print(text, box);
        description.text += text.str();
    }
}

Description described_balls(const fs::path& file) {
    const std::vector<Ball> balls = read_balls(file);
    const std::vector<Ball> distinct = cleaned(balls);
    std::ostringstream text;
    print_balls(text, balls.size(), std::nullopt);
    label(text, "distinct") << distinct.size() << '\n';
    Description description{"balls", {{"balls", balls.size()}, {"distinct", distinct.size()}}, text.str()};
    describe_extent(distinct, description);
    return description;
}

Description described_axis(const fs::path& file) {
    const MedialComplex complex = read_axis(file);
    const Topology shape = topology(complex);
    std::ostringstream text;
    print(text, complex, shape);
    Description description{"axis",
                            {{"vertices", complex.vertices.size()},
                             {"edges", complex.edges.size()},
                             {"faces", complex.faces.size()},
                             {"sheets", complex.sheets},
                             {"topology", to_json(shape)}},
                            text.str()};
    describe_extent(balls_of(complex), description);
    return description;
}

Description described(const fs::path& file) {
    switch (file_kind(file)) {
        case FileKind::kBalls:
            return described_balls(file);
        case FileKind::kAxis:
            return described_axis(file);
        case FileKind::kPoints:
            return described_points(file);
        case FileKind::kMesh:
            break;
    }
    return described_mesh(file);
}

Status run_info(const InfoOptions& options) {
    const Description description = described(options.file);
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
    CLI::App* command =
        program.add_subcommand("info", "What is in a mesh, ball or axis file: counts, bounds, topology, faults");
    auto options = std::make_shared<InfoOptions>();
    command->add_option("FILE", options->file, "Mesh, balls, or axis (.ply, .ma)")->required()->option_text(" ");
    command->add_flag("--json", options->is_json, "As JSON")->option_text(" ");
    command->footer("A mesh that bounds no solid is described, too; its fault is named, and the exit status is 0.");
    return {command, [options] { return run_info(*options); }};
}

}  // namespace scaleaxis::app
