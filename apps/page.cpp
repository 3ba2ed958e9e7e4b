// SPDX-License-Identifier: Apache-2.0
#include "page.hpp"

#include <algorithm>
#include <utility>

#include "outputs.hpp"

namespace scaleaxis::app {

namespace {

std::string title_of(const std::vector<std::string>& names) {
    if (names.size() > kMostSideBySide) {
        return std::to_string(names.size()) + " models";
    }
    std::string title;
    for (const std::string& name : names) {
        title += (title.empty() ? "" : ", ") + name;
    }
    return title;
}

}  // namespace

ViewedAxis viewed(Filtration filtration, std::vector<FiltrationLevel> levels, std::string statistics) {
    const ScalePlateau plateau = longest_plateau(levels);
    return {1.0,
            std::move(filtration.complex),
            {},
            std::move(statistics),
            ViewedScales{std::move(filtration.vertex_scales), std::move(filtration.edge_scales),
                         std::move(filtration.face_scales), std::move(levels), plateau}};
}

void Page::add(std::string name, std::string model) {
    names.push_back(std::move(name));
    models.push_back(std::move(model));
}

void Page::write(const std::filesystem::path& file) const {
    const ViewLayout layout = models.size() > kMostSideBySide ? ViewLayout::kContactSheet : ViewLayout::kSideBySide;
    write_view(file, title_of(names), layout, models);
}

void print_page(const std::filesystem::path& file) {
    print_text("\nview -> " + file.string() + " (open it in a browser)\n");
}

}  // namespace scaleaxis::app
