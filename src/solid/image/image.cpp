// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/image.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/ranges.hpp"
#include "solid/image/canonical_image.hpp"
#include "solid/image/mask_smoothing.hpp"
#include "spatial/extent.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr unsigned kVoxelsAtOnce = 1 << 20;  // between two questions whether to stop
constexpr std::size_t kMostLabels = 65535;

double component(const Point& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

std::string text_of(const ImageView& image, std::size_t voxel) {
    const std::size_t width = image.sizes[0];
    const std::size_t height = image.sizes[1];
    Words text;
    text << "voxel (" << voxel % width << ", " << voxel / width % height << ", " << voxel / width / height << ')';
    return text.str();
}

/// The part of an image in a box, with a margin where the image has one, of whose values `of(value)` is taken.
template <class Of>
Image cropped(const CanonicalImage& image, IndexBox box, Index margin, const Of& of) {
    auto& [low, high] = box;
    Image part;
    part.steps = image.steps;
    part.origin = image.origin;
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::max<Index>(0, low[axis] - margin);
        high[axis] = std::min<Index>(image.sizes[axis] - 1, high[axis] + margin);
        part.sizes[axis] = high[axis] - low[axis] + 1;
        part.origin = part.origin + static_cast<double>(low[axis]) * image.steps[axis];
    }
    part.values.resize(static_cast<std::size_t>(part.sizes[0]) * part.sizes[1] * part.sizes[2]);
    std::vector<float> memory;
    auto to = part.values.begin();
    for (Index k = low[2]; k <= high[2]; ++k) {
        stop_if_cancelled();
        for (Index j = low[1]; j <= high[1]; ++j) {
            to = std::ranges::transform(image.row(low[0], part.sizes[0], j, k, memory), to, of).out;
        }
    }
    return part;
}

/// The part of a mask that is not empty, with a margin where the image has one.
/// \throws UnusableInput if all of it is empty
Image cropped_mask(const CanonicalImage& image, Index margin) {
    const auto [count, low, high] = inside_voxels(image, [](float value) { return value > kMaskLevel; });
    if (count == 0) {
        throw UnusableInput("no voxel is above 0.5: the mask is empty");
    }
    return cropped(image, {low, high}, margin, std::identity());
}

/// How far around a mask its smoothing looks, and one voxel more; without smoothing what the default needs.
Index margin_of(double width) { return reach_of_smoothing(width > 0.0 ? width : MaskSmoothing().width) + 2; }

using LabelCounts = std::map<float, LabelCount>;

void add(LabelCounts& counts, const LabelCount& more) {
    const auto [place, is_new] = counts.try_emplace(more.label, more);
    if (!is_new) {
        LabelCount& count = place->second;
        count.voxels += more.voxels;
        for (int axis = 0; axis < 3; ++axis) {
            count.low[axis] = std::min(count.low[axis], more.low[axis]);
            count.high[axis] = std::max(count.high[axis], more.high[axis]);
        }
    }
}

/// Counts the values other than 0 in slice `k`. \return false, without counting all, if they are no labels
bool count_labels(const ImageView& image, Index k, LabelCounts& counts) {
    const auto& [width, height, depth] = image.sizes;
    const float* row = image.values.data() + static_cast<std::size_t>(k) * width * height;
    for (Index j = 0; j < height; ++j, row += width) {
        for (Index i = 0; i < width;) {
            const float value = row[i];
            const Index begin = i++;
            while (i < width && row[i] == value) {
                ++i;
            }
            if (value == 0.0F) {
                continue;
            }
            if (value != std::floor(value) || std::abs(value) > kMostExactFloat || counts.size() > kMostLabels) {
                return false;
            }
            add(counts, {value, i - begin, {begin, j, k}, {i - 1, j, k}});
        }
    }
    return true;
}

/// Throws if the sizes and the values do not belong together, or the steps do not span space.
void check_layout(const ImageView& image) {
    const auto [width, height, depth] = image.sizes;
    const auto text_of_sizes = [&] {
        const auto& sizes = image.sizes;
        return std::to_string(sizes[0]) + " x " + std::to_string(sizes[1]) + " x " + std::to_string(sizes[2]);
    };
    if (std::min({width, height, depth}) < 1) {
        throw UnusableInput("the image has no voxels: its sizes are " + text_of_sizes());
    }
    // The product of two of them cannot overflow, and that of all is not needed.
    const std::size_t slice = static_cast<std::size_t>(width) * height;
    if (image.values.size() % slice != 0 || image.values.size() / slice != static_cast<std::size_t>(depth)) {
        throw UnusableInput("the image has " + std::to_string(image.values.size()) + " values, its sizes are " +
                            text_of_sizes());
    }
    const auto& [a, b, c] = image.steps;
    const double volume = std::abs(dot(a, cross(b, c)));
    if (!is_finite(image.origin) || !std::isfinite(volume) || !(volume > 1e-6 * norm(a) * norm(b) * norm(c))) {
        throw UnusableInput("the spacing or the directions of the image are not usable: its axes do not span space");
    }
    Box box;
    for (int corner = 0; corner < 8; ++corner) {
        Point p = image.origin;
        for (int axis = 0; axis < 3; ++axis) {
            p = p + ((corner >> axis & 1) != 0 ? image.sizes[axis] - 0.5 : -0.5) * image.steps[axis];
        }
        box.extend(p);
    }
    if (Diagnostic fault = extent_fault(box, "voxels"); !fault.empty()) {
        throw UnusableInput(std::move(fault));
    }
}

void check_width(double smoothing_width) {
    require(kMaskSmoothingRange.contains(smoothing_width),
            "the width of the smoothing of masks must lie between 0 and 10 voxels");
}

/// See `smoothed_mask`. \param free_mask is called as soon as `mask` is not needed any more
template <class Free>
Image smoothed(const ImageView& mask, const MaskSmoothing& options, const Execution& execution, const Free& free_mask) {
    check_width(options.width);
    return in_arena(execution, [&] {
        report(execution, kMaskStage, 0.0);
        check(mask, execution);
        Image image = cropped_mask(canonical(mask), margin_of(options.width));
        free_mask();
        if (options.width > 0.0) {
            smooth_mask(image, options.width, execution);
        }
        report(execution, kMaskStage, 1.0);
        return image;
    });
}

}  // namespace

void check(const ImageView& image, const Execution& execution) {
    check_layout(image);
    const std::size_t slice = image.values.size() / image.sizes[2];
    in_arena(execution, [&] {
        const auto first_of_slices = collect<std::vector<std::size_t>>(
            static_cast<std::size_t>(image.sizes[2]),
            [&](std::size_t k, std::vector<std::size_t>& out) {
                const std::span<const float> values = image.values.subspan(k * slice, slice);
                int count = 0;
                for (const float value : values) {
                    count += std::isnan(value) ? 1 : 0;
                }
                if (count > 0) {
                    const auto nan = std::ranges::find_if(values, [](float value) { return std::isnan(value); });
                    out.push_back(k * slice + (nan - values.begin()));
                }
            },
            std::size_t{1});
        if (!first_of_slices.empty()) {
            throw UnusableInput(text_of(image, first_of_slices.front()) + " is not a number");
        }
    });
}

std::vector<LabelCount> labels(const ImageView& image, const Execution& execution) {
    return in_arena(execution, [&] {
        LabelCounts all;
        std::atomic<bool> are_labels = true;
        std::mutex mutex;
        const auto count_slice = [&](Index k) {
            LabelCounts counts;
            if (!are_labels || !count_labels(image, k, counts)) {
                are_labels = false;
                return;
            }
            const std::lock_guard lock(mutex);  // what is added makes the same in any order
            for (const auto& [label, count] : counts) {
                add(all, count);
            }
            if (all.size() > kMostLabels) {
                are_labels = false;
            }
        };
        for_each_index(image.sizes[2], count_slice, Index{1});
        std::vector<LabelCount> result;
        for (const auto& [label, count] : all) {
            result.push_back(count);
        }
        return are_labels ? result : std::vector<LabelCount>();
    });
}

Image label_mask(const ImageView& image, const LabelCount& label, double smoothing_width) {
    check_width(smoothing_width);
    const CanonicalImage view = canonical(image);
    IndexBox box;
    for (int axis = 0; axis < 3; ++axis) {
        const int from = view.axes[axis];
        const Index last = view.sizes[axis] - 1;
        box.low[axis] = view.is_turned[axis] ? last - label.high[from] : label.low[from];
        box.high[axis] = view.is_turned[axis] ? last - label.low[from] : label.high[from];
    }
    return cropped(view, box, margin_of(smoothing_width),
                   [&](float value) { return value == label.label ? 1.0F : 0.0F; });
}

Image mask(Image image, std::span<const float> labels, const Execution& execution) {
    return in_arena(execution, [&] {
        check(image, execution);
        std::vector<std::int64_t> counts(labels.size());
        bool is_empty = true;
        CancellationPoint cancellation(kVoxelsAtOnce);
        for (float& value : image.values) {
            cancellation();
            bool is_inside = value != 0.0F;
            if (!labels.empty()) {
                const auto label = std::ranges::find(labels, value);
                is_inside = label != labels.end();
                if (is_inside) {
                    ++counts[label - labels.begin()];
                }
            }
            is_empty = is_empty && !is_inside;
            value = is_inside ? 1.0F : 0.0F;
        }
        for (const float label : labels) {
            if (counts[std::ranges::find(labels, label) - labels.begin()] == 0) {  // the first of equal ones
                Words text;
                text << "no voxel has the label " << label << "; choose one that the image has";
                throw UnusableInput(text.str());
            }
        }
        if (is_empty) {
            throw UnusableInput("all voxels are 0: the mask is empty");
        }
        return std::move(image);
    });
}

std::int64_t border_voxels(const ImageView& image, const Level& level) {
    check_layout(image);
    const auto& [width, height, depth] = image.sizes;
    const float iso = static_cast<float>(level.iso);
    std::int64_t count = 0;
    const float* value = image.values.data();
    for (Index k = 0; k < depth; ++k) {
        for (Index j = 0; j < height; ++j, value += width) {
            const bool is_side = k == 0 || j == 0 || k + 1 == depth || j + 1 == height;
            for (Index i = 0; i < width; i += is_side || i + 1 == width ? 1 : width - 1) {
                count += (level.is_below ? value[i] < iso : value[i] > iso) ? 1 : 0;
            }
        }
    }
    return count;
}

CanonicalImage canonical(const ImageView& image) {
    std::array<int, 3> order{0, 1, 2};  // order[a]: the axis of the image that is nearest to x, y, z
    std::array<int, 3> best = order;
    double most = -1.0;
    do {
        const auto along = [&](int axis) {
            const Point& step = image.steps[order[axis]];
            return std::abs(component(step, axis)) / norm(step);
        };
        if (const double product = along(0) * along(1) * along(2) + 1e-12 * along(0); product > most + 1e-9) {
            most = product;
            best = order;
        }
    } while (std::ranges::next_permutation(order).found);

    CanonicalImage result;
    result.origin = image.origin;
    result.first = image.values.data();
    const std::array<std::ptrdiff_t, 3> strides{1, image.sizes[0],
                                                static_cast<std::ptrdiff_t>(image.sizes[0]) * image.sizes[1]};
    for (int axis = 0; axis < 3; ++axis) {
        const int from = best[axis];
        const bool is_turned = component(image.steps[from], axis) < 0.0;
        result.sizes[axis] = image.sizes[from];
        result.steps[axis] = is_turned ? -1.0 * image.steps[from] : image.steps[from];
        result.strides[axis] = is_turned ? -strides[from] : strides[from];
        result.axes[axis] = from;
        result.is_turned[axis] = is_turned;
        if (is_turned) {
            result.origin = result.origin + static_cast<double>(image.sizes[from] - 1) * image.steps[from];
            result.first += (image.sizes[from] - 1) * strides[from];
        }
    }
    return result;
}

Image smoothed_mask(const ImageView& mask, const MaskSmoothing& options, const Execution& execution) {
    return smoothed(mask, options, execution, [] {});
}

Image smoothed_mask(Image mask, const MaskSmoothing& options, const Execution& execution) {
    return smoothed(mask, options, execution, [&] { mask = {}; });
}

}  // namespace scaleaxis::inline v1
