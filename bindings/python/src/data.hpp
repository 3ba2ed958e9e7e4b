// SPDX-License-Identifier: Apache-2.0
/// \file
/// Plain data of the library ↔ dictionaries of arrays, from which the Python side makes its classes.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/few_balls.hpp"
#include "scaleaxis/filtration.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/length.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/shells.hpp"
#include "scaleaxis/skeleton.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::python {

/// A dictionary whose keys are names.
using Fields = nb::typed<nb::dict, nb::str, nb::any>;

/// Components, Euler characteristic, tunnels, voids.
using TopologyTuple = std::tuple<std::int64_t, std::int64_t, std::optional<std::int64_t>, std::optional<std::int64_t>>;
TopologyTuple tuple_of(const Topology& topology);
std::optional<TopologyTuple> tuple_of(const std::optional<Topology>& topology);
std::optional<Topology> topology_of(const std::optional<TopologyTuple>& tuple);

/// None, or its value and whether it is a length in units of the input.
using LengthIn = std::optional<std::pair<double, bool>>;
std::optional<Length> length_of(const LengthIn& given);

Fields fields_of(MedialComplex complex);
MedialComplex complex_of(const Fields& fields);

/// Of the option `sampling`, which is named after its values in Python and on the command line.
Sizing sizing_of(std::string_view name);

using PointTuple = std::tuple<double, double, double>;
/// Normals and offsets.
std::vector<HalfSpace> half_spaces_of(const std::vector<std::pair<PointTuple, double>>& planes);

Fields fields_of(Samples samples);
Samples samples_of(const Fields& fields);

Fields fields_of(TriangleMesh mesh);
/// `sizes`, `values`, `place`: the origin and the three steps; `unit` and `space`.
Fields fields_of(Image image);
Fields fields_of(LoadedSolid loaded);
Fields fields_of(ScaleAxis result);
/// The keys are the names of the members; lengths are `LengthIn`.
ScaleAxisOptions axis_options_of(const Fields& fields);

Skeleton skeleton_of(const Fields& fields);

/// `areas`, `means`, `minima` and `maxima` of their thickness.
void add_sheets(Fields& fields, const std::vector<MidsurfaceSheet>& sheets);
Fields fields_of(ShellMesh shells);
ShellMesh shells_of(const Fields& fields);

/// Of balls, vertices, edges and faces; the largest one.
using ScalesIn = std::tuple<DoublesIn, DoublesIn, DoublesIn, DoublesIn, double>;
Filtration filtration_of(const Fields& complex, const ScalesIn& scales);
TriangleMesh mesh_of(const PointsIn& vertices, const RowsIn<3>& triangles);

/// `balls` and `contacts`, moved out of a result that has them.
template <class Result>
Fields fields_of_balls(Result& result) {
    Fields fields;
    fields["balls"] = array_of(std::move(result.balls));
    fields["contacts"] = array_of(std::move(result.contacts));
    return fields;
}

/// The same, and `fit`, `costs` and `warnings`: how the union came about.
template <class Result>
Fields fields_of_union(Result& result) {
    Fields fields = fields_of_balls(result);
    fields["fit"] = result.fit ? nb::cast(to_json(*result.fit)) : nb::none();
    fields["costs"] = to_json(std::span<const StageCost>(result.costs));
    fields["warnings"] = to_json(std::span<const Diagnostic>(result.warnings));
    return fields;
}

Out<double, 3> array_of(const Box& box);  ///< 2×3: the least and the largest coordinates
std::pair<Out<Index>, Out<Index>> arrays_of(IndexLists lists);
IndexLists lists_of(const IndicesIn& offsets, const IndicesIn& indices);

/// The value that a name stands for. \throws InvalidOption that lists all names
template <class Value, std::size_t N>
Value value_of(std::string_view option, std::string_view name, const std::pair<std::string_view, Value> (&names)[N]) {
    std::string all;
    for (const auto& [known, value] : names) {
        if (known == name) {
            return value;
        }
        all += (all.empty() ? "'" : ", '") + std::string(known) + "'";
    }
    throw InvalidOption(std::string(option) + " must be one of " + all + ", not '" + std::string(name) + "'");
}

}  // namespace scaleaxis::python
