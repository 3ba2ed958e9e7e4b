// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Statistics of the library as JSON (docs/statistics.md) and as text for people. Both say the same.
#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scaleaxis/filter.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/points.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace scaleaxis::app {

using Json = nlohmann::ordered_json;

/// The axis of a union of balls, as `scaleaxis axis` makes one for each scale and `scaleaxis medial` makes one.
struct AxisReport {
    double scale = 1.0;
    std::filesystem::path file;
    MedialAxisStatistics medial;
    std::optional<FilterStatistics> filter;  ///< unset where nothing was filtered
    std::optional<Topology> solid;           ///< unset where it is not known
    Index vertices = 0;                      ///< of the result: its balls
    Index edges = 0;
    Index faces = 0;
    Index sheets = 0;
    std::vector<StageCost> costs;

    void set_result(const MedialComplex& complex);
};

/// Does each complex have the topology of the one before it? Unset where one of the two is not known.
struct Agreement {
    std::optional<bool> solid_and_dual;
    bool dual_and_medial = false;
    std::optional<bool> medial_and_filtered;
};
Agreement agreement(const AxisReport& axis);

Json to_json(const Box& box);
Json to_json(const Topology& topology);
Json to_json(const MeshReport& mesh);
Json to_json(const CloudReport& cloud);
Json to_json(const SamplingStatistics& sampling);
Json to_json(const AxisReport& axis);
Json to_json(const std::vector<StageCost>& costs);

/// Begins a line with its first column.
std::ostream& label(std::ostream& out, std::string_view name);

void print(std::ostream& out, const Box& box);
void print(std::ostream& out, const MeshReport& mesh);
void print(std::ostream& out, const CloudReport& cloud);
void print_solid(std::ostream& out, const std::string& fault, const std::optional<Topology>& topology);
void print(std::ostream& out, Index samples, double tolerance, const SamplingStatistics& sampling);
void print_balls(std::ostream& out, std::size_t balls, const std::optional<std::filesystem::path>& file);
void print(std::ostream& out, const AxisReport& axis);
void print(std::ostream& out, const MedialComplex& axis, const Topology& topology);
void print(std::ostream& out, const std::vector<StageCost>& costs);

/// The JSON document that begins with its schema and the version of the program.
Json new_document(const std::string& schema);

/// Indented, with a newline; file names that are not UTF-8 get replacement characters.
std::string to_text(const Json& document);

/// Writes the document to the file, to stdout for `-`, and nowhere for an empty name.
void write_statistics(const std::string& file, const Json& document);

}  // namespace scaleaxis::app
