// SPDX-License-Identifier: Apache-2.0
/// \file
/// JSON documents of statistics (docs/statistics.md).
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "base/formats/json.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis::app {

/// What `scaleaxis::to_json` says about `value`.
template <class Value>
Json json_of(const Value& value) {
    return Json::parse(to_json(value));
}
template <class Value>
Json json_of(const std::optional<Value>& value) {
    return value ? json_of(*value) : Json(nullptr);
}

/// The JSON document that begins with its schema and the version of the program.
Json new_document(const std::string& schema);

/// Indented, with a newline; file names that are not UTF-8 get replacement characters.
std::string to_text(const Json& document);
/// The same in one line.
std::string to_line(const Json& document);

/// A place in a summary: "(x, y, z)".
std::string text_of_place(const Point& p);

/// Are statistics in this file JSON Lines?
bool has_lines(const std::filesystem::path& file);

/// Writes the document to the file, to stdout for `-`, and nowhere for an empty name.
void write_statistics(const std::string& file, const Json& document);

/// Statistics of several results: one document when all are there; or in JSON Lines (`.jsonl`) one line for each result
/// as it comes, so that what is there stays when the program is killed.
class BatchStatistics {
   public:
    /// \param is_continued whether lines are appended to those of an earlier run
    BatchStatistics(std::string file, Json head, bool is_continued);

    /// \throws FileError if the line cannot be written
    void add(Json result);
    void finish(int status);

   private:
    void write_line(const Json& line);

    std::string file_;
    Json document_;
    std::ofstream lines_;
};

/// The document that `BatchStatistics` wrote to a file, in either form: of several results of one input the last one
/// that has axes. Each result has the `options` that it was computed with. Nothing if it is no such file.
std::optional<Json> read_statistics(const std::filesystem::path& file);

}  // namespace scaleaxis::app
