// SPDX-License-Identifier: Apache-2.0
/// \file
/// What files that are refused are refused with.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::test {

/// The message of the `FileError` that `call` throws; empty if it throws none.
inline std::string error_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const FileError& error) {
        return error.what();
    }
    return {};
}

/// Expects an error of one line with all these words.
inline void expect_error(const std::function<void()>& call, const std::vector<std::string>& words) {
    const std::string message = error_of(call);
    EXPECT_FALSE(message.empty()) << "no error";
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& word : words) {
        EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' is not in: " << message;
    }
}

}  // namespace scaleaxis::test
