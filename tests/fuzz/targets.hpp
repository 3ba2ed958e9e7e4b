// SPDX-License-Identifier: Apache-2.0
/// \file
/// What libFuzzer (tools/fuzz) and the test of the stored inputs (fuzz_test.cpp) give bytes to.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace scaleaxis::test {

/// Readers of one family. `read` takes any bytes: what it makes of them has to be a value, or an error of the library
/// that is meant for users; anything else ends the program or is thrown.
struct FuzzTarget {
    std::string_view name;  ///< also of its folder in corpus/
    void (*read)(std::span<const std::byte> bytes);
};

const std::vector<FuzzTarget>& fuzz_targets();

}  // namespace scaleaxis::test
