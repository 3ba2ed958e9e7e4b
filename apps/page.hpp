// SPDX-License-Identifier: Apache-2.0
/// \file
/// The interactive page of several subcommands.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/view.hpp"

namespace scaleaxis::app {

/// As many models are seen beside each other; more are a contact sheet.
inline constexpr std::size_t kMostSideBySide = 6;

/// A page in the making.
struct Page {
    std::vector<std::string> names;
    std::vector<std::string> models;  ///< what `view_data` has made of each

    void add(std::string name, std::string model);

    /// \throws FileError
    void write(const std::filesystem::path& file) const;
};

/// Where the page is and how to open it, for people; on stdout.
std::string text_of_page(const std::filesystem::path& file);
void print_page(const std::filesystem::path& file);

/// Where a command writes its page, after a check that it can be written; empty if none is asked for.
/// \param pattern what `--view` gives, see `output_pattern` \throws FileError, InvalidOption
std::filesystem::path page_output(const std::string& pattern, const std::filesystem::path& input, double scale);

/// Writes the page of one model. \param is_told on stdout, too \throws as `view_data`
void write_page(const std::filesystem::path& file, const ViewedModel& model, bool is_told, const Execution& execution);

}  // namespace scaleaxis::app
