// SPDX-License-Identifier: Apache-2.0
// Stages 3 to 6: union of balls → medial axis → filtered, cleaned, shrunk, smoothed.
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "images.hpp"
#include "scaleaxis/centering.hpp"
#include "scaleaxis/cleaning.hpp"
#include "scaleaxis/filter.hpp"
#include "scaleaxis/filtration.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/midsurface.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/sharp_edges.hpp"
#include "scaleaxis/shells.hpp"
#include "scaleaxis/shrinking.hpp"
#include "scaleaxis/simplification.hpp"
#include "scaleaxis/smoothing.hpp"
#include "scaleaxis/thickness.hpp"

namespace scaleaxis::python {
namespace {

using python::fields_of;

Fields fields_of(MedialComplex complex, const AxisReport& report) {
    Fields fields;
    fields["complex"] = fields_of(std::move(complex));
    fields["statistics"] = to_json(report);
    return fields;
}

Fields fields_of(MedialAxis axis) {
    AxisReport report;
    report.medial = axis.statistics;
    std::vector<Diagnostic> warnings;
    if (const std::optional<Diagnostic> warning = changed_union(axis.statistics)) {
        warnings.push_back(*warning);
    }
    Fields fields = fields_of(std::move(axis.complex), report);
    fields["warnings"] = to_json(std::span<const Diagnostic>(warnings));
    fields["ball_union"] = nb::cast(std::move(axis.ball_union));
    return fields;
}

Fields fields_of(FilteredComplex filtered) {
    AxisReport report;
    report.filter = filtered.statistics;
    return fields_of(std::move(filtered.complex), report);
}

Fields fields_of(SharpComplex sharp) {
    AxisReport report;
    report.sharp = sharp.statistics;
    return fields_of(std::move(sharp.complex), report);
}

Fields fields_of(CenteredComplex centered) {
    AxisReport report;
    report.center = centered.statistics;
    return fields_of(std::move(centered.complex), report);
}

Fields fields_of(CleanedComplex cleaned) {
    AxisReport report;
    report.clean = cleaned.statistics;
    return fields_of(std::move(cleaned.complex), report);
}

Fields fields_of(SimplifiedComplex simplified) {
    AxisReport report;
    report.simplify = simplified.statistics;
    return fields_of(std::move(simplified.complex), report);
}

Fields fields_of(Filtration nested) {
    Fields fields;
    fields["complex"] = fields_of(std::move(nested.complex));
    fields["ball_scales"] = array_of(std::move(nested.ball_scales));
    fields["vertex_scales"] = array_of(std::move(nested.vertex_scales));
    fields["edge_scales"] = array_of(std::move(nested.edge_scales));
    fields["face_scales"] = array_of(std::move(nested.face_scales));
    fields["largest_scale"] = nested.largest_scale;
    return fields;
}

std::vector<Diagnostic> listed(const std::optional<Diagnostic>& warning) {
    return warning ? std::vector{*warning} : std::vector<Diagnostic>();
}

void bind_filtration(nb::module_& m) {
    m.def("vanishing_scales",
          [](const BallsIn& given, double largest_scale, double tolerance, int threads, Tell progress) {
              return array_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
                  return vanishing_scales(balls(given), {largest_scale, tolerance}, execution);
              }));
          });
    m.def("filtration", [](const Fields& complex, double largest_scale, double tolerance, int threads, Tell progress) {
        MedialComplex given = complex_of(complex);
        const std::string warnings = to_json(listed(grown_axis(given)));
        return std::make_pair(
            fields_of(run({threads, std::move(progress)},
                          [&](const Execution& execution) {
                              return filtration(std::move(given), {largest_scale, tolerance}, execution);
                          })),
            warnings);
    });
    m.def("cut", [](const Fields& complex, const ScalesIn& scales, double scale) {
        const Filtration given = filtration_of(complex, scales);
        return std::make_pair(fields_of(unlocked([&] { return cut(given, scale); })),
                              to_json(listed(unknown_level(given, scale))));
    });
    // Levels and plateau as JSON; as CSV, as SVG.
    m.def("profile", [](const Fields& complex, const ScalesIn& scales, double largest_scale, Index count,
                        const std::string& title) {
        return unlocked([&, given = filtration_of(complex, scales)] {
            const std::vector<FiltrationLevel> levels = profile(given, largest_scale, count);
            const ScalePlateau plateau = longest_plateau(levels);
            return std::make_tuple(to_json(std::span<const FiltrationLevel>(levels)), to_json(plateau), to_csv(levels),
                                   to_svg(levels, plateau, title));
        });
    });
    m.def("write_filtration", [](const std::filesystem::path& file, const Fields& complex, const ScalesIn& scales,
                                 bool has_polygons) {
        unlocked([&, given = filtration_of(complex, scales)] { write_filtration(file, given, {}, has_polygons); });
    });
    m.def("read_filtration",
          [](const std::filesystem::path& file) { return fields_of(unlocked([&] { return read_filtration(file); })); });
}

}  // namespace

void bind_axis(nb::module_& m) {
    bind_filtration(m);
    m.def("medial_axis", [](const BallsIn& given, double perturbation, std::uint64_t seed, int threads, Tell progress) {
        return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return medial_axis(balls(given), {perturbation, seed}, execution);
        }));
    });
    m.def("medial_axis_of_union",
          [](const BallUnion& given, double perturbation, std::uint64_t seed, int threads, Tell progress) {
              return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
                  return medial_axis(given, {perturbation, seed}, execution);
              }));
          });
    m.def("filter", [](const Fields& complex, double angle, const std::string& measure, int threads, Tell progress) {
        constexpr std::pair<std::string_view, SheetAngle> kMeasures[]{{"largest", SheetAngle::kLargest},
                                                                      {"by_area", SheetAngle::kByArea}};
        const FilterOptions options{angle, value_of("measure", measure, kMeasures)};
        const MedialComplex given = complex_of(complex);
        return fields_of(run({threads, std::move(progress)},
                             [&](const Execution& execution) { return filter(given, options, execution); }));
    });
    m.def("with_object_angles", [](const Fields& complex) {
        MedialComplex given = complex_of(complex);
        return fields_of(unlocked([&] { return with_object_angles(std::move(given)); }));
    });
    m.def("with_linear_radii", [](const Fields& complex) { return fields_of(with_linear_radii(complex_of(complex))); });
    m.def("thresholded",
          [](const Fields& complex, const std::string& measure, double threshold, int threads, Tell progress) {
              constexpr std::pair<std::string_view, LocalMeasure> kMeasures[]{
                  {"object_angle", LocalMeasure::kObjectAngle}, {"circumradius", LocalMeasure::kCircumradius}};
              const LocalMeasure chosen = value_of("measure", measure, kMeasures);
              const MedialComplex given = complex_of(complex);
              return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
                  return thresholded(given, chosen, threshold, execution);
              }));
          });
    m.def("extend_to_sharp_edges", [](const Fields& complex, const Solid& solid, double tolerance, double angle,
                                      double scale, int threads, Tell progress) {
        const MedialComplex given = complex_of(complex);
        return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return extend_to_sharp_edges(given, solid, {.angle = angle, .tolerance = tolerance, .scale = scale},
                                         execution);
        }));
    });
    m.def("center", [](const Fields& complex, const Solid& solid, double tolerance, int threads, Tell progress) {
        MedialComplex given = complex_of(complex);
        return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return center(std::move(given), solid, {.tolerance = tolerance}, execution);
        }));
    });
    m.def("erosion_thickness", [](const Fields& complex, int threads, Tell progress) {
        const MedialComplex given = complex_of(complex);
        ErosionThickness thickness = run({threads, std::move(progress)}, [&](const Execution& execution) {
            return erosion_thickness(given, execution);
        });
        Fields fields;
        fields["burn_times"] = array_of(std::move(thickness.burn_times));
        fields["thickness"] = array_of(std::move(thickness.thickness));
        fields["corner_burn_times"] = array_of(std::move(thickness.corner_burn_times));
        return fields;
    });
    m.def("clean", [](const Fields& complex, double thickness, bool finds_ridges, int threads, Tell progress) {
        const MedialComplex given = complex_of(complex);
        return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return clean(given, {thickness, finds_ridges}, execution);
        }));
    });
    m.def("contract_slivers", [](const Fields& complex, double tolerance, int threads, Tell progress) {
        const MedialComplex given = complex_of(complex);
        return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return contract_slivers(given, tolerance, execution);
        }));
    });
    m.def("simplify", [](const Fields& complex, std::optional<double> error, std::optional<Index> vertices,
                         std::vector<Index> anchors, int threads, Tell progress) {
        const MedialComplex given = complex_of(complex);
        const SimplifyOptions options{error, vertices, std::move(anchors)};
        return fields_of(run({threads, std::move(progress)},
                             [&](const Execution& execution) { return simplify(given, options, execution); }));
    });
    m.def("thickness", [](const Fields& complex, const PointsIn& at, const RowsIn<3>& triangles, double angle,
                          int threads, Tell progress) {
        const MedialComplex given = complex_of(complex);
        const std::vector<PointThickness> found = run({threads, std::move(progress)}, [&](const Execution& execution) {
            const Thickness thickness(given, {angle});
            return triangles.shape(0) > 0 ? thickness.at_surface(mesh_of(at, triangles), execution)
                                          : thickness.at_surface(points(at), execution);
        });
        std::vector<double> local;
        std::vector<double> foot;
        std::vector<Ball> balls;
        for (const PointThickness& thickness : found) {
            local.push_back(thickness.thickness);
            foot.push_back(thickness.foot);
            balls.push_back(thickness.ball);
        }
        Fields fields;
        fields["local"] = array_of(std::move(local));
        fields["foot"] = array_of(std::move(foot));
        fields["balls"] = array_of(std::move(balls));
        return fields;
    });
    m.def("thickness_image", [](const Fields& complex, const FloatsIn& values, const PointsIn& place, double angle,
                                int threads, Tell progress) {
        const MedialComplex given = complex_of(complex);
        const ImageView mask = image_view(values, place);
        return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return Thickness(given, {angle}).image(mask, execution);
        }));
    });
    m.def("with_short_edges", [](const PointsIn& vertices, const RowsIn<3>& triangles, double length) {
        return fields_of(run({}, [&](const Execution& execution) {
            return with_short_edges(mesh_of(vertices, triangles), length, execution);
        }));
    });
    m.def("unresolved_thickness",
          [](const PointsIn& vertices, const RowsIn<3>& triangles, const DoublesIn& values, const PointsIn& steps) {
              const std::span<const Point> given = points(steps);
              const auto warning = unresolved_thickness(mesh_of(vertices, triangles), rows<double>(values),
                                                        {given[0], given[1], given[2]});
              return to_json(warning ? std::span(&*warning, 1) : std::span<const Diagnostic>());
          });
    m.def("thin_regions",
          [](const PointsIn& vertices, const RowsIn<3>& triangles, const DoublesIn& values, double limit) {
              const TriangleMesh mesh{copy(points(vertices)), copy(index_rows<3>(triangles))};
              ThinRegions found = unlocked([&] { return thin_regions(mesh, rows<double>(values), limit); });
              std::vector<double> areas;
              std::vector<double> least;
              std::vector<Index> places;
              for (const ThinRegion& region : found.regions) {
                  areas.push_back(region.area);
                  least.push_back(region.min);
                  places.push_back(region.min_vertex);
              }
              Fields fields;
              fields["areas"] = array_of(std::move(areas));
              fields["minima"] = array_of(std::move(least));
              fields["minimum_vertices"] = array_of(std::move(places));
              fields["vertex_regions"] = array_of(std::move(found.vertex_regions));
              return fields;
          });
    m.def(
        "midsurface",
        [](const Fields& complex, const Solid* solid, double angle, bool extends, int threads, Tell progress) {
            const MedialComplex given = complex_of(complex);
            const MidsurfaceOptions options{angle, extends};
            Midsurface surface = run({threads, std::move(progress)}, [&](const Execution& execution) {
                return solid != nullptr ? midsurface(given, *solid, options, execution)
                                        : midsurface(given, options, execution);
            });
            Fields fields;
            fields["complex"] = fields_of(complex_of(surface));
            add_sheets(fields, surface.sheets);
            fields["seams"] = nb::cast(surface.seams);
            fields["seam_length"] = nb::cast(surface.seam_length);
            fields["vertices"] = array_of(std::move(surface.mesh.vertices));
            fields["triangles"] = array_of(std::move(surface.mesh.triangles));
            fields["thickness"] = array_of(std::move(surface.thickness));
            fields["triangle_sheets"] = array_of(std::move(surface.triangle_sheets));
            return fields;
        },
        nb::arg("complex"), nb::arg("solid").none(), nb::arg("angle"), nb::arg("extends"), nb::arg("threads"),
        nb::arg("progress").none());
    m.def(
        "shells",
        [](const Fields& complex, const Solid* solid, double angle, double size, int threads, Tell progress) {
            const MedialComplex given = complex_of(complex);
            const ShellOptions options{size, angle};
            return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
                return solid != nullptr ? shell_mesh(given, *solid, options, execution)
                                        : shell_mesh(given, options, execution);
            }));
        },
        nb::arg("complex"), nb::arg("solid").none(), nb::arg("angle"), nb::arg("size"), nb::arg("threads"),
        nb::arg("progress").none());
    m.def("shrink", [](const Fields& complex, double scale) {
        MedialComplex given = complex_of(complex);
        return fields_of(unlocked([&] { return shrink(std::move(given), scale); }));
    });
    m.def("densify", [](const Fields& complex, double meeting_angle, std::optional<Index> most_vertices, int threads,
                        Tell progress) {
        const MedialComplex given = complex_of(complex);
        return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return densify(given, {meeting_angle, most_vertices}, execution);
        }));
    });
    m.def("smooth", [](const Fields& complex, const BallUnion& ball_union, Index rounds, int threads, Tell progress) {
        MedialComplex given = complex_of(complex);
        return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return smooth(std::move(given), ball_union, {rounds}, execution);
        }));
    });
    m.def("smooth_alone", [](const Fields& complex, Index rounds, int threads, Tell progress) {
        MedialComplex given = complex_of(complex);
        return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return smooth(std::move(given), {rounds}, execution);
        }));
    });
    m.def("check_complex", [](const Fields& complex) { unlocked([given = complex_of(complex)] { check(given); }); });
    m.def("topology_of_complex", [](const Fields& complex) {
        return tuple_of(unlocked([given = complex_of(complex)] { return topology(given); }));
    });
    m.def("label_sheets", [](const Fields& complex) {
        MedialComplex given = complex_of(complex);
        given.face_sheets.assign(given.faces.size(), 0);  // they are about to be found
        given.sheets = given.faces.empty() ? 0 : 1;
        unlocked([&] {
            check(given);
            label_sheets(given);
        });
        return fields_of(std::move(given));
    });
}

}  // namespace scaleaxis::python
