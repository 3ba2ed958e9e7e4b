// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace scaleaxis::view {

/// viewer/dist/template.html, the page without data; the build makes its source from that file.
std::string_view page_template();

}  // namespace scaleaxis::view
