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

void Page::add(std::string name, std::string model) {
    names.push_back(std::move(name));
    models.push_back(std::move(model));
}

void Page::write(const std::filesystem::path& file) const {
    const ViewLayout layout = models.size() > kMostSideBySide ? ViewLayout::kContactSheet : ViewLayout::kSideBySide;
    write_view(file, title_of(names), layout, models);
}

std::string text_of_page(const std::filesystem::path& file) {
    return "\nview -> " + file.string() + " (open it in a browser)\n";
}

void print_page(const std::filesystem::path& file) { print_text(text_of_page(file)); }

std::filesystem::path page_output(const std::string& pattern, const std::filesystem::path& input, double scale) {
    if (pattern.empty()) {
        return {};
    }
    const std::filesystem::path file = expand(output_pattern(pattern, "view", false, "html"), input, scale);
    check_output(file, check_view_output);
    return file;
}

void write_page(const std::filesystem::path& file, const ViewedModel& model, bool is_told, const Execution& execution) {
    Page page;
    page.add(model.name, view_data(model, execution));
    page.write(file);
    if (is_told) {
        print_page(file);
    }
}

}  // namespace scaleaxis::app
