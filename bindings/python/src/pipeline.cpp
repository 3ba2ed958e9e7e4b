// SPDX-License-Identifier: Apache-2.0
// Several stages in one call.
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace scaleaxis::python {
namespace {

using python::fields_of;

std::optional<UnionKind> union_kind_of(const std::optional<std::string>& name) {
    constexpr std::pair<std::string_view, UnionKind> kKinds[]{{"polar", UnionKind::kPolar},
                                                              {"fitted", UnionKind::kFitted}};
    return name ? std::optional(value_of("union_kind", *name, kKinds)) : std::nullopt;
}

Method method_of(const std::string& name) {
    constexpr std::pair<std::string_view, Method> kMethods[]{
        {"scale", Method::kScale}, {"angle", Method::kAngle}, {"lambda", Method::kLambda}};
    return value_of("method", name, kMethods);
}

Fields fields_of(AxisAtScale axis, const std::optional<Topology>& solid) {
    Fields fields;
    fields["scale"] = axis.scale;
    fields["report"] = to_json(report_of(axis, solid));
    fields["complex"] = fields_of(std::move(axis.complex));
    return fields;
}

Fields fields_of(ScaleAxis result) {
    nb::list axes;
    for (AxisAtScale& axis : result.axes) {
        axes.append(fields_of(std::move(axis), result.solid_topology));
    }
    Fields fields = fields_of_union(result);
    fields["axes"] = axes;
    fields["delta_choice"] = nb::none();
    if (result.delta_choice) {
        fields["delta_choice"] = to_json(*result.delta_choice);
    }
    fields["tolerance"] = result.tolerance;
    fields["diagonal"] = result.diagonal;
    fields["sample_count"] = result.samples;
    fields["samples"] = nb::none();
    if (result.kept_samples) {
        fields["samples"] = fields_of(std::move(*result.kept_samples));
    }
    fields["sampling"] = to_json(result.sampling_statistics);
    fields["solid_topology"] = tuple_of(result.solid_topology);
    return fields;
}

}  // namespace

void bind_pipeline(nb::module_& m) {
    m.attr("default_delta_range") = nb::make_tuple(DeltaRange().coarsest, DeltaRange().finest);
    m.def("scale_axis",
          [](const std::variant<const Solid*, Fields>& from, const LengthIn& delta,
             const std::optional<std::array<double, 2>>& delta_range, const std::optional<std::string>& union_kind,
             const std::string& method, std::vector<double> scales, std::optional<double> filter_angle,
             const LengthIn& lambda, bool reaches_sharp_edges, std::optional<double> sharp_angle,
             const LengthIn& cleaning, const std::optional<std::pair<LengthIn, std::optional<Index>>>& compact,
             bool is_dense, std::optional<Index> smoothing_rounds, bool is_centered, bool suits_features,
             bool limits_deviation, bool keeps_samples, std::uint64_t seed, int threads, Tell progress) {
              ScaleAxisOptions options;
              options.delta = length_of(delta);
              if (delta_range) {
                  options.delta_range = DeltaRange{(*delta_range)[0], (*delta_range)[1]};
              }
              options.union_kind = union_kind_of(union_kind);
              options.method = method_of(method);
              options.scales = std::move(scales);
              options.filter_angle = filter_angle;
              options.lambda = length_of(lambda);
              options.reaches_sharp_edges = reaches_sharp_edges;
              options.sharp_angle = sharp_angle;
              options.cleaning = length_of(cleaning);
              if (compact) {
                  options.compact = CompactOptions{length_of(compact->first), compact->second};
              }
              options.is_dense = is_dense;
              options.smoothing_rounds = smoothing_rounds;
              options.is_centered = is_centered;
              options.suits_features = suits_features;
              options.limits_deviation = limits_deviation;
              options.keeps_samples = keeps_samples;
              options.seed = seed;
              const Run how{threads, std::move(progress)};
              if (const auto* solid = std::get_if<const Solid*>(&from)) {
                  return fields_of(
                      run(how, [&](const Execution& execution) { return scale_axis(**solid, options, execution); }));
              }
              Samples samples = samples_of(std::get<Fields>(from));
              return fields_of(run(
                  how, [&](const Execution& execution) { return scale_axis(std::move(samples), options, execution); }));
          });
    m.def("finest_delta", [](const LengthIn& delta, const std::optional<std::array<double, 2>>& delta_range,
                             bool suits_features, bool limits_deviation) {
        ScaleAxisOptions options;
        options.delta = length_of(delta);
        if (delta_range) {
            options.delta_range = DeltaRange{(*delta_range)[0], (*delta_range)[1]};
        }
        options.suits_features = suits_features;
        options.limits_deviation = limits_deviation;
        const Length finest = finest_delta(options);
        return std::pair(finest.value(), finest.is_absolute());
    });
    m.def("union_of", [](const Fields& samples, const Solid& solid, const std::optional<std::string>& kind,
                         const std::optional<TopologyTuple>& topology, std::uint64_t seed, int threads, Tell progress) {
        const Samples given = samples_of(samples);
        const UnionOptions options{union_kind_of(kind), topology_of(topology), seed};
        SolidUnion all = run({threads, std::move(progress)},
                             [&](const Execution& execution) { return union_of(given, solid, options, execution); });
        return fields_of_union(all);
    });
    m.def("default_union", [](const Solid& solid) {
        return std::string(default_union(solid) == UnionKind::kFitted ? "fitted" : "polar");
    });
    m.def("peak_memory", [] { return peak_memory(); });
}

}  // namespace scaleaxis::python
