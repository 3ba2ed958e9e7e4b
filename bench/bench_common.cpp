// SPDX-License-Identifier: Apache-2.0
#include "bench_common.hpp"

#include <CGAL/boost/graph/IO/polygon_mesh_io.h>
#include <CGAL/subdivision_method_3.h>
#include <CGAL/version.h>
#include <sys/wait.h>
#include <unistd.h>
#include <boost/preprocessor/stringize.hpp>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <thread>

#include "cgal_types.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace scaleaxis::bench {
namespace {

// With its folder where that is missing.
void write_text(const std::filesystem::path& file, const std::string& text) {
    if (file.has_parent_path()) {
        std::filesystem::create_directories(file.parent_path());
    }
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.close();
    if (!out) {
        throw FileError("cannot write " + file.string());
    }
}

struct Child {
    std::size_t task = 0;
    std::FILE* result = nullptr;
};

Json guarded(const std::function<Json()>& task) {
    try {
        return task();
    } catch (const std::exception& error) {
        return {{"error", error.what()}};
    }
}

// The result takes the way of an unnamed file, which unlike a pipe holds any amount until someone reads it.
std::pair<pid_t, std::FILE*> start(const std::function<Json()>& task, unsigned limit) {
    std::FILE* file = std::tmpfile();
    if (file == nullptr) {
        throw FileError(std::string("cannot create a temporary file: ") + std::strerror(errno));
    }
    std::cout.flush();
    const pid_t process = fork();
    if (process < 0) {
        throw FileError(std::string("cannot start a process: ") + std::strerror(errno));
    }
    if (process == 0) {
        alarm(limit);
        Json result = guarded(task);
        if (!result.contains("peak_memory")) {
            result["peak_memory"] = peak_memory();
        }
        const std::string text = result.dump();
        const bool is_complete = std::fwrite(text.data(), 1, text.size(), file) == text.size();
        _exit(is_complete && std::fflush(file) == 0 ? 0 : 1);
    }
    return {process, file};
}

Json finish(std::FILE* file, int status, unsigned limit) {
    std::string text;
    std::rewind(file);
    for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
        text.push_back(static_cast<char>(c));
    }
    std::fclose(file);
    if (WIFSIGNALED(status)) {
        return {{"error", WTERMSIG(status) == SIGALRM ? "took longer than " + std::to_string(limit) + " seconds"
                                                      : std::string("killed: ") + strsignal(WTERMSIG(status))}};
    }
    const Json result = Json::parse(text, nullptr, false);
    return result.is_discarded() ? Json{{"error", "ended without a result"}} : result;
}

}  // namespace

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

Json measured(const std::vector<double>& values) { return {{"median", median(values)}, {"all", values}}; }

double delaunay_seconds(std::span<const Point> points) {
    const std::vector<Kernel::Point_3> converted = to_cgal(points);
    std::optional<Delaunay> triangulation;
    return seconds_of([&] { triangulation.emplace(converted.begin(), converted.end()); });
}

std::vector<Json> in_own_processes(const std::vector<std::function<Json()>>& tasks, int jobs, unsigned limit,
                                   const std::function<void(std::size_t, const Json&)>& on_done) {
    std::vector<Json> results(tasks.size());
    std::map<pid_t, Child> running;
    std::size_t next = 0;
    while (next < tasks.size() || !running.empty()) {
        if (next < tasks.size() && std::ssize(running) < jobs) {
            const auto [process, file] = start(tasks[next], limit);
            running[process] = {next++, file};
            continue;
        }
        int status = 0;
        const auto ended = running.find(wait(&status));
        if (ended != running.end()) {
            const Child child = ended->second;
            running.erase(ended);
            results[child.task] = finish(child.result, status, limit);
            on_done(child.task, results[child.task]);
        }
    }
    return results;
}

Json named(Json names, const Json& result) {
    names.update(result);
    return names;
}

Json by_model(const std::vector<std::filesystem::path>& models, const std::vector<Json>& results) {
    Json all = Json::array();
    for (std::size_t m = 0; m < models.size(); ++m) {
        all.push_back(named({{"model", models[m].stem().string()}}, results[m]));
    }
    return all;
}

std::vector<std::filesystem::path> models_of(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> models;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension == ".off" || extension == ".obj" || extension == ".ply" || extension == ".stl") {
            models.push_back(entry.path());
        }
    }
    std::sort(models.begin(), models.end());
    return models;
}

Point point_of_triangle(const TriangleMesh& mesh, const std::array<Index, 3>& triangle, double x, double y) {
    // The half of the parallelogram beyond the triangle is turned into it.
    const bool is_beyond = x + y > 1.0;
    const Point& a = mesh.vertices[triangle[0]];
    return a + (is_beyond ? 1.0 - x : x) * (mesh.vertices[triangle[1]] - a) +
           (is_beyond ? 1.0 - y : y) * (mesh.vertices[triangle[2]] - a);
}

RepairedMesh read_solid(const std::filesystem::path& file) {
    RepairedMesh repaired = repair(read_mesh(file));
    if (!repaired.report.fault.empty()) {
        throw UnusableInput(file.string() + ": " + repaired.report.fault.message);
    }
    return repaired;
}

SubdividedFile::SubdividedFile(const std::filesystem::path& file, int steps) : path_(file) {
    if (steps == 0) {
        return;
    }
    path_ = std::filesystem::temp_directory_path() / ("scaleaxis_bench_" + std::to_string(getpid()) + ".ply");
    is_temporary_ = true;
    // In a process of its own: the memory that it takes is not to be counted.
    const auto subdivide = [&]() -> Json {
        SurfaceMesh mesh = to_cgal(read_solid(file).mesh);
        CGAL::Subdivision_method_3::Loop_subdivision(mesh, CGAL::parameters::number_of_iterations(steps));
        if (!CGAL::IO::write_polygon_mesh(path_.string(), mesh, CGAL::parameters::use_binary_mode(true))) {
            throw FileError("cannot write " + path_.string());
        }
        return Json::object();
    };
    const Json result = in_own_processes({subdivide})[0];
    if (result.contains("error")) {
        throw UnusableInput("subdivision failed: " + result["error"].get<std::string>());
    }
}

SubdividedFile::~SubdividedFile() {
    if (is_temporary_) {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
}

Json to_json(const Topology& topology) { return Json::parse(scaleaxis::to_json(topology)); }

Json to_json(const std::optional<Topology>& topology) { return topology ? bench::to_json(*topology) : Json(nullptr); }

Json machine() {
    std::string processor = "unknown";
    std::ifstream cpus("/proc/cpuinfo");
    for (std::string line; std::getline(cpus, line);) {
        if (line.starts_with("model name") && line.find(": ") != std::string::npos) {
            processor = line.substr(line.find(": ") + 2);
            break;
        }
    }
    return {{"processor", processor},
            {"threads", std::thread::hardware_concurrency()},
            {"compiler", __VERSION__},
            {"cgal", BOOST_STRINGIZE(CGAL_VERSION)}};
}

std::string markdown_row(const std::vector<std::string>& cells) {
    std::string row = "|";
    for (const std::string& cell : cells) {
        row += " " + cell + " |";
    }
    return row + "\n";
}

std::string markdown_header(const std::vector<std::string>& titles) {
    return markdown_row(titles) + markdown_row(std::vector<std::string>(titles.size(), "---"));
}

std::string fixed(double value, int digits) {
    std::ostringstream text;
    text.setf(std::ios::fixed);
    text.precision(digits);
    text << value;
    return text.str();
}

void add_batch_options(CLI::App& program, Batch& batch) {
    program.add_option("--delta", batch.delta, "Tolerance δ, relative to the bounding box")->capture_default_str();
    program.add_option("--jobs", batch.jobs, "Models at a time")->capture_default_str()->check(CLI::PositiveNumber);
    program.add_option("--threads", batch.threads, "Threads for each")->capture_default_str();
    program.add_option("--limit", batch.limit, "Seconds after which a model is given up")->capture_default_str();
}

void add_output_options(CLI::App& program, Outputs& outputs) {
    program.add_option("--json", outputs.json, "File for the results");
    program.add_option("--table", outputs.table, "File for the Markdown tables");
}

void publish(const Outputs& outputs, const std::string& table, const Json& results) {
    std::cout << table;
    if (!outputs.table.empty()) {
        write_text(outputs.table, table);
    }
    if (!outputs.json.empty()) {
        Json all{{"machine", machine()}};
        all.update(results);
        write_text(outputs.json, all.dump(2) + '\n');
    }
}

int exit_status(const std::function<void()>& program) {
    try {
        program();
        return 0;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
        return 1;
    }
}

}  // namespace scaleaxis::bench
