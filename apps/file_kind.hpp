// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a file holds, as far as its name and its first lines tell.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace scaleaxis::app {

enum class FileKind { kMesh, kBalls, kAxis };

/// Counts that the head of an axis file states.
struct AxisCounts {
    std::int64_t vertices = 0;
    std::int64_t edges = 0;
    std::int64_t faces = 0;
};

struct FileHead {
    FileKind kind = FileKind::kMesh;  ///< also of a file that cannot be read: the mesh reader says why
    AxisCounts axis;                  ///< of an axis
};

FileHead file_head(const std::filesystem::path& file);

}  // namespace scaleaxis::app
