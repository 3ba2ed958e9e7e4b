// SPDX-License-Identifier: Apache-2.0
/// \file
/// What the benchmarks share: timing, one process for each measurement, the plain Delaunay triangulation that times are
/// compared with, JSON and Markdown.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scaleaxis/mesh.hpp"
#include "scaleaxis/solid.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::bench {

using Json = nlohmann::ordered_json;

template <class Work>
double seconds_of(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values);

/// The median of repeated measurements, with all of them beside it.
Json measured(const std::vector<double>& values);

/// Seconds of one plain `CGAL::Delaunay_triangulation_3` of the points, one thread.
double delaunay_seconds(std::span<const Point> points);

/// Runs every task in a process of its own, `jobs` at a time, so that peaks of memory, caches and failures do not mix.
/// A result gets `peak_memory` (bytes, of the whole process) unless it has one; the result of a task that throws,
/// crashes or takes longer than `limit` seconds (0: any time) is `{"error": …}`. `on_done` is told of each as it ends.
/// To be called while the caller has one thread.
std::vector<Json> in_own_processes(
    const std::vector<std::function<Json()>>& tasks, int jobs = 1, unsigned limit = 0,
    const std::function<void(std::size_t task, const Json& result)>& on_done = [](std::size_t, const Json&) {});

/// Puts what a result belongs to before it.
Json named(Json names, const Json& result);

/// The same with the name of each model.
Json by_model(const std::vector<std::filesystem::path>& models, const std::vector<Json>& results);

/// The meshes in a folder, sorted by name.
std::vector<std::filesystem::path> models_of(const std::filesystem::path& folder);

/// A point of a triangle from two numbers, 0…1: evenly spread if they are.
Point point_of_triangle(const TriangleMesh& mesh, const std::array<Index, 3>& triangle, double x, double y);

/// Reads and repairs a mesh.
/// \throws FileError, UnusableInput
RepairedMesh read_solid(const std::filesystem::path& file);

/// `file`, or where `steps` > 0 a file that holds its mesh after that many steps of Loop's subdivision: removed again
/// with this object.
class SubdividedFile {
   public:
    SubdividedFile(const std::filesystem::path& file, int steps);
    SubdividedFile(const SubdividedFile&) = delete;
    SubdividedFile& operator=(const SubdividedFile&) = delete;
    ~SubdividedFile();

    const std::filesystem::path& path() const { return path_; }

   private:
    std::filesystem::path path_;
    bool is_temporary_ = false;
};

Json to_json(const Topology& topology);
Json to_json(const std::optional<Topology>& topology);

/// The processor, its threads, the compiler and the CGAL that the times belong to.
Json machine();

/// `| a | b |`, and with `markdown_header` the line below it.
std::string markdown_row(const std::vector<std::string>& cells);
std::string markdown_header(const std::vector<std::string>& titles);
std::string fixed(double value, int digits);

/// What benchmarks of many models share.
struct Batch {
    double delta = 0.01;  ///< relative to the bounding box
    int jobs = 1;
    int threads = 1;
    unsigned limit = 600;  ///< seconds for a model
};
void add_batch_options(CLI::App& program, Batch& batch);

/// Where the results go besides stdout.
struct Outputs {
    std::filesystem::path json;
    std::filesystem::path table;
};
void add_output_options(CLI::App& program, Outputs& outputs);

/// Prints the table, and writes table and results (with `machine()`) to the files that are named.
void publish(const Outputs& outputs, const std::string& table, const Json& results);

/// Runs a program: 0, or the message of what it throws on stderr and 1.
int exit_status(const std::function<void()>& program);

}  // namespace scaleaxis::bench
