// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scaleaxis/image.hpp"

namespace scaleaxis {

/// The same image in the order in which its axes are nearest to x, y and z and point the same way: so that results do
/// not depend on the order in which values are stored.
Image canonical(Image image);

}  // namespace scaleaxis
