// SPDX-License-Identifier: GPL-3.0-or-later
#include "file_kind.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

namespace scaleaxis::app {

namespace {

constexpr std::size_t kHeadSize = 16384;

std::string first_bytes(const std::filesystem::path& file) {
    std::string head(kHeadSize, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(stream.gcount()));
    return head;
}

std::string lower_case_extension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

// Vertices with a radius are balls, and with edges between them an axis.
FileHead ply_head(const std::string& head) {
    AxisCounts counts;
    bool has_radius = false;
    bool has_edges = false;
    std::istringstream lines(head.substr(0, head.find("end_header")));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string keyword, name;
        words >> keyword >> name;
        if (keyword == "element") {
            std::int64_t count = 0;
            words >> count;
            has_edges = has_edges || name == "edge";
            (name == "vertex" ? counts.vertices : name == "edge" ? counts.edges : counts.faces) = count;
        } else if (keyword == "property") {
            has_radius = has_radius || line.find(" radius") != std::string::npos;
        }
    }
    return {!has_radius ? FileKind::kMesh : has_edges ? FileKind::kAxis : FileKind::kBalls, counts};
}

// `nv ne nf` on the first line
FileHead ma_head(const std::string& head) {
    AxisCounts counts;
    std::istringstream(head) >> counts.vertices >> counts.edges >> counts.faces;
    return {FileKind::kAxis, counts};
}

}  // namespace

FileHead file_head(const std::filesystem::path& file) {
    const std::string extension = lower_case_extension(file);
    if (extension == ".ply") {
        return ply_head(first_bytes(file));
    }
    if (extension == ".ma") {
        return ma_head(first_bytes(file));
    }
    constexpr std::array<std::string_view, 4> kBallExtensions{".balls", ".txt", ".xyzr", ".woff"};
    const bool has_balls =
        std::find(kBallExtensions.begin(), kBallExtensions.end(), extension) != kBallExtensions.end();
    return {has_balls ? FileKind::kBalls : FileKind::kMesh, {}};
}

}  // namespace scaleaxis::app
