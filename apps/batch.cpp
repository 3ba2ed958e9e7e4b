// SPDX-License-Identifier: Apache-2.0
#include "batch.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include "interrupts.hpp"
#include "outputs.hpp"
#include "readable.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

class SourceRun {
   public:
    SourceRun(const std::vector<Source>& sources, const CommonOptions& options, const std::stop_token& cancel,
              const std::function<void(std::size_t, const Listener&)>& work,
              const std::function<void(std::size_t)>& tell)
        : sources_(sources), options_(options), cancel_(cancel), work_(work), tell_(tell) {}

    void run() {
        for (std::size_t i = 0; i < sources_.size();) {
            std::size_t end = i + 1;
            while (end < sources_.size() && is_of_same_image(sources_[i], sources_[end])) {
                ++end;
            }
            sources_[i].label ? run_labels(i, end) : run_alone(i);
            i = end;
        }
    }

   private:
    void run_alone(std::size_t i) {
        ProgressBar bar(sources_[i].name.filename().string(), options_.verbosity(), {i + 1, sources_.size(), start_});
        const Listener listener{
            [&](const WorkShare& share) { return bar.execution(options_.threads, cancel_, share); },
            [&](const fs::path& about, const Diagnostic& warning) { warn_above(bar, about)(warning); }};
        work_(i, listener);
        bar.erase();
        tell_(i);
    }

    void run_labels(std::size_t begin, std::size_t end) {
        const Source& first = sources_[begin];
        try {
            first.images->read(first.file, first.options);  // before several threads ask for it
        } catch (const Error&) {
            for (std::size_t i = begin; i < end; ++i) {
                run_alone(i);  // the error is that of each
            }
            return;
        }
        std::vector<std::size_t> order(end - begin);
        std::iota(order.begin(), order.end(), begin);
        std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return sources_[i].label->voxels; });

        ProgressBar bar(first.file.filename().string(), options_.verbosity(), {});
        const auto execution = [&](const WorkShare&) { return Execution{options_.threads, {}, cancel_}; };
        using Warnings = std::vector<std::pair<fs::path, Diagnostic>>;
        std::vector<std::optional<Warnings>> finished(order.size());
        std::size_t done = 0;
        std::size_t told = 0;
        std::mutex mutex;
        const auto work = [&](std::size_t n) {
            Warnings warnings;
            const auto warn = [&](const fs::path& about, const Diagnostic& warning) {
                warnings.emplace_back(about, warning);
            };
            work_(order[n], {execution, warn});
            const std::lock_guard lock(mutex);
            finished[order[n] - begin] = std::move(warnings);
            ++done;
            bar.erase();
            for (; told < order.size() && finished[told]; ++told) {
                for (const auto& [about, warning] : *finished[told]) {
                    print_warning(about.string() + ": " + with_hints(warning));
                }
                tell_(begin + told);
            }
            bar.show("labels", static_cast<double>(done) / static_cast<double>(order.size()));
        };
        run_concurrently(order.size(), work, execution({}));
        bar.erase();
    }

    const std::vector<Source>& sources_;
    const CommonOptions& options_;
    const std::stop_token& cancel_;
    const std::function<void(std::size_t, const Listener&)>& work_;
    const std::function<void(std::size_t)>& tell_;
    Clock::time_point start_ = Clock::now();
};

}  // namespace

bool is_of_same_image(const Source& a, const Source& b) { return a.label && b.label && a.file == b.file; }

void for_each_source(const std::vector<Source>& sources, const CommonOptions& options, const std::stop_token& cancel,
                     const std::function<void(std::size_t, const Listener&)>& work,
                     const std::function<void(std::size_t)>& tell) {
    SourceRun(sources, options, cancel, work, tell).run();
}

Json entry_of(const Source& source) {
    Json entry{{"input", source.name.string()}, {"status", kDone}, {"error", nullptr}};
    if (source.label) {
        entry["label"] = static_cast<std::int64_t>(source.label->label);
    }
    return entry;
}

std::string add_error(const Source& source, const std::exception& error, Json& entry) {
    std::string text = describe(error, source.name);
    if (!source.origin.empty()) {
        text += " (" + source.origin + ")";
    }
    entry["status"] = status_of(error);
    entry["error"] = json_of(diagnostic_of(error, text));
    return text;
}

Status telling_source(const Source& source, const std::function<Status()>& work) {
    try {
        return work();
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        print_error(describe(error, source.name));
        return status_of(error);
    }
}

void print_failures(std::size_t failures, std::size_t inputs) {
    if (failures > 0 && inputs > 1) {
        print_error(std::to_string(failures) + " of " + std::to_string(inputs) + " inputs failed");
    }
}

Status run_sources(const std::vector<Source>& sources, const SourceOptions& source_options,
                   const CommonOptions& options, Json head, const std::stop_token& cancel,
                   const std::function<SourceResult(std::size_t, const Listener&)>& work) {
    const auto print_summary = [&](const std::string& summary) {
        if (options.has_summary()) {
            print_text(summary);
        }
    };
    if (!is_each(source_options)) {
        return telling_source(sources.front(), [&] {
            SourceResult result;
            for_each_source(
                sources, options, cancel, [&](std::size_t i, const Listener& listener) { result = work(i, listener); },
                [](std::size_t) {});
            print_summary(result.summary);
            head.update(result.entry);
            write_statistics(options.statistics, head);
            return result.status;
        });
    }
    BatchStatistics statistics(options.statistics, std::move(head), false);
    std::vector<SourceResult> results(sources.size());
    std::vector<std::string> errors(sources.size());
    std::size_t failures = 0;
    Status worst = kDone;
    for_each_source(
        sources, options, cancel,
        [&](std::size_t i, const Listener& listener) {
            Json entry = entry_of(sources[i]);
            try {
                results[i] = work(i, listener);
                entry.update(results[i].entry);
                entry["status"] = results[i].status;
            } catch (const Cancelled&) {
                throw;
            } catch (const std::exception& error) {
                errors[i] = add_error(sources[i], error, entry);
            }
            results[i].entry = std::move(entry);
        },
        [&](std::size_t i) {
            auto [entry, summary, status] = std::exchange(results[i], {});
            if (errors[i].empty()) {
                print_summary(summary);
            } else {
                print_error(errors[i]);
                ++failures;
            }
            worst = worse(worst, entry["status"].get<Status>());
            statistics.add(std::move(entry));
        });
    print_failures(failures, sources.size());
    statistics.finish(worst);
    return worst;
}

void find_kind(Source& source) {
    if (!source.images && !source.meshes && !source.file.empty() && !fs::is_directory(source.file)) {
        source.readable = std::make_shared<const ReadableFile>(source.file, source.options.format);
        source.is_axis = !source.options.load.kind &&
                         reading(source, [](const fs::path& path) { return file_kind(path); }) == FileKind::kAxis;
    }
}

std::vector<Source> sources_of_one(const fs::path& input, const SourceOptions& options) {
    std::vector<Input> inputs;
    if (!input.empty()) {
        inputs.push_back({input, {}});
    }
    std::vector<Source> sources = sources_of(inputs, options);
    std::ranges::for_each(sources, find_kind);
    return sources;
}

void check_all_outputs(std::vector<Output> outputs, CommonOptions& options) {
    options.has_data_on_stdout = std::ranges::any_of(outputs, is_stdout, &Output::file);
    add_statistics_file(options.statistics, outputs);
    check_distinct(outputs);
}

}  // namespace scaleaxis::app
