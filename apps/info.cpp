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
#include "file_kind.hpp"
#include "outputs.hpp"
#include "report.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/shape.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

struct InfoOptions {
    fs::path file;
    bool is_json = false;
};

/// The same in both forms.
struct Description {
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
    return {{{"kind", "mesh"}, {"mesh", std::move(json)}}, text.str()};
}

Description described_balls(const fs::path& file) {
    const std::vector<Ball> balls = read_balls(file);
    const std::vector<Ball> distinct = cleaned(balls);
    const auto [smallest, largest] = std::minmax_element(
        distinct.begin(), distinct.end(), [](const Ball& a, const Ball& b) { return a.radius < b.radius; });
    const Box box = bounds(distinct);
    std::ostringstream text;
    print_balls(text, balls.size(), std::nullopt);
    Json json{{"balls", balls.size()}, {"distinct", distinct.size()}, {"bounds", to_json(box)}, {"radius", nullptr}};
    if (!distinct.empty()) {
        label(text, "distinct") << distinct.size() << '\n';
        label(text, "radius") << smallest->radius << " ... " << largest->radius << '\n';
        print(text, box);
        json["radius"] = {{"min", smallest->radius}, {"max", largest->radius}};
    }
    return {{{"kind", "balls"}, {"balls", std::move(json)}}, text.str()};
}

Description described_axis(const AxisCounts& counts) {
    std::ostringstream text;
    label(text, "axis") << counts.vertices << " vertices, " << counts.edges << " edges, " << counts.faces << " faces\n";
    return {
        {{"kind", "axis"}, {"axis", {{"vertices", counts.vertices}, {"edges", counts.edges}, {"faces", counts.faces}}}},
        text.str()};
}

Description described(const fs::path& file) {
    const FileHead head = file_head(file);
    switch (head.kind) {
        case FileKind::kBalls:
            return described_balls(file);
        case FileKind::kAxis:
            return described_axis(head.axis);
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
        document.update(description.json);
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
    command->footer(
        "A mesh that bounds no solid is described, too; its fault is named, and the exit status is 0.\n"
        "Of an axis the counts are what the head of the file states.");
    return {command, [options] { return run_info(*options); }};
}

}  // namespace scaleaxis::app
