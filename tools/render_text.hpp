// SPDX-License-Identifier: Apache-2.0
/// \file
/// Text drawn with lines, so that a label needs no font library.
#pragma once

#include <string_view>

#include "render_canvas.hpp"

namespace scaleaxis::render {

/// Width in pixels of `text` in letters whose capitals are `height` pixels high.
double text_width(std::string_view text, double height);

/// Draws `text` before everything else, its baseline starting at `start`. Bytes beyond ASCII appear as question marks.
void draw_text(Canvas& canvas, std::string_view text, const Corner& start, double height);

}  // namespace scaleaxis::render
