// SPDX-License-Identifier: Apache-2.0
// In place of input_file.cpp and output_file.cpp, and of the reader of TIFF, where there are no files.
#include "io/memory/without_files.hpp"

#include <utility>

#include "base/faults.hpp"
#include "base/files.hpp"
#include "io/formats.hpp"
#include "io/input_file.hpp"
#include "io/output_file.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::io {
namespace {

std::string& written() {
    static std::string bytes;
    return bytes;
}

[[noreturn]] void fail_without_files(const std::filesystem::path& file) {
    throw FileError(
        Diagnostic{"file.open", utf8_of(file) + ": this build reads no files but the bytes that it is given"});
}

}  // namespace

std::string take_written() { return std::exchange(written(), {}); }

OutputFile::OutputFile(std::filesystem::path file) : file_(std::move(file)) {}
OutputFile::~OutputFile() = default;
void OutputFile::flush() {}
void OutputFile::commit() { written() = std::move(buffer_); }

void check_output_file(const std::filesystem::path&) {}

std::string read_file(const std::filesystem::path& file, bool(std::string_view)) { fail_without_files(file); }
bool is_plain_file(const std::filesystem::path&) { return false; }
std::uintmax_t size_of_file(const std::filesystem::path& file) { fail_without_files(file); }
ByteSource bytes_of_file(const std::filesystem::path& file, std::uintmax_t) { fail_without_files(file); }

bool is_tiff(std::string_view content) {
    return content.starts_with("II*") || content.starts_with(std::string_view("MM\0*", 4));
}

Image read_tiff_image(std::string_view, const std::filesystem::path&) {
    throw unsupported("this build does not read TIFF: save the image as NRRD, as in Fiji");
}

}  // namespace scaleaxis::io
