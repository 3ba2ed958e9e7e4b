// SPDX-License-Identifier: Apache-2.0
#include "options.hpp"

#include <array>
#include <functional>
#include <utility>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::wasm {
namespace {

template <class Value>
struct Choice {
    std::string_view name;
    Value value;
};

template <class Value, std::size_t count>
Value chosen(const Json& given, const Choice<Value> (&choices)[count]) {
    const auto name = given.get<std::string>();
    std::string known;
    for (const Choice<Value>& choice : choices) {
        if (choice.name == name) {
            return choice.value;
        }
        known += (known.empty() ? "'" : ", '") + std::string(choice.name) + "'";
    }
    throw InvalidOption("'" + name + "' is none of " + known);
}

template <class Value>
std::vector<Value> list_of(const Json& given) {
    std::vector<Value> values;
    if (!given.is_array()) {
        return {given.get<Value>()};
    }
    for (const Json& element : given.elements()) {
        values.push_back(element.get<Value>());
    }
    return values;
}

Length relative(const Json& given) { return Length::relative(given.get<double>()); }
Length absolute(const Json& given) { return Length::absolute(given.get<double>()); }

CompactOptions& compact(Options& options) {
    return options.pipeline.compact ? *options.pipeline.compact : options.pipeline.compact.emplace();
}

void set_labels(Options& options, const Json& given) {
    for (const Json& label : given.is_array() ? given.elements() : Json::Elements{given}) {
        if (label.is_string()) {
            options.load.label_names.push_back(label.get<std::string>());
        } else {
            options.load.labels.push_back(label.get<float>());
        }
    }
}

struct Option {
    std::string_view name;
    void (*set)(Options& options, const Json& given);
};

constexpr std::array kOptions{
    // How the file becomes a solid.
    Option{"kind",
           [](Options& o, const Json& j) {
               o.load.kind = chosen<FileKind>(j, {{"mesh", FileKind::kMesh},
                                                  {"image", FileKind::kImage},
                                                  {"points", FileKind::kPoints},
                                                  {"balls", FileKind::kBalls}});
           }},
    Option{"triangles",
           [](Options& o, const Json& j) {
               o.load.solid.kind = chosen<SolidKind>(j, {{"auto", SolidKind::kAuto},
                                                         {"winding", SolidKind::kWinding},
                                                         {"wrap", SolidKind::kWrap},
                                                         {"thicken", SolidKind::kThicken}});
           }},
    Option{"opening", [](Options& o, const Json& j) { o.load.solid.opening = j.get<double>(); }},
    Option{"thickness", [](Options& o, const Json& j) { o.load.solid.thickness = j.get<double>(); }},
    Option{"objects", [](Options& o, const Json& j) { o.load.objects = list_of<Index>(j); }},
    Option{"iso", [](Options& o, const Json& j) { o.load.iso = j.get<double>(); }},
    Option{"below", [](Options& o, const Json& j) { o.load.is_below = j.get<bool>(); }},
    Option{"labels", set_labels},
    Option{"nonzero", [](Options& o, const Json& j) { o.load.is_nonzero = j.get<bool>(); }},
    Option{"maskSmoothing", [](Options& o, const Json& j) { o.load.mask_smoothing = j.get<double>(); }},
    Option{"fillVoids", [](Options& o, const Json& j) { o.load.fills_voids = j.get<bool>(); }},
    Option{"points",
           [](Options& o, const Json& j) {
               o.load.cloud_method =
                   chosen<CloudMethod>(j, {{"mls", CloudMethod::kMovingLeastSquares}, {"crust", CloudMethod::kCrust}});
           }},
    Option{"kernel", [](Options& o, const Json& j) { o.load.kernel = j.get<double>(); }},
    // The axis.
    Option{"delta", [](Options& o, const Json& j) { o.pipeline.delta = relative(j); }},
    Option{"deltaAbs", [](Options& o, const Json& j) { o.pipeline.delta = absolute(j); }},
    Option{"scale", [](Options& o, const Json& j) { o.pipeline.scales = list_of<double>(j); }},
    Option{"union",
           [](Options& o, const Json& j) {
               o.pipeline.union_kind =
                   chosen<UnionKind>(j, {{"polar", UnionKind::kPolar}, {"fitted", UnionKind::kFitted}});
           }},
    Option{"sampling",
           [](Options& o, const Json& j) {
               o.pipeline.sizing = chosen<Sizing>(j, {{"adaptive", Sizing::kAdaptive}, {"uniform", Sizing::kUniform}});
           }},
    Option{"angle", [](Options& o, const Json& j) { o.pipeline.filter_angle = j.get<double>(); }},
    Option{"sharp", [](Options& o, const Json& j) { o.pipeline.reaches_sharp_edges = j.get<bool>(); }},
    Option{"sharpAngle", [](Options& o, const Json& j) { o.pipeline.sharp_angle = j.get<double>(); }},
    Option{"clean", [](Options& o, const Json& j) { o.pipeline.cleaning = relative(j); }},
    Option{"cleanAbs", [](Options& o, const Json& j) { o.pipeline.cleaning = absolute(j); }},
    Option{"compact",
           [](Options& o, const Json& j) {
               if (j.get<bool>()) {
                   compact(o);
               }
           }},
    Option{"error", [](Options& o, const Json& j) { compact(o).error = relative(j); }},
    Option{"errorAbs", [](Options& o, const Json& j) { compact(o).error = absolute(j); }},
    Option{"vertices", [](Options& o, const Json& j) { compact(o).vertices = j.get<Index>(); }},
    Option{"dense", [](Options& o, const Json& j) { o.pipeline.is_dense = j.get<bool>(); }},
    Option{"smooth", [](Options& o, const Json& j) { o.pipeline.smoothing_rounds = j.get<Index>(); }},
    Option{"center", [](Options& o, const Json& j) { o.pipeline.is_centered = j.get<bool>(); }},
    Option{"seed", [](Options& o, const Json& j) { o.pipeline.seed = j.get<std::uint64_t>(); }},
    // The skeleton.
    Option{"nodeSpacing", [](Options& o, const Json& j) { o.node_spacing = relative(j); }},
    Option{"significance", [](Options& o, const Json& j) { o.skeleton.significance = j.get<double>(); }},
    Option{"radius",
           [](Options& o, const Json& j) {
               o.skeleton.radius = chosen<SkeletonRadius>(
                   j, {{"inscribed", SkeletonRadius::kInscribed}, {"mean", SkeletonRadius::kMean}});
           }},
    // Thickness.
    Option{"contactAngle", [](Options& o, const Json& j) { o.thickness.angle = j.get<double>(); }},
    Option{"edge", [](Options& o, const Json& j) { o.edge = j.get<double>(); }},
    // What is made of the results.
    Option{"formats", [](Options& o, const Json& j) { o.outputs.formats = list_of<std::string>(j); }},
    Option{"view", [](Options& o, const Json& j) { o.outputs.has_view = j.get<bool>(); }},
};

}  // namespace

Options read_options(const Json& given) {
    Options options;
    for (const auto& [name, value] : given.members()) {
        const auto known = std::find_if(kOptions.begin(), kOptions.end(),
                                        [&name = name](const Option& option) { return option.name == name; });
        if (known == kOptions.end()) {
            throw InvalidOption("there is no option '" + name + "'");
        }
        try {
            known->set(options, value);
        } catch (const JsonError& error) {
            throw InvalidOption(name + ": " + error.what());
        } catch (const InvalidOption& error) {
            throw InvalidOption(name + ": " + error.what());
        }
    }
    return options;
}

}  // namespace scaleaxis::wasm
