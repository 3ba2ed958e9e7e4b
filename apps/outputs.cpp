// SPDX-License-Identifier: Apache-2.0
#include "outputs.hpp"

#include <array>
#include <charconv>
#include <iostream>
#include <map>
#include <system_error>

#include "base/files.hpp"
#include "inputs.hpp"
#include "io/output_file.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/cleaning.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

namespace scaleaxis::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kStdout = "/dev/stdout";

bool is_folder(const std::string& output) { return output.ends_with('/') || fs::is_directory(output); }

void replace_all(std::string& text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
}

std::string shortest_decimal(double value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return {digits.data(), end};
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

void check_writable(const fs::path& file) {
    const fs::path folder = folder_of(file);
    if (fs::is_directory(file)) {
        throw InvalidOption(file.string() + " is a folder, a file is needed");
    }
    if (why_not_writable(folder) != 0) {
        throw InvalidOption(file.string() + ": no permission to write to the folder " + folder.string());
    }
}

/// Makes the folder of a file, with those above it. \return the topmost one that is new, or nothing
/// \throws InvalidOption
fs::path make_folder_of(const fs::path& file) {
    fs::path topmost_new;
    std::error_code error;
    for (fs::path folder = folder_of(file); !folder.empty() && !fs::exists(folder, error);
         folder = folder.parent_path()) {
        topmost_new = folder;
    }
    fs::create_directories(folder_of(file), error);
    if (error) {
        throw InvalidOption(file.string() + ": the folder " + folder_of(file).string() +
                            " is not there and cannot be made: " + error.message());
    }
    return topmost_new;
}

}  // namespace

std::string output_pattern(const std::string& output, const std::string& kind, bool has_several_scales,
                           const std::string& format, const std::string& otherwise) {
    if (output == "-" || is_stdout(output)) {
        return kStdout;
    }
    const std::string extension = "." + (format.empty() ? otherwise : format);
    fs::path pattern = is_folder(output) ? fs::path(output) / ("{name}-" + kind + extension) : fs::path(output);
    if (has_several_scales && pattern.string().find("{scale}") == std::string::npos) {
        pattern.replace_filename(pattern.stem().string() + "-s{scale}" + pattern.extension().string());
    }
    return pattern.string();
}

bool is_stdout(const fs::path& file) { return file == kStdout; }

std::string format_of(const fs::path& file, const std::string& format) {
    std::string name = format.empty() ? file.extension().string() : format;
    name.erase(0, name.starts_with('.') ? 1 : 0);
    return io::to_lower(name);
}

std::string written_format(const fs::path& file, const std::string& format, const std::string& otherwise) {
    return format.empty() && is_stdout(file) ? otherwise : format;
}

std::string stem_of(const fs::path& file) {
    if (file == "-") {
        return "stdin";
    }
    return file.extension() == ".gz" ? file.stem().stem().string() : file.stem().string();
}

fs::path expand(const std::string& pattern, const fs::path& input, double scale) {
    std::string name = pattern;
    replace_all(name, "{scale}", shortest_decimal(scale));
    replace_all(name, "{name}", stem_of(input));
    return name;
}

void check_distinct(const std::vector<Output>& outputs) {
    std::map<fs::path, fs::path> known;  // and whose results they are
    for (const auto& [file, input] : outputs) {
        const auto [first, is_new] = known.emplace(is_stdout(file) ? file : without_links(file), input);
        if (is_new) {
            continue;
        }
        const fs::path& other = first->second;
        const bool has_two_inputs = !input.empty() && !other.empty() && input != other;
        const std::string what =
            has_two_inputs ? "the results of " + other.string() + " and " + input.string() : std::string("two results");
        const std::string advice = is_stdout(file)   ? ", which takes one: name a file or a folder for the other"
                                   : !has_two_inputs ? ": name each input and each output once"
                                   : stem_of(input) == stem_of(other)
                                       ? ", as both are called " + stem_of(input) +
                                             ": rename one, or call the program for each, with another output"
                                       : ": name a folder, or a file with {name} in it";
        throw InvalidOption(what + " would both be written to " + file.string() + advice);
    }
}

void check_output(const fs::path& file, const OutputCheck& check) {
    const fs::path made = make_folder_of(file);
    try {
        check_is_no_input(file);
        check(file);
    } catch (const Error& error) {
        if (!made.empty()) {
            std::error_code ignored;
            fs::remove_all(made, ignored);  // there is nothing in it yet
        }
        throw InvalidOption(error.what());
    }
}

OutputCheck axis_output_check(const std::string& format, bool has_polygons) {
    return [=](const fs::path& file) {
        const std::string written = written_format(file, format);
        check_axis_output(file, written);
        if (has_polygons && format_of(file, written) != "ply") {
            throw InvalidOption("--polygons is for PLY, but " + file.string() +
                                " is of another format: VTP and OBJ have polygons anyway, the others triangles");
        }
    };
}

void write_axis_file(const fs::path& file, const MedialComplex& complex, const std::string& format, bool has_polygons,
                     const Execution& execution) {
    AxisFileOptions options{.has_polygons = has_polygons};
    if (const std::string kind = format_of(file, format); kind == "ply" || kind == "vtp") {
        options.vertex_values.push_back({"erosion_thickness", erosion_thickness(complex, execution).thickness});
    }
    write_axis(file, complex, format, options);
}

void add_statistics_file(const std::string& file, std::vector<Output>& outputs) {
    if (file == "-") {
        outputs.push_back({kStdout});
    } else if (!file.empty()) {
        check_output(file, check_writable);
        outputs.push_back({file});
    }
}

fs::path checked_output(const std::string& pattern, const fs::path& input, double scale, const std::string& statistics,
                        const OutputCheck& check) {
    const fs::path output = expand(pattern, input, scale);
    check_output(output, check);
    std::vector<Output> outputs{{output, input}};
    add_statistics_file(statistics, outputs);
    check_distinct(outputs);
    return output;
}

void write_text(const fs::path& file, const std::string& text) {
    io::OutputFile output(file);
    output.text(text);
    output.commit();
}

void print_text(const std::string& text) {
    std::cout << text << std::flush;
    if (!std::cout) {
        throw FileError("stdout: cannot be written");
    }
}

}  // namespace scaleaxis::app
