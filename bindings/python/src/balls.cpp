// SPDX-License-Identifier: Apache-2.0
// Stage 2: samples → union of balls; and unions of balls as objects.
#include "scaleaxis/balls.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/few_balls.hpp"
#include "scaleaxis/fit.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis::python {
namespace {

using python::fields_of;

std::vector<Contacts> contacts_of(const In<double, nb::shape<-1, 2, 3>>& array) { return copy(rows<Contacts>(array)); }

Fields fields_of(FittedBalls fitted) {
    Fields fields = fields_of_balls(fitted);
    fields["given"] = array_of(std::move(fitted.given));
    Fields statistics;
    statistics["outside"] = fitted.statistics.outside;
    statistics["repeated"] = fitted.statistics.repeated;
    statistics["inexact"] = fitted.statistics.inexact;
    statistics["queries"] = fitted.statistics.queries;
    fields["statistics"] = statistics;
    return fields;
}

nb::list gaps_of(const std::vector<Gap>& gaps) {
    nb::list list;
    for (const Gap& gap : gaps) {
        list.append(nb::make_tuple(nb::make_tuple(gap.place.x, gap.place.y, gap.place.z), gap.width, gap.scale));
    }
    return list;
}

void bind_stages(nb::module_& m) {
    m.def("inner_balls", [](const Fields& samples, int threads, Tell progress) {
        const Samples given = samples_of(samples);
        return array_of(run({threads, std::move(progress)},
                            [&](const Execution& execution) { return inner_balls(given, execution); }));
    });
    m.def("scaled", [](const BallsIn& given, double factor) { return array_of(scaled(balls(given), factor)); });
    m.def("perturbed", [](const BallsIn& given, double amount, std::uint64_t seed) {
        return array_of(perturbed(balls(given), amount, seed));
    });
    m.def("distinct_positions",
          [](const BallsIn& given) { return array_of(unlocked([&] { return distinct_positions(balls(given)); })); });
    m.def("distinct_balls",
          [](const BallsIn& given) { return array_of(unlocked([&] { return distinct_balls(balls(given)); })); });
    m.def("check_balls", [](const BallsIn& given) { check_balls(balls(given)); });
    m.def("fit", [](const BallsIn& given, const Solid& solid, double slack, int threads, Tell progress) {
        return fields_of(run({threads, std::move(progress)},
                             [&](const Execution& execution) { return fit(balls(given), solid, {slack}, execution); }));
    });
    m.def("few_balls", [](const BallsIn& candidates, const PointsIn& given, const Solid& solid, bool is_inside,
                          std::optional<Index> count, std::optional<double> error,
                          const std::vector<std::pair<PointTuple, double>>& clip, int threads, Tell progress) {
        FewBallsOptions options;
        options.clip = half_spaces_of(clip);
        options.kind = is_inside ? FewBallsKind::kInside : FewBallsKind::kCover;
        options.count = count;
        options.error = error;
        FewBalls few = run({threads, std::move(progress)}, [&](const Execution& execution) {
            return few_balls(balls(candidates), points(given), solid, options, execution);
        });
        Fields fields;
        fields["balls"] = array_of(std::move(few.balls));
        fields["statistics"] = to_json(few.statistics);
        return fields;
    });
    m.def("ball_scores", [](const BallsIn& given, const PointsIn& surface, const Solid& solid, std::uint64_t seed,
                            int threads, Tell progress) {
        return to_json(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return ball_scores(balls(given), points(surface), solid, seed, execution);
        }));
    });
    m.def("points_left_out", [](const PointsIn& vertices, const RowsIn<3>& triangles, const Solid& solid,
                                double spacing, std::uint64_t seed, int threads, Tell progress) {
        const MeshView mesh{points(vertices), index_rows<3>(triangles)};
        return array_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return points_left_out(mesh, solid, spacing, seed, execution);
        }));
    });
    m.def("repair",
          [](const BallsIn& given, const In<double, nb::shape<-1, 2, 3>>& contacts, const Fields& samples,
             const Solid& solid, const std::optional<TopologyTuple>& topology, Index max_rounds, double growth_limit,
             double slack, double perturbation, std::uint64_t seed, int threads, Tell progress) {
              FittedBalls fitted;
              fitted.balls = copy(balls(given));
              fitted.contacts = contacts_of(contacts);
              const Samples of_boundary = samples_of(samples);
              RepairOptions options;
              options.topology = topology_of(topology);
              options.max_rounds = max_rounds;
              options.growth_limit = growth_limit;
              options.slack = slack;
              options.perturbation = perturbation;
              options.seed = seed;
              RepairedBalls repaired = run({threads, std::move(progress)}, [&](const Execution& execution) {
                  return repair(fitted, of_boundary, solid, options, execution);
              });
              Fields fields = fields_of_balls(repaired);
              fields["gaps"] = gaps_of(repaired.report.gaps);
              fields["topology"] = tuple_of(repaired.report.topology);
              FitReport report;
              report.repair = std::move(repaired.report);
              fields["report"] = to_json(report);
              return fields;
          });
    m.def("union_accuracy", [](const BallsIn& given, const In<double, nb::shape<-1, 2, 3>>& contacts,
                               const Fields& samples, int threads, Tell progress) {
        const Samples of_boundary = samples_of(samples);
        const std::vector<Contacts> touching = contacts_of(contacts);
        FitReport report;
        report.accuracy = run({threads, std::move(progress)}, [&](const Execution& execution) {
            return union_accuracy(balls(given), touching, of_boundary, execution);
        });
        return to_json(report);
    });
}

void bind_union(nb::module_& m) {
    nb::class_<BallUnion>(m, "CoreUnion")
        .def("__init__", [](BallUnion* self, const BallsIn& given) { new (self) BallUnion(copy(balls(given))); })
        .def("balls", [](const BallUnion& all) { return array_of(copy(all.balls())); })
        .def("bounds", [](const BallUnion& all) { return array_of(all.bounds()); })
        .def("topology",
             [](const BallUnion& all, int threads, Tell progress) {
                 return tuple_of(run({threads, std::move(progress)},
                                     [&](const Execution& execution) { return all.topology(execution); }));
             })
        .def("neighbors",
             [](const BallUnion& all, int threads, Tell progress) {
                 return arrays_of(run({threads, std::move(progress)},
                                      [&](const Execution& execution) { return all.neighbors(execution); }));
             })
        .def("boundary_vertices",
             [](const BallUnion& all, int threads, Tell progress) {
                 BoundaryVertices vertices = run({threads, std::move(progress)}, [&](const Execution& execution) {
                     return all.boundary_vertices(execution);
                 });
                 Fields fields;
                 fields["points"] = array_of(std::move(vertices.points));
                 fields["balls"] = array_of(std::move(vertices.balls));
                 fields["pairs"] = array_of(std::move(vertices.pairs));
                 return fields;
             })
        .def("nearest_balls",
             [](const BallUnion& all, const PointsIn& given, int threads, Tell progress) {
                 const std::vector<NearestBall> nearest =
                     run({threads, std::move(progress)},
                         [&](const Execution& execution) { return all.nearest_balls(points(given), execution); });
                 std::vector<Index> which(nearest.size());
                 std::vector<double> distances(nearest.size());
                 for (std::size_t i = 0; i < nearest.size(); ++i) {
                     which[i] = nearest[i].ball;
                     distances[i] = nearest[i].distance;
                 }
                 return std::pair(array_of(std::move(which)), array_of(std::move(distances)));
             })
        .def("signed_distances",
             [](const BallUnion& all, const PointsIn& given, int threads, Tell progress) {
                 return array_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
                     return all.signed_distances(points(given), execution);
                 }));
             })
        .def("inside",
             [](const BallUnion& all, const PointsIn& given, int threads, Tell progress) {
                 return array_of(run({threads, std::move(progress)},
                                     [&](const Execution& execution) { return all.inside(points(given), execution); }));
             })
        .def("distances_to_boundary", [](const BallUnion& all, const PointsIn& given, int threads, Tell progress) {
            return array_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
                return all.distances_to_boundary(points(given), execution);
            }));
        });
}

}  // namespace

void bind_balls(nb::module_& m) {
    bind_stages(m);
    bind_union(m);
}

}  // namespace scaleaxis::python
