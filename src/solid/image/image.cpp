// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaleaxis/image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "kernel/parallel.hpp"
#include "scaleaxis/errors.hpp"
#include "shapes/canonical_image.hpp"

namespace scaleaxis {
namespace {

constexpr float kMostLabel = 1 << 24;  // beyond it floats are not all integers
constexpr std::size_t kMostLabels = 65535;
constexpr double kMostWidth = 10.0;
constexpr float kIso = 0.5F;
constexpr float kTooFar = 0.125F;  // beyond it, for a thin part to be kept

double component(const Point& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

std::string text_of(const Image& image, std::size_t voxel) {
    const std::size_t width = image.sizes[0];
    const std::size_t height = image.sizes[1];
    std::ostringstream text;
    text << "voxel (" << voxel % width << ", " << voxel / width % height << ", " << voxel / width / height << ')';
    return text.str();
}

/// Weights of a Gaussian kernel at 0, 1, 2…; their sum with both signs is 1.
std::vector<float> gaussian_weights(double width) {
    std::vector<double> weights{1.0};
    double sum = 1.0;
    for (int i = 1; i <= std::ceil(3.0 * width); ++i) {
        weights.push_back(std::exp(-0.5 * i * i / (width * width)));
        sum += 2.0 * weights.back();
    }
    std::vector<float> result;
    for (const double weight : weights) {
        result.push_back(static_cast<float>(weight / sum));
    }
    return result;
}

/// Convolves rows of `length` values along one axis, many at a time: `count` values beside each other, `stride` apart
/// along the axis. Beyond the ends the values are those at the ends.
void convolve(float* values, Index length, std::size_t stride, std::size_t count, const std::vector<float>& weights,
              std::vector<float>& buffer) {
    const auto reach = static_cast<Index>(weights.size()) - 1;
    buffer.resize((length + 2 * reach) * count);
    for (Index i = -reach; i < length + reach; ++i) {
        const float* from = values + std::clamp<Index>(i, 0, length - 1) * stride;
        std::copy_n(from, count, buffer.data() + (i + reach) * count);
    }
    for (Index i = 0; i < length; ++i) {
        float* to = values + i * stride;
        const float* middle = buffer.data() + (i + reach) * count;
        for (std::size_t n = 0; n < count; ++n) {
            to[n] = weights[0] * middle[n];
        }
        for (Index d = 1; d <= reach; ++d) {
            const float weight = weights[d];
            const float* left = middle - d * count;
            const float* right = middle + d * count;
            for (std::size_t n = 0; n < count; ++n) {
                to[n] += weight * (left[n] + right[n]);
            }
        }
    }
}

void blur(Image& image, const std::vector<float>& weights) {
    const std::size_t width = image.sizes[0];
    const std::size_t height = image.sizes[1];
    const std::size_t depth = image.sizes[2];
    float* const values = image.values.data();
    constexpr std::size_t kTogether = 64;
    kernel::for_each_index(
        depth,
        [&](std::size_t k) {
            std::vector<float> buffer;
            float* const slice = values + k * width * height;
            for (std::size_t j = 0; j < height; ++j) {
                convolve(slice + j * width, image.sizes[0], 1, 1, weights, buffer);
            }
            for (std::size_t i = 0; i < width; i += kTogether) {
                convolve(slice + i, image.sizes[1], width, std::min(kTogether, width - i), weights, buffer);
            }
        },
        std::size_t{1});
    kernel::for_each_index(
        height,
        [&](std::size_t j) {
            std::vector<float> buffer;
            for (std::size_t i = 0; i < width; i += kTogether) {
                convolve(values + j * width + i, image.sizes[2], width * height, std::min(kTogether, width - i),
                         weights, buffer);
            }
        },
        std::size_t{1});
}

/// The level for which the part of a smoothed mask above it has a volume of `volume` voxels. A voxel counts by the part
/// of it that is above if the mask has a flat boundary there.
float level_with(const std::vector<float>& values, double width, double volume) {
    constexpr int kClasses = 4096;
    std::vector<std::int64_t> classes(kClasses);
    for (const float value : values) {
        ++classes[std::clamp(static_cast<int>(value * kClasses), 0, kClasses - 1)];
    }
    const double slope = 1.0 / (std::max(width, 0.5) * std::sqrt(2.0 * std::numbers::pi));  // a voxel, at the boundary
    const auto volume_above = [&](double level) {
        double sum = 0.0;
        for (int i = 0; i < kClasses; ++i) {
            const double value = (i + 0.5) / kClasses;
            sum += static_cast<double>(classes[i]) * std::clamp(0.5 + (value - level) / slope, 0.0, 1.0);
        }
        return sum;
    };
    double low = 0.0;
    double high = 1.0;
    for (int step = 0; step < 30; ++step) {
        const double middle = 0.5 * (low + high);
        (volume_above(middle) > volume ? low : high) = middle;
    }
    return static_cast<float>(low);
}

/// Is a voxel in no block of 2 x 2 x 2 voxels of its side? The image goes on beyond its border as it is there.
bool is_thin(const std::array<Index, 3>& sizes, const std::vector<bool>& is_inside, std::size_t voxel) {
    const std::size_t width = sizes[0];
    const std::size_t height = sizes[1];
    const std::array<Index, 3> at{static_cast<Index>(voxel % width), static_cast<Index>(voxel / width % height),
                                  static_cast<Index>(voxel / width / height)};
    const auto is_equal = [&](int block, int corner) {
        std::array<std::size_t, 3> n{};
        for (int axis = 0; axis < 3; ++axis) {
            const Index by = (block >> axis & 1) != 0 ? 1 : -1;
            n[axis] = std::clamp<Index>(at[axis] + ((corner >> axis & 1) != 0 ? by : 0), 0, sizes[axis] - 1);
        }
        return is_inside[(n[2] * height + n[1]) * width + n[0]] == is_inside[voxel];
    };
    for (int block = 0; block < 8; ++block) {
        int corner = 1;
        while (corner < 8 && is_equal(block, corner)) {
            ++corner;
        }
        if (corner == 8) {
            return false;
        }
    }
    return true;
}

/// The part of a mask that is not empty, with a margin where the image has one.
Image cropped(const Image& image, Index margin) {
    const auto& [width, height, depth] = image.sizes;
    std::array<Index, 3> low{width, height, depth};
    std::array<Index, 3> high{-1, -1, -1};
    std::size_t row = 0;
    for (Index k = 0; k < depth; ++k) {
        for (Index j = 0; j < height; ++j, row += width) {
            const auto begin = image.values.begin() + static_cast<std::ptrdiff_t>(row);
            const auto end = begin + width;
            const auto is_inside = [](float value) { return value > kIso; };
            const auto first = std::find_if(begin, end, is_inside);
            if (first != end) {
                const auto last =
                    std::find_if(std::make_reverse_iterator(end), std::make_reverse_iterator(first), is_inside);
                const std::array<Index, 3> from{static_cast<Index>(first - begin), j, k};
                const std::array<Index, 3> to{static_cast<Index>(last.base() - begin) - 1, j, k};
                for (int axis = 0; axis < 3; ++axis) {
                    low[axis] = std::min(low[axis], from[axis]);
                    high[axis] = std::max(high[axis], to[axis]);
                }
            }
        }
    }
    Image part;
    part.steps = image.steps;
    part.origin = image.origin;
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::max<Index>(0, low[axis] - margin);
        high[axis] = std::min<Index>(image.sizes[axis] - 1, high[axis] + margin);
        part.sizes[axis] = high[axis] - low[axis] + 1;
        part.origin = part.origin + static_cast<double>(low[axis]) * image.steps[axis];
    }
    part.values.reserve(static_cast<std::size_t>(part.sizes[0]) * part.sizes[1] * part.sizes[2]);
    for (Index k = low[2]; k <= high[2]; ++k) {
        for (Index j = low[1]; j <= high[1]; ++j) {
            const auto begin = image.values.begin() + (static_cast<std::ptrdiff_t>(k) * height + j) * width;
            part.values.insert(part.values.end(), begin + low[0], begin + high[0] + 1);
        }
    }
    return part;
}

}  // namespace

void check(const Image& image) {
    const auto& [width, height, depth] = image.sizes;
    if (std::min({width, height, depth}) < 1) {
        throw UnusableShape("the image has no voxels: its sizes are " + std::to_string(width) + " x " +
                            std::to_string(height) + " x " + std::to_string(depth));
    }
    if (image.values.size() != static_cast<std::size_t>(width) * height * depth) {
        throw UnusableShape("the image has " + std::to_string(image.values.size()) + " values, its sizes are " +
                            std::to_string(width) + " x " + std::to_string(height) + " x " + std::to_string(depth));
    }
    const auto& [a, b, c] = image.steps;
    const double volume = std::abs(dot(a, cross(b, c)));
    if (!is_finite(image.origin) || !std::isfinite(volume) || !(volume > 1e-6 * norm(a) * norm(b) * norm(c))) {
        throw UnusableShape("the spacing or the directions of the image are not usable: its axes do not span space");
    }
    const auto nan = std::ranges::find_if(image.values, [](float value) { return std::isnan(value); });
    if (nan != image.values.end()) {
        throw UnusableShape(text_of(image, nan - image.values.begin()) + " is not a number");
    }
}

std::vector<LabelCount> labels(const Image& image) {
    std::map<float, std::int64_t> counts;
    for (std::size_t i = 0; i < image.values.size();) {
        const float value = image.values[i];
        const std::size_t begin = i;
        while (i < image.values.size() && image.values[i] == value) {
            ++i;
        }
        if (value != 0.0F) {
            counts[value] += static_cast<std::int64_t>(i - begin);
            if (value != std::floor(value) || std::abs(value) > kMostLabel || counts.size() > kMostLabels) {
                return {};
            }
        }
        i = std::max(i, begin + 1);
    }
    std::vector<LabelCount> result;
    for (const auto& [label, count] : counts) {
        result.push_back({label, count});
    }
    return result;
}

Image mask(Image image, std::span<const float> labels) {
    check(image);
    std::vector<std::int64_t> counts(labels.size());
    bool is_empty = true;
    for (float& value : image.values) {
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
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (counts[i] == 0) {
            std::ostringstream text;
            text << "no voxel has the label " << labels[i] << "; scaleaxis info lists those that there are";
            throw UnusableShape(text.str());
        }
    }
    if (is_empty) {
        throw UnusableShape("all voxels are 0: the mask is empty");
    }
    return image;
}

std::int64_t border_voxels(const Image& image, const Level& level) {
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

Image canonical(Image image) {
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

    Image result;
    result.origin = image.origin;
    std::array<std::ptrdiff_t, 3> strides{1, image.sizes[0],
                                          static_cast<std::ptrdiff_t>(image.sizes[0]) * image.sizes[1]};
    std::array<std::ptrdiff_t, 3> by{};
    std::ptrdiff_t first = 0;
    bool is_canonical = true;
    for (int axis = 0; axis < 3; ++axis) {
        const int from = best[axis];
        const bool is_turned = component(image.steps[from], axis) < 0.0;
        result.sizes[axis] = image.sizes[from];
        result.steps[axis] = is_turned ? -1.0 * image.steps[from] : image.steps[from];
        by[axis] = is_turned ? -strides[from] : strides[from];
        if (is_turned) {
            result.origin = result.origin + static_cast<double>(image.sizes[from] - 1) * image.steps[from];
            first += (image.sizes[from] - 1) * strides[from];
        }
        is_canonical = is_canonical && from == axis && !is_turned;
    }
    if (is_canonical) {
        return image;
    }
    result.values.resize(image.values.size());
    std::size_t to = 0;
    for (Index k = 0; k < result.sizes[2]; ++k) {
        for (Index j = 0; j < result.sizes[1]; ++j) {
            const float* from = image.values.data() + first + k * by[2] + j * by[1];
            for (Index i = 0; i < result.sizes[0]; ++i, from += by[0]) {
                result.values[to++] = *from;
            }
        }
    }
    return result;
}

Image smoothed_mask(Image image, const MaskSmoothing& options, const Execution& execution) {
    if (!(options.width >= 0.0 && options.width <= kMostWidth)) {
        throw InvalidOption("the width of the smoothing of masks must lie between 0 and 10 voxels");
    }
    return kernel::in_arena(execution, [&] {
        kernel::report(execution, "mask", 0.0);
        const std::vector<float> weights = gaussian_weights(options.width > 0.0 ? options.width : 1.0);
        image = canonical(std::move(image));
        image = cropped(image, static_cast<Index>(weights.size()) + 1);
        if (options.width == 0.0) {
            return std::move(image);
        }
        std::vector<bool> is_inside(image.values.size());
        std::transform(image.values.begin(), image.values.end(), is_inside.begin(),
                       [](float value) { return value > kIso; });
        const auto inside = static_cast<double>(std::count(is_inside.begin(), is_inside.end(), true));
        blur(image, weights);
        const float level = level_with(image.values, options.width, inside);
        for (std::size_t i = 0; i < image.values.size(); ++i) {
            const float difference = image.values[i] - level;
            const bool is_lost =
                (is_inside[i] ? difference : -difference) < -kTooFar && is_thin(image.sizes, is_inside, i);
            image.values[i] = is_lost ? kIso - difference : kIso + difference;
        }
        if (std::ranges::none_of(image.values, [](float value) { return value > kIso; })) {
            throw UnusableShape(
                "nothing is left of the mask when it is smoothed: its parts are too small for that; "
                "smooth less, or by 0");
        }
        return std::move(image);
    });
}

}  // namespace scaleaxis
