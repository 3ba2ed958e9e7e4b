// SPDX-License-Identifier: Apache-2.0
#include "inputs.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>
#include <sstream>
#include <system_error>

#include "io/text_reader.hpp"
#include "readable.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

bool is_stdin(const fs::path& file) { return file == "-" || file == "/dev/stdin"; }

bool has_extension_of_input(const fs::path& file, const std::vector<std::string>& extensions) {
    std::string name = file.filename().string();
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    name = name.ends_with(".gz") ? name.substr(0, name.size() - 3) : name;
    return std::ranges::any_of(extensions, [&](const std::string& extension) {
        return extension != ".txt" && name.size() > extension.size() && name.ends_with(extension);
    });
}

std::vector<Input> files_of_folder(const fs::path& folder, const std::string& origin) {
    const std::vector<std::string> extensions = input_extensions();
    std::vector<Input> files;
    try {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
            if (entry.is_regular_file() && has_extension_of_input(entry.path(), extensions)) {
                files.push_back({entry.path(), origin});
            }
        }
    } catch (const fs::filesystem_error& error) {
        throw FileError(Diagnostic{"file.open", folder.string() + ": cannot read: " + error.code().message()});
    }
    if (files.empty()) {
        return {{folder, origin}};  // it is met again where errors of this input are reported
    }
    std::ranges::sort(files, {}, &Input::file);
    return files;
}

std::vector<Input> files_of(const fs::path& input, const std::string& origin) {
    std::error_code error;
    return fs::is_directory(input, error) ? files_of_folder(input, origin) : std::vector{Input{input, origin}};
}

std::string text_of(const fs::path& list) {
    return reading(list, {}, [&](const fs::path& path) {
        std::ifstream stream(path, std::ios::binary);
        std::ostringstream text;
        text << stream.rdbuf();
        if (!stream || fs::is_directory(path)) {
            throw FileError(Diagnostic{"file.open", list.string() + ": this list of inputs cannot be read"});
        }
        return text.str();
    });
}

std::vector<Input> files_of_list(const fs::path& list) {
    std::vector<Input> files;
    std::istringstream text(text_of(list));
    std::size_t number = 0;
    for (std::string line; std::getline(text, line);) {
        ++number;
        line = io::trimmed(io::text_beginning(line));
        if (line.empty() || line.starts_with('#')) {
            continue;
        }
        const std::string origin = list.string() + ", line " + std::to_string(number);
        if (line == "-" || line.starts_with('@')) {
            throw FileError(Diagnostic{"file.value", origin + ": " + line + ": a list names files and folders only"});
        }
        try {
            const fs::path folder = is_stdin(list) ? fs::path() : list.parent_path();
            const std::vector<Input> named = files_of(folder / line, origin);
            files.insert(files.end(), named.begin(), named.end());
        } catch (const FileError& error) {
            throw FileError(Diagnostic{error.diagnostic().code, origin + ": " + error.what()});
        }
    }
    if (files.empty()) {
        throw FileError(Diagnostic{"file.value", list.string() + ": this list names no input"});
    }
    return files;
}

// Those of this run of the program.
std::set<fs::path>& named_inputs() {
    static std::set<fs::path> files;
    return files;
}

}  // namespace

fs::path without_links(const fs::path& file) {
    std::error_code error;
    const fs::path path = fs::weakly_canonical(fs::absolute(file), error);
    return error ? fs::absolute(file) : path;
}

void forget_inputs() { named_inputs().clear(); }

void protect_input(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    // Pipes and devices cannot be overwritten.
    if (fs::is_regular_file(status) || !fs::exists(status)) {
        named_inputs().insert(without_links(file));
    }
}

void check_is_no_input(const fs::path& file) {
    if (named_inputs().contains(without_links(file))) {
        throw InvalidOption("the output would overwrite the input " + file.string() +
                            ": choose another name or folder");
    }
}

bool is_folder_without_inputs(const fs::path& file) {
    std::error_code error;
    return fs::is_directory(file, error) && files_of_folder(file, {}).front().file == file;
}

std::vector<Input> expanded(const std::vector<fs::path>& inputs) {
    std::vector<Input> files;
    std::ptrdiff_t reads_of_stdin = 0;
    for (const fs::path& input : inputs) {
        const std::string name = input.string();
        const bool is_list = name.size() > 1 && name.starts_with('@');
        const fs::path named = is_list ? fs::path(name.substr(1)) : input;
        protect_input(named);
        reads_of_stdin += is_stdin(named) ? 1 : 0;
        if (reads_of_stdin > 1) {
            throw InvalidOption("standard input can be read only once, and is named twice");
        }
        const std::vector<Input> found = is_list ? files_of_list(named) : files_of(named, {});
        files.insert(files.end(), found.begin(), found.end());
    }
    std::ranges::for_each(files, protect_input, &Input::file);
    return files;
}

}  // namespace scaleaxis::app
