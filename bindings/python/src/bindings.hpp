// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of the module, one source each.
#pragma once

#include <nanobind/nanobind.h>

namespace scaleaxis::python {

void bind_errors(nanobind::module_& m);
void bind_solids(nanobind::module_& m);
void bind_loading(nanobind::module_& m);
void bind_sampling(nanobind::module_& m);
void bind_balls(nanobind::module_& m);
void bind_axis(nanobind::module_& m);
void bind_surfaces(nanobind::module_& m);
void bind_files(nanobind::module_& m);
void bind_pipeline(nanobind::module_& m);
void bind_kernels(nanobind::module_& m);
void bind_labels(nanobind::module_& m);
void bind_view(nanobind::module_& m);
void bind_skeleton(nanobind::module_& m);
void bind_walls(nanobind::module_& m);
void bind_sizes(nanobind::module_& m);
void bind_robots(nanobind::module_& m);
void bind_volumes(nanobind::module_& m);

}  // namespace scaleaxis::python
