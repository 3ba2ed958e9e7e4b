// SPDX-License-Identifier: Apache-2.0
#include "documents.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <utility>

#include "outputs.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/version.hpp"

namespace scaleaxis::app {

namespace {

bool is_schema_of_axis(const Json& document) {
    const Json schema = document.value("schema", Json());
    return schema == Json("scaleaxis.axis/1") || schema == Json("scaleaxis.axis/2");
}

bool is_result(const Json& result) { return result.value("input", Json()).is_string(); }

/// In place of the result of the same input, unless that has axes and this one has none.
void replace_or_add(Json result, Json& results) {
    if (results.is_null()) {
        results = Json::array();
    }
    Json::Elements& all = results.elements();
    const auto same = std::ranges::find_if(all, [&](const Json& r) { return r.at("input") == result.at("input"); });
    if (same == all.end()) {
        all.push_back(std::move(result));
    } else if (result.contains("axes") || !same->contains("axes")) {
        *same = std::move(result);
    }
}

std::optional<Json> read_lines(std::istream& stream) {
    Json document;
    for (std::string text; std::getline(stream, text);) {
        Json line = Json::parse(text);
        if (is_schema_of_axis(line)) {
            line.erase("results");  // each has a line of its own
            document.update(line);
        } else if (document.is_null()) {
            return std::nullopt;
        } else if (is_result(line)) {  // the last line may be incomplete
            line["options"] = document.value("options", Json());
            replace_or_add(std::move(line), document["results"]);
        }
    }
    return document.is_null() ? std::nullopt : std::optional(std::move(document));
}

}  // namespace

Json new_document(const std::string& schema) { return {{"schema", schema}, {"version", SCALEAXIS_VERSION}}; }

std::string to_text(const Json& document) { return document.dump(2) + "\n"; }

std::string to_line(const Json& document) { return document.dump() + "\n"; }

std::string text_of_place(const Point& p) {
    std::ostringstream text;
    text << '(' << p.x << ", " << p.y << ", " << p.z << ')';
    return text.str();
}

bool has_lines(const std::filesystem::path& file) { return file.extension() == ".jsonl"; }

void write_statistics(const std::string& file, const Json& document) {
    if (file == "-") {
        print_text(to_text(document));
    } else if (!file.empty()) {
        write_text(file, has_lines(file) ? to_line(document) : to_text(document));
    }
}

BatchStatistics::BatchStatistics(std::string file, Json head, bool is_continued)
    : file_(std::move(file)), document_(std::move(head)) {
    if (has_lines(file_)) {
        lines_.open(file_, std::ios::binary | (is_continued ? std::ios::app : std::ios::trunc));
        write_line(document_);
    }
    document_["results"] = Json::array();
}

void BatchStatistics::add(Json result) {
    if (lines_.is_open()) {
        write_line(result);
    } else {
        document_["results"].push_back(std::move(result));
    }
}

void BatchStatistics::finish(int status) {
    if (lines_.is_open()) {
        write_line({{"status", status}});
    } else {
        document_["status"] = status;
        write_statistics(file_, document_);
    }
}

void BatchStatistics::write_line(const Json& line) {
    lines_ << to_line(line) << std::flush;
    if (!lines_) {
        throw FileError(file_ + ": cannot be written: disk full?");
    }
}

std::optional<Json> read_statistics(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (has_lines(file)) {
        return read_lines(stream);
    }
    Json document = Json::parse(std::string(std::istreambuf_iterator<char>(stream), {}));
    const Json* results = document.find("results");
    if (!is_schema_of_axis(document) || results == nullptr || !results->is_array() ||
        !std::ranges::all_of(results->elements(), is_result)) {
        return std::nullopt;
    }
    for (Json& result : document["results"].elements()) {
        result["options"] = document.value("options", Json());
    }
    return document;
}

}  // namespace scaleaxis::app
