// SPDX-License-Identifier: Apache-2.0
// Robots in spheres.
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/robot.hpp"

namespace scaleaxis::python {
namespace {

std::vector<LinkBalls> links_of(const nb::dict& given) {
    std::vector<LinkBalls> links;
    for (const auto& [name, rows] : given) {
        links.push_back({nb::cast<std::string>(name), copy(balls(nb::cast<BallsIn>(rows)))});
    }
    return links;
}

}  // namespace

void bind_robots(nb::module_& m) {
    using Paths = std::vector<std::filesystem::path>;
    using Positions = std::map<std::string, double>;
    nb::class_<Robot>(m, "Robot")
        .def("__init__",
             [](Robot* self, const std::optional<std::string>& text, const std::filesystem::path& file,
                const Paths& packages, const Positions& rest) {
                 const RobotOptions options{packages, rest};
                 text ? new (self) Robot(*text, file, options) : new (self) Robot(file, options);
             })
        .def_prop_ro("name", &Robot::name)
        .def("warnings", [](const Robot& robot) { return to_json(std::span<const Diagnostic>(robot.warnings())); })
        .def("ignored_pairs",
             [](const Robot& robot, const nb::dict& links) {
                 nb::list pairs;
                 for (const IgnoredPair& pair : robot.ignored_pairs(links_of(links))) {
                     pairs.append(nb::make_tuple(pair.first, pair.second, pair.is_adjacent));
                 }
                 return pairs;
             })
        .def("files", [](const Robot& robot, const nb::dict& links, const std::string& format, const std::string& name,
                         Index large) {
            nb::list files;
            for (const auto& [file, text] : robot_files(robot, links_of(links), format, name, large)) {
                files.append(nb::make_tuple(file, text));
            }
            return files;
        });
    m.def("robot_spheres",
          [](const Robot& robot, bool is_inside, std::optional<Index> count, std::optional<Index> total,
             std::optional<double> error, bool is_absolute,
             const std::map<std::string, std::vector<std::pair<PointTuple, double>>>& clip, double effort, double delta,
             const std::string& sampling, std::uint64_t seed, int threads, Tell progress) {
              RobotSpheresOptions options;
              options.kind = is_inside ? FewBallsKind::kInside : FewBallsKind::kCover;
              options.count = count;
              options.total = total;
              if (error) {
                  options.error = is_absolute ? Length::absolute(*error) : Length::relative(*error);
              }
              for (const auto& [link, planes] : clip) {
                  options.clip[link] = half_spaces_of(planes);
              }
              options.effort = effort;
              options.delta = Length::relative(delta);
              options.sizing = sizing_of(sampling);
              options.seed = seed;
              std::vector<LinkSpheres> found = run({threads, std::move(progress)}, [&](const Execution& execution) {
                  return robot_spheres(robot, options, execution);
              });
              nb::list links;
              for (LinkSpheres& link : found) {
                  links.append(nb::make_tuple(link.link, array_of(std::move(link.balls)),
                                              link.statistics ? to_json(*link.statistics) : "{}",
                                              link.scores ? to_json(*link.scores) : "{}"));
              }
              return links;
          });
    m.def("enclosing_balls", [](const BallsIn& given, Index count) {
        return array_of(unlocked([&] { return enclosing_balls(balls(given), count); }));
    });
}

}  // namespace scaleaxis::python
