// SPDX-License-Identifier: Apache-2.0
// Stage 1: solid → samples of its boundary.
#include "scaleaxis/sampling.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <string>

#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "scaleaxis/boundary.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace scaleaxis::python {

void bind_sampling(nb::module_& m) {
    m.def("sample", [](const Solid& solid, double tolerance, const std::string& sampling, std::uint64_t seed,
                       bool needs_manifold, double facet_distance, const PointsIn& creases, double growth_limit,
                       Index max_samples, int threads, Tell progress) {
        SamplingOptions options;
        options.tolerance = tolerance;
        options.sizing = sizing_of(sampling);
        options.seed = seed;
        options.needs_manifold = needs_manifold;
        options.facet_distance = facet_distance;
        const auto ends = points(creases);
        for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
            options.creases.push_back({ends[i], ends[i + 1]});
        }
        options.growth_limit = growth_limit;
        options.max_samples = max_samples;
        return fields_of(run({threads, std::move(progress)},
                             [&](const Execution& execution) { return sample(solid, options, execution); }));
    });
    m.def("topology_of_samples", [](const Fields& samples) {
        return tuple_of(unlocked([given = samples_of(samples)] { return topology(given); }));
    });
    m.def("boundary_mesh", [](const Fields& samples, int threads, Tell progress) {
        const Samples given = samples_of(samples);
        BoundaryMesh boundary = run({threads, std::move(progress)},
                                    [&](const Execution& execution) { return boundary_mesh(given, execution); });
        Fields fields = fields_of(std::move(boundary.mesh));
        fields["copied_vertices"] = boundary.copied_vertices;
        fields["parted_edges"] = boundary.parted_edges;
        fields["lost_samples"] = boundary.lost_samples;
        return fields;
    });
    m.def("tolerance_of", [](double delta, bool is_absolute, double diagonal) {
        return tolerance_of(is_absolute ? Length::absolute(delta) : Length::relative(delta), diagonal);
    });
}

}  // namespace scaleaxis::python
