// SPDX-License-Identifier: Apache-2.0
// The module scaleaxis._core: the functions of the library on arrays and dictionaries of them. The Python files beside
// it check what users give and make classes of what comes back.
#include <nanobind/nanobind.h>

#include "bindings.hpp"
#include "scaleaxis/version.hpp"

NB_MODULE(_core, m) {
    using namespace scaleaxis::python;
    m.attr("version") = SCALEAXIS_VERSION;
    bind_errors(m);
    bind_solids(m);
    bind_loading(m);
    bind_sampling(m);
    bind_balls(m);
    bind_axis(m);
    bind_surfaces(m);
    bind_files(m);
    bind_pipeline(m);
    bind_kernels(m);
    bind_labels(m);
    bind_view(m);
    bind_skeleton(m);
    bind_walls(m);
    bind_sizes(m);
    bind_robots(m);
    bind_volumes(m);
}
