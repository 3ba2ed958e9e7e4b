// SPDX-License-Identifier: GPL-3.0-or-later
#include "balls/general_position.hpp"

#include "scaleaxis/balls.hpp"

namespace scaleaxis {

std::vector<Ball> in_general_position(std::span<const Ball> balls) {
    constexpr double kPerturbation = 1e-9;
    return perturbed(scaled(balls, 1.0 + 2.0 * kPerturbation), kPerturbation, 1);
}

}  // namespace scaleaxis
