// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "kernel/parallel.hpp"
#include "kernel/random.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/shape.hpp"
#include "shapes/bvh.hpp"
#include "shapes/segment_crossing.hpp"
#include "shapes/self_intersections.hpp"
