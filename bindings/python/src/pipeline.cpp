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
#include <type_traits>
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

std::optional<UnionKind> union_kind_of(const std::optional<std::string>& name) {
    constexpr std::pair<std::string_view, UnionKind> kUnionKinds[]{{"polar", UnionKind::kPolar},
                                                                   {"fitted", UnionKind::kFitted}};
    return name ? std::optional(value_of("union_kind", *name, kUnionKinds)) : std::nullopt;
}

Method method_of(const std::string& name) {
    constexpr std::pair<std::string_view, Method> kMethods[]{
        {"scale", Method::kScale}, {"angle", Method::kAngle}, {"lambda", Method::kLambda}};
    return value_of("method", name, kMethods);
}

Fields fields_of(AxisAtScale axis, const std::optional<Topology>& solid) {
    Fields fields;
    fields["report"] = to_json(report_of(axis, solid));
    fields["complex"] = python::fields_of(std::move(axis.complex));
    return fields;
}

}  // namespace

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

ScaleAxisOptions axis_options_of(const Fields& fields) {
    const auto take = [&](const char* name, auto& option) {
        option = nb::cast<std::remove_reference_t<decltype(option)>>(fields[name]);
    };
    const auto take_length = [&](const char* name, std::optional<Length>& option) {
        option = length_of(nb::cast<LengthIn>(fields[name]));
    };
    ScaleAxisOptions options;
    take_length("delta", options.delta);
    if (const auto range = nb::cast<std::optional<std::array<double, 2>>>(fields["delta_range"])) {
        options.delta_range = DeltaRange{Length::relative((*range)[0]), Length::relative((*range)[1])};
    }
    options.union_kind = union_kind_of(nb::cast<std::optional<std::string>>(fields["union_kind"]));
    options.method = method_of(nb::cast<std::string>(fields["method"]));
    take("scales", options.scales);
    take("filter_angle", options.filter_angle);
    take_length("lambda", options.lambda);
    take("reaches_sharp_edges", options.reaches_sharp_edges);
    take("sharp_angle", options.sharp_angle);
    take_length("cleaning", options.cleaning);
    using CompactIn = std::pair<LengthIn, std::optional<Index>>;
    if (const auto compact = nb::cast<std::optional<CompactIn>>(fields["compact"])) {
        options.compact = CompactOptions{length_of(compact->first), compact->second};
    }
    take("is_dense", options.is_dense);
    take("smoothing_rounds", options.smoothing_rounds);
    take("is_centered", options.is_centered);
    options.sizing = sizing_of(nb::cast<std::string>(fields["sizing"]));
    take("keeps_samples", options.keeps_samples);
    take("seed", options.seed);
    return options;
}

void bind_pipeline(nb::module_& m) {
    m.attr("default_delta_range") = nb::make_tuple(DeltaRange().coarsest.value(), DeltaRange().finest.value());
    m.def("scale_axis",
          [](const std::variant<const Solid*, Fields>& from, const Fields& given, int threads, Tell progress) {
              const ScaleAxisOptions options = axis_options_of(given);
              const Run how{threads, std::move(progress)};
              if (const auto* solid = std::get_if<const Solid*>(&from)) {
                  return fields_of(
                      run(how, [&](const Execution& execution) { return scale_axis(**solid, options, execution); }));
              }
              Samples samples = samples_of(std::get<Fields>(from));
              return fields_of(run(
                  how, [&](const Execution& execution) { return scale_axis(std::move(samples), options, execution); }));
          });
    m.def("finest_delta", [](const Fields& options) {
        const Length finest = finest_delta(axis_options_of(options));
        return std::pair(finest.value(), finest.is_absolute());
    });
    m.def("union_of", [](const Fields& samples, const Solid& solid, const std::optional<std::string>& kind,
                         const std::optional<TopologyTuple>& topology, std::uint64_t seed, bool keeps_all, int threads,
                         Tell progress) {
        const Samples given = samples_of(samples);
        const UnionOptions options{union_kind_of(kind), topology_of(topology), seed, keeps_all};
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
