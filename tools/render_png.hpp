// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "render_canvas.hpp"

namespace scaleaxis::render {

/// Written under a temporary name and renamed when it is complete.
/// \throws FileError
void write_png(const std::filesystem::path& file, const Image& image);

}  // namespace scaleaxis::render
