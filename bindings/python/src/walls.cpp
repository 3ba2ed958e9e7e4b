// SPDX-License-Identifier: Apache-2.0
// Walls and gaps.
#include "scaleaxis/walls.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>

#include <optional>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::python {

void bind_walls(nb::module_& m) {
    m.def("find_walls", [](const Solid& solid, const PointsIn& vertices, const RowsIn<3>& triangles,
                           std::optional<double> min_wall, std::optional<double> max_wall,
                           std::optional<double> min_gap, double angle, double edge, int threads, Tell progress) {
        const WallOptions options{min_wall, max_wall, min_gap, angle, edge};
        TriangleMesh surface = mesh_of(vertices, triangles);
        Walls walls = run({threads, std::move(progress)}, [&](const Execution& execution) {
            return find_walls(solid, std::move(surface), options, execution);
        });
        Fields fields;
        fields["findings"] = to_json(walls);
        fields["surface"] = fields_of(std::move(walls.surface));
        fields["wall"] = array_of(std::move(walls.wall));
        fields["gap"] = array_of(std::move(walls.gap));
        fields["wall_findings"] = array_of(std::move(walls.wall_findings));
        fields["gap_findings"] = array_of(std::move(walls.gap_findings));
        return fields;
    });
    m.def("wall_at",
          [](const Solid& solid, const PointsIn& given, bool is_gap, double angle, int threads, Tell progress) {
              const std::vector<WallAt> found = run({threads, std::move(progress)}, [&](const Execution& execution) {
                  return is_gap ? gap_at(solid, points(given), angle, execution)
                                : wall_at(solid, points(given), angle, execution);
              });
              std::vector<double> values;
              for (const WallAt& wall : found) {
                  values.push_back(wall.value);
              }
              return array_of(std::move(values));
          });
}

}  // namespace scaleaxis::python
