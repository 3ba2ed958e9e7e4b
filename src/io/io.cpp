// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaleaxis/io.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "io/formats.hpp"
#include "io/input_file.hpp"
#include "io/output_file.hpp"
#include "io/polygon_mesh.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis {
namespace {

using namespace io;

struct Format {
    std::string_view extension;  ///< in lower case
    bool (*is_content)(std::string_view content) = nullptr;
    PolygonMesh (*read_mesh)(std::string_view content) = nullptr;
    std::vector<Ball> (*read_balls)(std::string_view content) = nullptr;
    void (*write_balls)(OutputFile& out, std::span<const Ball> balls) = nullptr;
    void (*write_axis)(OutputFile& out, const MedialComplex& complex) = nullptr;
};

/// All formats. A content is taken for the first that recognises it.
constexpr std::array kFormats{
    Format{".ply", is_ply, read_ply_mesh, read_ply_balls, write_ply_balls, write_ply_axis},
    Format{".off", is_off, read_off_mesh},
    Format{".stl", is_stl, read_stl_mesh},
    Format{".obj", is_obj, read_obj_mesh, nullptr, nullptr, write_obj_axis},
    Format{".woff", is_woff, nullptr, read_woff_balls, write_woff_balls},
    Format{".balls", is_ball_text, nullptr, read_ball_text, write_ball_text},
    Format{".txt", is_ball_text, nullptr, read_ball_text, write_ball_text},
    Format{".xyzr", is_ball_text, nullptr, read_ball_text, write_ball_text},
    Format{".ma", nullptr, nullptr, nullptr, nullptr, write_ma_axis},
    Format{".vtp", nullptr, nullptr, nullptr, nullptr, write_vtp_axis},
};

/// The extensions of the formats that have the function `member`, for a message.
template <class Function>
std::string extensions(Function Format::*member) {
    std::string result;
    for (const Format& format : kFormats) {
        if (format.*member != nullptr) {
            result += (result.empty() ? "" : ", ") + std::string(format.extension);
        }
    }
    return result;
}

/// The function of the format that a file has by its name; null if there is none.
template <class Function>
Function by_extension(const std::filesystem::path& file, Function Format::*member) {
    const std::string extension = to_lower(file.extension().string());
    for (const Format& format : kFormats) {
        if (format.extension == extension && format.*member != nullptr) {
            return format.*member;
        }
    }
    return nullptr;
}

/// The function of the format that a file has by its content, or else by its name.
template <class Function>
Function select_reader(const std::filesystem::path& file, std::string_view content, Function Format::*member) {
    for (const Format& format : kFormats) {
        if (format.*member != nullptr && format.is_content(content)) {
            return format.*member;
        }
    }
    if (const Function reader = by_extension(file, member)) {
        return reader;
    }
    throw FileError("neither its name nor its content is that of a format that can be read: " + extensions(member));
}

template <class Function>
Function select_writer(const std::filesystem::path& file, Function Format::*member) {
    if (const Function writer = by_extension(file, member)) {
        return writer;
    }
    throw FileError("cannot write " + file.string() + ": the name has to end in one of " + extensions(member));
}

void check_balls(const std::vector<Ball>& balls) {
    for (std::size_t i = 0; i < balls.size(); ++i) {
        const auto& [center, radius] = balls[i];
        const auto fail = [&](const std::string& what) {
            throw FileError("ball " + std::to_string(i + 1) + " of " + std::to_string(balls.size()) + " has " + what);
        };
        if (!is_finite(center)) {
            fail("a coordinate that is not a finite number");
        }
        if (!(radius > 0.0) || !std::isfinite(radius)) {
            fail("the radius " + std::to_string(radius) + ", which is not a positive finite number");
        }
    }
}

/// What `read` returns; its errors with the name of the file.
template <class Read>
auto with_name(const std::filesystem::path& file, const Read& read) {
    try {
        return read();
    } catch (const FileError& error) {
        throw FileError(file.string() + ": " + error.what());
    }
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& file) {
    return with_name(file, [&] {
        const std::string content = read_file(file);
        return triangulated(select_reader(file, content, &Format::read_mesh)(content));
    });
}

std::vector<Ball> read_balls(const std::filesystem::path& file) {
    return with_name(file, [&] {
        const std::string content = read_file(file);
        std::vector<Ball> balls = select_reader(file, content, &Format::read_balls)(content);
        check_balls(balls);
        return balls;
    });
}

void write_balls(const std::filesystem::path& file, std::span<const Ball> balls) {
    const auto write = select_writer(file, &Format::write_balls);
    OutputFile out(file);
    write(out, balls);
    out.commit();
}

void write_axis(const std::filesystem::path& file, const MedialComplex& complex) {
    const auto write = select_writer(file, &Format::write_axis);
    OutputFile out(file);
    write(out, complex);
    out.commit();
}

void check_balls_output(const std::filesystem::path& file) {
    select_writer(file, &Format::write_balls);
    const OutputFile probe(file);
}

void check_axis_output(const std::filesystem::path& file) {
    select_writer(file, &Format::write_axis);
    const OutputFile probe(file);
}

}  // namespace scaleaxis
