// SPDX-License-Identifier: Apache-2.0
/// \file
/// A function that the user writes.
#pragma once

#include <functional>
#include <string>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::app {

/// The function of x, y and z that `expression` stands for. It may be called from several threads at once.
/// \throws InvalidOption naming the column of what is wrong
std::function<double(const Point&)> compiled(const std::string& expression);

}  // namespace scaleaxis::app
