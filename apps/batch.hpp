// SPDX-License-Identifier: Apache-2.0
/// \file
/// The solids of one call: one after the other, or the labels of an image at the same time.
#pragma once

#include <cstddef>
#include <exception>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "documents.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "source.hpp"
#include "status.hpp"
#include "terminal.hpp"

namespace scaleaxis::app {

/// How the work at a solid tells what it does.
struct Listener {
    std::function<Execution(const WorkShare&)> execution;
    std::function<void(const std::filesystem::path& about, const Diagnostic&)> warn;

    std::function<void(const Diagnostic&)> warn_about(const std::filesystem::path& input) const {
        return [this, input](const Diagnostic& warning) { warn(input, warning); };
    }
};

/// Are both labels of one image?
bool is_of_same_image(const Source& a, const Source& b);

/// Calls `work(i, listener)` for each source: one after the other, but labels of an image at the same time, the large
/// ones first, since a large one that begins last would keep one thread busy while the others have nothing to do. Calls
/// `tell(i)` in the order of the sources, after the warnings of this one.
/// \param work with several sources throws `Cancelled` only
void for_each_source(const std::vector<Source>& sources, const CommonOptions& options, const std::stop_token& cancel,
                     const std::function<void(std::size_t, const Listener&)>& work,
                     const std::function<void(std::size_t)>& tell);

/// What statistics say of a source before anything of it is known.
Json entry_of(const Source& source);

/// Adds to the entry what went wrong. \return the error for people
std::string add_error(const Source& source, const std::exception& error, Json& entry);

/// What `work` returns; what goes wrong is told with the name of its source.
Status telling_source(const Source& source, const std::function<Status()>& work);

/// Tells how many of several inputs failed, if any did.
void print_failures(std::size_t failures, std::size_t inputs);

/// What has become of a source.
struct SourceResult {
    Json entry;           ///< in the statistics
    std::string summary;  ///< for people
    Status status = kDone;
};

/// Runs a command on one solid, or with `--each-label` and `--each-object` on several: then the statistics have
/// `results`, and one that fails is told and does not stop the others.
/// \param head of the statistics \return the worst status
Status run_sources(const std::vector<Source>& sources, const SourceOptions& source_options,
                   const CommonOptions& options, Json head, const std::stop_token& cancel,
                   const std::function<SourceResult(std::size_t, const Listener&)>& work);

/// Finds out whether a source is an axis that is there already, and keeps what is read only once.
void find_kind(Source& source);

/// The sources of a command that takes one input, a solid or an axis that is there already, several with
/// `--each-label` or `--each-object`. \param input empty: none \throws InvalidOption
std::vector<Source> sources_of_one(const std::filesystem::path& input, const SourceOptions& options);

/// \throws InvalidOption if an output is the same as another one
void check_all_outputs(std::vector<Output> outputs, CommonOptions& options);

}  // namespace scaleaxis::app
