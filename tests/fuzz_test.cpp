// SPDX-License-Identifier: Apache-2.0
// What the fuzzers (tools/fuzz) begin with, and all that they have found, read once by each build: tests/fuzz/corpus.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include "fuzz/targets.hpp"

namespace scaleaxis::test {
namespace {

namespace fs = std::filesystem;

class Fuzz : public testing::TestWithParam<FuzzTarget> {};

TEST_P(Fuzz, ReplaysCorpus) {
    std::vector<fs::path> files;
    for (const auto& entry :
         fs::directory_iterator(fs::path(SCALEAXIS_SOURCE_DIR "/tests/fuzz/corpus") / GetParam().name)) {
        files.push_back(entry.path());
    }
    ASSERT_FALSE(files.empty());
    std::ranges::sort(files);
    for (const fs::path& file : files) {
        SCOPED_TRACE(file.string());
        std::ifstream stream(file, std::ios::binary);
        const std::string content{std::istreambuf_iterator<char>(stream), {}};
        EXPECT_NO_THROW(GetParam().read(std::as_bytes(std::span(content))));
        // What is torn has to be survived, too.
        const std::string half = content.substr(0, content.size() / 2);
        EXPECT_NO_THROW(GetParam().read(std::as_bytes(std::span(half))));
    }
}

INSTANTIATE_TEST_SUITE_P(Readers, Fuzz, testing::ValuesIn(fuzz_targets()),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace scaleaxis::test
