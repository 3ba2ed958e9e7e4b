// SPDX-License-Identifier: Apache-2.0
// The axes of all labels of an image.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <functional>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "images.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis::python {
namespace {

/// What has become of one label: an axis, or an error.
struct LabelResult {
    std::int64_t label = 0;
    std::optional<LoadedSolid> input;  ///< without the solid
    std::optional<ScaleAxis> axis;
    std::vector<Diagnostic> error;
};

/// Takes the results, in any order, with the number of each in that of the labels.
using Deliver = std::function<void(std::size_t number, LabelResult result)>;

LabelResult result_of(const ImageView& image, const ImageReport& report, float label, const LoadOptions& load,
                      const ScaleAxisOptions& options, const Execution& execution) {
    LabelResult result{static_cast<std::int64_t>(label), std::nullopt, std::nullopt, {}};
    try {
        LoadedSolid input = load_label(image, report, label, load, execution);
        ScaleAxis axis = scale_axis(*input.solid, options, execution);
        const auto told = std::ssize(input.solid->warnings());  // when it was loaded
        axis.warnings.erase(axis.warnings.begin(), axis.warnings.begin() + told);
        input.solid.reset();
        result.input = std::move(input);
        result.axis = std::move(axis);
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        result.error.push_back(error.diagnostic());
    }
    return result;
}

/// \throws InvalidOption if the options suit no label
void check_options(const LoadOptions& load, const ScaleAxisOptions& options) {
    validate(load, name_of(FileKind::kImage));
    validate(options);
    if (options.delta && !options.delta->is_absolute()) {
        tolerance_of(*options.delta, 1.0);
    }
}

/// Several labels at once, the large ones first: a large one that begins last would keep one thread busy while the
/// others have nothing to do.
void run_labels(const ImageView& image, const std::pair<std::string, std::string>& frame, const LoadOptions& load,
                const ScaleAxisOptions& options, const Deliver& deliver, const Execution& execution) {
    const auto tell = [&](double part) {
        if (execution.progress) {
            execution.progress("labels", part);
        }
    };
    tell(0.0);
    check_options(load, options);
    const Execution inner{execution.threads, {}, execution.cancel};
    check(image, inner);
    ImageReport report = report_of(image);
    report.unit = frame.first;
    report.space = frame.second;
    if (report.labels.empty()) {
        throw UnusableInput("the image has no labels, which are whole numbers other than 0 and up to 2^24");
    }
    std::vector<std::size_t> order(report.labels.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return report.labels[i].voxels; });
    std::mutex mutex;
    std::size_t done = 0;
    run_concurrently(
        order.size(),
        [&](std::size_t i) {
            const float label = report.labels[order[i]].label;
            deliver(order[i], result_of(image, report, label, load, options, inner));
            const std::lock_guard lock(mutex);
            tell(static_cast<double>(++done) / static_cast<double>(order.size()));
        },
        inner);
}

Fields fields_of(LabelResult result) {
    Fields fields;
    fields["label"] = result.label;
    fields["error"] = to_json(std::span<const Diagnostic>(result.error));
    if (result.axis) {
        fields["input"] = python::fields_of(std::move(*result.input));
        fields["axis"] = python::fields_of(std::move(*result.axis));
    }
    return fields;
}

}  // namespace

void bind_labels(nb::module_& m) {
    using Receiver = nb::typed<nb::callable, nb::object(std::size_t, Fields)>;
    m.def("label_axes",
          [](const FloatsIn& values, const PointsIn& place, const FrameIn& frame, std::optional<double> mask_smoothing,
             bool fills_voids, const Fields& given, const Receiver& receive, int threads, Tell progress) {
              const ScaleAxisOptions options = axis_options_of(given);
              LoadOptions load;
              load.mask_smoothing = mask_smoothing;
              load.fills_voids = fills_voids;
              const Deliver deliver = [&](std::size_t number, LabelResult result) {
                  const nb::gil_scoped_acquire acquired;
                  receive(number, fields_of(std::move(result)));
              };
              const ImageView image = image_view(values, place);
              const std::function<void(const Execution&)> work = [&](const Execution& execution) {
                  run_labels(image, frame, load, options, deliver, execution);
              };
              run({threads, std::move(progress)}, work);
          });
}

}  // namespace scaleaxis::python
