// SPDX-License-Identifier: Apache-2.0
// Blocks of images that are larger than memory.
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>

#include <array>
#include <cstdint>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "scaleaxis/volume.hpp"

namespace scaleaxis::python {
namespace {

using MaskIn = In<std::uint8_t, nb::ndim<3>>;

template <class Array>
std::array<Index, 3> sizes_of(const Array& array) {
    return {static_cast<Index>(array.shape(2)), static_cast<Index>(array.shape(1)), static_cast<Index>(array.shape(0))};
}

/// The first voxel of the array, of the core, the one after the core; the sizes of the volume; the empty layers before
/// and after the array.
using Place = std::array<Voxel, 6>;

template <class Array>
VolumeBlock block_of(const Array& array, const Place& place) {
    return {sizes_of(array), place[0], place[1], place[2], place[3], place[4], place[5]};
}

template <class Array>
auto values_of(const Array& array) {
    return std::span(array.data(), array.size());
}

Fields fields_of(VolumePart part) {
    Fields fields;
    fields["vertices"] = array_of(std::move(part.vertices));
    fields["radii"] = array_of(std::move(part.radii));
    const auto [offsets, corners] = arrays_of(std::move(part.faces));
    fields["face_offsets"] = offsets;
    fields["face_vertices"] = corners;
    fields["angles"] = array_of(std::move(part.angles));
    fields["curves"] = array_of(std::move(part.curves));
    fields["euler"] = part.euler;
    fields["solid_euler"] = part.solid_euler;
    fields["samples"] = part.samples;
    fields["balls"] = part.balls;
    fields["halo"] = part.halo;
    fields["is_certain"] = part.is_certain;
    return fields;
}

}  // namespace

void bind_volumes(nb::module_& m) {
    m.def("mask_values", [](const MaskIn& mask, int passes, int threads) {
        return array_of(run({threads, {}}, [&](const Execution& execution) {
            return mask_values(sizes_of(mask), values_of(mask), passes, execution);
        }));
    });
    m.def("axis_of_block", [](const FloatsIn& values, const Place& place, double scale, double largest_depth,
                              std::uint64_t seed, double move, int threads) {
        return fields_of(run({threads, {}}, [&](const Execution& execution) {
            return axis_of_block(block_of(values, place), values_of(values), {scale, largest_depth, seed, move},
                                 execution);
        }));
    });
    m.def("halo_of_axis", &halo_of_axis);
    m.def("squared_depths", [](const MaskIn& mask, int threads) {
        return array_of(run({threads, {}}, [&](const Execution& execution) {
            return squared_depths(sizes_of(mask), values_of(mask), execution);
        }));
    });
    m.def("thickness_of_block", [](const MaskIn& mask, const Place& place, int threads) {
        return array_of(run({threads, {}}, [&](const Execution& execution) {
            return thickness_of_block(block_of(mask, place), values_of(mask), execution);
        }));
    });
}

}  // namespace scaleaxis::python
