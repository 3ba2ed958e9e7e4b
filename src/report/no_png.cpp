// SPDX-License-Identifier: Apache-2.0
//
// In the place of png.cpp where the library is built without librsvg.
#include "io/faults.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis {

std::string to_png(std::string_view) {
    throw io::unsupported(
        "plots as PNG need librsvg, and this was built without it (SCALEAXIS_WITH_RSVG=OFF): write .svg, which "
        "browsers show, and convert that, as by `rsvg-convert -z 2 plot.svg -o plot.png` or Inkscape");
}

}  // namespace scaleaxis
